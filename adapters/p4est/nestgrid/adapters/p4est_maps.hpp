// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the trees of a forest lie; included by p4est.hpp.
#pragma once

#include <p4est_geometry.h>
#include <p8est_geometry.h>

#include <nestgrid/shape.hpp>

namespace nestgrid {

/// Trees are bilinear or trilinear between the vertices of their connectivity.
struct P4estVertices {};

/// Trees are mapped by a geometry of p4est's own, p4est_geometry_t or p8est_geometry_t. Its
/// function X is called from all threads at once.
template <class Geometry>
struct P4estGeometry {
    Geometry* geometry;
    Point operator()(std::size_t tree, const Point& reference) const {
        Point x{0, 0, 0};
        geometry->X(geometry, static_cast<p4est_topidx_t>(tree), reference.data(), x.data());
        return x;
    }
};
template <class Geometry>
P4estGeometry(Geometry*) -> P4estGeometry<Geometry>;

}  // namespace nestgrid
