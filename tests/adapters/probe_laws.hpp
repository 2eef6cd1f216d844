// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// No point inside is lost: every point of every leaf is found, be the grid curved and its nodes
// hanging as they may.
#pragma once

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/detail/shape_functions.hpp>
#include <probes/inverse_map.hpp>
#include <walk/for_each_element.hpp>
#include <walk/hanging_nodes.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// A linear function of the positions of a grid that gives those of new nodes.
template <class Grid>
class LinearField {
public:
    using value_type = double;
    explicit LinearField(const Grid& grid) : grid_{&grid} {}

    static double at(const Point& x) { return 0.5 + 0.7 * x[0] - 0.4 * x[1] + 0.3 * x[2]; }
    NodeMask coarse_values(std::size_t i, std::span<double> out, Context<Grid>& context) const {
        const auto coarse = nestgrid::detail::call_coarse(*grid_, context, i);
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = at(coarse.corners[k]);
        return 0;
    }
    NodeMask new_values(const ElementOf<Grid>& e, NodeMask which, std::span<double> out,
                        Context<Grid>& context) const {
        std::array<Point, max_new_nodes> x{};
        nestgrid::detail::call_new_positions(*grid_, context, e, which,
                                             std::span(x).first(out.size()));
        for (std::size_t n = 0; n < out.size(); ++n) out[n] = at(x[n]);
        return 0;
    }

private:
    const Grid* grid_;
};

/// A leaf: as it is drawn, and with its corners where the grid has them.
struct TwofoldLeaf {
    Shape shape;
    int level;
    std::array<Point, max_corners> drawn;
    std::array<Point, max_corners> placed;
};

inline std::vector<TwofoldLeaf> twofold_leaves(const Hierarchy<double>& hierarchy) {
    const HangingNodes hanging = engine::find_hanging_nodes(hierarchy);
    const engine::Walk<double> walk(
        hierarchy, {.values = false, .keys = true, .positions = true, .placed = true}, &hanging);
    std::vector<TwofoldLeaf> leaves;
    engine::for_each_element<double>(walk, false, [&](const auto& view, const auto&) {
        if (!view.is_leaf() || view.member->hidden == Hidden::wholly) return;
        TwofoldLeaf leaf{view.shape, view.level, {}, {}};
        walk.corners(view, nullptr, leaf.drawn.data());
        leaf.placed = leaf.drawn;
        if (walk.places_corners()) walk.placed_corners(view, leaf.placed.data());
        leaves.push_back(leaf);
    });
    return leaves;
}

/// Random points of leaves, one half of them as these are drawn; every tenth on a face, an edge or
/// at a corner.
inline std::vector<Point> points_in(const std::vector<TwofoldLeaf>& leaves, std::size_t count,
                                    unsigned seed) {
    std::mt19937 random(seed);
    std::exponential_distribution<double> exponential;
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i) {
        const TwofoldLeaf& leaf = leaves[random() % leaves.size()];
        const Topology& t = topology(leaf.shape);
        std::array<double, max_corners> weight{};
        double sum = 0;
        for (std::size_t k = 0; k < t.corners; ++k) {
            const bool left_out = i % 10 == 0 && k > 0 && random() % 2 == 0;
            sum += weight[k] = left_out ? 0 : exponential(random);
        }
        Point s{0, 0, 0};
        for (std::size_t k = 0; k < t.corners; ++k) s = s + weight[k] / sum * t.reference[k];
        points.push_back(engine::place_of(leaf.shape, i % 2 == 0 ? leaf.drawn : leaf.placed, s));
    }
    return points;
}

/// What a probe says of the leaf around a point, and of the point in it, fits together.
template <class Grid>
void expect_leaves(const Grid& grid, const std::vector<TwofoldLeaf>& leaves,
                   std::span<const Point> points, const ProbeResult& result) {
    auto context = make_context(grid);
    const auto elements = result.elements.as<ElementOf<Grid>>();
    ASSERT_EQ(result.shape_of.size(), elements.size());
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 100) {
        const std::uint32_t e = result.element_of.at(i);
        ASSERT_LT(e, elements.size());
        EXPECT_EQ(nestgrid::detail::call_split(grid, context, elements[e]), nullptr);
        const auto fits = [&](const TwofoldLeaf& leaf) {
            const auto is_place = [&](std::span<const Point> corners) {
                const Point x = engine::place_of(leaf.shape, corners, result.reference[i]);
                return norm(x - points[i]) < 1e-10;
            };
            return leaf.level == result.level[i] && leaf.shape == result.shape_of[e] &&
                   (is_place(leaf.drawn) || is_place(leaf.placed));
        };
        EXPECT_TRUE(std::ranges::any_of(leaves, fits)) << text_of(points[i]);
    }
}

/// Data of leaves: 1 and -2.
template <class Grid>
struct TwoConstants {
    static constexpr int components = 2;
    void leaf_values(const ElementOf<Grid>& /*leaf*/, std::span<double> out) const {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = i % 2 == 0 ? 1 : -2;
    }
};

/// Data that jump between leaves are found where the field is.
template <class Grid>
void expect_jumping_data(const Grid& grid, std::span<const Point> points,
                         const ProbeResult& result) {
    const TwoConstants<Grid> constants;
    const ProbeResult jumping = probe(DiscontinuousData(grid, constants), points);
    EXPECT_EQ(jumping.level, result.level);
    EXPECT_EQ(jumping.element_of, result.element_of);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!result.found(i)) continue;
        EXPECT_NEAR(jumping.values[2 * i], 1, 1e-12);
        EXPECT_NEAR(jumping.values[2 * i + 1], -2, 1e-12);
    }
}

/// \param field that of LinearField::at() at the nodes
template <class Grid, class Field>
void expect_no_point_lost(const Grid& grid, const Field& field, std::size_t count, unsigned seed) {
    const std::vector<TwofoldLeaf> leaves = twofold_leaves(erase(grid, field));
    const std::vector<Point> points = points_in(leaves, count, seed);
    const ProbeResult result = probe(grid, field, points);
    std::size_t lost = 0;
    double wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!result.found(i)) {
            ++lost;
            continue;
        }
        const double expected = LinearField<Grid>::at(points[i]);
        wrong = std::max(wrong, std::abs(result.values[i] - expected));
    }
    EXPECT_EQ(lost, 0U) << "of " << points.size();
    EXPECT_LT(wrong, 1e-12);
    if (lost > 0) return;
    expect_leaves(grid, leaves, points, result);
    expect_jumping_data(grid, points, result);
}

/// On a grid with true positions.
template <class Grid>
void expect_no_point_lost(const Grid& grid, std::size_t count, unsigned seed) {
    expect_no_point_lost(grid, LinearField<Grid>(grid), count, seed);
}

}  // namespace nestgrid_test
