// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <graphs/with_graph.hpp>
#include <projection/by_criterion.hpp>

namespace nestgrid::engine {

template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const ShadingOptions& options,
                                             const Executor& executor) {
    const auto count = [&](const Graph<Real>& graph) -> std::optional<std::uint64_t> {
        Surface<3> element;
        Triangulation<Real> drawing(graph, {element, false});
        drawing.count_only(most);
        try {
            drawing.run(executor, options.progress);
        } catch (const OverLimit&) {
            return std::nullopt;
        }
        std::uint64_t triangles = drawing.triangles();
        std::array<std::uint64_t*, 1> sum{&triangles};
        if (const auto* shared = hierarchy.facts().shared) engine::take_sums(shared->ranks(), sum);
        if (triangles > most) return std::nullopt;
        return triangles;
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
