// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A threshold on cut deviations is the error of a surface, there and back, and nothing that is
// further from the isovalue changes its side. By brute force, on every family.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/detail/shape_functions.hpp>

#include "families.hpp"
#include "kept_elements.hpp"
#include "projection_judge.hpp"
#include "surface_judge.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace cut_deviation_test {

constexpr double bfloat16_steps = 1 + 1.0 / 128;  // numbers are rounded up by less
constexpr double rounding = 1e-12;
constexpr double cut_distance = 1e-5;  // cuts stay away from nodes
constexpr std::array<double, 6> all_thresholds{0, 0.02, 0.1, 0.3, 1, 3};

/// Fields with surfaces that come and go between levels.
std::vector<NodalSamples> cut_fields(const std::vector<Point>& nodes, unsigned seed) {
    std::vector<NodalSamples> fields;
    for (NodalSamples& samples : catching_fields(nodes, seed)) {
        const bool small = samples.name == "tiny" || samples.name.starts_with("5 units");
        if (!small) fields.push_back(std::move(samples));
    }
    std::mt19937 random(seed);
    NodalSamples peak{"one peak", std::vector<double>(nodes.size(), -1), true};
    peak.values[nodes.size() - 2] = 10;
    NodalSamples bytes{"8 bits at the isovalue", {}, false};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        bytes.values.push_back((static_cast<double>(random() % 9) - 4) / 4);
    }
    fields.push_back(std::move(peak));
    fields.push_back(std::move(bytes));
    return fields;
}

template <class Family, class Test>
void for_each_cut_field(int levels, unsigned seed, Test&& test) {
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, levels * Family::steps);
        for (const NodalSamples& samples : cut_fields(grid.node_positions(), seed)) {
            SCOPED_TRACE(samples.name);
            const NodeField<typename Family::Grid, double> field(grid, samples.values);
            test(erase(grid, field));
        }
    }
}

/// The greatest errors of a function beside the data.
struct Errors {
    double drawn = 0;  // |U - C| where the function is C
    double back = 0;   // |function - C| where U = C
    double sides = 0;  // |U - C| where they lie on different sides

    double greatest() const { return std::max({drawn, back, sides}); }
    void add(const Errors& e) {
        drawn = std::max(drawn, e.drawn);
        back = std::max(back, e.back);
        sides = std::max(sides, e.sides);
    }
};

/// The errors on the line between two points, on which both functions are affine.
Errors errors_between(double u0, double u1, double v0, double v1) {
    Errors e;
    for (const auto& [u, v] : {std::pair{u0, v0}, std::pair{u1, v1}}) {
        if ((u >= 0) != (v >= 0)) e.sides = std::max(e.sides, std::abs(u));
    }
    if ((v0 >= 0) != (v1 >= 0)) e.drawn = std::abs(u0 + v0 / (v0 - v1) * (u1 - u0));
    if ((u0 >= 0) != (u1 >= 0)) e.back = std::abs(v0 + u0 / (u0 - u1) * (v1 - v0));
    return e;
}

/// A leaf, with the data and a function at its corners, from which the isovalue is subtracted.
struct JudgedLeaf {
    Shape shape;
    std::array<double, max_corners> u;
    std::array<double, max_corners> v;

    Errors on_edges() const {
        Errors e;
        const Topology& t = topology(shape);
        for (std::size_t i = 0; i < t.edges; ++i) {
            const auto [a, b] = t.edge[i];
            e.add(errors_between(u[a], u[b], v[a], v[b]));
        }
        return e;
    }
    /// At points of the leaf: by steps on lines between random points of it.
    Errors inside(std::mt19937& random) const {
        Errors e;
        const Topology& t = topology(shape);
        const auto point = [&] {
            Point s{0, 0, 0};
            double sum = 0;
            for (std::size_t k = 0; k < t.corners; ++k) {
                const double w = std::pow(uniform(random), 4);
                s = s + w * t.reference[k];
                sum += w;
            }
            return (1 / sum) * s;
        };
        const auto at = [&](const Point& s, const auto& values) {
            const auto weight = shape_functions(shape, s);
            double sum = 0;
            for (std::size_t k = 0; k < t.corners; ++k) sum += weight[k] * values[k];
            return sum;
        };
        const auto zero = [&](Point a, Point b, const auto& values) {
            const bool inside = at(a, values) >= 0;
            for (int i = 0; i < 52; ++i) {
                const Point m = 0.5 * (a + b);
                ((at(m, values) >= 0) == inside ? a : b) = m;
            }
            return a;
        };
        const Point a = point();
        const Point b = point();
        if ((at(a, u) >= 0) != (at(a, v) >= 0)) e.sides = std::abs(at(a, u));
        if ((at(a, v) >= 0) != (at(b, v) >= 0)) e.drawn = std::abs(at(zero(a, b, v), u));
        if ((at(a, u) >= 0) != (at(b, u) >= 0)) e.back = std::abs(at(zero(a, b, u), v));
        return e;
    }
};

/// Calls a function for all leaves, with the projection at their corners, continued below the
/// elements that stop.
class LeafJudge final : public engine::Visitor<double> {
public:
    using View = engine::ElementView<double>;

    LeafJudge(const Hierarchy<double>& h, const ProjectedNodes& exact, const Criterion& criterion,
              double isovalue, const std::function<void(const JudgedLeaf&)>& function)
        : exact_{&exact},
          criterion_{&criterion},
          isovalue_{isovalue},
          function_{&function},
          hanging_{engine::find_hanging_nodes(h)},
          walk_{h, {.keys = true, .positions = true}, &hanging_} {
        walk_.run(*this);
    }
    bool sees_hidden() const override { return true; }
    engine::Decision inspect(const View& view, const engine::Split& split) override {
        if (view.level <= stop_level_) stop_level_ = none_;
        if (split.rule == nullptr) return {engine::Visit::stop, 0};
        if (stop_level_ == none_) {
            const auto decision = question_.ask(walk_, *criterion_, view, split);
            if (decision.visit != engine::Visit::stop) return decision;
            stop_level_ = view.level;
        }
        return {engine::Visit::descend, split.rule->all()};
    }
    void extract(const View& view) override {
        JudgedLeaf leaf{view.shape, {}, {}};
        std::array<NodeKey, max_corners> keys{};
        walk_.corners(view, keys.data(), nullptr);
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            leaf.u[k] = exact_->values().at(keys[k]) - isovalue_;
            leaf.v[k] = view.value[k * walk_.components()] - isovalue_;
        }
        (*function_)(leaf);
    }

private:
    static constexpr int none_ = -1;

    const ProjectedNodes* exact_;
    const Criterion* criterion_;
    double isovalue_;
    const std::function<void(const JudgedLeaf&)>* function_;
    HangingNodes hanging_;
    engine::Walk<double> walk_;
    engine::CriterionQuestion question_;
    int stop_level_ = none_;
};

/// The errors of a projection, at nodes, on edges of leaves, and at random points of them.
Errors errors_of(const Hierarchy<double>& h, const ProjectedNodes& exact,
                 const Criterion& criterion, double isovalue) {
    Errors e;
    std::mt19937 random(5);
    const std::function<void(const JudgedLeaf&)> judge = [&](const JudgedLeaf& leaf) {
        e.add(leaf.on_edges());
        const bool simplex = topology(leaf.shape).corners == topology(leaf.shape).dimension + 1U;
        if (!simplex) e.add(leaf.inside(random));
    };
    LeafJudge(h, exact, criterion, isovalue, judge);
    return e;
}

/// |U - C| at vertices, middles of edges and middles of what is drawn.
template <int dimension>
double greatest_on_surface(const Hierarchy<double>& h, const Surface<dimension>& s,
                           double isovalue) {
    std::vector<Point> points = s.vertices;
    for (const auto& simplex : s.simplices) {
        Point sum{0, 0, 0};
        for (std::size_t i = 0; i < dimension; ++i) {
            const Point& x = s.vertices[simplex[i]];
            sum = sum + x;
            points.push_back(0.5 * (x + s.vertices[simplex[(i + 1) % dimension]]));
        }
        points.push_back((1.0 / dimension) * sum);
    }
    return greatest_difference(h, points, isovalue);
}

bool has_simplices_only(const Hierarchy<double>& h) {
    const Shape shape = h.facts().only_shape;
    return shape == Shape::tetrahedron || shape == Shape::triangle;
}

/// The errors of the interpolant of element i on all leaves below it.
Errors errors_below(const std::vector<KeptElement>& elements, std::size_t i, double isovalue) {
    const auto corners = static_cast<std::size_t>(elements[i].rule->corner_count());
    std::map<NodeKey, double> z;
    for (std::size_t k = 0; k < corners; ++k) z[elements[i].keys[k]] = elements[i].values[k];
    Errors e;
    for (std::size_t j = i;
         j < elements.size() && (j == i || elements[j].level > elements[i].level); ++j) {
        const KeptElement& below = elements[j];
        if (below.rule == nullptr) {
            JudgedLeaf leaf{below.shape, {}, {}};
            for (std::size_t k = 0; k < below.keys.size(); ++k) {
                leaf.u[k] = below.values[k] - isovalue;
                leaf.v[k] = z.at(below.keys[k]) - isovalue;
            }
            e.add(leaf.on_edges());
            continue;
        }
        const auto first = static_cast<std::size_t>(below.rule->corner_count());
        for (std::size_t n = 0; n < below.rule->new_nodes.size(); ++n) {
            const Stencil& stencil = below.rule->new_nodes[n];
            double mean = 0;
            for (std::size_t p = 0; p < stencil.count; ++p) {
                mean += stencil.weight[p] * z.at(below.keys[stencil.parent[p]]);
            }
            z[below.keys[first + n]] = mean;
        }
    }
    return e;
}

template <class Family>
class CutDeviation : public testing::Test {};
TYPED_TEST_SUITE(CutDeviation, Families);

TYPED_TEST(CutDeviation, OfNodesIsNoLessThanTheErrorOfTheirElements) {
    const std::array<double, 2> isovalues{0, 0.4};
    for_each_cut_field<TypeParam>(2, 4, [&](const auto& h) {
        const HierarchicalIndicator bounds(h);
        const SweptIndicator indicator = cut_deviations(h, isovalues, bounds);
        expect_saturated(h, indicator);
        const std::vector<KeptElement> elements = elements_of(h);
        double greatest = 0;
        double greatest_stop = 0;
        bool one_at_a_time = true;
        for (std::size_t i = 0; i < elements.size(); ++i) {
            if (elements[i].rule == nullptr) continue;
            double error = 0;
            for (const double isovalue : isovalues) {
                error = std::max(error, errors_below(elements, i, isovalue).greatest());
            }
            greatest = std::max(greatest, error);
            const auto corners = static_cast<std::size_t>(elements[i].rule->corner_count());
            one_at_a_time = one_at_a_time && elements[i].keys.size() == corners + 1;
            for (std::size_t n = corners; n < elements[i].keys.size(); ++n) {
                const double stop = indicator.stop(elements[i].keys[n]);
                EXPECT_GE(stop, error - 1e-14);
                greatest_stop = std::max(greatest_stop, stop);
            }
        }
        if (one_at_a_time && has_simplices_only(h)) {
            EXPECT_LE(greatest_stop, greatest * bfloat16_steps + 1e-14);
        }
    });
}

TYPED_TEST(CutDeviation, ThatStopsIsTheErrorOfTheSurfaceThereAndBack) {
    const std::array<double, 2> isovalues{0, -0.3};
    for_each_cut_field<TypeParam>(3, 5, [&](const auto& h) {
        const HierarchicalIndicator bounds(h);
        const SweptIndicator indicator = cut_deviations(h, isovalues, bounds);
        const ProjectedNodes exact(h, Exact(), 0.0);
        for (const double threshold : all_thresholds) {
            SCOPED_TRACE(threshold);
            const Threshold s(&indicator, threshold);
            for (const double isovalue : isovalues) {
                const Errors e = errors_of(h, exact, s, isovalue);
                EXPECT_LE(e.drawn, threshold + rounding);
                EXPECT_LE(e.back, threshold + rounding);
                EXPECT_LE(e.sides, threshold + rounding);
            }
        }
    });
}

TYPED_TEST(CutDeviation, KeepsTheErrorOfClosedSurfaces) {
    constexpr int dimension = TypeParam::Grid::dimension;
    for_each_cut_field<TypeParam>(2, 6, [&](const auto& h) {
        const HierarchicalIndicator bounds(h);
        const std::array<double, 1> isovalue{0};
        const SweptIndicator indicator = cut_deviations(h, isovalue, bounds);
        const double flat = isosurface<dimension>(h, 0.0, under(Exact(), bounds)).surface_error;
        EXPECT_TRUE(flat == 0 || !has_simplices_only(h));
        for (const double threshold : {0.0, 0.1, 0.3, 1.0}) {
            SCOPED_TRACE(threshold);
            const Threshold s(&indicator, threshold);
            const auto result = isosurface<dimension>(h, 0.0, under(s, bounds));
            expect_closed(result.surface);
            EXPECT_LE(result.surface_error, std::max(threshold, flat));
            EXPECT_LE(result.error_bound, result.surface_error);
            EXPECT_LE(greatest_on_surface(h, result.surface, 0),
                      result.surface_error + cut_distance * (1 + result.range_bound));
        }
        const auto other = isosurface<dimension>(h, 0.1, under(Threshold(&indicator, 0.3), bounds));
        EXPECT_EQ(other.surface_error, std::numeric_limits<double>::infinity());
    });
}

TYPED_TEST(CutDeviation, GoesWithOtherCriteria) {
    const std::array<double, 1> isovalue{0};
    for_each_cut_field<TypeParam>(2, 8, [&](const auto& h) {
        const HierarchicalIndicator bounds(h);
        const SweptIndicator indicator = cut_deviations(h, isovalue, bounds, {.factor = 1.5});
        expect_saturated(h, indicator);
        const ProjectedNodes exact(h, Exact(), 0.0);
        for (const double threshold : {0.1, 0.5}) {
            SCOPED_TRACE(threshold);
            const Blended blended(&indicator, threshold, 1.5);
            const double most = blended.surface_error(isovalue);
            EXPECT_LE(most, 1.5 * threshold);
            EXPECT_LE(errors_of(h, exact, blended, 0).greatest(), most + rounding);
            const auto both = Threshold(&indicator, threshold) && Threshold(&bounds, 0.4);
            EXPECT_LE(errors_of(h, exact, both, 0).greatest(),
                      both.surface_error(isovalue) + rounding);
            EXPECT_LE(both.surface_error(isovalue), threshold);
        }
    });
}

TYPED_TEST(CutDeviation, DependsNeitherOnThreadsNorOnTheOrder) {
    for_each_cut_field<TypeParam>(2, 7, [](const auto& h) {
        const std::array<double, 2> isovalues{0, 0.4};
        const HierarchicalIndicator bounds(h);
        const SweptIndicator one = cut_deviations(h, isovalues, bounds);
        const SweptIndicator slope = slope_deviations(h, isovalues, bounds);
        expect_saturated(h, slope);
        const std::vector<KeptElement> elements = elements_of(h);
        for (const std::size_t threads : {2U, 3U}) {
            const ThreadExecutor executor(threads);
            const SweptIndicator many = cut_deviations(h, isovalues, bounds, {}, executor);
            const SweptIndicator slopes = slope_deviations(h, isovalues, bounds, {}, executor);
            for (const KeptElement& element : elements) {
                for (const NodeKey node : element.keys) {
                    EXPECT_EQ(many.stop(node), one.stop(node));
                    EXPECT_EQ(slopes.stop(node), slope.stop(node));
                }
            }
        }
    });
}

/// On a lattice, where the walk leaves out what the isovalue does not pass and rows of nodes
/// saturate the numbers.
template <class Grid>
void expect_error_on_lattice(const Grid& grid, std::size_t count) {
    constexpr int dimension = Grid::dimension;
    std::mt19937 random(11);
    for (const bool noise : {true, false}) {
        std::vector<double> values(count);
        for (std::size_t i = 0; i < count; ++i) {
            values[i] = noise ? uniform(random) : std::sin(0.01 * static_cast<double>(i));
        }
        const LatticeField field(grid, std::span<const double>(values));
        const auto h = erase(grid, field);
        ASSERT_TRUE(h.facts().knows_star_positions);
        const std::array<double, 1> isovalue{0.5};
        const HierarchicalIndicator bounds(h);
        const SweptIndicator indicator = cut_deviations(h, isovalue, bounds);
        expect_saturated(h, indicator);
        expect_saturated(h, slope_deviations(h, isovalue, bounds, {.slope = 0.1}));
        const SweptIndicator many = cut_deviations(h, isovalue, bounds, {}, ThreadExecutor(3));
        for (NodeKey node = 0; node < h.facts().node_count; ++node) {
            EXPECT_EQ(many.stop(node), indicator.stop(node));
        }
        const ProjectedNodes exact(h, Exact(), 0.5);
        for (const double threshold : {0.0, 0.02, 0.2, 0.4}) {
            const Threshold s(&indicator, threshold);
            EXPECT_LE(errors_of(h, exact, s, 0.5).greatest(), threshold + rounding);
            const auto result = isosurface<dimension>(h, 0.5, under(s, bounds));
            expect_closed(result.surface);
            EXPECT_LE(greatest_on_surface(h, result.surface, 0.5),
                      result.surface_error + cut_distance);
        }
    }
}

TEST(CutDeviation, IsTheErrorOnLattices) {
    expect_error_on_lattice(LatticeBisection<3>({.samples = {9, 17, 9}}), 9 * 17 * 9);
    expect_error_on_lattice(LatticeBisection<3>({.samples = {11, 9, 14}}), 11 * 9 * 14);
    expect_error_on_lattice(LatticeBisection<2>({.samples = {33, 17}}), 33 * 17);
    expect_error_on_lattice(LatticeOctree<3>({.samples = {9, 9, 17}}), 9 * 9 * 17);
    expect_error_on_lattice(LatticeOctree<2>({.samples = {20, 13}}), 20 * 13);
}

TEST(CutDeviation, RefusesWhatIsNoIsovalue) {
    const LatticeBisection<2> grid({.samples = {5, 5}});
    const std::vector<double> values(25, 1);
    const LatticeField field(grid, std::span<const double>(values));
    const HierarchicalIndicator bounds(grid, field);
    const std::array<double, 1> nan{std::numeric_limits<double>::quiet_NaN()};
    EXPECT_THROW(cut_deviations({grid, field}, nan, bounds), InvalidInput);
    EXPECT_THROW(slope_deviations({grid, field}, nan, bounds), InvalidInput);
}

}  // namespace cut_deviation_test
