// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/algorithms/isosurfaces.hpp>

#include "sample_grids.hpp"

namespace nestgrid_test {

/// A sphere in an octree with hanging nodes, extracted into a sink and as a Surface.
template <class Sink>
Isosurface<3> pour_sphere(Sink sink) {
    OctreeGrid<3> grid(shaken(hexahedra(2), 1, 0.05), {.balanced = false});
    refine_at_sphere(grid, 4);
    const auto values = sample_nodes(grid, [](const Point& x) { return -to_sphere(x, 3); });
    const NodeField<OctreeGrid<3>, double> field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    const Threshold criterion{&indicator, 0.01};
    const double isovalue = 0;
    extract_isosurfaces(grid, field, std::span<const double>(&isovalue, 1),
                        std::vector<Sink>{std::move(sink)}, under(criterion, indicator),
                        {.normals = true});
    return isosurface(grid, field, isovalue, under(criterion, indicator), {.normals = true});
}

}  // namespace nestgrid_test
