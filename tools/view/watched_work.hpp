// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A hierarchy that is asked now and then whether somebody waits for the work, and ends it by
// FrameAbandoned where nobody does. Results have the bits of the hierarchy inside.
#pragma once

#include <memory>

#include <nestgrid/detail/forwarding_hierarchy.hpp>

#include "frame_watch.hpp"

namespace nestgrid::view {

/// For one thread, which enters elements or takes rows of stars.
template <class Real>
class WatchedHierarchy final : public detail::ForwardingHierarchy<Real> {
public:
    /// Borrows both.
    WatchedHierarchy(const Hierarchy<Real>& inner, const WatchedSteps& steps)
        : detail::ForwardingHierarchy<Real>(inner, inner.facts()), steps_{&steps} {}

    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        watch();
        this->inner().coarse(task, i, coarse, family);
    }
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& children) const override {
        watch();
        return this->inner().enter(task, element, rule, which, values, wanted, children);
    }
    void star_rows(const std::function<void(const StarRow&)>& function) const override {
        this->inner().star_rows([&](const StarRow& row) {
            watch();
            function(row);
        });
    }

private:
    void watch() const {
        constexpr unsigned often = 4096;
        if (++calls_ % often == 0) steps_->check();
    }

    const WatchedSteps* steps_;
    mutable unsigned calls_ = 0;
};

}  // namespace nestgrid::view
