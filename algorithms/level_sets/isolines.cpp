// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <projection/by_criterion.hpp>

#include <algorithm>

#include <ranks/agreement.hpp>
#include <ranks/join_lines.hpp>

namespace nestgrid::engine {

template <class Real>
Isolines isolines(const Hierarchy<Real>& hierarchy, std::span<const double> values,
                  const Criterion& criterion, const Bounds& bounds,
                  const IsosurfaceOptions& options, const Executor& executor) {
    const engine::SharedNodes* const shared = hierarchy.facts().shared;
    IsosurfaceOptions kept = options;
    kept.normals = kept.elements = kept.reference = false;
    auto drawn = isosurfaces<2>(hierarchy, values, {}, criterion, bounds, kept, executor);
    Isolines result;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        if (shared != nullptr) engine::join_lines(drawn[i].surface, drawn[i].names, *shared);
        engine::together(shared, "isolines", [&] {
            detail::append_polylines(result.lines, drawn[i].surface, values[i]);
        });
        drawn[i].surface = {};  // its memory is needed for the lines
        result.counts.calls = drawn[i].counts.calls;
        result.counts.visited = drawn[i].counts.visited;
        result.counts.extracted += drawn[i].counts.extracted;
        result.counts.limited += drawn[i].counts.limited;
        result.add_bounds(drawn[i]);
        result.position_bound = std::max(result.position_bound, drawn[i].position_bound);
        result.cancelled = drawn[i].cancelled;
    }
    return result;
}

template Isolines isolines(const Hierarchy<float>&, std::span<const double>, const Criterion&,
                           const Bounds&, const IsosurfaceOptions&, const Executor&);
template Isolines isolines(const Hierarchy<double>&, std::span<const double>, const Criterion&,
                           const Bounds&, const IsosurfaceOptions&, const Executor&);

}  // namespace nestgrid::engine
