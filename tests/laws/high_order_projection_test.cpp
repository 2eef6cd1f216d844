// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data of higher degree within a number of triangles, in a lens, in a region, between frames, and
// within an error of positions.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/frames.hpp>
#include <nestgrid/algorithms/polynomial_values.hpp>

#include "curved_world.hpp"
#include "high_order_judge.hpp"
#include "high_order_worlds.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"

using namespace nestgrid_test;
using namespace nestgrid;

namespace {

// Budgets.

double next_below(double threshold) {
    return detail::bfloat16_value(
        static_cast<std::uint16_t>(detail::bfloat16_below(threshold) - 1));
}

/// \param draw draw(projection) draws
template <class Draw>
auto expect_least(const Draw& draw, std::uint64_t most) {
    auto drawn = draw({.max_triangles = most, .indicator = "error"});
    EXPECT_LE(drawn.surface.simplices.size(), most);
    EXPECT_GE(drawn.search.triangles, drawn.surface.simplices.size());
    EXPECT_EQ(drawn.search.max_triangles, most);
    const auto again = draw({.threshold = drawn.search.threshold, .indicator = "error"});
    expect_same_simplices(drawn.surface, again.surface);
    if (drawn.search.end() != BudgetEnd::complete) {
        const auto finer =
            draw({.threshold = next_below(drawn.search.threshold), .indicator = "error"});
        EXPECT_GT(finer.surface.simplices.size(), most);
    }
    return drawn;
}

TEST(HighOrderBudgets, AreKeptByTheLeastTolerance) {
    for_each_world(4, [](const auto& drawn, unsigned seed) {
        const Prerolls prerolls(drawn.world, drawn.field);
        const auto draw = [&](const Projection& projection) {
            return isosurface<3>(prerolls, 0.1, projection, {.verify = true});
        };
        const std::uint64_t coarsest =
            draw({.threshold = 1e9, .indicator = "error"}).surface.simplices.size();
        const auto result = expect_least(draw, coarsest + 500 * seed);
        expect_closed(result.surface);
        expect_bound(drawn, result, 0.1, result.search.threshold);
    });
}

TEST(HighOrderBudgets, AreKeptBySlicesAndInThePlane) {
    const OnBoxes<3> drawn(hanging_world(4), waves);
    const Prerolls prerolls(drawn.world, drawn.field);
    for (const std::uint64_t most : {500U, 5000U}) {
        const Projection projection{.max_triangles = most, .indicator = "error"};
        const auto plane = slice(prerolls, Plane({0.1, 0, 0}, {1, 2, 3}), projection);
        expect_closed(plane.surface);
        EXPECT_LE(plane.surface.simplices.size(), most);
        EXPECT_GT(plane.surface.simplices.size(), most / 2);
        EXPECT_LE(plane.error_bound, (plane.search.threshold + drawn.data.jump()) * (1 + 1e-6));
    }
    const OnShapes<2> flat(Cells::columns, hanging_world(5), gyroid);
    const Prerolls in_plane(flat.world, flat.field);
    expect_least([&](const Projection& p) { return isosurface<2>(in_plane, 0.1, p); }, 400);
    expect_least([&](const Projection& p) { return shading(in_plane, p); }, 2000);
    expect_least([&](const Projection& p) { return height_field(in_plane, 1.0, p); }, 2000);
}

TEST(HighOrderBudgets, EndAtTheLeastToleranceThatIsTried) {
    // Linear, by the name of a quadratic: nothing is halved at any tolerance.
    const OnBoxes<3> drawn(WorldOptions{.least_degree = 2, .greatest_degree = 2},
                           [](const Point& x) { return x[0] + 0.3 * x[1] - 0.2 * x[2]; });
    const Prerolls prerolls(drawn.world, drawn.field);
    const auto all = isosurface<3>(prerolls, 0.1, {.max_triangles = 1000, .indicator = "error"});
    EXPECT_EQ(all.search.end(), BudgetEnd::complete);
    EXPECT_GE(all.search.threshold, drawn.data.least_tolerance());
    EXPECT_NE(all.budget_reason().find(": no error below "), std::string::npos);
    expect_refused(
        [&] { (void)isosurface<3>(prerolls, 0.1, {.max_triangles = 3, .indicator = "error"}); },
        "even the coarsest surface has more than 3 triangles");
    // What front ends ask for by a number alone is searched among errors, too.
    const Projection asked = with_error(prerolls, {.max_triangles = 1000});
    EXPECT_EQ(asked.indicator, "error");
}

/// Where positions have an error of their own, they do not end a search: data that are nearly
/// linear in leaves that are strongly curved go on below the tolerance at which both would be as
/// fine.
TEST(HighOrderBudgets, GoOnWherePositionsHaveAnErrorOfTheirOwn) {
    const DrawnWorld<CurvedWorld<DegreeWorld<2>>, DegreeField<2>> drawn(
        polynomial_bend(3, 0.1, 2), WorldOptions{.least_degree = 2, .greatest_degree = 2},
        [](const Point& x) { return x[0] + 0.3 * x[1] + 1e-4 * x[0] * x[0]; });
    const Prerolls prerolls(drawn.world, drawn.field);
    const double with_positions = drawn.data.least_tolerance();
    const double alone = drawn.data.least_tolerance(0.01);
    EXPECT_LT(alone, with_positions / 8);
    const auto lines = [&](const Projection& how) { return isosurface<2>(prerolls, 0.1, how); };
    const std::uint64_t most =
        lines({.threshold = with_positions / 4, .indicator = "error", .position_error = 0.01})
            .surface.simplices.size();
    const auto found = lines({.max_triangles = most, .indicator = "error", .position_error = 0.01});
    EXPECT_LE(found.surface.simplices.size(), most);
    EXPECT_LE(found.search.threshold, with_positions / 4 * (1 + 1e-2));
}

TEST(HighOrderBudgets, EndWhereProgressSaysSo) {
    const OnBoxes<3> drawn(hanging_world(1), gyroid);
    const Prerolls prerolls(drawn.world, drawn.field);
    const auto stop = [](const auto&) { return false; };
    const auto stopped = isosurface<3>(
        prerolls, 0.1, {.max_triangles = 1'000'000, .indicator = "error"}, {.progress = stop});
    EXPECT_TRUE(stopped.search.cancelled);
}

/// The least threshold that may be tried ends a search from any start, and none below it is tried.
TEST(HighOrderBudgets, TryNoThresholdBelowTheLeast) {
    for (const double least : {1e-30, 1e-4, 0.013, 2.0, 1e30}) {
        for (const double start : {0.0, 1e-3, 1.0, 1e20}) {
            for (const double number : {1.0, 20.0, 1e6, 1e40}) {
                const auto count = [&](double threshold,
                                       std::uint64_t most) -> std::optional<std::uint64_t> {
                    EXPECT_GE(threshold, least);
                    const double triangles = std::ceil(number / threshold);
                    if (triangles > static_cast<double>(most)) return std::nullopt;
                    return static_cast<std::uint64_t>(triangles);
                };
                const TriangleBudget found = least_threshold(count, start, 100, least);
                EXPECT_LE(found.triangles, 100U);
                if (found.end() == BudgetEnd::complete) continue;
                EXPECT_FALSE(count(next_below(found.threshold), 100).has_value());
            }
        }
    }
}

// Lenses.

/// Edges of triangles that touch the ball are at most so long.
double longest_edge_in(const Surface<3>& surface, const Ball& ball) {
    double longest = 0;
    for (const auto& t : surface.simplices) {
        const bool touches =
            std::ranges::any_of(t, [&](std::uint32_t v) { return ball(surface.vertices[v]) == 0; });
        for (std::size_t i = 0; touches && i < 3; ++i) {
            longest =
                std::max(longest, norm(surface.vertices[t[i]] - surface.vertices[t[(i + 1) % 3]]));
        }
    }
    return longest;
}

TEST(HighOrderLenses, AreFineInsideAndClosed) {
    for_each_world(15, [](const auto& drawn, unsigned seed) {
        std::mt19937 random(seed);
        const Ball ball{{uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5},
                        0.1 + 0.3 * uniform(random)};
        const double tolerance = std::array{0.1, 1.0, 1e9}[seed % 3];
        const LensRequest lens{ball, 0.2, 1e9, std::array{0.0, 0.5, 2.0}[seed / 3 % 3]};
        const VirtualOptions options{tolerance, 5, lens};
        const auto result = drawn.surface(0.1, options, {.verify = true});
        expect_closed(result.surface);
        expect_bound(drawn, result, 0.1, tolerance);
        EXPECT_LE(longest_edge_in(result.surface, ball), 0.2);
    });
}

TEST(HighOrderLenses, AreCoarseFarAway) {
    const OnBoxes<3> drawn(WorldOptions{.least_degree = 3, .greatest_degree = 3}, gyroid);
    const Prerolls prerolls(drawn.world, drawn.field);
    const Ball ball{{0.6, 0.6, 0.6}, 0.2};
    const auto in_lens = [&](double coarsest, double slope) {
        return isosurface<3>(
            prerolls, 0.1, with_error(prerolls, {.lens = LensRequest{ball, 0.1, coarsest, slope}}));
    };
    const auto lens = in_lens(10, 0.5);
    const auto everywhere = in_lens(0.1, 0.5);
    expect_closed(lens.surface);
    EXPECT_LT(lens.surface.simplices.size(), everywhere.surface.simplices.size() / 4);
    EXPECT_GT(longest_edge_in(lens.surface, {{-0.9, -0.9, -0.9}, 0.5}), 0.2);
    expect_refused(
        [&] {
            (void)isosurface<3>(prerolls, 0.1, {.indicator = "error", .lens = LensRequest{ball}});
        },
        "0 < finest <= coarsest");
}

// Regions.

TEST(HighOrderRegions, KeepTheirOwnErrorAndStayClosed) {
    std::size_t inner = 0;
    for_each_world(12, [&](const auto& drawn, unsigned seed) {
        std::mt19937 random(seed);
        const Ball ball{{uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5},
                        0.1 + 0.3 * uniform(random)};
        const double inside = std::array{0.02, 0.1}[seed % 2];
        VirtualOptions options{1, 6};
        const std::size_t coarse = drawn.surface(0.1, options).surface.simplices.size();
        options.region = RegionRequest{ball, inside};
        const auto result = drawn.surface(0.1, options, {.verify = true});
        expect_closed(result.surface);
        expect_bound(drawn, result, 0.1, 1);
        EXPECT_GE(result.surface.simplices.size(), coarse);
        if (result.counts.limited != 0) return;
        Surface<3> in_ball = result.surface;
        std::erase_if(in_ball.simplices, [&](const auto& t) {
            return std::ranges::none_of(
                t, [&](std::uint32_t v) { return ball(result.surface.vertices[v]) == 0; });
        });
        inner += in_ball.simplices.size();
        EXPECT_LE(measured(drawn.world, in_ball, 0.1),
                  inside + drawn.data.jump() + std::ldexp(4.0, -20));
    });
    EXPECT_GT(inner, 1000U);
}

TEST(HighOrderRegions, AreCoarseFarAwayAndRefuseNoTolerance) {
    const OnBoxes<3> boxes(
        WorldOptions{.cells = 4, .levels = 1, .least_degree = 3, .greatest_degree = 3}, gyroid);
    const Prerolls prerolls(boxes.world, boxes.field);
    Projection how{.threshold = 0.5, .indicator = "error"};
    const auto triangles = [&] {
        return isosurface<3>(prerolls, 0.1, how).surface.simplices.size();
    };
    const std::size_t coarse = triangles();
    how.region = RegionRequest{Ball{{-0.7, -0.7, -0.7}, 0.2}, 0.005};
    const std::size_t region = triangles();
    how.threshold = 0.005;
    const std::size_t fine = triangles();
    EXPECT_GT(region, coarse * 3 / 2);
    EXPECT_LT(region, fine / 3);
    how.region->threshold = 0;
    expect_refused([&] { (void)triangles(); }, "the tolerance in the region is not");
}

// Frames.

struct TwoFrames {
    DegreeWorld<3> world;
    DegreeWorld<3> later;  // the same grid, with other data
    DegreeField<3> first{world};
    DegreeField<3> second{later};

    explicit TwoFrames(const WorldOptions& options)
        : world(with_degrees(options, 2, 4), gyroid), later(with_degrees(options, 3, 5), ties) {}
    static WorldOptions with_degrees(WorldOptions options, int least, int greatest) {
        options.least_degree = least;
        options.greatest_degree = greatest;
        return options;
    }

    Frames frames() const {
        return shared_frames(std::shared_ptr<const DegreeWorld<3>>(std::shared_ptr<void>(), &world),
                             std::vector{first, second}, {0, 1}, nullptr);
    }
};

/// The data at a moment, for the judge.
struct AtMoment {
    static constexpr int dimension = 3;
    const TwoFrames* frames;
    double t;
    double operator()(const Point& x) const {
        return (1 - t) * frames->world(x) + t * frames->later(x);
    }
};

TEST(HighOrderFrames, AreClosedAndWithinTheirBoundsAtAnyTime) {
    for (unsigned seed = 1; seed <= 6 && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const TwoFrames two({.levels = 2, .seed = seed});
        const Frames frames = two.frames();
        for (const float t : {0.0F, 0.3F, 0.5F, 0.9F, 1.0F}) {
            const auto prerolls = frames.at(std::array{1 - t, t});
            const auto data = prerolls->high_order({});
            ASSERT_NE(data, nullptr);
            const std::array<Point, 3> points{
                {{0.3, -0.2, 0.7}, {-0.61, 0.4, 0.12}, {0.9, 0.8, -0.3}}};
            const ProbeResult probed = probe(*data, points);
            const AtMoment moment{&two, static_cast<double>(t)};
            for (std::size_t i = 0; i < points.size(); ++i) {
                EXPECT_NEAR(probed.values[i], moment(points[i]), 1e-6);
            }
            const auto result = isosurface<3>(
                *prerolls, 0.1, {.threshold = 0.2, .indicator = "error"}, {.verify = true});
            expect_closed(result.surface);
            EXPECT_GT(result.surface.simplices.size(), 100U);
            EXPECT_LE(measured(moment, result.surface, 0.1),
                      result.error_bound + std::ldexp(4.0, -20));
            EXPECT_LE(result.error_bound, (0.2 + data->jump()) * (1 + 1e-6));
        }
    }
}

TEST(HighOrderFrames, AtTheirTimesAreTheFramesThemselves) {
    const TwoFrames two({.levels = 2});
    const HighOrder alone(two.world, two.first);
    const Between<DegreeField<3>> between({&two.first, &two.second}, std::array{1.0F, 0.0F});
    const HighOrder same(two.world, between);
    const auto draw = [](const HighOrder& data) {
        const VirtualRefinement fine(data, {.tolerance = 0.1});
        return isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds())).surface;
    };
    expect_same(draw(alone), draw(same));
}

// Positions of curved leaves.

/// A projection asks for an error of positions, and results tell what is kept of it: also shadings,
/// whose boundary is then within it of that of the leaves, and isolines.
TEST(HighOrderPositions, KeepTheErrorThatAProjectionAsksFor) {
    const DrawnWorld<CurvedWorld<DegreeWorld<2>>, DegreeField<2>> drawn(
        polynomial_bend(3, 0.1, 2), WorldOptions{.levels = 1}, square<2>);
    const Prerolls prerolls(drawn.world, drawn.field);
    const std::vector<double> isovalues{0.3, 0.8};
    std::size_t triangles = 0;
    std::size_t points = 0;
    for (const double places : {0.1, 0.01, 0.001}) {
        const Projection how{.threshold = 1, .indicator = "error", .position_error = places};
        const auto shaded = shading(prerolls, how);
        EXPECT_GT(shaded.position_bound, 0);
        EXPECT_LE(shaded.position_bound, places * (1 + 1e-6));
        EXPECT_GT(shaded.surface.simplices.size(), triangles);
        triangles = shaded.surface.simplices.size();
        double off = 0;
        for (const auto& edge : shaded.surface.boundary) {
            const Point middle =
                0.5 * (shaded.surface.vertices[edge[0]] + shaded.surface.vertices[edge[1]]);
            Point near = drawn.world.straight(middle);
            const std::size_t side = std::abs(near[0]) > std::abs(near[1]) ? 0 : 1;
            near[side] = std::copysign(1, near[side]);
            off = std::max(off, norm(drawn.world.bent(near) - middle));
        }
        EXPECT_GT(off, 0);
        EXPECT_LE(off, shaded.position_bound);
        EXPECT_EQ(height_field(prerolls, 2, how).position_bound, shaded.position_bound);
        const auto lines = isolines(prerolls, isovalues, how);
        EXPECT_GT(lines.position_bound, 0);
        EXPECT_LE(lines.position_bound, places * (1 + 1e-6));
        EXPECT_GT(lines.lines.vertices.size(), points);
        points = lines.lines.vertices.size();
    }
    expect_refused([&] { shading(prerolls, {.position_error = 0.1}); }, "drawn within an error");
    for (const double none : {-1.0, std::numeric_limits<double>::infinity()}) {
        expect_refused(
            [&] {
                shading(prerolls, {.threshold = 1, .indicator = "error", .position_error = none});
            },
            "the error of positions is not a finite number >= 0");
    }
}

}  // namespace
