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

#include <nestgrid/algorithms/prerolls.hpp>
#include <nestgrid/algorithms/projection.hpp>
#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/algorithms/watch.hpp>

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

/// Volume of the part of the domain of dimension 3 where low <= U < high: the difference of two
/// capped surfaces, of which nothing is kept.
/// \throw InvalidInput unless low <= high, and as extract_isosurfaces()
double volume_between(const Prerolls& prerolls, double low, double high,
                      const Projection& projection = {}, const Work& work = {});

}  // namespace nestgrid
