// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drawings that look at the leaves of their level sets, slices and boundaries alone
// (VirtualOptions::values, functions, boundary): they draw the same, evaluate each of these leaves
// once, and keep nothing of others.
#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "curved_world.hpp"
#include "degree_world.hpp"
#include "high_order_judge.hpp"
#include "same_surface.hpp"
#include "shape_world.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;
using namespace nestgrid;

namespace {

template <int dim>
using OfBoxes = DrawnWorld<DegreeWorld<dim>, DegreeField<dim>>;
template <int dim>
using OfShapes = DrawnWorld<ShapeWorld<dim>, ShapeField<dim>>;
using OfCurvedBoxes = DrawnWorld<CurvedWorld<DegreeWorld<3>>, DegreeField<3>>;
using OfCurvedShapes = DrawnWorld<CurvedWorld<ShapeWorld<3>>, ShapeField<3>>;

/// Degrees from 1 to 6, some equal, sizes that differ, jumps in a third of them.
WorldOptions world_at(unsigned seed) {
    std::mt19937 random(seed);
    WorldOptions options;
    options.cells = 1 + random() % 3;
    options.levels = static_cast<int>(random() % 4);
    options.least_degree = 1 + static_cast<int>(random() % 4);
    options.greatest_degree = options.least_degree + static_cast<int>(random() % 3);
    if (random() % 3 == 0) options.noise = 0.2;
    options.seed = seed;
    return options;
}

/// What is drawn looking at the leaves of a level set alone is what is drawn looking at all.
class Comparison {
public:
    /// \param seed chooses isovalue, tolerance, depth, caps, threads and lenses
    template <class Drawn>
    void expect_same_drawing(const Drawn& drawn, unsigned seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        constexpr int dim = Drawn::dim;
        const double isovalue = 0.25 * (seed % 4);
        const double tolerance = std::pow(10.0, -0.3 - 0.3 * (seed % 3));
        VirtualOptions at{tolerance, 3 + static_cast<int>(seed % 2)};
        if (seed % 5 == 0) at.lens = LensRequest{Ball{{0.2, 0.1, 0}, 0.2}, 0.2, 1e9, 0.5};
        IsosurfaceOptions options{.elements = true};
        options.cap = dim == 3 && seed % 3 == 0;
        VirtualOptions alone = at;
        alone.values.emplace({std::array{
            isovalue, options.cap ? std::numeric_limits<double>::infinity() : isovalue}});
        const auto draw = [&](const VirtualOptions& with, std::size_t threads) {
            const VirtualRefinement fine(drawn.data, with);
            return isosurface<dim>(fine, isovalue, under(fine.criterion(), fine.bounds()), options,
                                   {ThreadExecutor(threads)});
        };
        const auto one = draw(alone, 1);
        kept_alone_ += drawn.data.memory_bytes();
        const auto more = draw(alone, 2 + seed % 2);
        const auto all = draw(at, 1);
        kept_of_all_ += drawn.data.memory_bytes();
        for (const auto* const other : {&more, &all}) {
            expect_same(one.surface, other->surface);
            EXPECT_EQ(one.error_bound, other->error_bound);
            EXPECT_EQ(one.position_bound, other->position_bound);
            EXPECT_EQ(one.counts.limited, other->counts.limited);
        }
        EXPECT_TRUE(std::isfinite(one.error_bound));
        simplices_ += one.surface.simplices.size();
    }
    /// That surfaces were drawn, and leaves left out.
    void expect_sense() const {
        EXPECT_GT(simplices_, 1000U);
        EXPECT_LT(kept_alone_, kept_of_all_);
    }

private:
    std::size_t simplices_ = 0;
    std::size_t kept_alone_ = 0;
    std::size_t kept_of_all_ = 0;
};

TEST(HighOrderValues, BoxesAreDrawnTheSame) {
    Comparison comparison;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        comparison.expect_same_drawing(OfBoxes<3>(world_at(seed), functions[seed % 4]), seed);
    }
    comparison.expect_sense();
}

TEST(HighOrderValues, LinesAreDrawnTheSame) {
    Comparison comparison;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        comparison.expect_same_drawing(OfBoxes<2>(world_at(seed), functions[seed % 4]), seed);
        comparison.expect_same_drawing(
            OfShapes<2>(Cells::columns, world_at(seed), functions[seed % 4]), seed);
    }
    comparison.expect_sense();
}

TEST(HighOrderValues, ShapesAreDrawnTheSame) {
    Comparison comparison;
    for (const Cells cells : {Cells::simplices, Cells::prisms, Cells::all, Cells::pyramids}) {
        for (unsigned seed = 1; seed <= (cells == Cells::pyramids ? 2U : 4U); ++seed) {
            WorldOptions options = world_at(seed);
            options.cells = std::min<std::size_t>(options.cells, 2);
            options.levels = std::min(options.levels, cells == Cells::pyramids ? 1 : 2);
            comparison.expect_same_drawing(OfShapes<3>(cells, options, functions[seed % 4]), seed);
        }
    }
    comparison.expect_sense();
}

TEST(HighOrderValues, CurvedLeavesAreDrawnTheSame) {
    Comparison comparison;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        Bend bend = polynomial_bend(2 + static_cast<int>(seed % 3), 0.1, 3);
        if (seed % 2 == 0) bend.least_degree = 1;
        WorldOptions options = world_at(seed);
        options.levels = std::min(options.levels, 2);
        comparison.expect_same_drawing(OfCurvedBoxes(bend, options, functions[seed % 4]), seed);
        options.cells = std::min<std::size_t>(options.cells, 2);
        options.levels = std::min(options.levels, 1);
        comparison.expect_same_drawing(
            OfCurvedShapes(bend, Cells::all, options, functions[seed % 4]), seed);
    }
    comparison.expect_sense();
}

/// Slices, and boundaries, drawn from the leaves that they pass through are those drawn from all.
template <class Drawn>
void expect_same_slices(const Drawn& drawn, unsigned seed, std::size_t& triangles) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::array<Point, 3> normals{Point{1, 0, 0}, Point{1, 2, -1}, Point{0, 0, 1}};
    const Plane plane({0.1 * (seed % 3), 0, 0.25 * (seed % 2)}, normals[seed % 3]);
    const Sphere sphere({0.2, 0.1, 0}, 0.4);
    const detail::Everywhere everywhere;
    const std::array<const LevelFunction*, 3> all{&plane, &sphere, &everywhere};
    const LevelFunction& function = *all[seed % 3];
    const IsosurfaceOptions options{.cap = seed % 3 == 2 || seed % 4 == 0};
    const VirtualOptions at{std::pow(10.0, -0.3 - 0.3 * (seed % 3)), 3};
    const auto draw = [&](const VirtualOptions& with, std::size_t threads) {
        const VirtualRefinement fine(drawn.data, with);
        return slice(fine, function, under(fine.criterion(), fine.bounds()), options,
                     {ThreadExecutor(threads)});
    };
    VirtualOptions alone = at;
    alone.values.emplace();
    alone.functions = {&function};
    alone.boundary = options.cap;
    const auto one = draw(alone, 1);
    const std::size_t kept = drawn.data.memory_bytes();
    const auto more = draw(alone, 2 + seed % 2);
    const auto whole = draw(at, 1);  // last, as polynomials of all leaves serve all drawings
    EXPECT_LE(kept, drawn.data.memory_bytes());
    for (const auto* const other : {&one, &more}) {
        expect_same(whole.surface, other->surface);
        EXPECT_EQ(whole.surface.attributes, other->surface.attributes);
        EXPECT_EQ(whole.error_bound, other->error_bound);
        EXPECT_EQ(whole.position_bound, other->position_bound);
        EXPECT_EQ(whole.counts.limited, other->counts.limited);
    }
    EXPECT_TRUE(std::isfinite(one.error_bound));
    triangles += one.surface.simplices.size();
}

TEST(HighOrderValues, SlicesAndBoundariesAreDrawnTheSame) {
    std::size_t triangles = 0;
    for (unsigned seed = 1; seed <= 36; ++seed) {
        expect_same_slices(OfBoxes<3>(world_at(seed), functions[seed % 4]), seed, triangles);
    }
    for (const Cells cells : {Cells::simplices, Cells::prisms, Cells::all}) {
        for (unsigned seed = 1; seed <= 6; ++seed) {
            WorldOptions options = world_at(seed);
            options.cells = std::min<std::size_t>(options.cells, 2);
            options.levels = std::min(options.levels, 2);
            expect_same_slices(OfShapes<3>(cells, options, functions[seed % 4]), seed, triangles);
        }
    }
    EXPECT_GT(triangles, 10000U);
}

TEST(HighOrderValues, SlicesAndBoundariesOfCurvedLeavesAreDrawnTheSame) {
    std::size_t triangles = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        Bend bend = polynomial_bend(2 + static_cast<int>(seed % 3), 0.1, 3);
        if (seed % 2 == 0) bend.least_degree = 1;
        WorldOptions options = world_at(seed);
        options.levels = std::min(options.levels, 2);
        expect_same_slices(OfCurvedBoxes(bend, options, functions[seed % 4]), seed, triangles);
        options.cells = std::min<std::size_t>(options.cells, 2);
        options.levels = std::min(options.levels, 1);
        expect_same_slices(OfCurvedShapes(bend, Cells::all, options, functions[seed % 4]), seed,
                           triangles);
    }
    EXPECT_GT(triangles, 10000U);
}

/// A plane that meets one curved leaf where it bulges, and no hull of corners.
TEST(HighOrderValues, SlicesOfWhatLeavesTheHullOfCornersAreDrawn) {
    const Bend bulge{[](const Point& x) {
        const double by = 0.2 * (1 - x[1] * x[1]) * (1 - x[2] * x[2]);
        return Point{x[0] * (1 + by), x[1], x[2]};
    }};
    const OfCurvedBoxes drawn(bulge, WorldOptions{.cells = 1}, gyroid);
    const Plane plane({1.1, 0, 0}, {1, 0, 0});
    VirtualOptions at{.tolerance = 0.3, .position_tolerance = 0.02};
    at.values.emplace();
    at.functions = {&plane};
    const auto draw = [&] {
        const VirtualRefinement fine(drawn.data, at);
        return slice(fine, plane, under(fine.criterion(), fine.bounds()));
    };
    const auto alone = draw();
    EXPECT_GT(alone.surface.simplices.size(), 10U);
    EXPECT_EQ(alone.counts.limited, 0U);
    at.values.reset();
    expect_same(alone.surface, draw().surface);
}

/// A field that counts how often each leaf is evaluated, and at how many points.
class Counted {
public:
    using value_type = double;
    using Element = DegreeWorld<3>::Element;

    explicit Counted(const DegreeWorld<3>& world) : field_{world} {}

    NodeMask coarse_values(std::size_t, std::span<double>) const { return ~NodeMask{0}; }
    NodeMask new_values(const Element&, NodeMask, std::span<double>) const { return ~NodeMask{0}; }
    int degree(const Element& leaf) const { return field_.degree(leaf); }
    void evaluate(const Element& leaf, std::span<const Point> reference,
                  std::span<double> out) const {
        if (calls.size() <= leaf.cell) calls.resize(leaf.cell + 1);
        ++calls[leaf.cell];
        const auto n = static_cast<std::size_t>(degree(leaf) + 1);
        EXPECT_EQ(reference.size(), n * n * n);
        field_.evaluate(leaf, reference, out);
    }
    /// How many leaves were evaluated since this was asked last, none of them twice.
    std::size_t take_count() const {
        std::size_t count = 0;
        for (const int times : calls) {
            EXPECT_LE(times, 1);
            count += times > 0 ? 1 : 0;
        }
        calls.clear();
        return count;
    }

    mutable std::vector<int> calls;

private:
    DegreeField<3> field_;
};

const WorldOptions many_leaves{.cells = 4, .levels = 3, .least_degree = 2, .greatest_degree = 4};

TEST(HighOrderValues, EvaluatesEachLeafOnceAndThoseOfADrawingOnceMore) {
    const DegreeWorld<3> world(many_leaves, square<3>);
    const Counted field(world);
    const HighOrder data(world, field);
    EXPECT_EQ(field.take_count(), world.leaf_count());
    const auto draw = [&](double isovalue, double tolerance) {
        const VirtualRefinement fine(data,
                                     {.tolerance = tolerance, .values = {{{isovalue, isovalue}}}});
        return isosurface<3>(fine, isovalue, under(fine.criterion(), fine.bounds()));
    };
    EXPECT_GT(draw(0.4, 0.1).surface.simplices.size(), 100U);
    const std::size_t small = field.take_count();
    EXPECT_GT(small, 0U);
    EXPECT_LT(small, world.leaf_count() / 2);
    (void)draw(0.4, 0.01);
    EXPECT_EQ(field.take_count(), 0U);  // gathered before
    (void)draw(0.6, 0.1);
    EXPECT_GT(field.take_count(), 0U);
    EXPECT_EQ(draw(100, 0.1).surface.simplices.size(), 0U);
    EXPECT_EQ(field.take_count(), 0U);  // passes nowhere
}

/// Leaves are read in chunks, and their owners may lie in later ones.
TEST(HighOrderValues, ThreadsMakeTheSameData) {
    const WorldOptions options{
        .cells = 4, .levels = 4, .least_degree = 2, .greatest_degree = 4, .noise = 0.1};
    const OfBoxes<3> one(options, gyroid);
    EXPECT_GT(one.world.leaf_count(), 1500U);
    const VirtualOptions at{.tolerance = 0.2, .depth = 4};
    const auto whole = one.surface_of_all(0.25, at);
    const auto expect_same_data = [&](const HighOrder& data) {
        EXPECT_EQ(data.jump(), one.data.jump());
        EXPECT_EQ(data.memory_bytes(), HighOrder(one.world, one.field).memory_bytes());
        EXPECT_EQ(data.least_tolerance(), one.data.least_tolerance());
        const VirtualRefinement fine(data, at);
        const auto result = isosurface<3>(fine, 0.25, under(fine.criterion(), fine.bounds()));
        expect_same(result.surface, whole.surface);
        EXPECT_EQ(result.error_bound, whole.error_bound);
    };
    for (const std::size_t threads : {1U, 2U, 3U}) {
        expect_same_data(HighOrder(one.world, one.field, ThreadExecutor(threads)));
    }
}

TEST(HighOrderValues, FrontEndsLookAtTheLeavesThatTheyDraw) {
    const DegreeWorld<3> world(many_leaves, square<3>);
    const Counted field(world);
    const Prerolls prerolls(world, field);
    const Projection within{.threshold = 0.05, .indicator = "error"};
    const auto expect_few = [&](const char* what) {
        const std::size_t count = field.take_count();
        EXPECT_GT(count, 0U) << what;
        EXPECT_LT(count, world.leaf_count() / 2) << what;
    };
    (void)prerolls.high_order({});
    (void)field.take_count();
    const auto surface = isosurface<3>(prerolls, 0.4, within);
    expect_few("a surface");
    const std::array values{0.3, 0.5};
    const auto several = isosurfaces<3>(prerolls, std::span<const double>(values), within);
    expect_few("surfaces");
    const auto cut = slice(prerolls, Plane({0, 0, 0.1}, {0, 0, 1}), within);
    expect_few("a slice");
    EXPECT_GT(cut.surface.simplices.size(), 100U);
    const auto skin = boundary_surface(prerolls, within);
    const std::size_t on_boundary = field.take_count();
    EXPECT_GT(on_boundary, 0U);
    EXPECT_LT(on_boundary, world.leaf_count());
    const HighOrder data(world, field);
    (void)field.take_count();
    const VirtualRefinement fine(data, {.tolerance = 0.05});
    const auto under_all = under(fine.criterion(), fine.bounds());
    expect_same(surface.surface, isosurface<3>(fine, 0.4, under_all).surface);
    for (std::size_t i = 0; i < values.size(); ++i) {
        expect_same_simplices(several[i].surface,
                              isosurface<3>(fine, values[i], under_all).surface);
    }
}

/// What is kept beside nodes does not depend on degrees, and nothing is where no level set passes.
TEST(HighOrderValues, KeepsFewBytesOfALeaf) {
    std::size_t kept = 0;
    for (const int degree : {2, 4, 8}) {
        WorldOptions options = many_leaves;
        options.least_degree = options.greatest_degree = degree;
        const OfBoxes<3> drawn(options, square<3>);
        const std::size_t bytes = drawn.data.memory_bytes();
        if (kept == 0) kept = bytes;
        EXPECT_EQ(bytes, kept);
        EXPECT_LT(bytes, 500 * drawn.world.leaf_count());
        (void)drawn.surface(100, {0.1});
        EXPECT_EQ(drawn.data.memory_bytes(), kept);
        (void)drawn.surface(0.4, {0.1});
        EXPECT_GT(drawn.data.memory_bytes(), kept);
        (void)drawn.surface(100, {0.1});
        EXPECT_EQ(drawn.data.memory_bytes(), kept);
    }
}

/// Else elements beside jumps were divided as often as the depth allows.
TEST(HighOrderValues, JumpsAreKnownWithoutTheirNeighbours) {
    const OfBoxes<3> drawn(
        WorldOptions{.levels = 1, .least_degree = 2, .greatest_degree = 2, .noise = 0.1},
        square<3>);
    EXPECT_GT(drawn.data.jump(), 0.1);
    const auto result = drawn.surface(0.4, {.tolerance = 0.02, .depth = 6});
    EXPECT_GT(result.surface.simplices.size(), 100U);
    EXPECT_EQ(result.counts.limited, 0U);
}

TEST(HighOrderValues, OtherValuesHaveAnErrorOfTheWholeRange) {
    const OfBoxes<3> drawn(many_leaves, square<3>);
    const VirtualRefinement fine(drawn.data, {.tolerance = 0.1, .values = {{{0.4, 0.5}}}});
    const auto draw = [&](double isovalue) {
        return isosurface<3>(fine, isovalue, under(fine.criterion(), fine.bounds()));
    };
    for (const double isovalue : {0.4, 0.45, 0.5}) {
        const auto result = draw(isovalue);
        EXPECT_LE(result.error_bound, 0.1);
        EXPECT_EQ(result.counts.limited, 0U);
    }
    const auto other = draw(1.5);
    EXPECT_GE(other.error_bound, 1.5);
    EXPECT_GT(other.counts.limited, 0U);
}

}  // namespace
