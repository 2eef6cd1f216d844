// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several slices and isosurfaces of a hierarchy of dimension 3 in one traversal. What holds of each
// slice, slice.hpp says.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/slice.hpp>

namespace nestgrid {

/// What one walk draws.
struct SliceRequest {
    std::vector<const LevelFunction*> functions;  ///< borrowed
    std::vector<double> isovalues{};              ///< isosurfaces of component 0, behind the slices
};

namespace detail {

/// Draws into targets, or into the results where there are none.
std::vector<Slice> draw_slices(const Prerolls& prerolls, const SliceRequest& request,
                               const SurfaceTargets<3>& targets, const Projection& projection,
                               const IsosurfaceOptions& options, const Work& work);

}  // namespace detail

/// Slices and isosurfaces at one threshold. All carry all components of the field as attributes.
/// \throw InvalidInput also where an isovalue is not finite, for collapses, distances that are
///        kept, tolerances of colours, and a number of triangles
inline std::vector<Slice> slices(const Prerolls& prerolls, const SliceRequest& request,
                                 const Projection& projection = {},
                                 const IsosurfaceOptions& options = {}, const Work& work = {}) {
    return detail::draw_slices(prerolls, request, {}, projection, options, work);
}

/// How many triangles slices() would draw of all of them together, before vertices are merged at
/// nodes, or nothing where there are more than `most` or options.progress ends it. Counts up to
/// there, and stores no triangle.
/// \param options only cap and progress have an effect
/// \throw InvalidInput, GridError as slices()
std::optional<std::uint64_t> count_triangles(const Prerolls& prerolls, const SliceRequest& request,
                                             const Projection& projection, std::uint64_t most,
                                             const IsosurfaceOptions& options = {},
                                             const Work& work = {});

/// Draws the slices and isosurfaces into sinks (surface.hpp), one for each. A SimplexSink also gets
/// triangles without area, around nodes that lie on a slice.
/// \throw InvalidInput also where there is not one sink for each, and for normals into a
///        SimplexSink
template <class Sink>
std::vector<Slice> extract_slices(const Prerolls& prerolls, const SliceRequest& request,
                                  std::vector<Sink> sinks, const Projection& projection = {},
                                  const IsosurfaceOptions& options = {}, const Work& work = {}) {
    return detail::draw_slices(prerolls, request, detail::targets_of<3>(sinks), projection, options,
                               work);
}

}  // namespace nestgrid
