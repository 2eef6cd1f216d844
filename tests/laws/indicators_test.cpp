// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of the indicators that are sources of one sweep (paper, sections 4.1, 4.2, 5.1 and 5.2), on
// every family.
#include <map>

#include <gtest/gtest.h>

#include <indicators/lifting.hpp>
#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "bent_grid.hpp"
#include "families.hpp"
#include "projection_judge.hpp"
#include "refusal.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace indicators_test {

/// An indicator with a name, and a threshold that projects about half of a gyroid away.
struct Named {
    std::string name;
    SweptIndicator indicator;
    double middle;
};

/// All indicators that see the data.
std::vector<Named> indicators(const Hierarchy<double>& h, const Spread& spread = {}) {
    std::vector<Named> all;
    all.push_back({"visual", visual_indicator(h, {.spread = spread}), 0.5});
    all.push_back({"numerical", numerical_indicator(h, {.spread = spread}), 0.5});
    all.push_back({"wavelet", wavelet_indicator(h, {.spread = spread}), 0.1});
    all.push_back({"norm", norm_indicator(h, {.spread = spread}), 0.1});
    return all;
}

/// Data with a surface at 0.
std::vector<NodalSamples> fields(const std::vector<Point>& nodes) {
    std::mt19937 random(21);
    std::vector<NodalSamples> all;
    const auto add = [&](const char* name, auto&& f) {
        NodalSamples samples{name, {}, true};
        for (const Point& x : nodes) samples.values.push_back(f(x));
        all.push_back(std::move(samples));
    };
    add("gyroid", [](const Point& x) {
        const auto [a, b, c] = 7.0 * x;
        return std::sin(a) * std::cos(b) + std::sin(b) * std::cos(c) + std::sin(c) * std::cos(a);
    });
    add("noise", [&](const Point&) { return uniform(random) - 0.5; });
    add("plateau with noise of 1e-15", [&](const Point& x) {
        return std::max(0.0, norm(x - Point{0.5, 0.5, 0.5}) - 0.3) + 1e-15 * uniform(random) - 0.1;
    });
    add("plane with noise of 1e-13",
        [&](const Point& x) { return x[0] + 0.7 * x[1] - 0.6 + 1e-13 * uniform(random); });
    const std::size_t peak = nodes.size() - 1;
    std::size_t node = 0;
    add("peak", [&](const Point&) { return node++ == peak ? 1 - 0.1 : -0.1; });
    return all;
}

/// Calls test(hierarchy, grid) for the grids of a family and the fields on them.
template <class Family, class Test>
void on_hierarchies(Test&& test) {
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, 3 * Family::steps);
        for (const NodalSamples& samples : fields(grid.node_positions())) {
            SCOPED_TRACE(samples.name);
            const NodeField<typename Family::Grid, double> field(grid, samples.values);
            test(erase(grid, field));
        }
    }
}

/// Calls test(hierarchy) for a function on the grids of a family.
template <class Family, class Function, class Test>
void with_function(const Function& f, Test&& test) {
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, 3 * Family::steps);
        const auto values = sample_nodes(grid, f);
        const NodeField<typename Family::Grid, double> field(grid, values);
        test(erase(grid, field));
    }
}

void expect_closed_surface(const Hierarchy<double>& h, const Criterion& s, const Bounds& bounds) {
    if (h.facts().dimension == 2) {
        expect_closed(isosurface<2>(h, 0.0, under(s, bounds)).surface);
        return;
    }
    expect_closed(isosurface<3>(h, 0.0, under(s, bounds)).surface);
    const Plane plane({0.5, 0.45, 0.52}, {1, 2, -1});
    expect_closed(slice(h, plane, under(s, bounds)).surface);
}

ErrorBounds bounds_at_zero(const Hierarchy<double>& h, const Criterion& s, const Bounds& bounds) {
    if (h.facts().dimension == 2) return isosurface<2>(h, 0.0, under(s, bounds));
    return isosurface<3>(h, 0.0, under(s, bounds));
}

template <class Family>
class Indicators : public testing::Test {};
TYPED_TEST_SUITE(Indicators, Families);

TYPED_TEST(Indicators, AreSaturatedAtEverySplit) {
    on_hierarchies<TypeParam>([](const Hierarchy<double>& h) {
        for (const Spread& spread : {Spread{}, Spread{.factor = 1.5}, Spread{.slope = 0.5}}) {
            for (const Named& named : indicators(h, spread)) {
                SCOPED_TRACE(named.name);
                expect_saturated(h, named.indicator);
            }
        }
    });
}

TYPED_TEST(Indicators, DrawClosedSurfacesAloneAndCombined) {
    on_hierarchies<TypeParam>([](const Hierarchy<double>& h) {
        const HierarchicalIndicator offsets(h);
        const Threshold small(&offsets, 0.02);
        for (const Named& named : indicators(h)) {
            SCOPED_TRACE(named.name);
            for (const double times : {0.1, 1.0, 2.0}) {
                const Threshold s(&named.indicator, times * named.middle);
                expect_closed_surface(h, s, offsets);
                expect_closed_surface(h, s && small, offsets);
                expect_closed_surface(h, s || small, offsets);
            }
        }
    });
}

TYPED_TEST(Indicators, ProjectWithinTheErrorBound) {
    on_hierarchies<TypeParam>([](const Hierarchy<double>& h) {
        const HierarchicalIndicator offsets(h);
        const ProjectedNodes data(h, Exact(), 0.0);
        for (const Named& named : indicators(h)) {
            SCOPED_TRACE(named.name);
            std::size_t stopped = data.stopped();
            for (const double times : {0.1, 1.0, 2.0}) {
                const Threshold s(&named.indicator, times * named.middle);
                const ProjectedNodes projected(h, s, 0.0);
                EXPECT_EQ(projected.interpolated_corners(), 0U);
                const ErrorBounds bounds = bounds_at_zero(h, s, offsets);
                // On what is drawn the data are no further from the level than anywhere.
                EXPECT_LE(std::min(projected.difference_where_drawn(data), bounds.range_bound),
                          bounds.error_bound);
                EXPECT_LE(projected.stopped(), stopped);
                stopped = projected.stopped();
            }
        }
    });
}

TYPED_TEST(Indicators, ChangeNothingAtThresholdZero) {
    on_hierarchies<TypeParam>([](const Hierarchy<double>& h) {
        const ProjectedNodes data(h, Exact(), 0.0);
        for (const Named& named : indicators(h)) {
            SCOPED_TRACE(named.name);
            const ProjectedNodes projected(h, Threshold(&named.indicator, 0), 0.0);
            EXPECT_EQ(projected.difference(data), 0);
        }
    });
}

/// The greatest eta of all nodes.
double greatest(const Hierarchy<double>& h, const Indicator& indicator) {
    double result = 0;
    for_each_judged_split(h, [&](const JudgedSplit& split) {
        for (const NodeKey key : split.keys) result = std::max(result, indicator.stop(key));
    });
    return result;
}

/// Whether a grid is a surface in space: the tangential gradients of linear data jump there.
bool is_bent(const Hierarchy<double>& h) {
    bool bent = false;
    for_each_judged_split(h, [&](const JudgedSplit& split) {
        for (const Point& x : split.positions)
            bent = bent || (h.facts().dimension == 2 && x[2] != 0);
    });
    return bent;
}

TYPED_TEST(Indicators, AreZeroForLinearData) {
    with_function<TypeParam>([](const Point& x) { return x[0] - 2 * x[1] + 0.5 * x[2]; },
                             [](const Hierarchy<double>& h) {
                                 if (is_bent(h)) return;
                                 for (const Named& named : indicators(h)) {
                                     EXPECT_LE(greatest(h, named.indicator), 1e-5) << named.name;
                                 }
                             });
}

TYPED_TEST(Indicators, OfFoldsDependOnNoAmplitude) {
    const auto f = [](const Point& x) { return std::sin(5 * x[0]) * std::cos(4 * x[1] + x[2]); };
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        const auto values = sample_nodes(grid, f);
        const auto scaled = sample_nodes(grid, [&](const Point& x) { return 1000 * f(x) - 3; });
        const NodeField<typename TypeParam::Grid, double> field(grid, values);
        const NodeField<typename TypeParam::Grid, double> scaled_field(grid, scaled);
        const auto h = erase(grid, field);
        const SweptIndicator eta = visual_indicator(h, {.tau = 1e-6});
        const SweptIndicator of_scaled = visual_indicator({grid, scaled_field}, {.tau = 1e-3});
        double least = 2;
        for_each_judged_split(h, [&](const JudgedSplit& split) {
            for (const NodeKey key : split.keys) {
                EXPECT_NEAR(eta.stop(key), of_scaled.stop(key), 0.01);
                least = std::min(least, eta.stop(key));
            }
        });
        EXPECT_GT(least, 0);
        EXPECT_LE(greatest(h, eta), 2.01);
    }
}

TYPED_TEST(Indicators, KeepPeaks) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        std::vector<double> values(grid.node_count(), 0.0);
        values.back() = 1;
        const NodeField<typename TypeParam::Grid, double> field(grid, values);
        const auto h = erase(grid, field);
        const ProjectedNodes data(h, Exact(), 0.5);
        for (const Named& named : indicators(h)) {
            const ProjectedNodes projected(h, Threshold(&named.indicator, 0.9), 0.5);
            EXPECT_EQ(projected.difference(data), 0) << named.name;
        }
    }
}

/// A transform of random values with random integrals of hat functions.
struct RandomLifting {
    engine::Lifting lifting;
    std::map<std::size_t, double> offsets;  ///< by the number of the node, of all new nodes

    RandomLifting(const Hierarchy<double>& h, std::mt19937& random) {
        std::unordered_map<NodeKey, std::size_t> numbers;
        for_each_judged_split(h, [&](const JudgedSplit& split) {
            std::vector<std::size_t> nodes;
            for (const NodeKey key : split.keys) {
                const auto [at, is_new] = numbers.emplace(key, numbers.size());
                nodes.push_back(at->second);
                if (!is_new) continue;
                lifting.set_value(at->second, uniform(random));
                lifting.add_integral(at->second, 0.01 + uniform(random));
            }
            for (std::size_t n = split.corner_count(); n < nodes.size(); ++n) {
                const Stencil& stencil = split.rule.new_nodes[n - split.corner_count()];
                lifting.add_parents(nodes[n], stencil, nodes);
                double offset = lifting.nodes()[nodes[n]].value;
                for (std::size_t i = 0; i < stencil.count; ++i) {
                    const std::size_t parent = nodes[stencil.parent[i]];
                    offset -= stencil.weight[i] * lifting.nodes()[parent].value;
                }
                offsets[nodes[n]] = offset;
            }
        });
    }
};

TYPED_TEST(Indicators, OfWaveletsKeepTheIntegral) {
    std::mt19937 random(22);
    const auto zero = [](const Point&) { return 0.0; };
    with_function<TypeParam>(zero, [&](const Hierarchy<double>& h) {
        RandomLifting sample(h, random);
        engine::Lifting& lifting = sample.lifting;
        double finest = 0;
        std::size_t last = 0;
        for (const auto& node : lifting.nodes()) {
            finest += node.value * node.integral;
            last = std::max(last, node.generation);
        }
        lifting.run([&](std::size_t node, double detail, double integral) {
            EXPECT_GT(integral, 0);
            if (lifting.nodes()[node].generation < last) return;
            EXPECT_NEAR(detail, sample.offsets.at(node), 1e-14);
        });
        double coarsest = 0;
        for (const auto& node : lifting.nodes()) {
            if (node.generation == 0) coarsest += node.value * node.integral;
        }
        EXPECT_NEAR(coarsest, finest, 1e-12 * static_cast<double>(lifting.nodes().size()));
    });
}

double position_bound(const Hierarchy<double>& h, const Criterion& s, const Bounds& bounds,
                      const Indicator& positions) {
    const IsosurfaceOptions options{.position_bounds = &positions};
    if (h.facts().dimension == 2)
        return isosurface<2>(h, 0.0, under(s, bounds), options).position_bound;
    return isosurface<3>(h, 0.0, under(s, bounds), options).position_bound;
}

TYPED_TEST(Indicators, OfGeometryBoundTheProjectedPositions) {
    for (const auto& straight : TypeParam::grids()) {
        auto refined = straight;
        refine_at_sphere(refined, 3 * TypeParam::steps);
        const Bent<typename TypeParam::Grid> grid(refined);
        const auto values = fields(refined.node_positions())[0].values;
        const NodeField<typename TypeParam::Grid, double> field(refined, values);
        const auto h = erase(grid, field);
        const SweptIndicator geometry = geometry_indicator(h);
        const SweptIndicator bounds = position_bounds(h);
        expect_saturated(h, geometry);
        expect_saturated(h, bounds);
        const HierarchicalIndicator offsets(h);
        const ProjectedNodes data(h, Exact(), 0.0);
        const ProjectedNodes exact(h, Threshold(&geometry, 0), 0.0);
        EXPECT_EQ(exact.distance_where_drawn(data), 0);
        for (const double epsilon : {0.002, 0.01, 0.03}) {
            const Threshold by_bounds(&bounds, epsilon);
            EXPECT_LE(ProjectedNodes(h, by_bounds, 0.0).distance_where_drawn(data), epsilon);
            const Threshold by_geometry(&geometry, epsilon);
            const Threshold by_data(&offsets, 10 * epsilon);
            const auto both = by_geometry && by_data;
            expect_closed_surface(h, both, offsets);
            EXPECT_LE(ProjectedNodes(h, by_data, 0.0).distance_where_drawn(data),
                      position_bound(h, by_data, offsets, bounds));
            EXPECT_LE(ProjectedNodes(h, both, 0.0).distance_where_drawn(data),
                      position_bound(h, both, offsets, bounds));
        }
    }
}

/// Noise of 1e-15 beside one large value.
TEST(VisualIndicator, SeesNoNoiseBelowTau) {
    std::mt19937 random(23);
    OctreeGrid<3> grid(hexahedra(1));
    for (int i = 0; i < 3; ++i) grid.refine_uniformly();
    std::vector<double> values;
    while (values.size() < grid.node_count()) values.push_back(1e-15 * uniform(random));
    values.back() = 1;
    const NodeField<OctreeGrid<3>, double> field(grid, values);
    const auto h = erase(grid, field);
    const auto folds = [&](const SweptIndicator& eta) {
        std::size_t count = 0;
        for_each_judged_split(h, [&](const JudgedSplit& split) {
            for (const NodeKey key : split.keys) count += eta.stop(key) > 0.5 ? 1U : 0U;
        });
        return count;
    };
    EXPECT_LT(5 * folds(visual_indicator(h)), folds(visual_indicator(h, {.tau = 0})));
}

/// On hexahedra the gradient of x y jumps nowhere at nodes, but flat triangles fold.
TEST(VisualIndicator, SeesSaddlesInsideHexahedra) {
    with_function<BalancedOctree>([](const Point& x) { return (x[0] - 0.5) * (x[1] - 0.5); },
                                  [](const Hierarchy<double>& h) {
                                      const SweptIndicator eta = visual_indicator(h);
                                      for_each_judged_split(h, [&](const JudgedSplit& split) {
                                          for (const NodeKey key : split.keys)
                                              EXPECT_GT(eta.stop(key), 0.01);
                                      });
                                  });
}

/// Two gradients meet at an edge of two triangles; the numerical indicator is their difference
/// times the diameter.
TEST(NumericalIndicator, IsTheJumpTimesTheDiameter) {
    BisectionGrid<2> grid(triangles(1));
    grid.refine_uniformly();
    const auto values = sample_nodes(grid, [](const Point& x) { return std::abs(x[0] - x[1]); });
    const NodeField<BisectionGrid<2>, double> field(grid, values);
    const auto h = erase(grid, field);
    const SweptIndicator eta = numerical_indicator(h);
    // The gradients on both sides of the diagonal are (1, -1) and (-1, 1), the diameter is sqrt(2).
    EXPECT_NEAR(greatest(h, eta), std::sqrt(8.0) * std::sqrt(2.0), 0.05);
}

/// Three components a node.
template <class Grid>
class Triples {
public:
    using value_type = double;
    static constexpr int components = 3;

    Triples(const Grid& grid, std::span<const Point> at_nodes)
        : grid_{&grid}, at_nodes_{at_nodes} {}
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return copy(grid_->coarse_grid().element(i), out);
    }
    NodeMask new_values(const typename Grid::Element& e, NodeMask, std::span<double> out,
                        typename Grid::Context& context) const {
        return copy(grid_->new_nodes(e, context), out);
    }

private:
    NodeMask copy(std::span<const std::uint32_t> nodes, std::span<double> out) const {
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            for (std::size_t c = 0; c < 3; ++c) out[3 * k + c] = at_nodes_[nodes[k]][c];
        }
        return 0;
    }
    const Grid* grid_;
    std::span<const Point> at_nodes_;
};

TYPED_TEST(Indicators, OfNormsAreOrderedAndCountAllComponents) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    auto grid = std::move(TypeParam::grids()[0]);
    refine_at_sphere(grid, 3 * TypeParam::steps);
    std::vector<Point> flow;
    std::vector<double> second;
    for (const Point& x : grid.node_positions()) {
        flow.push_back({std::sin(5 * x[1]) - 0.3, std::cos(4 * x[0] + x[1]), x[0] * x[1]});
        second.push_back(flow.back()[1]);
    }
    const Triples<typename TypeParam::Grid> field(grid, flow);
    const NodeField<typename TypeParam::Grid, double> second_alone(grid, second);
    const auto h = erase(grid, field);
    const SweptIndicator sum = norm_indicator(h, {.norm = OffsetNorm::sum});
    const SweptIndicator euclid = norm_indicator(h);
    const SweptIndicator most = norm_indicator(h, {.norm = OffsetNorm::greatest});
    const SweptIndicator of_second = norm_indicator(h, {.scales = {infinity, 2, infinity}});
    const SweptIndicator alone = norm_indicator({grid, second_alone});
    for (const SweptIndicator* indicator : {&sum, &euclid, &most}) expect_saturated(h, *indicator);
    for_each_judged_split(h, [&](const JudgedSplit& split) {
        for (const NodeKey key : split.keys) {
            EXPECT_LE(alone.stop(key), most.stop(key));
            EXPECT_LE(most.stop(key), euclid.stop(key));
            EXPECT_LE(euclid.stop(key), sum.stop(key));
            EXPECT_LE(sum.stop(key), 1.01 * 3 * most.stop(key));
            EXPECT_EQ(2 * of_second.stop(key), alone.stop(key));
        }
    });
    const HierarchicalIndicator offsets(h);
    const Threshold s(&euclid, 0.02);
    expect_closed_surface(h, s, offsets);
}

TEST(NormIndicator, RefusesScalesThatDoNotFit) {
    BisectionGrid<2> grid(triangles(1));
    const std::vector<double> values(grid.node_count(), 0.0);
    const NodeField<BisectionGrid<2>, double> field(grid, values);
    expect_refused([&] { norm_indicator({grid, field}, {.scales = {1, 1}}); }, "scales");
    expect_refused([&] { norm_indicator({grid, field}, {.scales = {0}}); }, "scale");
    expect_refused([&] { visual_indicator({grid, field}, {.tau = -1}); }, "tau");
    expect_refused([&] { visual_indicator({grid, field}, {.spread = {.factor = 0.5}}); }, "factor");
}

TEST(VisualIndicator, RefusesValuesThatAreNotFinite) {
    BisectionGrid<2> grid(triangles(1));
    grid.refine_uniformly();
    std::vector<double> values(grid.node_count(), 0.0);
    values.back() = std::numeric_limits<double>::quiet_NaN();
    const NodeField<BisectionGrid<2>, double> field(grid, values);
    expect_refused([&] { visual_indicator({grid, field}); }, "not a usable number");
    expect_refused([&] { numerical_indicator({grid, field}); }, "not a usable number");
    expect_refused([&] { norm_indicator({grid, field}); }, "not a usable number");
}

}  // namespace indicators_test
