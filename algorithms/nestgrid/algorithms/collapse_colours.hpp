// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fewer triangles of the same colours: edges of a drawn slice, boundary surface, shading or height
// field are collapsed as long as the data allow it. The surface keeps its place, or is kept within
// a distance of it, as a curved slice is best.
//
// Invariants, checked for every collapse:
//   - without a distance, vertices move in planes of the surface, and along its straight creases
//     and outlines; corners stay, and no triangle turns over. A height field does so in its plane;
//   - with a distance, no point of a new triangle is farther than that from the surface of all
//     data, no point of that becomes farther from what is drawn, and nothing else meets the
//     tetrahedra between old and new triangles. Borders keep on the domain's boundary;
//   - on every new triangle each attribute, linear between vertices, differs at every point by at
//     most its error from U, the data interpolated on the finest grid. This is checked on all
//     leaves that the triangle crosses, not at some of its points;
//   - the triangles around the edge stay a manifold and flatten by no more than is allowed.
// Consequence: without a distance the surface consists of the same points as before, up to
// rounding; with one it crosses itself nowhere and stays in the domain. Attributes stay continuous.
// The result depends neither on the order nor on the number of threads.
#pragma once

#include <nestgrid/algorithms/collapse.hpp>

namespace nestgrid {

/// What a collapse of colours is asked for.
struct ColourCollapseOptions {
    /// By attribute, in the units of the data, or one for all of them: positive.
    std::vector<double> errors{};
    /// That of a height field: vertices are lifted along z by it times attribute 0. Finite.
    double scale = 0;
    /// How far the surface may be from that of all data, there and back: for slices without a cap.
    /// Where there is nothing, it keeps its place. Not with a scale.
    std::optional<Nearness> nearness{};
    double turn = 78;    ///< beside a distance, as in CollapseOptions
    double shape = 0.1;  ///< the least quality of a triangle in its plane, as in CollapseOptions
};

/// Collapses edges of a surface that slice(), boundary_surface(), shading() or height_field() has
/// drawn. Best begun with one of half the error; beside a distance, with the slice of all data, as
/// coarser ones may be far from it. Vertices that are left need not have the data's own values, but
/// within the errors.
///
/// Afterwards the surface has vertices, triangles, attributes and boundary edges, and normals from
/// its triangles where it had normals. What is told of elements is gone. Where it cannot be decided
/// that a triangle keeps an error, as in elements with bent faces, it counts as one that does not.
/// What is too far from the beginning stays so.
/// \param surface its attributes are the last components of the field
/// \param bounds of the same grid and field: a HierarchicalIndicator, or other Bounds
/// \return `error` is that of attribute 0: other attributes are off by the same part of their
///         errors. Triangles that did not keep theirs, or the distance, from the beginning are
///         `exceeding`, and stay
/// \throw InvalidInput where an option is out of range, where the surface has no attributes, other
///        ones than errors, or more than the field has components; with a distance where the
///        hierarchy has another dimension than 3
/// \throw GridError where the grid has changed since the bounds were computed
template <class Real>
Collapsed collapse_colours(Surface<3>& surface, const Hierarchy<Real>& hierarchy,
                           const Bounds& bounds, const ColourCollapseOptions& options,
                           const Executor& executor = SequentialExecutor{});

}  // namespace nestgrid
