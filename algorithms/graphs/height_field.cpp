// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/height_field.hpp>

#include <cmath>

#include <graphs/triangulation.hpp>
#include <levels/draw.hpp>
#include <levels/level_search.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

template <class Real>
Threshold threshold_of(const Hierarchy<Real>& hierarchy, const HierarchicalIndicator& indicator,
                       const ShadingOptions& options) {
    hierarchy.facts().require_dimension(2);
    if (!(options.threshold >= 0)) throw InvalidInput("the threshold is negative or not a number");
    return {&indicator, options.threshold};
}

/// \throw InvalidInput, GridError as shading() and height_field() say
template <class Real>
void require_drawable(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                      const Bounds& bounds, const ShadingOptions& options) {
    hierarchy.facts().require_dimension(2);
    if (!std::isfinite(scale))
        throw InvalidInput("the scale of the heights is not a finite number");
    if (!(options.flatness >= 0)) throw InvalidInput("the flatness is negative or not a number");
    engine::require_same_epoch(hierarchy, bounds);
    engine::require_saturated(criterion, bounds, hierarchy.facts().decodes);
}

/// Calls draw(graph) with what a triangulation borrows.
/// \param elements whether to keep the elements
template <class Real, class Draw>
auto with_graph(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                const Bounds& bounds, const ShadingOptions& options, bool elements, Draw&& draw) {
    require_drawable(hierarchy, scale, criterion, bounds, options);
    const engine::Walk<Real> walk(hierarchy, engine::Triangulation<Real>::needs, bounds.hanging());
    return draw(engine::Graph<Real>{&walk,
                                    &criterion,
                                    &bounds,
                                    {scale, options.flatness},
                                    elements,
                                    engine::may_stop_apart(hierarchy, criterion, bounds)});
}

template <class Real>
Shading triangulate(const engine::Graph<Real>& graph, const Hierarchy<Real>& hierarchy,
                    const ShadingOptions& options, const Executor& executor) {
    Shading result;
    result.surface.elements = hierarchy.make_elements();
    engine::Triangulation<Real> drawing(graph, {result.surface, options.elements});
    try {
        drawing.run(executor, options.progress);
    } catch (const engine::Cancelled&) {
        result.cancelled = true;
    }
    drawing.report(result);
    if (graph.criterion->insists()) result.error_bound = std::numeric_limits<double>::infinity();
    return result;
}

template <class Real>
Shading triangulate(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                    const Bounds& bounds, const ShadingOptions& options, const Executor& executor) {
    return with_graph(hierarchy, scale, criterion, bounds, options, options.elements,
                      [&](const engine::Graph<Real>& graph) {
                          return triangulate(graph, hierarchy, options, executor);
                      });
}

/// Makes the preroll first.
template <class Real>
Shading triangulate(const Hierarchy<Real>& hierarchy, double scale, const ShadingOptions& options,
                    const Executor& executor) {
    hierarchy.facts().require_dimension(2);
    const HierarchicalIndicator indicator(hierarchy, LeafErrors{}, executor);
    return triangulate(hierarchy, scale, threshold_of(hierarchy, indicator, options), indicator,
                       options, executor);
}

}  // namespace

template <class Real>
Shading shading(const Hierarchy<Real>& hierarchy, const Criterion& criterion, const Bounds& bounds,
                const ShadingOptions& options, const Executor& executor) {
    return triangulate(hierarchy, 0, criterion, bounds, options, executor);
}
template <class Real>
Shading shading(const Hierarchy<Real>& hierarchy, const HierarchicalIndicator& indicator,
                const ShadingOptions& options, const Executor& executor) {
    return triangulate(hierarchy, 0, threshold_of(hierarchy, indicator, options), indicator,
                       options, executor);
}
template <class Real>
Shading shading(const Hierarchy<Real>& hierarchy, const ShadingOptions& options,
                const Executor& executor) {
    return triangulate(hierarchy, 0, options, executor);
}
template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                     const Bounds& bounds, const ShadingOptions& options,
                     const Executor& executor) {
    return triangulate(hierarchy, scale, criterion, bounds, options, executor);
}
template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale,
                     const HierarchicalIndicator& indicator, const ShadingOptions& options,
                     const Executor& executor) {
    return triangulate(hierarchy, scale, threshold_of(hierarchy, indicator, options), indicator,
                       options, executor);
}
template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale, const ShadingOptions& options,
                     const Executor& executor) {
    return triangulate(hierarchy, scale, options, executor);
}

template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const ShadingOptions& options,
                                             const Executor& executor) {
    const auto count = [&](const engine::Graph<Real>& graph) -> std::optional<std::uint64_t> {
        Surface<3> element;
        engine::Triangulation<Real> drawing(graph, {element, false});
        drawing.count_only(most);
        try {
            drawing.run(executor, options.progress);
        } catch (const engine::OverLimit&) {
            return std::nullopt;
        }
        return drawing.triangles();
    };
    return with_graph(hierarchy, 0, criterion, bounds, options, false, count);
}

#define NESTGRID_INSTANTIATE(Real)                                                                 \
    template Shading shading(const Hierarchy<Real>&, const Criterion&, const Bounds&,              \
                             const ShadingOptions&, const Executor&);                              \
    template Shading shading(const Hierarchy<Real>&, const HierarchicalIndicator&,                 \
                             const ShadingOptions&, const Executor&);                              \
    template Shading shading(const Hierarchy<Real>&, const ShadingOptions&, const Executor&);      \
    template Shading height_field(const Hierarchy<Real>&, double, const Criterion&, const Bounds&, \
                                  const ShadingOptions&, const Executor&);                         \
    template Shading height_field(const Hierarchy<Real>&, double, const HierarchicalIndicator&,    \
                                  const ShadingOptions&, const Executor&);                         \
    template Shading height_field(const Hierarchy<Real>&, double, const ShadingOptions&,           \
                                  const Executor&);                                                \
    template std::optional<std::uint64_t> count_triangles(                                         \
        const Hierarchy<Real>&, const Criterion&, const Bounds&, std::uint64_t,                    \
        const ShadingOptions&, const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid
