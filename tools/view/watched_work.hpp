// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A hierarchy that is asked now and then whether somebody waits for the work, and ends it by
// FrameAbandoned where nobody does. Results have the bits of the hierarchy inside.
#pragma once

#include <memory>

#include <nestgrid/hierarchy.hpp>

#include "frame_watch.hpp"

namespace nestgrid::view {

/// For one thread, which enters elements or takes rows of stars.
template <class Real>
class WatchedHierarchy final : public Hierarchy<Real> {
public:
    /// Borrows both.
    WatchedHierarchy(const Hierarchy<Real>& inner, const WatchedSteps& steps)
        : Hierarchy<Real>(inner.facts()), inner_{&inner}, steps_{&steps} {}

    std::size_t coarse_count() const override { return inner_->coarse_count(); }
    std::uint64_t epoch() const override { return inner_->epoch(); }
    Elements make_elements() const override { return inner_->make_elements(); }
    std::unique_ptr<Task> open() const override { return inner_->open(); }
    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        watch();
        inner_->coarse(task, i, coarse, family);
    }
    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           Real* out) const override {
        return inner_->coarse_values(task, i, corners, out);
    }
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& children) const override {
        watch();
        return inner_->enter(task, element, rule, which, values, wanted, children);
    }
    NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                        Real* values) const override {
        return inner_->new_values(task, element, rule, which, values);
    }
    void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                 Point* positions, unsigned* boundary) const override {
        inner_->corners(task, element, count, keys, positions, boundary);
    }
    void new_positions(Task* task, const Handle& element, NodeMask which,
                       std::span<Point> out) const override {
        inner_->new_positions(task, element, which, out);
    }
    void corner_gradients(Task* task, const Handle& element, std::span<Point> out) const override {
        inner_->corner_gradients(task, element, out);
    }
    std::array<NodeKey, 2> hanging_parents(NodeKey node) const override {
        return inner_->hanging_parents(node);
    }
    void star_rows(const std::function<void(const StarRow&)>& function) const override {
        inner_->star_rows([&](const StarRow& row) {
            watch();
            function(row);
        });
    }
    void row_values(NodeKey first, std::size_t stride, std::span<Real> out) const override {
        inner_->row_values(first, stride, out);
    }
    Point node_position(NodeKey node) const override { return inner_->node_position(node); }
    const detail::BisectionRows<Real>* bisection_rows() const override {
        return inner_->bisection_rows();
    }
    void bisect(Task* task, const Handle& element, const Real* values, int level, int orientation,
                detail::ErasedBisectionVisitor<2, Real>& visitor) const override {
        inner_->bisect(task, element, values, level, orientation, visitor);
    }
    void bisect(Task* task, const Handle& element, const Real* values, int level, int orientation,
                detail::ErasedBisectionVisitor<3, Real>& visitor) const override {
        inner_->bisect(task, element, values, level, orientation, visitor);
    }
    void bisect_means(Task* task, const Handle& element, const double* values, double tolerance,
                      int level, int orientation,
                      detail::ErasedBisectionVisitor<3, double>& visitor) const override {
        inner_->bisect_means(task, element, values, tolerance, level, orientation, visitor);
    }

private:
    void watch() const {
        constexpr unsigned often = 4096;
        if (++calls_ % often == 0) steps_->check();
    }

    const Hierarchy<Real>* inner_;
    const WatchedSteps* steps_;
    mutable unsigned calls_ = 0;
};

}  // namespace nestgrid::view
