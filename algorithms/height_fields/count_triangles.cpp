// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <height_fields/with_graph.hpp>
#include <projection/by_criterion.hpp>

namespace nestgrid::engine {

template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const ShadingOptions& options,
                                             const Executor& executor) {
    const auto count = [&](const Graph<Real>& graph) -> std::optional<std::uint64_t> {
        Surface<3> element;
        Triangulation<Real> drawing(graph, {element, false}, options.progress);
        return count_within<Real>(drawing, most, executor, hierarchy.facts().shared);
    };
    return with_graph(hierarchy, 0, criterion, bounds, options, false, count);
}

template std::optional<std::uint64_t> count_triangles(const Hierarchy<float>&, const Criterion&,
                                                      const Bounds&, std::uint64_t,
                                                      const ShadingOptions&, const Executor&);
template std::optional<std::uint64_t> count_triangles(const Hierarchy<double>&, const Criterion&,
                                                      const Bounds&, std::uint64_t,
                                                      const ShadingOptions&, const Executor&);

}  // namespace nestgrid::engine
