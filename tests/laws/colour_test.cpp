// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Colours that are not linear in the data (paper, end of section 8). An element that interpolates
// the colours of its corners jumps against a finer neighbour, whose corner on the common edge has
// the colour of the value there. The triangles of a shading have a vertex there on both sides.
#include <gtest/gtest.h>

#include <map>

#include <nestgrid/algorithms/shading.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "closedness.hpp"
#include "families.hpp"

using namespace nestgrid_test;

namespace colour_test {

template <class Family>
class Colours : public testing::Test {};
TYPED_TEST_SUITE(Colours, Families);

/// A colour that rises steeply around 0.
double colour(double value) { return std::tanh(20 * value); }

using Loop = std::vector<std::uint32_t>;

/// The outline of each element: the sides that its triangles have once, in order.
std::vector<Loop> outlines_of_elements(const Surface<3>& surface) {
    std::vector<std::map<std::uint32_t, std::uint32_t>> next(surface.shape_of.size());
    std::vector<std::map<std::array<std::uint32_t, 2>, int>> sides(next.size());
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        const auto& v = surface.simplices[t];
        for (std::size_t i = 0; i < 3; ++i) {
            ++sides[surface.element_of[t]][{v[i], v[(i + 1) % 3]}];
        }
    }
    std::vector<Loop> loops(next.size());
    for (std::size_t e = 0; e < next.size(); ++e) {
        for (const auto& [side, count] : sides[e]) {
            if (!sides[e].contains({side[1], side[0]})) next[e][side[0]] = side[1];
        }
        const std::uint32_t first = next[e].begin()->first;
        for (std::uint32_t v = first; loops[e].empty() || v != first; v = next[e][v]) {
            loops[e].push_back(v);
        }
    }
    return loops;
}

struct Jumps {
    double of_values = 0;
    double of_colours = 0;
};

/// How far values and colours at vertices inside edges of elements are from those that the element
/// interpolates between the ends of the edge.
Jumps jumps_of_elements(const Surface<3>& surface) {
    Jumps jumps;
    const auto& x = surface.vertices;
    for (const Loop& loop : outlines_of_elements(surface)) {
        const auto at = [&](std::size_t i) { return loop[i % loop.size()]; };
        const auto is_corner = [&](std::size_t i) {
            const Point in = x[at(i)] - x[at(i + loop.size() - 1)];
            const Point out = x[at(i + 1)] - x[at(i)];
            return norm(cross(in, out)) > 1e-9 * norm(in) * norm(out);
        };
        for (std::size_t i = 0; i < loop.size(); ++i) {
            if (!is_corner(i)) continue;
            std::size_t end = i + 1;
            while (!is_corner(end)) ++end;
            const double u = surface.attributes[at(i)];
            const double v = surface.attributes[at(end)];
            for (std::size_t k = i + 1; k < end; ++k) {
                const double t = norm(x[at(k)] - x[at(i)]) / norm(x[at(end)] - x[at(i)]);
                const double value = surface.attributes[at(k)];
                jumps.of_values = std::max(jumps.of_values, std::abs((1 - t) * u + t * v - value));
                jumps.of_colours =
                    std::max(jumps.of_colours,
                             std::abs((1 - t) * colour(u) + t * colour(v) - colour(value)));
            }
        }
    }
    return jumps;
}

TYPED_TEST(Colours, JumpWhereElementsInterpolateThem) {
    if constexpr (TypeParam::Grid::dimension == 2) {
        Jumps greatest;
        for_each_field_at_sphere<TypeParam>(4, 7, [&](const auto& grid, const auto& samples) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const Shading s = shading(grid, field, {.threshold = 0.1});
            EXPECT_EQ(surface_report(s.surface).open_edges, 0U);  // a vertex on both sides
            const Jumps jumps = jumps_of_elements(s.surface);
            greatest.of_values = std::max(greatest.of_values, jumps.of_values);
            greatest.of_colours = std::max(greatest.of_colours, jumps.of_colours);
        });
        EXPECT_LT(greatest.of_values, 1e-12);
        const bool conforms = std::is_same_v<TypeParam, BisectionTriangles>;  // no node hangs
        EXPECT_TRUE(conforms || greatest.of_colours > 0.2);
    }
}

}  // namespace colour_test
