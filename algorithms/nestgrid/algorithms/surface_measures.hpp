// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Area, enclosed volume, flux and integrals over a surface, per connected component.
//
// Everything is exact for the triangles and for functions that are linear on them, so for smooth
// data the error is of order h^2, h being the size of the elements.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// One connected component of a surface, or a whole one.
struct SurfaceMeasures {
    std::size_t triangles = 0;
    double area = 0;
    Point area_vector{0, 0, 0};  ///< 0 for a closed surface
    /// Enclosed, positive around U >= C, negative around a cavity; means nothing for a component
    /// that is not closed.
    double volume = 0;
    bool closed = true;             ///< no edge belongs to one triangle only
    std::vector<double> integrals;  ///< of each attribute (component 1 ... of the field)
};

/// The measures of all components of a surface.
struct SurfaceMeasurement {
    std::vector<SurfaceMeasures> components;  ///< in the order of their first triangles
    std::vector<std::uint32_t> component_of;  ///< per triangle
    SurfaceMeasures total;
};

/// Measures a triangle surface, component by component.
SurfaceMeasurement measure_surface(const Surface<3>& surface);

/// Flux of a vector field through each component, out of U >= C. The field is component `first`,
/// `first` + 1 and `first` + 2 of the attributes.
/// \throw InvalidInput where there are not so many attributes
std::vector<double> flux(const Surface<3>& surface, const SurfaceMeasurement& measured,
                         std::size_t first = 0);

/// Volume of the part of the domain where low <= U < high, under the projection with a threshold:
/// the difference of two capped surfaces, of which nothing is kept.
/// \throw InvalidInput unless low <= high
/// A hierarchy that has another dimension than 3 is InvalidInput.
template <class Real>
double volume_between(const Hierarchy<Real>& hierarchy, double low, double high,
                      const HierarchicalIndicator& indicator, double threshold = 0) {
    if (!(low <= high)) throw InvalidInput("the lower isovalue is not below the upper one");
    hierarchy.facts().require_one_process("a volume between isovalues");
    Coarse coarse;
    Family family;
    hierarchy.coarse(hierarchy.open().get(), 0, coarse, family);
    const Point origin = coarse.corners[0];
    std::array<double, 2> volume{0, 0};
    const auto adder = [&origin](double* sum) {
        return SimplexStream<3>([sum, &origin](const std::array<Point, 3>& x) {
            *sum += dot(x[0] - origin, cross(x[1] - origin, x[2] - origin)) / 6;
        });
    };
    const std::array<double, 2> isovalues{low, high};
    extract_isosurfaces<3>(hierarchy, std::span<const double>(isovalues),
                           std::vector{adder(&volume[0]), adder(&volume[1])},
                           Threshold(&indicator, threshold), indicator, {.cap = true});
    return volume[0] - volume[1];
}
template <class Grid, class Field>
double volume_between(const Grid& grid, const Field& field, double low, double high,
                      const HierarchicalIndicator& indicator, double threshold = 0) {
    static_assert(Grid::dimension == 3, "volumes need a grid of dimension 3");
    return volume_between(erase(grid, field), low, high, indicator, threshold);
}

}  // namespace nestgrid
