// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/child_maps.hpp>

#include <cmath>

#include <nestgrid/detail/shape_functions.hpp>
#include <walk/interpolate.hpp>

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
bool is_nested(const Rule& rule, const Child& child, const ChildMap& map) {
    const std::size_t corners = topology(child.shape).corners;
    const Point middle = reference_middle(child.shape);
    for (std::size_t i = 0; i < static_cast<std::size_t>(rule.corner_count()); ++i) {
        const std::vector<double> nodal = at_nodes(rule, i);
        for (std::size_t towards = 0; towards < corners; ++towards) {
            const Point& corner = topology(child.shape).reference[towards];
            const Point s = middle + 0.375 * (corner - middle);
            const auto weight = shape_functions(child.shape, s);
            double interpolated = 0;
            for (std::size_t k = 0; k < corners; ++k) {
                interpolated += weight[k] * nodal[child.corner[k]];
            }
            const Point at = place_of(child.shape, map.corners(), s);
            if (std::abs(interpolated - shape_functions(rule.parent, at)[i]) > 1e-12) return false;
        }
    }
    return true;
}

}  // namespace

ChildMap::ChildMap(const Child& child, std::span<const Point> nodes) : shape_{child.shape} {
    const Topology& t = topology(shape_);
    for (std::size_t k = 0; k < t.corners; ++k) corner_[k] = nodes[child.corner[k]];
    affine_ = is_affine(shape_, corners());
    const Point origin = place_of(shape_, corners(), {0, 0, 0});
    std::array<Point, 3> a{Point{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t d = 0; d < t.dimension; ++d) {
        Point unit{0, 0, 0};
        unit[d] = 1;
        a[d] = place_of(shape_, corners(), unit) - origin;
    }
    const double determinant = dot(a[0], cross(a[1], a[2]));
    row_ = {(1 / determinant) * cross(a[1], a[2]), (1 / determinant) * cross(a[2], a[0]),
            (1 / determinant) * cross(a[0], a[1])};
}

ChildMaps make_child_maps(const Rule& rule) {
    const std::vector<Point> nodes = reference_nodes(rule);
    ChildMaps maps;
    for (const Child& child : rule.children) {
        maps.child.emplace_back(child, nodes);
        maps.nested = maps.nested && is_nested(rule, child, maps.child.back());
    }
    return maps;
}

}  // namespace nestgrid::engine
