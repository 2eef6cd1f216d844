// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/child_maps.hpp>

#include <cmath>

#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/detail/shape_functions.hpp>

namespace nestgrid::engine {

namespace {

/// The shape function of a corner of the parent at all nodes of a rule, as its stencils have it.
std::vector<double> at_nodes(const Rule& rule, std::size_t corner) {
    std::vector<double> value(static_cast<std::size_t>(rule.corner_count()), 0.0);
    value[corner] = 1;
    for (const Stencil& s : rule.new_nodes) {
        value.push_back(detail::interpolate(s, value.data(), 1));
    }
    return value;
}

/// Whether each shape function of the parent, restricted to the child, is the one that the child
/// interpolates between its corners.
/// \param at_node the shape functions of the parent, each at all nodes
bool is_nested(Shape parent, const Child& child, const InverseMap& map,
               std::span<const std::vector<double>> at_node) {
    const std::size_t corners = topology(child.shape).corners;
    const Point middle = reference_middle(child.shape);
    for (std::size_t towards = 0; towards < corners; ++towards) {
        const Point& corner = topology(child.shape).reference[towards];
        const Point s = middle + 0.375 * (corner - middle);
        const auto weight = shape_functions(child.shape, s);
        const auto expected = shape_functions(parent, place_of(child.shape, map.corners(), s));
        for (std::size_t i = 0; i < at_node.size(); ++i) {
            double interpolated = 0;
            for (std::size_t k = 0; k < corners; ++k) {
                interpolated += weight[k] * at_node[i][child.corner[k]];
            }
            if (std::abs(interpolated - expected[i]) > 1e-12) return false;
        }
    }
    return true;
}

}  // namespace

ChildMaps make_child_maps(const Rule& rule) {
    const std::vector<Point> nodes = reference_nodes(rule);
    std::vector<std::vector<double>> shape_function;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rule.corner_count()); ++i) {
        shape_function.push_back(at_nodes(rule, i));
    }
    ChildMaps maps{&rule, {}};
    for (const Child& child : rule.children) {
        std::array<Point, max_corners> corner;
        const std::size_t corners = topology(child.shape).corners;
        for (std::size_t k = 0; k < corners; ++k) corner[k] = nodes[child.corner[k]];
        maps.child.emplace_back(child.shape, std::span(corner).first(corners));
        maps.nested =
            maps.nested && is_nested(rule.parent, child, maps.child.back(), shape_function);
    }
    return maps;
}

}  // namespace nestgrid::engine
