// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isolines.hpp>

#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>
#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>
#include <ranks/join_lines.hpp>

namespace nestgrid {

template <class Real>
Isolines isolines(const Hierarchy<Real>& hierarchy, std::span<const double> values,
                  const Criterion& criterion, const Bounds& bounds,
                  const IsosurfaceOptions& options, const Executor& executor) {
    const engine::SharedNodes* const shared = hierarchy.facts().shared;
    IsosurfaceOptions kept = options;
    kept.normals = kept.elements = kept.reference = false;
    auto drawn = isosurfaces<2>(hierarchy, values, criterion, bounds, kept, executor);
    Isolines result;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        if (shared != nullptr) engine::join_lines(drawn[i].surface, drawn[i].names, *shared);
        engine::together(shared, "isolines",
                         [&] { append_polylines(result.lines, drawn[i].surface, values[i]); });
        drawn[i].surface = {};  // its memory is needed for the lines
        result.counts.calls = drawn[i].counts.calls;
        result.counts.visited = drawn[i].counts.visited;
        result.counts.extracted += drawn[i].counts.extracted;
        result.counts.limited += drawn[i].counts.limited;
        result.add_bounds(drawn[i]);
        result.cancelled = drawn[i].cancelled;
    }
    return result;
}

template <class Real>
Isolines isolines(const Hierarchy<Real>& hierarchy, std::span<const double> values,
                  const HierarchicalIndicator& indicator, const IsosurfaceOptions& options,
                  const Executor& executor) {
    engine::together(hierarchy.facts().shared, "isolines", [&] {
        if (options.max_triangles == 0) return;
        throw InvalidInput("a limit of segments is for one isoline");
    });
    const auto s = criterion_for<2>(hierarchy, 0, indicator, options, executor);
    return isolines(hierarchy, values, s, indicator, options, executor);
}

template <class Real>
Isolines isolines(const Hierarchy<Real>& hierarchy, std::span<const double> values,
                  const IsosurfaceOptions& options, const Executor& executor) {
    const HierarchicalIndicator indicator(hierarchy, LeafErrors{}, executor);
    return isolines(hierarchy, values, indicator, options, executor);
}

#define NESTGRID_INSTANTIATE(Real)                                                                \
    template Isolines isolines(const Hierarchy<Real>&, std::span<const double>, const Criterion&, \
                               const Bounds&, const IsosurfaceOptions&, const Executor&);         \
    template Isolines isolines(const Hierarchy<Real>&, std::span<const double>,                   \
                               const HierarchicalIndicator&, const IsosurfaceOptions&,            \
                               const Executor&);                                                  \
    template Isolines isolines(const Hierarchy<Real>&, std::span<const double>,                   \
                               const IsosurfaceOptions&, const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid
