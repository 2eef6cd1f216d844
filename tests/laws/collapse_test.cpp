// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A collapsed surface keeps the error on all of its triangles, sides, borders and the manifold, and
// has fewer triangles. Judged by dense samples and by crossings along lines.
#include <gtest/gtest.h>

#include <collapses/field_check.hpp>
#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/probe.hpp>

#include "families.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "thread_executor.hpp"
#include "triangle_samples.hpp"

using namespace nestgrid_test;

namespace collapse_test {

constexpr double rounding = 1e-9;

template <class Real>
void expect_error_kept(const Surface<3>& s, const Hierarchy<Real>& h, double isovalue, double error,
                       const Collapsed& result) {
    std::vector<Point> points;
    constexpr int steps = 5;
    constexpr std::size_t each = (steps + 1) * (steps + 2) / 2;
    for (std::size_t t = 0; t < s.simplices.size(); ++t) {
        const auto of = samples_of(corners_of(s, t), steps);
        points.insert(points.end(), of.begin(), of.end());
    }
    const ProbeResult probed = probe(h, points);
    std::size_t exceeding = 0;
    for (std::size_t t = 0; t < s.simplices.size(); ++t) {
        double greatest = 0;
        for (std::size_t i = t * each; i < (t + 1) * each; ++i) {
            if (!probed.found(i)) continue;  // on the boundary, by rounding
            greatest =
                std::max(greatest, std::abs(probed.values[i * probed.components] - isovalue));
        }
        exceeding += greatest > error * (1 + rounding) ? 1U : 0U;
    }
    EXPECT_LE(exceeding, result.exceeding);
    EXPECT_LE(result.error, error);
}

template <class Family>
class Collapse : public testing::Test {};
TYPED_TEST_SUITE(Collapse, Families);

TYPED_TEST(Collapse, KeepsTheErrorTheManifoldAndTheBorder) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(2, 8, [](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h, NodeError::deviation);
            constexpr double error = 0.1;
            auto surface = isosurface<3>(h, 0.0, under(indicator, error / 2)).surface;
            const SurfaceReport before = surface_report(surface);
            const Collapsed result =
                collapse(surface, erase(grid, field), 0.0, indicator, {.error = error});
            expect_closed(surface);
            const SurfaceReport after = surface_report(surface);
            EXPECT_EQ(after.triangles == before.triangles, result.collapses == 0);
            EXPECT_EQ(after.euler, before.euler);
            EXPECT_EQ(after.components, before.components);
            EXPECT_EQ(after.boundary_edges == 0, before.boundary_edges == 0);
            expect_borders_on_cube(surface);
            expect_error_kept(surface, h, 0.0, error, result);
        });
    }
}

/// Nodes with |U - C| > e between which a line along z does not cross the surface as often as they
/// change sides, odd or even.
std::size_t wrong_sides(const Surface<3>& s, const SampledField& data, const Samples& n,
                        double error) {
    const auto size = [&](std::size_t d) { return static_cast<std::size_t>(n[d]); };
    std::vector<std::vector<double>> column(size(0) * size(1));
    const double dx = 1.234e-5;  // off the nodes, so that no line meets a vertex
    const double dy = 2.71e-5;
    for (std::size_t t = 0; t < s.simplices.size(); ++t) {
        const auto [a, b, c] = corners_of(s, t);
        const auto first = [](double x, double y, double z) {
            return static_cast<std::size_t>(std::max(0.0, std::floor(std::min({x, y, z}))));
        };
        for (std::size_t i = first(a[0], b[0], c[0]); i < size(0); ++i) {
            const double x = static_cast<double>(i) + dx;
            if (x > std::max({a[0], b[0], c[0]})) break;
            for (std::size_t j = first(a[1], b[1], c[1]); j < size(1); ++j) {
                const double y = static_cast<double>(j) + dy;
                const auto side = [&](const Point& p, const Point& q) {
                    return (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
                };
                const double u = side(a, b), v = side(b, c), w = side(c, a);
                if ((u > 0) != (v > 0) || (u > 0) != (w > 0)) continue;
                column[i + size(0) * j].push_back((v * a[2] + w * b[2] + u * c[2]) / (u + v + w));
            }
        }
    }
    std::size_t wrong = 0;
    for (std::size_t j = 0; j + 1 < size(1); ++j) {
        for (std::size_t i = 0; i + 1 < size(0); ++i) {
            const auto& crossings = column[i + size(0) * j];
            int last = 0;
            std::ptrdiff_t passed = 0;
            for (std::size_t k = 0; k < size(2); ++k) {
                const double off = data.values[i + size(0) * (j + size(1) * k)] - data.isovalue;
                if (std::abs(off) <= error * 1.001) continue;
                const int now = off > 0 ? 1 : -1;
                const auto below = std::ranges::count_if(
                    crossings, [&](double z) { return z < static_cast<double>(k); });
                if (last != 0 && ((below - passed) % 2 != 0) != (now != last)) ++wrong;
                last = now;
                passed = below;
            }
        }
    }
    return wrong;
}

/// White noise with lone peaks.
SampledField peaks(const Samples& n) {
    std::mt19937 random(31);
    return {"peaks",
            sample(n,
                   [&](double, double, double) {
                       const double at = uniform(random);
                       return at < 0.04 ? 3 : at < 0.1 ? -2 : uniform(random) - 0.5;
                   }),
            0.0, 5};
}

std::vector<SampledField> judged_fields(const Samples& n) {
    auto fields = sampled_fields(n);
    fields.push_back(peaks(n));
    return fields;
}

template <class Grid>
void expect_laws_on_lattice() {
    const Samples n{13, 13, 13};
    const Grid grid({.samples = n});
    for (const SampledField& data : judged_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const auto h = erase(grid, field);
        const HierarchicalIndicator indicator(h, NodeError::deviation);
        for (const double part : {0.05, 0.3}) {
            SCOPED_TRACE(part);
            const double error = part * data.range;
            auto surface = isosurface<3>(h, data.isovalue, under(indicator, error / 2)).surface;
            const SurfaceReport before = surface_report(surface);
            const std::size_t wrong_before = wrong_sides(surface, data, n, error);
            const Collapsed result =
                collapse(surface, h, data.isovalue, indicator, {.error = error});
            expect_closed(surface);
            EXPECT_EQ(surface_report(surface).euler, before.euler);
            expect_error_kept(surface, h, data.isovalue, error, result);
            EXPECT_EQ(wrong_before, 0U);
            EXPECT_EQ(wrong_sides(surface, data, n, error), 0U);
        }
    }
}

TEST(Collapse, KeepsSidesInLatticesOfTetrahedra) { expect_laws_on_lattice<LatticeBisection<3>>(); }
TEST(Collapse, KeepsSidesInLatticesOfHexahedra) { expect_laws_on_lattice<LatticeOctree<3>>(); }

TEST(Collapse, LeavesFewTriangles) {
    const Samples n{33, 33, 33};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[0];
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field);
    auto surface =
        isosurface(grid, field, data.isovalue, under(indicator, 0), {.normals = true}).surface;
    const std::size_t before = surface.simplices.size();
    collapse(surface, erase(grid, field), data.isovalue, indicator, {.error = 0.01});
    EXPECT_LE(surface.simplices.size(), before / 40);
    EXPECT_EQ(surface.normals.size(), surface.vertices.size());
    EXPECT_EQ(surface_report(surface).area_behind, 0);
}

TEST(Collapse, IsTheSameWithAnyNumberOfThreads) {
    const Samples n{25, 25, 25};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[3];  // noise: more than one block
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field, NodeError::deviation);
    const auto drawn = isosurface(grid, field, data.isovalue, under(indicator, 0)).surface;
    Surface<3> one = drawn;
    collapse(one, erase(grid, field), data.isovalue, indicator, {.error = 0.3});
    EXPECT_LT(one.simplices.size(), drawn.simplices.size());
    for (const std::size_t threads : {2U, 5U}) {
        Surface<3> many = drawn;
        collapse(many, erase(grid, field), data.isovalue, indicator, {.error = 0.3},
                 ThreadExecutor(threads));
        expect_same_bits(many.vertices, one.vertices, "vertices");
        expect_same_bits(many.simplices, one.simplices, "simplices");
    }
}

TEST(Collapse, RefusesOptionsOutOfRange) {
    const LatticeBisection<3> grid({.samples = {3, 3, 3}});
    const std::vector<float> values(27, 1.0F);
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    Surface<3> surface;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const CollapseOptions& options :
         {CollapseOptions{}, CollapseOptions{.error = -1}, CollapseOptions{.error = nan},
          CollapseOptions{.error = 1, .turn = 90}, CollapseOptions{.error = 1, .shape = 1}}) {
        EXPECT_THROW(collapse(surface, erase(grid, field), 0.0, indicator, options), InvalidInput);
    }
    EXPECT_THROW(collapse(surface, erase(grid, field), nan, indicator, {.error = 1}), InvalidInput);
    EXPECT_EQ(collapse(surface, erase(grid, field), 0.0, indicator, {.error = 1}).collapses, 0U);
}

/// The check is an upper bound of what samples find, and in simplices no more than what they find.
template <class Family>
class FieldChecks : public testing::Test {};
TYPED_TEST_SUITE(FieldChecks, Families);

TYPED_TEST(FieldChecks, AreNoLessThanSamples) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for (auto& grid : TypeParam::grids()) {
            refine_at_sphere(grid, 2 * TypeParam::steps);
            std::mt19937 random(11);
            std::vector<double> values(grid.node_positions().size());
            for (double& value : values) value = uniform(random) - 0.5;
            const NodeField<typename TypeParam::Grid, double> field(grid, values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h);
            const auto leaves = engine::NearLeaves::find(h, 0.0, 10.0, indicator);
            const engine::FieldCheck check(leaves);
            const bool simplices = h.facts().only_shape == Shape::tetrahedron;
            const auto any = [&] { return 0.2 + 0.6 * uniform(random); };
            std::size_t kept = 0;
            for (int i = 0; i < 30; ++i) {
                engine::Triangle x;
                for (Point& corner : x) corner = {any(), any(), any()};
                double greatest = 0;
                if (!check.keeps(engine::FlatTriangle(x), greatest)) continue;
                ++kept;
                const auto points = samples_of(x, 60);
                const ProbeResult probed = probe(h, points);
                double seen = 0;
                for (std::size_t p = 0; p < points.size(); ++p) {
                    ASSERT_TRUE(probed.found(p));
                    seen = std::max(seen, std::abs(probed.values[p]));
                }
                EXPECT_LE(seen, greatest * (1 + rounding));
                if (simplices) {
                    EXPECT_LE(greatest, seen + 0.05);
                }
            }
            EXPECT_EQ(kept, 30U);
        }
    }
}

TEST(FieldChecks, OfLatticesAreThoseOfTheirLeaves) {
    for (const Samples& n : {Samples{9, 9, 9}, Samples{9, 17, 5}}) {
        const LatticeBisection<3> grid({.samples = n, .spacing = {0.3, 1.1, 0.7}});
        std::mt19937 random(7);
        for (const double error : {0.4, 10.0}) {
            const auto values = sample(n, [&](double, double, double) { return uniform(random); });
            const LatticeField field(grid, std::span<const float>(values));
            const HierarchicalIndicator indicator(grid, field);
            const auto leaves = engine::NearLeaves::find(erase(grid, field), 0.5, error, indicator);
            ASSERT_TRUE(engine::KuhnLattice::find(leaves).has_value());
            const engine::FieldCheck check(leaves);
            std::size_t kept = 0;
            for (int i = 0; i < 400; ++i) {
                const auto any = [&](std::size_t d) { return uniform(random) * (n[d] - 1); };
                const Point a{0.3 * any(0), 1.1 * any(1), 0.7 * any(2)};
                const double size = i % 2 == 0 ? 0.2 : 1;
                engine::Triangle x{a, a, a};
                for (std::size_t j = 1; j < 3; ++j) {
                    const Point b{0.3 * any(0), 1.1 * any(1), 0.7 * any(2)};
                    x[j] = a + size * (b - a);
                }
                double fast = 0;
                double slow = 0;
                const engine::FlatTriangle triangle(x);
                const bool keeps = check.keeps(triangle, fast);
                EXPECT_EQ(keeps, check.keeps_in_leaves(triangle, slow));
                if (!keeps) continue;
                EXPECT_NEAR(fast, slow, 1e-9);
                ++kept;
            }
            EXPECT_GT(kept, error < 1 ? 0U : 399U);
        }
    }
}

}  // namespace collapse_test
