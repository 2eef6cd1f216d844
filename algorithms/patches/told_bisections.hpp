// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bisections that a hierarchy tells in rows of nodes (Hierarchy::bisection_rows), as a grid and a
// field with known bisections (known_bisection.hpp).
#pragma once

#include <algorithm>
#include <array>

#include <nestgrid/nestgrid.h>
#include <nestgrid/hierarchy.hpp>
#include <nestgrid/standard_rules.hpp>
#include <patches/erased_bisections.hpp>
#include <patches/known_bisection.hpp>
#include <patches/mean_values.hpp>

namespace nestgrid::engine {

/// The grid. Borrows hierarchy and task.
template <int dim, class Real>
class ToldBisections {
    static constexpr std::size_t corners_ = static_cast<std::size_t>(dim) + 1;
    using Rows = detail::BisectionRows<Real>;

public:
    using Element = nestgrid_element;
    using Node = typename Rows::Node;
    static constexpr Node no_node = Rows::no_node;
    static constexpr int dimension = dim;
    static constexpr auto bisections = maubach_bisections<dim>();
    static constexpr std::size_t patch_height = dim;

    explicit ToldBisections(const Hierarchy<Real>& hierarchy, Task* task)
        : hierarchy_{&hierarchy}, rows_{hierarchy.bisection_rows()}, task_{task} {
        for (int tag = 1; tag <= dim; ++tag) {
            rules_[static_cast<std::size_t>(tag - 1)] =
                &bisection_rule(dim == 2 ? Shape::triangle : Shape::tetrahedron, tag);
        }
    }

    std::size_t bisection(const Element& e) const {
        return static_cast<std::size_t>(e.word[corners_] - 1);
    }
    std::array<Node, corners_> nodes(const Element& e) const {
        std::array<Node, corners_> n;
        std::copy_n(&e.word[0], corners_, n.begin());
        return n;
    }
    Element element(std::size_t number, const std::array<Node, corners_>& nodes) const {
        Element e{};
        std::copy(nodes.begin(), nodes.end(), &e.word[0]);
        e.word[corners_] = number + 1;
        return e;
    }
    const Rule& rule(std::size_t number) const { return *rules_[number]; }
    unsigned boundary_faces(const Element& e) const {
        Handle handle;
        detail::set_handle(handle, e);
        unsigned faces = 0;
        hierarchy_->corners(task_, handle, corners_, nullptr, nullptr, &faces);
        return faces;
    }
    bool whole() const { return true; }

    // Single questions.
    bool halved(Node a, Node b) const {
        Node z{};
        perhaps_middles(std::span(&a, 1), std::span(&b, 1), std::span(&z, 1));
        return z != no_node;
    }
    /// \throw GridError where the hierarchy has no node in the middle
    Node middle(Node a, Node b) const {
        Node z{};
        middles(std::span(&a, 1), std::span(&b, 1), std::span(&z, 1));
        return z;
    }
    NodeKey key(Node node) const {
        NodeKey key{};
        keys(std::span(&node, 1), std::span(&key, 1));
        return key;
    }
    Point position(Node node) const {
        Point x{};
        positions(std::span(&node, 1), std::span(&x, 1));
        return x;
    }

    // Rows of questions. `out` may be the same row as the first argument.
    void middles(std::span<const Node> a, std::span<const Node> b, std::span<Node> out) const {
        perhaps_middles(a, b, out);
        if (std::find(out.begin(), out.end(), no_node) != out.end()) {
            throw GridError(
                "the operation 'middles' of the grid gave no node for an edge that is halved, for "
                "elements beside it are");
        }
    }
    /// Sets out[i] to the middle of a[i] and b[i], or to no_node where the grid does not halve
    /// their edge.
    void perhaps_middles(std::span<const Node> a, std::span<const Node> b,
                         std::span<Node> out) const {
        rows_->middles(a, b, out);
    }
    void keys(std::span<const Node> nodes, std::span<NodeKey> out) const {
        rows_->keys(nodes, out);
    }
    void positions(std::span<const Node> nodes, std::span<Point> out) const {
        rows_->positions(nodes, out);
    }

private:
    const Hierarchy<Real>* hierarchy_;
    const Rows* rows_;
    Task* task_;
    std::array<const Rule*, static_cast<std::size_t>(dim)> rules_{};
};

/// The field on ToldBisections.
template <class Real>
class ToldValues {
public:
    using value_type = Real;

    /// \param gradients whether gradients_at() works
    ToldValues(const detail::BisectionRows<Real>& rows, bool gradients)
        : rows_{&rows}, gradients_{gradients} {}

    template <bool whole>
    Real value_at(std::uint64_t node, NodeKey key) const {
        Real value{};
        values_at(std::span(&node, 1), std::span(&key, 1), std::span(&value, 1));
        return value;
    }
    void values_at(std::span<const std::uint64_t> nodes, std::span<const NodeKey> keys,
                   std::span<Real> out) const {
        rows_->values(nodes, keys, out);
    }
    bool gives_gradients() const { return gradients_; }
    void gradients_at(std::span<const std::uint64_t> nodes, std::span<Point> out) const {
        rows_->gradients(nodes, out);
    }

private:
    const detail::BisectionRows<Real>* rows_;
    bool gradients_;
};

/// Walks the bisections below an element in patches: by the rows that the hierarchy tells or, where
/// it tells none, by its own bisect(). Requires facts().knows_patches or, for a visitor that takes
/// means, facts().bisects_means.
/// \throw GridError where the element has a tag that does not exist
template <int dim, class Real>
void bisect(const Hierarchy<Real>& hierarchy, Task* task, const Handle& element,
            ErasedBisectionVisitor<dim, Real>& visitor);

}  // namespace nestgrid::engine
