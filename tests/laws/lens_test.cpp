// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lenses on every family: of random domains, small and large, by the size of elements and by the
// offsets of the data (paper, section 4.3).
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "closedness.hpp"
#include "curved.hpp"
#include "families.hpp"
#include "projection.hpp"
#include "refusal.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace lens_test {

template <class Family>
class Lenses : public testing::Test {};
TYPED_TEST_SUITE(Lenses, Families);

/// Makes domains of all kinds around nodes of a grid.
class RandomDomains {
public:
    RandomDomains(unsigned seed, std::vector<Point> nodes)
        : random_{seed}, nodes_{std::move(nodes)} {}

    /// Every second one is a ball, most of them smaller than an element.
    Distance operator()() {
        const Point x = near_node();
        switch (random_() % 6) {
            case 0:
                return Box{x, x + uniform(random_) * Point{0.2, 0.1, 0.3}};
            case 1:
                return HalfSpace(x, direction());
            case 2:
                return Cone(x, direction(), 0.3);
            default:
                return Ball{x, 0.3 * std::pow(uniform(random_), 4)};
        }
    }
    Point near_node() {
        const Point off = 0.1 * (Point{uniform(random_), uniform(random_), uniform(random_)} -
                                 Point{0.5, 0.5, 0.5});
        return nodes_[random_() % nodes_.size()] + off;
    }
    Point direction() {
        return {uniform(random_) - 0.5, uniform(random_) - 0.5, uniform(random_) - 0.501};
    }
    std::mt19937& random() { return random_; }

private:
    std::mt19937 random_;
    std::vector<Point> nodes_;
};

/// Calls test(grid, domains) on the grids of a family, refined at the sphere.
template <class Family, class Test>
void on_grids(unsigned seed, Test&& test) {
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, 3 * Family::steps);
        RandomDomains domains(seed, grid.node_positions());
        test(grid, domains);
    }
}

/// Calls test(grid, field, domains) likewise, for each of the catching fields.
template <class Family, class Test>
void on_fields(unsigned seed, Test&& test) {
    for_each_field_at_sphere<Family>(3, seed, [&](const auto& grid, const NodalSamples& samples) {
        const NodeField<typename Family::Grid, double> field(grid, samples.values);
        RandomDomains domains(++seed, grid.node_positions());
        test(grid, field, domains);
    });
}

/// The greatest diameter of a split element.
double greatest_size(const SweptIndicator& size, const auto& grid) {
    double greatest = 0;
    const auto hierarchy = erase(grid, ZeroField<std::decay_t<decltype(grid)>>{});
    for_each_asked_split(hierarchy, nullptr, Exact{}, [&](const AskedSplit& split) {
        for (const NodeKey key : split.keys.subspan(split.corner_count())) {
            greatest = std::max(greatest, size.stop(key));
        }
    });
    return greatest;
}

TYPED_TEST(Lenses, AreSaturatedAtEverySplit) {
    on_grids<TypeParam>(21, [](const auto& grid, RandomDomains& domains) {
        const auto hierarchy = erase(grid, ZeroField<std::decay_t<decltype(grid)>>{});
        const HangingNodes hanging = derive_hanging_nodes(grid);
        for (const double slope : {0.0, 0.5, 2.0}) {
            for (const double factor : {1.0, 1.5}) {
                const SweptIndicator size = mesh_size(grid, {.factor = factor, .slope = slope});
                const double greatest = greatest_size(size, grid);
                for (int i = 0; i < 8; ++i) {
                    const double finest = uniform(domains.random()) * greatest / 4;
                    const Lens lens(&size, domains(),
                                    {.finest = finest,
                                     .coarsest = i % 2 == 0 ? greatest / 3 + finest : 1e9,
                                     .blend = factor});
                    EXPECT_EQ(count_violations(hierarchy, &hanging, lens), 0U);
                    const auto both = lens && Lens(&size, domains(), {.finest = finest});
                    EXPECT_EQ(count_violations(hierarchy, &hanging, both), 0U);
                }
            }
        }
    });
}

TYPED_TEST(Lenses, KeepWhatIsLargerThanTheFinestInTheDomain) {
    on_grids<TypeParam>(22, [](const auto& grid, RandomDomains& domains) {
        const auto hierarchy = erase(grid, ZeroField<std::decay_t<decltype(grid)>>{});
        const HangingNodes hanging = derive_hanging_nodes(grid);
        for (const double slope : {0.1, 1.0}) {
            const SweptIndicator size = mesh_size(grid, {.slope = slope});
            const double greatest = greatest_size(size, grid);
            std::size_t dropped = 0;
            for (int i = 0; i < 16; ++i) {
                const Distance domain =
                    i % 2 == 0 ? domains() : HalfSpace(domains.near_node(), domains.direction());
                const double finest = uniform(domains.random()) * greatest;
                const double coarsest = 1.1 * finest;
                const Lens lens(&size, domain, {.finest = finest, .coarsest = coarsest});
                for_each_asked_split(hierarchy, &hanging, lens, [&](const AskedSplit& split) {
                    const std::size_t corners = split.corner_count();
                    for (std::size_t n = corners; n < split.s.size(); ++n) {
                        if (split.s[n] == 0) continue;
                        ++dropped;
                        const bool inside = domain(split.positions[n]) == 0;
                        EXPECT_LE(split.diameter(), inside ? finest : coarsest);
                    }
                });
            }
            EXPECT_GT(dropped, 0U);
        }
    });
}

/// The surface is closed, and the data on it are within its bound of the isovalue.
template <class Grid, class Field>
void expect_sound(const Grid& grid, const Field& field, const Criterion& criterion,
                  const HierarchicalIndicator& indicator) {
    const auto result = isosurface(grid, field, 0.0, under(criterion, indicator), {.verify = true});
    expect_closed(result.surface);
    const auto found = probe(grid, field, result.surface.vertices);
    for (std::size_t i = 0; i < result.surface.vertices.size(); ++i) {
        if (!found.found(i)) continue;
        EXPECT_LE(std::abs(found.values[i]), result.error_bound + 1e-5);
    }
    if constexpr (Grid::dimension == 3) {
        const Plane oblique({0.4, 0.5, 0.45}, {0.2, 0.3, 0.9});
        const Plane through_nodes({0.5, 0.5, 0.5}, {1, 1, 0});
        for (const Plane& plane : {oblique, through_nodes}) {
            const auto slice = nestgrid::slice(grid, field, plane, under(criterion, indicator));
            expect_closed(slice.surface);
            for (const Point& x : slice.surface.vertices) EXPECT_NEAR(plane.value(x), 0, 1e-12);
        }
    }
}

TYPED_TEST(Lenses, BySizeDrawClosedSurfacesWithinTheirBound) {
    on_fields<TypeParam>(23, [](const auto& grid, const auto& field, RandomDomains& domains) {
        const HierarchicalIndicator indicator(grid, field);
        const SweptIndicator size = mesh_size(grid, {.factor = 1.5, .slope = 0.7});
        const Threshold data(&indicator, 0.02);
        for (int i = 0; i < 2; ++i) {
            const double blend = i == 0 ? 1 : 1.5;
            const Lens lens(&size, domains(), {.finest = 0.2, .blend = blend});
            expect_sound(grid, field, lens, indicator);
            expect_sound(grid, field, lens && data, indicator);
            expect_sound(grid, field, lens || data, indicator);
        }
    });
}

TYPED_TEST(Lenses, ByOffsetsDrawClosedSurfacesWithinTheirBound) {
    on_fields<TypeParam>(24, [](const auto& grid, const auto& field, RandomDomains& domains) {
        const HierarchicalIndicator indicator(grid, field, Spread{.factor = 2, .slope = 0.5});
        for (const double blend : {1.0, 2.0}) {
            const Lens lens(&indicator, domains(),
                            {.finest = 0.001, .coarsest = 0.5, .blend = blend});
            expect_sound(grid, field, lens, indicator);
            expect_sound(grid, field, lens && Blended(&indicator, 0.1, blend), indicator);
        }
    });
}

/// The surface is drawn after S as a weight, also where S is 0 or 1.
class InWeights final : public Criterion {
public:
    explicit InWeights(const Criterion& s) : s_{&s} {}
    NodeMask holds(const NewNodes& nodes) const override { return s_->holds(nodes); }
    bool blends() const override { return true; }
    void weights(const NewNodes& nodes, std::span<float> s) const override {
        s_->weights(nodes, s);
    }
    bool wants_positions() const override { return s_->wants_positions(); }
    bool saturated() const override { return s_->saturated(); }

private:
    const Criterion* s_;
};

TYPED_TEST(Lenses, BlendedByOneAreNotBlended) {
    on_fields<TypeParam>(25, [](const auto& grid, const auto& field, RandomDomains& domains) {
        const HierarchicalIndicator indicator(grid, field);
        const SweptIndicator size = mesh_size(grid, {.factor = 1, .slope = 0.5});
        const Lens lens(&size, domains(), {.finest = 0.15, .blend = 1});
        const auto expected = isosurface(grid, field, 0.0, under(lens, indicator));
        const auto blended = isosurface(grid, field, 0.0, under(InWeights(lens), indicator));
        EXPECT_EQ(blended.surface.vertices, expected.surface.vertices);
        EXPECT_EQ(blended.surface.simplices, expected.surface.simplices);
    });
}

/// S moves the value at a node by at most |dS/dT| |offset| |change of T|, and T changes by at most
/// slope times the way of the domain. For an indicator that is not below the offsets, |offset| <= C
/// T where S is between 0 and 1; by the size of elements, the offset is what it is.
TYPED_TEST(Lenses, MoveTheProjectionContinuously) {
    const double c = 1.5;
    const double slope = 0.5;
    const double step = 1e-4;
    on_fields<TypeParam>(26, [&](const auto& grid, const auto& field, RandomDomains& domains) {
        const Spread spread{.factor = c, .slope = slope};
        const HierarchicalIndicator indicator(grid, field, spread);
        const SweptIndicator size = mesh_size(grid, spread);
        const Point x = domains.near_node();
        const Point by = domains.direction();
        const Point moved = x + step / norm(by) * by;
        const auto greatest_move = [&](const Indicator& eta, double finest) {
            const LensOptions options{.finest = finest, .blend = c};
            return greatest_moves(
                       projection(grid, field, Lens(&eta, Ball{x, 0.1}, options), indicator),
                       projection(grid, field, Lens(&eta, Ball{moved, 0.1}, options), indicator))
                .value;
        };
        const double offset = indicator.greatest() - indicator.least();
        const double rounding = 1e-7 * offset;  // of weights to floats
        EXPECT_LE(greatest_move(indicator, 0.01), c * c / (c - 1) * slope * step + rounding);
        EXPECT_LE(greatest_move(size, 0.2), c / (c - 1) * offset * slope * step / 0.2 + rounding);
    });
}

/// The paper's lens: h(x) is the distance of a node from its parents, not spread.
class PapersLens final : public Criterion {
public:
    PapersLens(std::map<NodeKey, double> h, Distance distance, double slope)
        : h_{std::move(h)}, distance_{std::move(distance)}, slope_{slope} {}
    NodeMask holds(const NewNodes& nodes) const override {
        NodeMask mask = 0;
        for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
            const double most = slope_ * distance_(nodes.positions[n]) + 0.05;
            mask |= NodeMask{h_.at(nodes.keys[n]) <= most} << n;
        }
        return mask & ~nodes.outside;
    }
    bool wants_positions() const override { return true; }
    bool saturated() const override { return false; }

private:
    std::map<NodeKey, double> h_;
    Distance distance_;
    double slope_;
};

/// alpha = 1/2 makes the slope 1 admissible in the paper. It is not: from the middle of an edge to
/// the centre of a child is sqrt(3)/2 of the distance from the middle to the ends of the edge.
TEST(PapersLens, IsNotSaturatedOnARegularOctree) {
    OctreeGrid<3> grid(hexahedra(2));
    for (int i = 0; i < 3; ++i) grid.refine_uniformly();
    const auto hierarchy = erase(grid, ZeroField<OctreeGrid<3>>{});
    std::map<NodeKey, double> h;
    for_each_asked_split(hierarchy, nullptr, Exact{}, [&](const AskedSplit& split) {
        for (std::size_t n = 0; n < split.rule.new_nodes.size(); ++n) {
            const std::size_t at = split.corner_count() + n;
            const Point& parent = split.positions[split.rule.new_nodes[n].parent[0]];
            h[split.keys[at]] = norm(split.positions[at] - parent);
        }
    });
    std::size_t violations = 0;
    std::size_t swept = 0;
    const SweptIndicator size = mesh_size(grid, {.slope = 1});
    RandomDomains domains(27, grid.node_positions());
    for (int i = 0; i < 12; ++i) {
        const Ball ball{domains.near_node(), 0.05};
        violations += count_violations(hierarchy, nullptr, Unsaturated(PapersLens(h, ball, 1)));
        swept += count_violations(hierarchy, nullptr, Lens(&size, ball, {.finest = 0.05}));
    }
    EXPECT_GT(violations, 0U);
    EXPECT_EQ(swept, 0U);
}

TEST(Lens, IsSaturatedWhereNodesAreCurvedAndHang) {
    std::mt19937 random(28);
    for (int i = 0; i < 4; ++i) {
        Forest<3> forest = boxes<3>(random, 2);
        refine_randomly(forest, random, 60);
        const CurvedGrid grid(forest);
        const CurvedField field(grid, [](const Point& x) { return norm(x) - 1.1; });
        const HierarchicalIndicator indicator(grid, field, Spread{.factor = 1.5, .slope = 1});
        const SweptIndicator size = mesh_size(grid, {.factor = 1.5, .slope = 1});
        RandomDomains domains(static_cast<unsigned>(random()), forest.positions);
        for (int k = 0; k < 20; ++k) {
            const Distance domain = domains();
            for (const double blend : {1.0, 1.5}) {
                const Lens by_size(&size, domain, {.finest = 0.3, .blend = blend});
                const Lens by_offset(&indicator, domain, {.finest = 0.001, .blend = blend});
                const auto hierarchy = erase(grid, field);
                EXPECT_EQ(count_violations(hierarchy, nullptr, by_size), 0U);
                EXPECT_EQ(count_violations(hierarchy, nullptr, by_offset), 0U);
                for (const Lens* lens : {&by_size, &by_offset}) {
                    const auto drawn =
                        isosurface(grid, field, 0.0, under(*lens, indicator), {.verify = true});
                    expect_closed(drawn.surface);
                }
            }
        }
    }
}

/// Lattices whose sides are no power of two have nodes beyond the domain, at which S may not hold.
TEST(Lens, HoldsNowhereOutsideTheDomain) {
    const LatticeBisection<3> grid({.samples = {14, 20, 11}});
    const SampledField data = sampled_fields({14, 20, 11})[2];
    const LatticeField<LatticeBisection<3>, float> field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field);
    const SweptIndicator size = mesh_size(grid, {.slope = 0.5});
    for (const Point& centre : {Point{3, 4, 5}, Point{13, 19, 10}}) {
        const Lens lens(&size, Ball{centre, 1}, {.finest = 2});
        const auto result = isosurface(grid, field, data.isovalue, under(lens, indicator));
        expect_closed(result.surface);
        EXPECT_GT(result.surface.simplices.size(), 0U);
    }
    /// An indicator that knows nothing of the nodes outside.
    class Zero final : public Indicator {
    public:
        double stop(NodeKey) const override { return 0; }
    };
    const Zero zero;
    const Rule& rule = dyadic_rule(Shape::quadrilateral);
    const std::array<NodeKey, 5> keys{1, 2, 3, 4, 5};
    const std::array<Point, 5> x{};
    const NewNodes nodes{rule, keys, 1, 0b01010, x};
    const Lens lens(&zero, Ball{}, {.blend = 1});
    EXPECT_EQ(lens.holds(nodes), 0b10101U);
    std::array<float, 5> s;
    lens.weights(nodes, s);
    EXPECT_EQ(s, (std::array<float, 5>{1, 0, 1, 0, 1}));
}

TEST(Lens, IsRefusedWhereItMakesNoSense) {
    const OctreeGrid<2> grid(quadrilaterals(2));
    const SweptIndicator size = mesh_size(grid, {.slope = 1});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    const auto lens = [&](const LensOptions& o) { Lens(&size, Ball{}, o); };
    for (const double finest : {-1.0, nan, infinite}) {
        expect_refused([&] { lens({.finest = finest}); }, "0 <= finest <= coarsest");
    }
    expect_refused([&] { lens({.finest = 2, .coarsest = 1}); }, "0 <= finest <= coarsest");
    expect_refused([&] { lens({.coarsest = nan}); }, "0 <= finest <= coarsest");
    for (const double blend : {0.5, nan, infinite}) {
        expect_refused([&] { lens({.blend = blend}); }, "blends by a factor");
    }
    expect_refused([&] { Lens(&size, Distance{}); }, "no distance");
    EXPECT_FALSE(Lens(&size, Ball{}, {.blend = 1.5}).saturated());
    EXPECT_TRUE(Lens(&size, Ball{}).saturated());
    expect_refused([&] { mesh_size(grid, {.slope = -1}); }, "slope");
}

}  // namespace lens_test
