// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A hierarchy that throws where a flag is set, so that every algorithm can be ended from outside,
// also one that takes no callback.
#pragma once

#include <atomic>

#include <nestgrid/detail/forwarding_hierarchy.hpp>

namespace nestgrid::python {

/// Thrown out of an algorithm that is to end.
struct Stopped {};

/// Hands every question on to another hierarchy, and throws Stopped once the flag is set.
template <class Real>
class Stoppable final : public detail::ForwardingHierarchy<Real> {
public:
    /// \param inner and the flag are borrowed
    Stoppable(const Hierarchy<Real>& inner, const std::atomic<bool>& stopped)
        : detail::ForwardingHierarchy<Real>(inner, inner.facts()), stopped_{stopped} {}

    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        asked().coarse(task, i, coarse, family);
    }
    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           Real* out) const override {
        return asked().coarse_values(task, i, corners, out);
    }
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& children) const override {
        return asked().enter(task, element, rule, which, values, wanted, children);
    }
    NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                        Real* values) const override {
        return asked().new_values(task, element, rule, which, values);
    }
    void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                 Point* positions, unsigned* boundary) const override {
        asked().corners(task, element, count, keys, positions, boundary);
    }
    void new_positions(Task* task, const Handle& element, NodeMask which,
                       std::span<Point> out) const override {
        asked().new_positions(task, element, which, out);
    }
    void corner_gradients(Task* task, const Handle& element, std::span<Point> out) const override {
        asked().corner_gradients(task, element, out);
    }
    void star_rows(const std::function<void(const StarRow&)>& function) const override {
        this->inner().star_rows([&](const StarRow& row) {
            asked();
            function(row);
        });
    }
    void row_values(NodeKey first, std::size_t stride, std::span<Real> out) const override {
        asked().row_values(first, stride, out);
    }
    Point node_position(NodeKey node) const override { return asked().node_position(node); }
    const detail::BisectionRows<Real>* bisection_rows() const override {
        return asked().bisection_rows();
    }
    void bisect(Task* task, const Handle& element, const Real* values, int level, int orientation,
                detail::ErasedBisectionVisitor<2, Real>& visitor) const override {
        asked().bisect(task, element, values, level, orientation, visitor);
    }
    void bisect(Task* task, const Handle& element, const Real* values, int level, int orientation,
                detail::ErasedBisectionVisitor<3, Real>& visitor) const override {
        asked().bisect(task, element, values, level, orientation, visitor);
    }
    void bisect_means(Task* task, const Handle& element, const double* values, double tolerance,
                      int level, int orientation,
                      detail::ErasedBisectionVisitor<3, double>& visitor) const override {
        asked().bisect_means(task, element, values, tolerance, level, orientation, visitor);
    }

private:
    const Hierarchy<Real>& asked() const {
        if (stopped_.load(std::memory_order_relaxed)) throw Stopped();
        return this->inner();
    }

    const std::atomic<bool>& stopped_;
};

}  // namespace nestgrid::python
