// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::detail {

/// A hierarchy whose values are converted to double. It is borrowed.
class Widened final : public Hierarchy<double> {
public:
    explicit Widened(const Hierarchy<float>& from)
        : Hierarchy<double>(from.facts()), from_{&from} {}

    std::size_t coarse_count() const override { return from_->coarse_count(); }
    std::uint64_t epoch() const override { return from_->epoch(); }
    Elements make_elements() const override { return from_->make_elements(); }
    std::unique_ptr<Task> open() const override { return from_->open(); }
    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        from_->coarse(task, i, coarse, family);
    }
    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           double* out) const override {
        return widen(corners, out,
                     [&](float* values) { return from_->coarse_values(task, i, corners, values); });
    }
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   double* values, NodeMask wanted, Family& children) const override {
        if (which == 0) return from_->enter(task, element, rule, 0, nullptr, wanted, children);
        return widen_split(rule, values, [&](float* narrow) {
            return from_->enter(task, element, rule, which, narrow, wanted, children);
        });
    }
    NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                        double* values) const override {
        return widen_split(rule, values, [&](float* narrow) {
            return from_->new_values(task, element, rule, which, narrow);
        });
    }
    void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                 Point* positions, unsigned* boundary) const override {
        from_->corners(task, element, count, keys, positions, boundary);
    }
    void new_positions(Task* task, const Handle& element, NodeMask which,
                       std::span<Point> out) const override {
        from_->new_positions(task, element, which, out);
    }
    std::array<NodeKey, 2> hanging_parents(NodeKey node) const override {
        return from_->hanging_parents(node);
    }
    void corner_gradients(Task* task, const Handle& element, std::span<Point> out) const override {
        from_->corner_gradients(task, element, out);
    }
    void node_gradients(std::span<const NodeKey> nodes, std::span<Point> out) const override {
        from_->node_gradients(nodes, out);
    }
    int degree(Task* task, const Handle& leaf) const override { return from_->degree(task, leaf); }
    void evaluate(Task* task, const Handle& leaf, std::span<const Point> reference,
                  double* out) const override {
        std::vector<float> values(reference.size() * static_cast<std::size_t>(facts().components));
        from_->evaluate(task, leaf, reference, values.data());
        std::copy(values.begin(), values.end(), out);
    }
    int geometry_degree(Task* task, const Handle& leaf) const override {
        return from_->geometry_degree(task, leaf);
    }
    void map(Task* task, const Handle& leaf, std::span<const Point> reference,
             std::span<Point> out) const override {
        from_->map(task, leaf, reference, out);
    }

private:
    /// Lets ask() write all components at some nodes, and converts them. There is room for as many
    /// nodes as any rule has.
    template <class Ask>
    NodeMask widen(std::size_t nodes, double* out, Ask&& ask) const {
        const auto components = static_cast<std::size_t>(facts().components);
        std::vector<float> values(max_new_nodes * components);
        const NodeMask missing = ask(values.data());
        std::copy_n(values.begin(), nodes * components, out);
        return missing;
    }

    /// widen() at new nodes, behind the values at the corners of a split, which are given.
    template <class Ask>
    NodeMask widen_split(const Rule& rule, double* split, Ask&& ask) const {
        const auto components = static_cast<std::size_t>(facts().components);
        const std::size_t corners = static_cast<std::size_t>(rule.corner_count()) * components;
        std::vector<float> values((max_corners + max_new_nodes) * components);
        for (std::size_t i = 0; i < corners; ++i) values[i] = static_cast<float>(split[i]);
        const NodeMask missing = ask(values.data());
        std::copy_n(values.data() + corners, rule.new_nodes.size() * components, split + corners);
        return missing;
    }

    const Hierarchy<float>* from_;
};

}  // namespace nestgrid::detail
