// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <graphs/triangulate.hpp>

#include <graphs/with_graph.hpp>

namespace nestgrid::engine {

namespace {

template <class Real>
Shading draw(const Graph<Real>& graph, const ShadingOptions& options, const Executor& executor) {
    Shading result;
    result.surface.elements = graph.walk->hierarchy().make_elements();
    Triangulation<Real> drawing(graph, {result.surface, options.elements});
    try {
        drawing.run(executor, options.progress);
    } catch (const Cancelled&) {
        result.cancelled = true;
    }
    const SharedNodes* const shared = graph.walk->hierarchy().facts().shared;
    if (shared != nullptr) drawing.agree(shared->ranks());
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

template <class Real>
Shading triangulate(const Hierarchy<Real>& hierarchy, double scale,
                    const HierarchicalIndicator& indicator, const ShadingOptions& options,
                    const Executor& executor) {
    together(hierarchy.facts().shared, "triangles", [&] {
        hierarchy.facts().require_dimension(2);
        if (options.threshold >= 0) return;
        throw InvalidInput("the threshold is negative or not a number");
    });
    const Threshold s(&indicator, options.threshold);
    return triangulate(hierarchy, scale, s, indicator, options, executor);
}

template <class Real>
Shading triangulate(const Hierarchy<Real>& hierarchy, double scale, const ShadingOptions& options,
                    const Executor& executor) {
    hierarchy.facts().require_dimension(2);
    const HierarchicalIndicator indicator(hierarchy, LeafErrors{}, executor);
    return triangulate(hierarchy, scale, indicator, options, executor);
}

#define NESTGRID_INSTANTIATE(Real)                                                                \
    template Shading triangulate(const Hierarchy<Real>&, double, const Criterion&, const Bounds&, \
                                 const ShadingOptions&, const Executor&);                         \
    template Shading triangulate(const Hierarchy<Real>&, double, const HierarchicalIndicator&,    \
                                 const ShadingOptions&, const Executor&);                         \
    template Shading triangulate(const Hierarchy<Real>&, double, const ShadingOptions&,           \
                                 const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::engine
