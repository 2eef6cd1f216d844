// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Caps close a surface towards hidden elements, too, whatever is hidden and however fine it is:
// along every edge as many triangles run one way as the other, and what a surface encloses and what
// the surface of the rest encloses is the part of the domain that is shown.
#include <map>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/holes.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <walk/for_each_element.hpp>
#include <walk/hanging_nodes.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "hiding_forest.hpp"
#include "sample_fields.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace hole_caps_test {

/// How many more simplices run along an edge, or end at a vertex, one way than the other.
std::size_t unbalanced(const Surface<3>& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& t : surface.simplices) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [a, b] = std::pair(t[i], t[(i + 1) % 3]);
            uses[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    }
    return static_cast<std::size_t>(
        std::ranges::count_if(uses, [](const auto& use) { return use.second != 0; }));
}
std::size_t unbalanced(const Surface<2>& lines) {
    std::vector<int> uses(lines.vertices.size());
    for (const auto& [a, b] : lines.simplices) {
        ++uses[a];
        --uses[b];
    }
    return static_cast<std::size_t>(std::ranges::count_if(uses, [](int use) { return use != 0; }));
}

/// The volume or area around which a surface runs.
double enclosed(const Surface<3>& surface) {
    double sum = 0;
    for (const auto& [a, b, c] : surface.simplices) {
        const auto& x = surface.vertices;
        sum += dot(x[a], cross(x[b], x[c])) / 6;
    }
    return sum;
}
double enclosed(const Surface<2>& lines) {
    double sum = 0;
    for (const auto& [a, b] : lines.simplices) {
        sum += cross(lines.vertices[a], lines.vertices[b])[2] / 2;
    }
    return sum;
}

/// The volume or area of the leaves that are shown.
template <int dim>
double shown(const Hierarchy<double>& hierarchy) {
    const engine::Walk<double> walk(hierarchy, {.values = false, .keys = true, .positions = true});
    double sum = 0;
    engine::for_each_element(walk, false, [&](const auto& view, const engine::Split& split) {
        if (split.rule != nullptr || view.member->hidden == Hidden::wholly) return;
        std::array<Point, max_corners> x;
        walk.corners(view, nullptr, x.data());
        double inside = 0;
        for (std::size_t f = 0; f < view.topology().faces; ++f) {
            const FaceTopology& face = view.topology().face[f];
            const auto corner = [&](std::size_t i) { return x[face.corner[i]]; };
            if (dim == 2) inside += cross(corner(0), corner(1))[2] / 2;
            for (std::size_t i = 2; i < face.corners; ++i) {
                inside += dot(corner(0), cross(corner(i - 1), corner(i))) / 6;
            }
        }
        sum += view.orientation * inside;
    });
    return sum;
}

template <int dim>
struct Judged {
    std::size_t simplices = 0;
    std::size_t capped = 0;  // by caps alone
};

template <int dim>
void expect_closed_report(const Surface<dim>& surface) {
    EXPECT_EQ(unbalanced(surface), 0U);
    if constexpr (dim == 3) {
        EXPECT_TRUE(surface_report(surface).closed());
    }
}

template <int dim>
void expect_capped(const Hierarchy<double>& hierarchy, double isovalue, const Criterion& criterion,
                   const Bounds& bounds, Judged<dim>& judged) {
    const IsosurfaceOptions options{.normals = dim == 3, .cap = true, .verify = true};
    const auto capped = isosurface<dim>(hierarchy, isovalue, under(criterion, bounds), options);
    expect_closed_report(capped.surface);
    for (const Point& n : capped.surface.normals) EXPECT_FALSE(std::isnan(norm(n)));
    const auto open = isosurface<dim>(hierarchy, isovalue, under(criterion, bounds));
    judged.simplices += open.surface.simplices.size();
    judged.capped += capped.surface.simplices.size() - open.surface.simplices.size();
    EXPECT_LE(capped.error_bound, capped.range_bound);
    const auto in_threads = isosurface<dim>(hierarchy, isovalue, under(criterion, bounds), options,
                                            {ThreadExecutor(3)});
    EXPECT_EQ(in_threads.surface.simplices, capped.surface.simplices);
    EXPECT_EQ(in_threads.surface.vertices, capped.surface.vertices);
    const std::array<double, 2> isovalues{isovalue, isovalue + 0.1};
    const auto several = isosurfaces<dim>(hierarchy, isovalues, under(criterion, bounds), options);
    EXPECT_EQ(several[0].surface.simplices, capped.surface.simplices);
    EXPECT_EQ(several[0].surface.vertices, capped.surface.vertices);
    expect_closed_report(several[1].surface);
}

/// At all thresholds; and everything that is shown is enclosed.
template <int dim>
void expect_capped(const Hierarchy<double>& hierarchy, Judged<dim>& judged) {
    const HierarchicalIndicator indicator(hierarchy);
    const double volume = shown<dim>(hierarchy);
    const Shape only = hierarchy.facts().only_shape;
    const bool planar = dim == 2 || only == Shape::tetrahedron;  // other faces may be warped
    const double tolerance = (planar ? 1e-9 : 1e-2) * std::abs(volume);
    for (const double threshold : six_thresholds) {
        SCOPED_TRACE("threshold " + std::to_string(threshold));
        const Threshold criterion(&indicator, threshold);
        expect_capped<dim>(hierarchy, 0, criterion, indicator, judged);
        const auto all = isosurface<dim>(hierarchy, indicator.least() - 1,
                                         under(criterion, indicator), {.cap = true});
        expect_closed_report(all.surface);
        EXPECT_NEAR(enclosed(all.surface), volume, tolerance);
    }
}

template <int dim>
void expect_capped_forests(Forest<dim> forest, int steps) {
    std::mt19937 random(7);
    refine_randomly(forest, random, steps);
    Judged<dim> judged;
    for (const unsigned hidden_of_20 : {1U, 6U, 16U}) {
        const HidingForest<dim> grid(forest,
                                     [&](std::size_t) { return random() % 20 < hidden_of_20; });
        for (const NodalSamples& samples : catching_fields(grid.positions, 11)) {
            SCOPED_TRACE(samples.name + ", hidden of 20: " + std::to_string(hidden_of_20));
            ForestField<dim> field(grid, [](const Point&) { return 0.0; });
            field.values = samples.values;
            expect_capped<dim>(erase(grid, field), judged);
            if (testing::Test::HasFailure()) return;
        }
    }
    EXPECT_GT(judged.simplices, 1000U);
    EXPECT_GT(judged.capped, 1000U);
}

TEST(HoleCaps, CloseBoxesAtRandom) {
    std::mt19937 random(3);
    expect_capped_forests(boxes<3>(random, 2), 60);
}
TEST(HoleCaps, CloseTetrahedraAtRandom) {
    expect_capped_forests(kuhn<3>(3), 1000);
    expect_capped_forests(kuhn<3>(0), 100);
}
TEST(HoleCaps, CloseLines) {
    std::mt19937 random(3);
    expect_capped_forests(boxes<2>(random, 3), 200);
    expect_capped_forests(kuhn<2>(2), 500);
}

/// What the sides U >= C and U <= C of a surface in simplices enclose is all that is shown.
TEST(HoleCaps, EncloseBothSides) {
    Forest<3> forest = kuhn<3>(3);
    std::mt19937 random(7);
    refine_randomly(forest, random, 1000);
    const HidingForest<3> grid(std::move(forest), random);
    {
        const ForestField<3> f(grid,
                               [](const Point& x) { return std::sin(5 * x[0]) - x[1] * x[2]; });
        ForestField<3> g = f;
        for (double& value : g.values) value = -value;
        const auto above = erase(grid, f);
        const auto below = erase(grid, g);
        const HierarchicalIndicator of_above(above);
        const HierarchicalIndicator of_below(below);
        for (const double threshold : {0.0, 0.05, 0.5}) {
            const double both =
                enclosed(
                    isosurface<3>(above, 0.3, under(of_above, threshold), {.cap = true}).surface) +
                enclosed(
                    isosurface<3>(below, -0.3, under(of_below, threshold), {.cap = true}).surface);
            EXPECT_NEAR(both, shown<3>(above), 1e-9);
        }
    }
}

template <class Family>
class HoleCapsOfFamilies : public testing::Test {};
TYPED_TEST_SUITE(HoleCapsOfFamilies, Families);

/// Holes around nodes at which data have no value: some at random, and a ball.
TYPED_TEST(HoleCapsOfFamilies, CloseWhatIsDrawn) {
    constexpr int dim = TypeParam::Grid::dimension;
    std::mt19937 random(5);
    Judged<dim> judged;
    for_each_field_at_sphere<TypeParam>(2, 7, [&](const auto& grid, NodalSamples samples) {
        for (const double share : {0.0, 0.05, 0.3}) {
            SCOPED_TRACE(samples.name + ", missing: " + std::to_string(share));
            std::vector<double> values = samples.values;
            const std::vector<Point> x = grid.node_positions();
            for (std::size_t n = 0; n < values.size(); ++n) {
                const bool in_ball = share == 0 && norm(x[n] - Point{0.4, 0.3, 0}) < 0.3;
                if (in_ball || uniform(random) < share) {
                    values[n] = std::numeric_limits<double>::quiet_NaN();
                }
            }
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
            const auto inner = erase(grid, field);
            const Holes<double> holes(inner);
            if (holes.hidden()->any()) expect_capped<dim>(holes, judged);
            if (testing::Test::HasFailure()) return;
        }
    });
    EXPECT_GT(judged.capped, 100U);
}

template <class Grid>
void expect_capped_samples(const Samples& n) {
    const Grid grid({.samples = n});
    std::mt19937 random(5);
    Judged<3> judged;
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        std::vector<double> values(data.values.begin(), data.values.end());
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] -= data.isovalue;
            if (uniform(random) < 0.004 || i % n[0] < 3) {
                values[i] = std::numeric_limits<double>::quiet_NaN();
            }
        }
        const LatticeField<Grid, double> field(grid, values);
        const auto inner = erase(grid, field);
        const Holes<double> holes(inner);
        expect_capped<3>(holes, judged);
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(judged.capped, 1000U);
}

TEST(HoleCaps, CloseSamples) {
    for (const Samples& n : {Samples{17, 17, 17}, Samples{14, 9, 20}}) {
        expect_capped_samples<LatticeOctree<3>>(n);
        expect_capped_samples<LatticeBisection<3>>(n);
    }
}

}  // namespace hole_caps_test
