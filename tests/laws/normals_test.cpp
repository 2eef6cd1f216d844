// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Normals agree with the triangles around their vertices: no part of a surface lies behind them.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/normals.hpp>
#include <nestgrid/algorithms/slices.hpp>
#include <surfaces/widest_direction.hpp>

#include "families.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace normals_test {

constexpr std::array<double, 7> all_thresholds{0, 0.02, 0.1, 0.3, 0.7, 2, 10};

constexpr double least_height = 2e-10;  // of triangles that have a direction
constexpr double rounding = 1e-5;       // of directions

/// The directions of the triangles around each vertex, but of those that rounding turns.
std::vector<std::vector<Point>> fans(const Surface<3>& s) {
    std::vector<std::vector<Point>> result(s.vertices.size());
    for (const auto& t : s.simplices) {
        const Point& x = s.vertices[t[0]];
        const Point n = cross(s.vertices[t[1]] - x, s.vertices[t[2]] - x);
        const double longest = std::max(norm(s.vertices[t[1]] - x), norm(s.vertices[t[2]] - x));
        if (norm(n) <= least_height * longest) continue;
        for (const std::uint32_t v : t) result[v].push_back((1 / norm(n)) * n);
    }
    return result;
}

/// No triangle lies behind a normal but where no direction has all of a fan in front of it.
/// \return the number of such folded fans
std::size_t expect_in_front(const Surface<3>& s) {
    EXPECT_EQ(s.normals.size(), s.vertices.size());
    std::size_t folded = 0;
    std::size_t behind = 0;
    const auto fan = fans(s);
    for (std::size_t v = 0; v < fan.size(); ++v) {
        if (fan[v].empty()) continue;
        if (engine::least_cosine(s.normals[v], fan[v]) > rounding) {
            EXPECT_NEAR(norm(s.normals[v]), 1, 1e-12);
            continue;
        }
        ++(engine::widest_direction(fan[v]).cosine > 4 * rounding ? behind : folded);
    }
    EXPECT_EQ(behind, 0U) << "of " << fan.size();
    if (folded == 0) {
        const SurfaceReport report = surface_report(s);
        EXPECT_LE(report.area_behind, 1e-9 * report.area);
    }
    return folded;
}

/// Where vertices may lie.
enum class CutPlaces {
    on_edges,
    near_nodes,  // where values are those of the level, nearly or exactly
};

/// In tetrahedra each cut edge points to the front of all triangles around its vertex, but where
/// the cut keeps its distance from a node at which the level passes.
void expect_nothing_behind(const Surface<3>& s, CutPlaces cuts) {
    const std::size_t folded = expect_in_front(s);
    const bool simplices =
        std::ranges::all_of(s.shape_of, [](Shape shape) { return shape == Shape::tetrahedron; });
    EXPECT_LE(2 * folded, simplices && cuts == CutPlaces::on_edges ? 0 : s.vertices.size());
}

/// Of surfaces at 0 of a field.
CutPlaces cuts_of(const NodalSamples& samples) {
    return samples.generic ? CutPlaces::on_edges : CutPlaces::near_nodes;
}

template <class Family>
class Normals : public testing::Test {};
TYPED_TEST_SUITE(Normals, Families);

TYPED_TEST(Normals, OfIsosurfacesAgreeWithTheirTriangles) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(3, 4, [](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const HierarchicalIndicator offsets(grid, field);
            for (const double threshold : all_thresholds) {
                SCOPED_TRACE(threshold);
                for (const bool cap : {false, true}) {
                    SCOPED_TRACE(cap ? "cap" : "");
                    IsosurfaceOptions options{.normals = true, .cap = cap};
                    expect_nothing_behind(
                        isosurface(grid, field, 0.0, under(offsets, threshold), options).surface,
                        cuts_of(samples));
                    SCOPED_TRACE("at nodes");
                    options.at_nodes = true;
                    expect_nothing_behind(
                        isosurface(grid, field, 0.0, under(offsets, threshold), options).surface,
                        CutPlaces::near_nodes);
                }
            }
        });
    }
}

TYPED_TEST(Normals, OfBandsAndSlicesAgreeWithTheirTriangles) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(3, 5, [](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const HierarchicalIndicator offsets(grid, field);
            const Plane plane({0.5, 0.45, 0.52}, {1, 2, -1});
            const Sphere sphere({0.5, 0.5, 0.5}, 0.35);
            for (const double threshold : all_thresholds) {
                SCOPED_TRACE(threshold);
                const Threshold s(&offsets, threshold);
                const IsosurfaceOptions options{.normals = true};
                expect_nothing_behind(
                    isoband(grid, field, -0.1, 0.2, under(s, offsets), options).surface,
                    CutPlaces::near_nodes);
                const auto drawn =
                    slices({grid, field}, {{&plane, &sphere}, {0.0}}, under(s, offsets), options);
                for (const Slice& slice : drawn) {
                    expect_nothing_behind(slice.surface, CutPlaces::near_nodes);
                }
            }
        });
    }
}

/// Noise, few integers, plateaus at the isovalue.
template <class Grid>
void expect_nothing_behind_on_lattice() {
    const Samples n{17, 17, 17};
    const Grid grid({.samples = n});
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const HierarchicalIndicator offsets(grid, field);
        for (const double threshold : all_thresholds) {
            SCOPED_TRACE(threshold);
            for (const bool at_nodes : {false, true}) {
                SCOPED_TRACE(at_nodes ? "at nodes" : "");
                const IsosurfaceOptions options{.normals = true, .at_nodes = at_nodes};
                expect_nothing_behind(isosurface(grid, field, data.isovalue,
                                                 under(offsets, threshold * data.range), options)
                                          .surface,
                                      CutPlaces::near_nodes);
            }
        }
    }
}

TEST(Normals, OfLatticesOfTetrahedraAgreeWithTheirTriangles) {
    expect_nothing_behind_on_lattice<LatticeBisection<3>>();
}
TEST(Normals, OfLatticesOfHexahedraAgreeWithTheirTriangles) {
    expect_nothing_behind_on_lattice<LatticeOctree<3>>();
}

TEST(WidestDirection, IsNoWorseThanAnyOther) {
    std::mt19937 random(5);
    const auto any = [&] {
        return Point{uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5};
    };
    for (int i = 0; i < 2000; ++i) {
        const Point middle = any();
        std::vector<Point> fan;
        for (std::size_t k = 0; k < 1 + random() % 9; ++k) {
            const Point d = middle + 1.2 * uniform(random) * any();
            fan.push_back((1 / norm(d)) * d);
        }
        const auto [direction, cosine] = engine::widest_direction(fan);
        for (int other = 0; other < 100; ++other) {
            const Point d = any();
            const double least = engine::least_cosine((1 / norm(d)) * d, fan);
            EXPECT_LE(least, std::max(cosine, 0.0) + 1e-12);
        }
        EXPECT_LE(norm(direction), 1 + 1e-12);
    }
}

/// Takes a surface in parts.
class Collected final : public MeshSink<3> {
public:
    explicit Collected(Surface<3>& all) : all_{&all} {}
    void take(const Surface<3>& part) override {
        all_->vertices.insert(all_->vertices.end(), part.vertices.begin(), part.vertices.end());
        all_->simplices.insert(all_->simplices.end(), part.simplices.begin(), part.simplices.end());
    }
    Point position(std::uint32_t vertex) const override { return all_->vertices[vertex]; }
    void set_normals(std::span<const Point> normals) override {
        all_->normals.assign(normals.begin(), normals.end());
    }

private:
    Surface<3>* all_;
};

TEST(Normals, AreTheSameInSinksAndFromAnyNumberOfThreads) {
    const Samples n{33, 33, 33};
    const LatticeOctree<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[2];
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator offsets(grid, field);
    const Threshold s(&offsets, 0.2 * data.range);
    for (const bool at_nodes : {false, true}) {
        const IsosurfaceOptions options{.normals = true, .elements = false, .at_nodes = at_nodes};
        const auto plain =
            isosurface(grid, field, data.isovalue, under(s, offsets), options).surface;
        expect_in_front(plain);
        for (const std::size_t threads : {1U, 4U}) {
            const double isovalues[] = {data.isovalue};
            Surface<3> all;
            extract_isosurfaces(grid, field, isovalues, std::vector{Collected(all)},
                                under(s, offsets), options, {ThreadExecutor(threads)});
            nestgrid_test::expect_same_bits(all.normals, plain.normals, "normals");
            nestgrid_test::expect_same_bits(all.simplices, plain.simplices, "simplices");
        }
    }
}

/// Samples whose gradients are known at the corners of elements, but not by the keys of nodes.
template <class Grid>
struct ByElement : LatticeField<Grid, float> {
    using LatticeField<Grid, float>::LatticeField;
    Point gradient_at(typename Grid::Place) const = delete;
};

/// On coarser octrees edges are cut whose far ends no drawn element has, and what is known of these
/// differs; so it does where offsets are 0 by chance.
/// \param options of which the general walk is one
template <class Grid>
void expect_same_by_element(std::span<const double> thresholds, const IsosurfaceOptions& options) {
    for (const Samples& n : {Samples{17, 17, 17}, Samples{19, 12, 16}}) {
        const Grid grid({.samples = n});
        for (const SampledField& data : sampled_fields(n)) {
            if (data.name == "integer noise" || data.name == "plateaus") continue;
            const LatticeField field(grid, std::span<const float>(data.values));
            const ByElement<Grid> by_element(grid, std::span<const float>(data.values));
            const HierarchicalIndicator offsets(grid, field);
            for (const double threshold : thresholds) {
                const Threshold s(&offsets, threshold * data.range);
                const auto draw = [&](const auto& drawn) {
                    return isosurface(grid, drawn, data.isovalue, under(s, offsets), options)
                        .surface;
                };
                nestgrid_test::expect_same_bits(draw(field).normals, draw(by_element).normals,
                                                data.name.c_str());
            }
        }
    }
}

TEST(Normals, AreTheSameWhereGradientsAreAskedForByElement) {
    const std::span thresholds(all_thresholds);
    expect_same_by_element<LatticeOctree<3>>(thresholds.first(1), {.normals = true});
    expect_same_by_element<LatticeBisection<3>>(thresholds, {.normals = true, .cap = true});
}

/// Gradients are projected where S interpolates: but for a few far ends, normals are those of
/// fields that are asked by element at any threshold.
TEST(Normals, OfCoarseOctreesAreProjected) {
    const Samples n{33, 33, 33};
    const LatticeOctree<3> grid({.samples = n});
    for (const SampledField& data : sampled_fields(n)) {
        const LatticeField field(grid, std::span<const float>(data.values));
        const ByElement<LatticeOctree<3>> by_element(grid, std::span<const float>(data.values));
        const HierarchicalIndicator offsets(grid, field);
        std::size_t other = 0;
        std::size_t all = 0;
        for (const double threshold : all_thresholds) {
            const Threshold s(&offsets, threshold * data.range);
            const auto draw = [&](const auto& drawn) {
                return isosurface(grid, drawn, data.isovalue, under(s, offsets), {.normals = true})
                    .surface.normals;
            };
            const std::vector<Point> a = draw(field);
            const std::vector<Point> b = draw(by_element);
            ASSERT_EQ(a.size(), b.size());
            all += a.size();
            for (std::size_t v = 0; v < a.size(); ++v) other += a[v] == b[v] ? 0U : 1U;
        }
        EXPECT_LT(50 * other, all) << data.name;
    }
}

}  // namespace normals_test
