// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/adapters/prism_grid.hpp>

namespace nestgrid {

template class StoredGrid<Prism>;
namespace detail {
template class Rewrite<Prism>;
template class ErasedHierarchy<PrismGrid, NodeField<PrismGrid, float>>;
template class ErasedHierarchy<PrismGrid, NodeField<PrismGrid, double>>;
}  // namespace detail

std::vector<Point> node_normals(const CoarseGrid& surface) {
    std::vector<Point> normal(surface.nodes.size(), Point{0, 0, 0});
    for (std::size_t e = 0; e < surface.element_count(); ++e) {
        const Point area = measure_vector(surface.shapes[e], surface.positions(e));
        for (const std::uint32_t node : surface.element(e)) normal[node] = normal[node] + area;
    }
    for (Point& n : normal) {
        if (norm(n) > 0) n = 1 / norm(n) * n;
    }
    return normal;
}

CoarseGrid extrude(const CoarseGrid& surface, std::span<const double> thickness,
                   const std::optional<Point>& direction) {
    if (thickness.empty()) throw InvalidInput("no layer to extrude");
    std::vector<Point> up;
    if (direction) {
        if (!(norm(*direction) > 0) || !std::isfinite(norm(*direction))) {
            throw InvalidInput("the direction of extrusion has no length");
        }
        up.assign(surface.nodes.size(), 1 / norm(*direction) * *direction);
    } else {
        up = node_normals(surface);
    }
    const auto nodes = static_cast<std::uint32_t>(surface.nodes.size());
    std::vector<Point> x;
    double height = 0;
    for (std::size_t layer = 0; layer <= thickness.size(); ++layer) {
        for (std::size_t i = 0; i < nodes; ++i) x.push_back(surface.nodes[i] + height * up[i]);
        if (layer == thickness.size()) break;
        if (!(thickness[layer] > 0) || !std::isfinite(thickness[layer])) {
            throw InvalidInput("the thickness of layer " + std::to_string(layer) +
                               " is no positive number");
        }
        height += thickness[layer];
    }
    CoarseGrid grid;
    grid.dimension = 3;
    grid.nodes = Coordinates(std::move(x));
    for (std::uint32_t layer = 0; layer < thickness.size(); ++layer) {
        for (std::size_t e = 0; e < surface.element_count(); ++e) {
            const auto of = surface.element(e);
            if (surface.shapes[e] != Shape::triangle) {
                throw InvalidInput("element " + std::to_string(e) +
                                   " of the surface is no triangle");
            }
            std::array<std::uint32_t, 6> prism{};
            for (std::size_t i = 0; i < 3; ++i) {
                prism[i] = of[i] + layer * nodes;
                prism[i + 3] = of[i] + (layer + 1) * nodes;
            }
            grid.add(Shape::prism, prism);
        }
    }
    return grid;
}

}  // namespace nestgrid
