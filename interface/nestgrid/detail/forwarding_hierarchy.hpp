// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A hierarchy that hands every question on to another one, for those that change or watch some.
#pragma once

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::detail {

template <class Real>
class ForwardingHierarchy : public Hierarchy<Real> {
public:
    const Hierarchy<Real>& inner() const { return *inner_; }

    std::size_t coarse_count() const override { return inner_->coarse_count(); }
    std::uint64_t epoch() const override { return inner_->epoch(); }
    Elements make_elements() const override { return inner_->make_elements(); }
    std::unique_ptr<Task> open() const override { return inner_->open(); }
    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        inner_->coarse(task, i, coarse, family);
    }
    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           Real* out) const override {
        return inner_->coarse_values(task, i, corners, out);
    }
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& children) const override {
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
    void node_gradients(std::span<const NodeKey> nodes, std::span<Point> out) const override {
        inner_->node_gradients(nodes, out);
    }
    int degree(Task* task, const Handle& leaf) const override { return inner_->degree(task, leaf); }
    void evaluate(Task* task, const Handle& leaf, std::span<const Point> reference,
                  Real* out) const override {
        inner_->evaluate(task, leaf, reference, out);
    }
    int geometry_degree(Task* task, const Handle& leaf) const override {
        return inner_->geometry_degree(task, leaf);
    }
    void map(Task* task, const Handle& leaf, std::span<const Point> reference,
             std::span<Point> out) const override {
        inner_->map(task, leaf, reference, out);
    }
    std::array<NodeKey, 2> hanging_parents(NodeKey node) const override {
        return inner_->hanging_parents(node);
    }
    void star_rows(const std::function<void(const StarRow&)>& function) const override {
        inner_->star_rows(function);
    }
    void row_values(NodeKey first, std::size_t stride, std::span<Real> out) const override {
        inner_->row_values(first, stride, out);
    }
    Point node_position(NodeKey node) const override { return inner_->node_position(node); }
    const BisectionRows<Real>* bisection_rows() const override { return inner_->bisection_rows(); }
    void bisect(const Handle& element, PatchVisitor& visitor) const override {
        inner_->bisect(element, visitor);
    }

protected:
    /// \param inner is borrowed
    /// \param facts those of `inner`, but for what is changed
    ForwardingHierarchy(const Hierarchy<Real>& inner, const HierarchyFacts& facts)
        : Hierarchy<Real>(facts), inner_{&inner} {}

private:
    const Hierarchy<Real>* inner_;
};

}  // namespace nestgrid::detail
