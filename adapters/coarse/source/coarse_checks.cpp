// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/adapters/coarse_checks.hpp>

#include <algorithm>
#include <cmath>

namespace nestgrid {

namespace {

std::string name_of(const CoarseGrid& grid, std::size_t e) {
    return std::string(topology(grid.shapes[e]).name) + " " + std::to_string(e);
}

}  // namespace

namespace detail {

void check_nodes(const CoarseGrid& grid, const CoarseChecks& options) {
    std::vector<std::pair<Point, std::size_t>> places;
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
        const Point x = grid.nodes[i];
        if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2])) {
            throw InvalidInput("node " + std::to_string(i) + " has a coordinate that is no number");
        }
        if (!options.slits) places.emplace_back(x, i);
    }
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        if (places[i].first == places[i + 1].first) {
            throw InvalidInput("duplicate vertex: the nodes " + std::to_string(places[i].second) +
                               " and " + std::to_string(places[i + 1].second) +
                               " are at the same place");
        }
    }
}

void check_element(const CoarseGrid& grid, std::size_t e) {
    if (topology(grid.shapes[e]).dimension != grid.dimension) {
        throw InvalidInput(name_of(grid, e) + " is no element of dimension " +
                           std::to_string(grid.dimension));
    }
    const auto nodes = grid.element(e);
    if (nodes.size() != topology(grid.shapes[e]).corners) {
        throw InvalidInput(name_of(grid, e) + " has " + std::to_string(nodes.size()) + " corners");
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i] >= grid.nodes.size()) {
            throw InvalidInput(name_of(grid, e) + " names the node " + std::to_string(nodes[i]) +
                               ", but there are " + std::to_string(grid.nodes.size()));
        }
        for (std::size_t k = 0; k < i; ++k) {
            if (nodes[i] == nodes[k]) {
                throw InvalidInput(name_of(grid, e) + " has the node " + std::to_string(nodes[i]) +
                                   " twice");
            }
        }
    }
}

}  // namespace detail

void check_and_orient(CoarseGrid& grid, const CoarseChecks& options) {
    if (grid.element_count() == 0) throw InvalidInput("the coarse grid has no element");
    detail::check_nodes(grid, options);
    for (std::size_t e = 0; e < grid.element_count(); ++e) detail::check_element(grid, e);
    if (grid.dimension == 2) orient(grid);
    bool plane = grid.dimension == 2;
    for (std::size_t i = 0; plane && i < grid.nodes.size(); ++i) plane = grid.nodes[i][2] == 0;
    // Tools differ in what they call positive; one element against its whole component is inverted.
    const std::vector<int> component = components(grid).first;
    std::vector<std::array<std::size_t, 2>> count(grid.element_count());  // by component and sign
    std::vector<bool> negative(grid.element_count());
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        const auto x = grid.positions(e);
        double size = 0;
        for (std::size_t k = 1; k < grid.element(e).size(); ++k) {
            size = std::max(size, norm(x[k] - x[0]));
        }
        const Point v = measure_vector(grid.shapes[e], x);
        const double measure = grid.dimension == 3 || plane ? v[2] : norm(v);
        if (!(std::abs(measure) > 1e-14 * std::pow(size, grid.dimension))) {
            throw InvalidInput(name_of(grid, e) + " is flat");
        }
        negative[e] = measure < 0;
        ++count[static_cast<std::size_t>(component[e])][negative[e] ? 1 : 0];
    }
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        const auto& [positives, negatives] = count[static_cast<std::size_t>(component[e])];
        if (positives > 0 && negatives > 0 && negative[e] == (negatives <= positives)) {
            throw InvalidInput("inverted element: " + name_of(grid, e) +
                               " is oriented against its neighbours");
        }
    }
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        if (negative[e]) mirror(grid.shapes[e], grid.element(e));
    }
}

}  // namespace nestgrid
