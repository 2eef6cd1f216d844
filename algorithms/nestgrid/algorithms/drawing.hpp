// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A field drawn as finely as a projection says: one call from a wish to what is drawn, with the
// indicators that earlier calls have made. What holds of each drawing, the header of its algorithm
// says.
//
//     Prerolls prerolls({grid, field});
//     const auto drawn = isosurface<3>(prerolls, 12.0, {.threshold = 0.1, .indicator = "error"});
//
// In each function
//   - options say what is kept and how, but not how finely: their threshold and number of triangles
//     have no effect;
//   - where edges are collapsed, what is drawn first has a part of the threshold, so that the whole
//     of it is kept in the end;
//   - a field of higher degree is drawn within an error by virtual refinement (high_order.hpp), by
//     any other projection at the corners of its leaves;
//   - it throws InvalidInput as Projection::check() and Prerolls::choose() do, and where the field
//     has another dimension; GridError where the field has no value, or where the grid has changed.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/least_threshold.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/prerolls.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/shading.hpp>
#include <nestgrid/algorithms/slice.hpp>

namespace nestgrid {

/// What was drawn under a projection, and what the projection came to.
template <class Result>
struct Projected : Result {
    /// At which threshold; with how it was found, where the projection has a number of triangles.
    TriangleBudget search{};
    std::optional<Collapsed> collapsed{};  ///< where edges were collapsed
    /// Vertices that were too far at first, where a distance is kept.
    std::size_t far_points = 0;

    /// Why there are fewer triangles than were asked for, as a sentence; or empty.
    std::string budget_reason() const {
        return search.max_triangles > 0 ? search.reason() : std::string();
    }
};

/// The error within which polynomials are drawn where nobody asks for one: a thousandth of their
/// range.
double default_error(const HighOrder& data);

/// The projection by which a front end draws a field: this one, but of a field of higher degree
/// always one within an error, which is default_error() where the projection asks for nothing.
///
/// \throw InvalidInput as Projection::require_error_alone(), and as HighOrder
Projection with_error(Prerolls& prerolls, Projection projection, const Work& work = {});

/// The isosurface of a field of dimension 3, or the isoline of one of dimension 2. Edges are
/// collapsed, and distances kept, in dimension 3.
/// \throw InvalidInput also where an isosurface that is collapsed is to have a cap or vertices at
///        nodes, and where the isovalue is not a number
template <int dimension>
Projected<Isosurface<dimension>> isosurface(Prerolls& prerolls, double isovalue,
                                            const Projection& projection,
                                            const IsosurfaceOptions& options = {},
                                            const Work& work = {});

/// Several isosurfaces in one walk (isosurfaces.hpp), one result for each isovalue, at one
/// threshold.
/// \throw InvalidInput also for collapses, distances that are kept and a number of triangles
template <int dimension>
std::vector<Isosurface<dimension>> isosurfaces(Prerolls& prerolls,
                                               std::span<const double> isovalues,
                                               const Projection& projection,
                                               const IsosurfaceOptions& options = {},
                                               const Work& work = {});

/// How far an isosurface is from the data and from that of all data, which is drawn for it
/// (measured_error.hpp).
/// \param points about how many to measure at, on each of both
MeasuredError measure_error(Prerolls& prerolls, const Surface<3>& drawn, double isovalue,
                            std::size_t points = 200000, const Work& work = {});

/// The slice of a field of dimension 3. Where all data are asked for, it needs no preroll. Colours
/// keep the threshold where edges are collapsed, or the least one with a number of triangles.
Projected<Slice> slice(Prerolls& prerolls, const LevelFunction& function,
                       const Projection& projection, const IsosurfaceOptions& options = {},
                       const Work& work = {});

/// The boundary of the domain of a field of dimension 3, as slice() draws it.
Projected<Slice> boundary_surface(Prerolls& prerolls, const Projection& projection,
                                  const IsosurfaceOptions& options = {}, const Work& work = {});

/// The band low <= U <= high of a field of dimension 2 or 3 (isoband.hpp).
/// \throw InvalidInput also for collapses and for a number of triangles
template <int dimension>
Projected<Isosurface<dimension>> isoband(Prerolls& prerolls, double low, double high,
                                         const Projection& projection,
                                         const IsosurfaceOptions& options = {},
                                         const Work& work = {});

/// Isolines of a field of dimension 2.
/// \throw InvalidInput also for collapses, and for a number of triangles
Projected<Isolines> isolines(Prerolls& prerolls, std::span<const double> values,
                             const Projection& projection, const IsosurfaceOptions& options = {},
                             const Work& work = {});

/// The field of dimension 2 as a triangulation in its plane, or on its surface in space.
Projected<Shading> shading(Prerolls& prerolls, const Projection& projection,
                           const ShadingOptions& options = {}, const Work& work = {});

/// The same, lifted along z by a scale times component 0.
Projected<Shading> height_field(Prerolls& prerolls, double scale, const Projection& projection,
                                const ShadingOptions& options = {}, const Work& work = {});

/// P_S U at points.
/// \throw InvalidInput also for collapses, and for a number of triangles
ProbeResult probe(Prerolls& prerolls, std::span<const Point> points, const Projection& projection,
                  const Work& work = {});

}  // namespace nestgrid
