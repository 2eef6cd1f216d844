// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <vector>

#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/error.hpp>

#include <surfaces/probed_colours.hpp>
#include <surfaces/require_simplices.hpp>
#include <surfaces/split_sides.hpp>

namespace nestgrid {

namespace {

using Triangle = Surface<3>::Simplex;
using engine::TriangleSide;

constexpr int most_halvings = 10;
/// Greatest sum of |cubic Lagrange polynomials| of a triangle, those of its corners left out.
constexpr double lebesgue = 2.2;

void sort_each_once(std::vector<TriangleSide>& sides) {
    std::sort(sides.begin(), sides.end());
    sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
}

class ColourRefiner {
public:
    ColourRefiner(Surface<3>& surface, double tolerance, const detail::ProbePoints& probe)
        : surface_{surface}, tolerance_{tolerance / lebesgue}, colours_{surface, probe} {}

    ColourRefinement run() {
        std::vector<bool> is_new(surface_.simplices.size(), true);  // by triangle: not yet probed
        for (int i = 0; i < most_halvings; ++i) {
            const std::vector<TriangleSide> marked = find_sides(is_new);
            if (marked.empty()) break;
            result_.split += marked.size();
            const std::size_t first_middle = surface_.vertices.size();
            is_new = engine::split_sides(surface_, marked);
            colours_.colour_from(first_middle);
        }
        return result_;
    }

private:
    /// The sides of new triangles that are to be split, ascending.
    std::vector<TriangleSide> find_sides(const std::vector<bool>& is_new) {
        std::vector<TriangleSide> sides;
        std::vector<std::uint32_t> triangles;
        for (std::uint32_t t = 0; t < surface_.simplices.size(); ++t) {
            if (!is_new[t]) continue;
            triangles.push_back(t);
            const Triangle& v = surface_.simplices[t];
            for (std::size_t i = 0; i < 3; ++i) sides.emplace_back(v[i], v[(i + 1) % 3]);
        }
        sort_each_once(sides);
        const std::vector<double> misses = colours_.misses_at(samples_of(sides, triangles));
        std::vector<TriangleSide> marked;
        double within = 0;
        const auto mark_where = [&](double miss, TriangleSide side) {
            if (miss > tolerance_)
                marked.push_back(side);
            else
                within = std::max(within, miss);
        };
        for (std::size_t i = 0; i < sides.size(); ++i) {
            mark_where(std::max(misses[2 * i], misses[2 * i + 1]), sides[i]);
        }
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            mark_where(misses[2 * sides.size() + i], longest_side(triangles[i]));
        }
        result_.miss = std::max(result_.miss, within);
        sort_each_once(marked);
        return marked;
    }

    /// Two points of each side, then the centre of each triangle.
    std::vector<engine::ColourSample> samples_of(
        const std::vector<TriangleSide>& sides, const std::vector<std::uint32_t>& triangles) const {
        std::vector<engine::ColourSample> samples;
        for (const TriangleSide side : sides) {
            const Triangle ends{side.first(), side.second(), side.first()};
            samples.push_back({ends, {2.0 / 3, 1.0 / 3, 0}});
            samples.push_back({ends, {1.0 / 3, 2.0 / 3, 0}});
        }
        for (const std::uint32_t t : triangles) {
            samples.push_back({surface_.simplices[t], {1.0 / 3, 1.0 / 3, 1.0 / 3}});
        }
        return samples;
    }

    TriangleSide longest_side(std::uint32_t triangle) const {
        const Triangle& v = surface_.simplices[triangle];
        const auto length = [&](std::size_t i) {
            return norm(surface_.vertices[v[i]] - surface_.vertices[v[(i + 1) % 3]]);
        };
        std::size_t longest = 0;
        for (const std::size_t i : {1U, 2U}) {
            if (length(i) > length(longest)) longest = i;
        }
        return {v[longest], v[(longest + 1) % 3]};
    }

    Surface<3>& surface_;
    double tolerance_;
    engine::ProbedColours colours_;
    ColourRefinement result_;
};

}  // namespace

ColourRefinement detail::refine_colours(Surface<3>& surface, double tolerance,
                                        const ProbePoints& probe) {
    if (!(tolerance > 0)) {
        throw InvalidInput("the tolerance of colours is not a positive number");
    }
    engine::require_simplices(surface);
    if (surface.vertices.empty()) return {};
    if (surface.attributes.empty()) throw InvalidInput("the surface has no attributes to refine");
    if (!surface.reference.empty()) {
        throw InvalidInput("reference coordinates are not kept where colours are refined");
    }
    return ColourRefiner(surface, tolerance, probe).run();
}

}  // namespace nestgrid
