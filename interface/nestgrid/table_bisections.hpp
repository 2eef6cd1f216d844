// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bisections that C codes tell in their tables (nestgrid.h), as a grid and a field that know them
// (known_bisection.hpp).
#pragma once

#include <algorithm>
#include <vector>

#include <nestgrid/nestgrid.h>
#include <nestgrid/known_bisection.hpp>
#include <nestgrid/standard_rules.hpp>
#include <nestgrid/table.hpp>

namespace nestgrid::detail {

/// The table is borrowed.
template <int dim>
class TableBisections {
    static constexpr std::size_t corners_ = static_cast<std::size_t>(dim) + 1;

public:
    using Element = nestgrid_element;
    using Node = std::uint64_t;
    static constexpr Node no_node = NESTGRID_NO_NODE;
    static constexpr int dimension = dim;
    static constexpr auto bisections = maubach_bisections<dim>();
    static constexpr std::size_t block_height = dim;

    /// Whether a table has what it takes.
    static bool are_in(const nestgrid_grid& t) {
        return t.middles != nullptr && t.node_keys != nullptr && t.node_positions != nullptr &&
               t.corner_keys != nullptr && t.new_keys != nullptr && t.corner_positions != nullptr &&
               t.boundary_faces != nullptr && t.conforming != 0 && t.constrained == nullptr &&
               t.masked == nullptr && t.hidden == nullptr && t.outside == nullptr;
    }

    /// \param context of the task that walks
    explicit TableBisections(const nestgrid_grid& table, void* context)
        : table_{&table}, context_{context} {
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
        unsigned faces = 0;
        check(table_->boundary_faces(table_->self, context_, &e, &faces), "boundary_faces");
        return faces;
    }
    bool whole() const { return true; }

    // One by one.
    bool halved(Node a, Node b) const {
        Node z{};
        perhaps_middles(std::span(&a, 1), std::span(&b, 1), std::span(&z, 1));
        return z != no_node;
    }
    /// \throw GridError where there is none
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

    // In rows; the answers may take the place of the first one.
    void middles(std::span<const Node> a, std::span<const Node> b, std::span<Node> out) const {
        perhaps_middles(a, b, out);
        if (std::find(out.begin(), out.end(), no_node) != out.end()) {
            throw GridError(
                "the operation 'middles' of the grid gave no node for an edge that is halved, for "
                "elements beside it are");
        }
    }
    /// The same, or no_node where an edge is not halved.
    void perhaps_middles(std::span<const Node> a, std::span<const Node> b,
                         std::span<Node> out) const {
        check(table_->middles(table_->self, out.size(), a.data(), b.data(), out.data()), "middles");
    }
    void keys(std::span<const Node> nodes, std::span<NodeKey> out) const {
        if constexpr (std::is_same_v<NodeKey, std::uint64_t>) {
            check(table_->node_keys(table_->self, nodes.size(), nodes.data(), out.data()),
                  "node_keys");
        } else {
            std::vector<std::uint64_t> narrow(nodes.size());
            check(table_->node_keys(table_->self, nodes.size(), nodes.data(), narrow.data()),
                  "node_keys");
            std::copy(narrow.begin(), narrow.end(), out.begin());
        }
    }
    void positions(std::span<const Node> nodes, std::span<Point> out) const {
        check(table_->node_positions(table_->self, nodes.size(), nodes.data(), as_rows(out)),
              "node_positions");
    }

private:
    static void check(int code, const char* operation) { check_code(code, "grid", operation); }

    const nestgrid_grid* table_;
    void* context_;
    std::array<const Rule*, static_cast<std::size_t>(dim)> rules_{};
};

/// The field on it; the table is borrowed.
template <class Real>
class TableValues {
public:
    using value_type = Real;

    explicit TableValues(const nestgrid_field& table) : table_{&table} {}

    template <bool whole>
    Real value_at(std::uint64_t node, NodeKey key) const {
        Real value{};
        values_at(std::span(&node, 1), std::span(&key, 1), std::span(&value, 1));
        return value;
    }
    void values_at(std::span<const std::uint64_t> nodes, std::span<const NodeKey> keys,
                   std::span<Real> out) const {
        const auto ask = [&](const std::uint64_t* narrow) {
            check_code(
                table_->node_values(table_->self, nodes.size(), nodes.data(), narrow, out.data()),
                "field", "node_values");
        };
        if constexpr (std::is_same_v<NodeKey, std::uint64_t>) {
            ask(keys.data());
        } else {
            ask(std::vector<std::uint64_t>(keys.begin(), keys.end()).data());
        }
    }

private:
    const nestgrid_field* table_;
};

}  // namespace nestgrid::detail
