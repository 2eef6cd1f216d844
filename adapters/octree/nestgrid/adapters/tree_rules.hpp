// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How trees of quadrilaterals or hexahedra are divided, by two or by three in each direction, and
// which new nodes hang: those that an undivided neighbour has on a face or an edge.
#pragma once

#include <array>
#include <vector>

#include <nestgrid/standard_rules.hpp>

namespace nestgrid::detail {

/// Nodes are those of a lattice of thirds, each a mean of the corners around it.
inline Rule make_ternary_rule(Shape shape, int dim) {
    constexpr int side = 4;  // nodes along an edge
    const int corners = 1 << dim;
    const auto digit = [](int number, int base, int d) {
        for (; d > 0; --d) number /= base;
        return number % base;
    };
    const int nodes = dim == 2 ? 16 : 64;
    std::vector<std::uint8_t> number(static_cast<std::size_t>(nodes));  // in the rule, by place
    std::vector<Stencil> stencils;
    for (int place = 0; place < nodes; ++place) {
        Stencil stencil;
        for (int k = 0; k < corners; ++k) {
            int weight = 1;
            for (int d = 0; d < dim; ++d) {
                const int at = digit(place, side, d);
                weight *= (k >> d & 1) != 0 ? at : 3 - at;
            }
            if (weight == 0) continue;
            stencil.parent[stencil.count] = static_cast<std::uint8_t>(k);
            stencil.weight[stencil.count++] = weight / (dim == 2 ? 9.0 : 27.0);
        }
        const bool is_corner = stencil.count == 1;
        number[static_cast<std::size_t>(place)] =
            is_corner ? stencil.parent[0]
                      : static_cast<std::uint8_t>(corners + static_cast<int>(stencils.size()));
        if (!is_corner) stencils.push_back(stencil);
    }
    std::vector<Child> children;
    for (int c = 0; c < (dim == 2 ? 9 : 27); ++c) {
        Child child{shape, {}, 1, {}};
        for (int k = 0; k < corners; ++k) {
            int place = 0;
            for (int d = dim; d-- > 0;) place = side * place + digit(c, 3, d) + (k >> d & 1);
            child.corner[static_cast<std::size_t>(k)] = number[static_cast<std::size_t>(place)];
        }
        children.push_back(child);
    }
    return make_rule("thirds", shape, std::move(stencils), std::move(children));
}

/// A quadrilateral or hexahedron divided into `factor` in each direction, children x fastest.
template <int dim, int factor>
const Rule& rule_of_trees() {
    constexpr Shape shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;
    if constexpr (factor == 2) {
        return dyadic_rule(shape);
    } else {
        static const Rule rule = make_ternary_rule(shape, dim);
        return rule;
    }
}

/// The new nodes of an element, by the neighbours of its size that have them, too.
template <int dim, int factor>
class NodesOfTrees {
public:
    NodesOfTrees() {
        const Rule& rule = rule_of_trees<dim, factor>();
        for (std::size_t s = 0; s < shared_.size(); ++s) {
            if (s == shared_.size() / 2) continue;  // the element itself
            for (std::size_t n = 0; n < rule.new_corner.size(); ++n) {
                if (lies_beside(rule.new_corner[n], s)) shared_[s] |= NodeMask{1} << n;
            }
        }
    }

    /// \param is_undivided called with the way to a neighbour: -1, 0 or 1 steps as long as the
    ///        element along each direction. Whether a leaf that is not hidden fills its place
    template <class IsUndivided>
    NodeMask hanging(const IsUndivided& is_undivided) const {
        NodeMask hanging = 0;
        for (std::size_t s = 0; s < shared_.size(); ++s) {
            if ((shared_[s] & ~hanging) == 0) continue;
            std::array<int, 3> steps{};
            for (std::size_t d = 0, rest = s; d < dim; ++d, rest /= 3) {
                steps[d] = static_cast<int>(rest % 3) - 1;
            }
            if (is_undivided(steps)) hanging |= shared_[s];
        }
        return hanging;
    }

private:
    static bool lies_beside(const ChildCorner& node, std::size_t side) {
        std::size_t child = node.child;
        for (std::size_t d = 0; d < dim; ++d, child /= factor, side /= 3) {
            const std::size_t at = child % factor + (node.corner >> d & 1U);
            if (side % 3 != 1 && at != (side % 3 == 0 ? 0 : factor)) return false;
        }
        return true;
    }

    std::array<NodeMask, dim == 2 ? 9 : 27> shared_{};
};

}  // namespace nestgrid::detail
