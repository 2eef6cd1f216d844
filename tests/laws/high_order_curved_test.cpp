// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Curved leaves: surfaces are closed, and within both of their bounds.

#include <gtest/gtest.h>

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/polynomial_values.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/check_grid.hpp>

#include "curved_world.hpp"
#include "high_order_judge.hpp"
#include "long_run.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "table_in_c.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;
using namespace nestgrid;

namespace {

template <int dim>
using CurvedBoxes = DrawnWorld<CurvedWorld<DegreeWorld<dim>>, DegreeField<dim>>;
template <int dim>
using CurvedShapes = DrawnWorld<CurvedWorld<ShapeWorld<dim>>, ShapeField<dim>>;

unsigned count_of_curved_worlds() { return is_long_run() ? 1000 : 20; }

/// Points of triangles are within position_bound of points at which U is within error_bound of the
/// isovalue: looked for along the gradient of U.
template <class Drawn>
void expect_near(const Drawn& drawn, const Isosurface<Drawn::dim>& result, double isovalue) {
    constexpr int dim = Drawn::dim;
    const auto u = [&](const Point& x) { return drawn.world(drawn.world.straight(x)) - isovalue; };
    const std::size_t step = 1 + result.surface.simplices.size() / 300;
    double worst = 0;
    for (std::size_t s = 0; s < result.surface.simplices.size(); s += step) {
        Point x{0, 0, 0};
        for (std::size_t k = 0; k < std::size_t{dim}; ++k) {
            const double weight = dim == 3 ? std::array{0.5, 0.3, 0.2}[k] : 0.5;
            x = x + weight * result.surface.vertices[result.surface.simplices[s][k]];
        }
        Point gradient{0, 0, 0};
        for (std::size_t d = 0; d < std::size_t{dim}; ++d) {
            Point to = x;
            to[d] += 1e-5;
            Point from = x;
            from[d] -= 1e-5;
            gradient[d] = (u(to) - u(from)) / 2e-5;
        }
        const double length = norm(gradient);
        if (length == 0) continue;
        double least = std::abs(u(x));
        double before = 0;
        for (double along = -1; along <= 1; along += 0.25) {
            const double there = u(x + (along * result.position_bound / length) * gradient);
            least = std::min(least, std::abs(there));
            if (there * before < 0) least = 0;  // between the two
            before = there;
        }
        worst = std::max(worst, least);
    }
    EXPECT_LE(worst, result.error_bound + 1e-5);
}

struct CurvedTolerances {
    double data;
    double positions;
    int depth;
};
CurvedTolerances random_tolerances(std::mt19937& random) {
    return {std::pow(10.0, -0.3 - 0.3 * static_cast<double>(random() % 3)),
            std::pow(10.0, -1 - 0.5 * static_cast<double>(random() % 3)),
            3 + static_cast<int>(random() % 2)};
}

/// \param exact whether leaves are bent as their world is
template <class Drawn>
void expect_within_both(const Drawn& drawn, const CurvedTolerances& at, double isovalue,
                        bool exact) {
    const auto result = drawn.surface(
        isovalue, {.tolerance = at.data, .depth = at.depth, .position_tolerance = at.positions},
        {.verify = true});
    expect_closed(result.surface);
    EXPECT_EQ(result.position_bound > 0, drawn.data.geometry_degree() > 1);
    if (result.counts.limited == 0) {
        EXPECT_LE(result.position_bound, (at.positions + drawn.data.position_jump()) * (1 + 1e-6));
        EXPECT_LE(result.error_bound, (at.data + drawn.data.jump()) * (1 + 1e-6));
    }
    if (exact && drawn.data.jump() < 1e-9) {
        expect_near(drawn, result, isovalue);
    }
}

WorldOptions curved_options(std::mt19937& random, unsigned seed) {
    WorldOptions options;
    options.cells = 1 + random() % 2;
    options.levels = static_cast<int>(random() % 3);
    options.least_degree = 1 + static_cast<int>(random() % 4);
    options.greatest_degree = options.least_degree + static_cast<int>(random() % 2);
    options.seed = seed;
    return options;
}
/// Of one degree without gaps, or of several with gaps.
Bend random_bend(std::mt19937& random, int dim) {
    Bend bend = polynomial_bend(2 + static_cast<int>(random() % 3), 0.1, dim);
    if (random() % 2 == 0) {
        bend.least_degree = 1 + static_cast<int>(random() % 2);
        bend.greatest_degree = 4;
    }
    return bend;
}

bool is_exact(const Bend& bend) { return bend.least_degree == bend.greatest_degree; }

TEST(HighOrderCurved, BoxesAreClosedAndWithinBothBounds) {
    for (unsigned seed = 1; seed <= 2 * count_of_curved_worlds() && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        const WorldOptions options = curved_options(random, seed);
        const Bend bend = random_bend(random, 3);
        const CurvedBoxes<3> drawn(bend, options, functions[random() % functions.size()]);
        expect_within_both(drawn, random_tolerances(random), 0.1, is_exact(bend));
    }
}

TEST(HighOrderCurved, ShapesAreClosedAndWithinBothBounds) {
    for (const Cells cells : {Cells::simplices, Cells::prisms, Cells::all, Cells::pyramids}) {
        const unsigned count = count_of_curved_worlds() / (cells == Cells::pyramids ? 4 : 2);
        for (unsigned seed = 1; seed <= count && !HasFailure(); ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            std::mt19937 random(seed);
            const WorldOptions options = curved_options(random, seed);
            const Bend bend = random_bend(random, 3);
            const CurvedShapes<3> drawn(bend, cells, options,
                                        functions[random() % functions.size()]);
            expect_within_both(drawn, random_tolerances(random), 0.1, is_exact(bend));
        }
    }
}

TEST(HighOrderCurved, LinesAreClosedAndWithinBothBounds) {
    for (unsigned seed = 1; seed <= 4 * count_of_curved_worlds() && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        const WorldOptions options = curved_options(random, seed);
        const Bend bend = random_bend(random, 2);
        CurvedTolerances at = random_tolerances(random);
        at.depth = 6;
        const CurvedBoxes<2> boxes(bend, options, functions[random() % functions.size()]);
        expect_within_both(boxes, at, 0.1, is_exact(bend));
        const CurvedShapes<2> columns(bend, Cells::columns, options,
                                      functions[random() % functions.size()]);
        expect_within_both(columns, at, 0.1, is_exact(bend));
    }
}

/// The boundary of a ball is a sphere, and of a disk a circle, as near as its leaves are and the
/// tolerance asks for; slices through its middle are disks.
TEST(HighOrderCurved, BallsAreRound) {
    const Bend bend{on_ball, 4, 4};
    const CurvedBoxes<3> ball(bend, WorldOptions{.cells = 2, .levels = 1, .refined = 1}, square<3>);
    // How far the leaves themselves are from the sphere: interpolation of degree 4.
    const double off_leaves = 4e-3;
    std::size_t before = 0;
    for (const double tolerance : {0.1, 0.03, 0.01}) {
        const VirtualRefinement fine(
            ball.data, {.tolerance = 100, .depth = 6, .position_tolerance = tolerance});
        const auto projection = under(fine.criterion(), fine.bounds());
        const auto sphere = boundary_surface(fine, projection);
        expect_closed(sphere.surface, true);
        EXPECT_GT(sphere.surface.simplices.size(), before);
        before = sphere.surface.simplices.size();
        double off = 0;
        for (const auto& t : sphere.surface.simplices) {
            Point middle{0, 0, 0};
            for (const auto v : t) middle = middle + (1.0 / 3) * sphere.surface.vertices[v];
            off = std::max(off, std::abs(norm(middle) - 1));
        }
        EXPECT_LE(off, tolerance + off_leaves);
        const auto disk = slice(fine, Plane({0, 0, 0.1}, {0, 1, 3}), projection);
        expect_closed(disk.surface);
        const double radius = std::sqrt(1 - 0.01 * 9 / 10);
        EXPECT_NEAR(surface_report(disk.surface).area, std::acos(-1.0) * radius * radius,
                    8 * (tolerance + off_leaves));
    }
}

/// A slice finds leaves that bulge into its plane, though their corners lie on one side of it.
TEST(HighOrderCurved, SlicesFindWhatLeavesTheHullOfCorners) {
    Bend bend{[](const Point& s) {
                  return Point{s[0], s[1], s[2] + 0.4 * (1 - s[0] * s[0]) * (1 - s[1] * s[1])};
              },
              4, 4};
    const CurvedBoxes<3> drawn(bend, WorldOptions{.cells = 1, .mirrored = false}, square<3>);
    const VirtualRefinement fine(drawn.data,
                                 {.tolerance = 0.1, .depth = 6, .position_tolerance = 0.01});
    const auto cap =
        slice(fine, Plane({0, 0, 1.2}, {0, 0, 1}), under(fine.criterion(), fine.bounds()));
    expect_closed(cap.surface);
    EXPECT_GT(surface_report(cap.surface).area, 0.5);
    EXPECT_LE(cap.position_bound, 0.01 * (1 + 1e-6));
}

TEST(HighOrderCurved, ThreadsDrawTheSameBits) {
    const CurvedShapes<3> drawn(polynomial_bend(3, 0.1, 3), Cells::all,
                                WorldOptions{.levels = 2, .greatest_degree = 4}, gyroid);
    const VirtualRefinement fine(drawn.data,
                                 {.tolerance = 0.3, .depth = 4, .position_tolerance = 0.03});
    const auto projection = under(fine.criterion(), fine.bounds());
    const auto one = isosurface<3>(fine, 0.1, projection);
    EXPECT_GT(one.surface.simplices.size(), 1000U);
    const auto more = isosurface<3>(fine, 0.1, projection, {}, {ThreadExecutor(3)});
    expect_same(one.surface, more.surface);
    EXPECT_EQ(one.position_bound, more.position_bound);
}

/// Points of surfaces lie in leaves where their polynomials have nearly the isovalue, and normals
/// are those of the polynomials.
TEST(HighOrderCurved, ProbesAndNormalsFollowTheLeaves) {
    for (const Cells cells : {Cells::simplices, Cells::all, Cells::pyramids}) {
        const CurvedShapes<3> drawn(
            polynomial_bend(2, 0.1, 3), cells,
            WorldOptions{.levels = 1, .least_degree = 2, .greatest_degree = 2}, square<3>);
        std::mt19937 random(3);
        std::vector<Point> straight;
        std::vector<Point> points;
        for (int i = 0; i < 200; ++i) {
            straight.push_back(
                {1.8 * uniform(random) - 0.9, 1.8 * uniform(random) - 0.9, -0.9 * uniform(random)});
            // Every other one at the boundary, which is drawn elsewhere.
            if (i % 2 == 1) straight.back()[random() % 2] = i % 4 == 1 ? 1 - 1e-5 : -1 + 1e-5;
            points.push_back(drawn.world.bent(straight.back()));
        }
        const ProbeResult probed = probe(drawn.data, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_TRUE(probed.found(i));
            EXPECT_NEAR(probed.values[i], square<3>(straight[i]), 1e-10);
        }
        Surface<3> surface = drawn.surface(0.3, {.tolerance = 0.05}).surface;
        ASSERT_GT(surface.vertices.size(), 100U);
        set_polynomial_normals(surface, drawn.data);
        double cosine = 1;
        for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
            const auto u = [&](std::size_t axis, double by) {
                Point x = surface.vertices[v];
                x[axis] += by;
                return square<3>(drawn.world.straight(x));
            };
            Point gradient;
            for (std::size_t d = 0; d < 3; ++d) gradient[d] = u(d, 1e-5) - u(d, -1e-5);
            cosine = std::min(cosine, -dot(surface.normals[v], (1 / norm(gradient)) * gradient));
        }
        EXPECT_GT(cosine, 1 - 1e-6);
    }
}

/// Without a tolerance of positions it is the same share of the domain as that of the data.
TEST(HighOrderCurved, PositionsFollowTheToleranceOfTheData) {
    const CurvedBoxes<3> drawn(polynomial_bend(2, 0.1, 3),
                               WorldOptions{.least_degree = 2, .greatest_degree = 2}, square<3>);
    EXPECT_EQ(drawn.data.geometry_degree(), 2);
    EXPECT_LE(drawn.data.position_jump(), 1e-12);
    double before = 1;
    for (const double tolerance : {0.3, 0.1, 0.03}) {
        const auto result = drawn.surface(0.8, {.tolerance = tolerance});
        EXPECT_LT(result.position_bound, before);
        before = result.position_bound;
    }
    for (const double none : {-1.0, 1e-14, std::numeric_limits<double>::quiet_NaN()}) {
        expect_refused([&] { drawn.surface(0.8, {.tolerance = 0.1, .position_tolerance = none}); },
                       "the tolerance of positions is");
    }
}

/// Leaves of degree 1 are drawn as without the operations, to the last bit.
TEST(HighOrderCurved, StraightLeavesAreAsEver) {
    const WorldOptions options{.levels = 2, .least_degree = 3, .greatest_degree = 3};
    const Bend none{[](const Point& x) { return x; }, 1, 1};
    const CurvedBoxes<3> curved(none, options, gyroid);
    const DrawnWorld<DegreeWorld<3>, DegreeField<3>> straight(options, gyroid);
    EXPECT_EQ(curved.data.geometry_degree(), 1);
    expect_same(straight.surface(0.1, {.tolerance = 0.1}).surface,
                curved.surface(0.1, {.tolerance = 0.1}).surface);
}

TEST(HighOrderCurved, TablesInCDrawTheSame) {
    const CurvedBoxes<3> drawn(polynomial_bend(3, 0.1, 3), WorldOptions{.levels = 1}, gyroid);
    const BehindTables tables(drawn.world, drawn.field);
    EXPECT_FALSE(check_hierarchy(*tables.hierarchy).has_value());
    const HighOrder behind(*tables.hierarchy);
    EXPECT_EQ(behind.geometry_degree(), 3);
    const VirtualRefinement fine(behind, {.tolerance = 0.2});
    expect_same(drawn.surface(0.1, {.tolerance = 0.2}).surface,
                isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds())).surface);

    TableInC<CurvedWorld<DegreeWorld<3>>> grid(drawn.world);
    grid.table.map = nullptr;
    const nestgrid_field field = field_in_c(drawn.world, drawn.field);
    expect_refused([&] { (void)open_table<double>(grid.table, field); },
                   "one of 'geometry_degree' and 'map' alone");
    grid.table.size = offsetof(nestgrid_grid, geometry_degree);
    EXPECT_FALSE(open_table<double>(grid.table, field)->offers(Feature::geometry_degree));
}

/// A grid whose map errs.
struct WrongMap : CurvedWorld<DegreeWorld<3>> {
    using Base = CurvedWorld<DegreeWorld<3>>;
    using Base::Base;

    int geometry_degree(const Element& e) const { return says.value_or(Base::geometry_degree(e)); }
    void map(const Element& e, std::span<const Point> reference, std::span<Point> out) const {
        Base::map(e, reference, out);
        for (Point& x : out) x[1] += plus;
    }
    std::optional<int> says;
    double plus = 0;
};

TEST(HighOrderCurved, CheckGridFindsMapsThatDoNotMeetTheirCorners) {
    WrongMap world(polynomial_bend(3, 0.1, 3), WorldOptions{.levels = 1}, gyroid);
    const DegreeField<3> field(world);
    const auto violation = [&] {
        const auto found = check_grid(world, field);
        return found && found->law == Law::map ? found->sentence : "";
    };
    EXPECT_EQ(violation(), "");
    world.says = 4;
    EXPECT_EQ(violation(), "") << "a polynomial of degree 3 is one of degree 4";
    world.says = 1;
    EXPECT_NE(violation().find("the position is no polynomial of degree 1"), std::string::npos)
        << violation();
    for (const int none : {0, 9}) {
        world.says = none;
        EXPECT_NE(violation().find("has the geometry degree " + std::to_string(none)),
                  std::string::npos);
        EXPECT_NE(refusal<GridError>([&] {
                      const HighOrder data(world, field);
                  }).find("has the geometry degree " + std::to_string(none)),
                  std::string::npos);
    }
    world.says = {};
    world.plus = 1e-3;
    EXPECT_NE(violation().find("but the node there has the coordinate"), std::string::npos)
        << violation();
    world.plus = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(violation().find("map() gives no finite number"), std::string::npos);
    EXPECT_NE(refusal<GridError>([&] {
                  const HighOrder data(world, field);
              }).find("map() gives no finite number in element"),
              std::string::npos);
}

}  // namespace
