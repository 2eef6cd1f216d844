// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators that keep the error of isosurfaces with given isovalues: where U is far from all of
// them, nothing is kept.
//
// The cut deviation of an element E that is split, for one isovalue C, with the interpolant I U of
// its corner values, is the greatest of
//   - |U - C| where I U = C, and |I U - C| where U = C, on the leaves below E;
//   - |U - C| at the nodes below E at which U and I U lie on different sides of C.
// eta of a node is that of the elements whose split makes it, saturated. Where a split makes
// several nodes, it also counts what a child may draw while some of its corners are dropped; in
// shapes other than simplices it counts the flatness of the triangles of E. Consequences, where S =
// (eta <= epsilon), with P_S U as it is drawn:
//   - |U - C| <= epsilon on every triangle, but for those in leaves, which in shapes other than
//     simplices are as flat as without a criterion;
//   - |P_S U - C| <= epsilon on the whole surface U = C of the finest grid, also where nothing is
//     drawn;
//   - U > C + epsilon is inside what is drawn, and U < C - epsilon is outside.
// All this holds for several isovalues, and for none between them: bounds, for the search, are
// those of the data. Isosurface::surface_error is the error that was reached.
#pragma once

#include <span>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

namespace detail {

/// Whether all elements are simplices, where cut deviations are the errors themselves. In other
/// shapes the flatness of triangles counts several times, and deviations of elements
/// (NodeError::deviation) keep the same error with fewer triangles.
bool cuts_are_errors(const HierarchyFacts& facts);

}  // namespace detail

/// \param bounds of the same grid and field: a HierarchicalIndicator, or other Bounds
/// \param executor of several threads, or of one; the result does not depend on it
/// \throw InvalidInput where an isovalue is not finite, and for a spread as in measured_indicator()
/// \throw GridError where the grid has changed since the bounds were computed
SweptIndicator cut_deviations(const FieldOnGrid& field, std::span<const double> isovalues,
                              const Bounds& bounds, const Spread& spread = {},
                              const Executor& executor = SequentialExecutor{});

/// The same errors, each divided by the slope there of what is not C, and at most the diameter of
/// the element: an estimate of the distance between the two surfaces, in units of length. It keeps
/// no promise: where the data are flat, the surface may be further off, and parts smaller than
/// epsilon may be left out.
SweptIndicator slope_deviations(const FieldOnGrid& field, std::span<const double> isovalues,
                                const Bounds& bounds, const Spread& spread = {},
                                const Executor& executor = SequentialExecutor{});

}  // namespace nestgrid
