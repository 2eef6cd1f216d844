// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <height_fields/triangulate.hpp>

#include <height_fields/with_graph.hpp>

namespace nestgrid::engine {

namespace {

template <class Real>
Shading draw(const Graph<Real>& graph, const ShadingOptions& options, const Executor& executor) {
    Shading result;
    result.surface.elements = graph.walk->hierarchy().make_elements();
    Triangulation<Real> drawing(graph, {result.surface, options.elements}, options.progress);
    result.cancelled =
        run_until_cancelled<Real>(drawing, executor, graph.walk->hierarchy().facts().shared);
    drawing.report(result);
    if (graph.criterion->insists()) result.error_bound = result.range_bound;
    return result;
}

}  // namespace

template <class Real>
Shading triangulate(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                    const Bounds& bounds, const ShadingOptions& options, const Executor& executor) {
    return with_graph(hierarchy, scale, criterion, bounds, options, options.elements,
                      [&](const Graph<Real>& graph) { return draw(graph, options, executor); });
}

template Shading triangulate(const Hierarchy<float>&, double, const Criterion&, const Bounds&,
                             const ShadingOptions&, const Executor&);
template Shading triangulate(const Hierarchy<double>&, double, const Criterion&, const Bounds&,
                             const ShadingOptions&, const Executor&);

}  // namespace nestgrid::engine
