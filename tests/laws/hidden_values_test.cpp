// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is hidden is never looked at: whatever a field has at the nodes of hidden leaves alone, be
// it no number or no value at all, every indicator and every drawing is the same to the last bit.
#include <cmath>
#include <limits>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/discontinuous.hpp>
#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/hierarchy_copy.hpp>
#include <nestgrid/algorithms/holes.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>
#include <nestgrid/check_grid.hpp>
#include <walk/for_each_element.hpp>

#include "closedness.hpp"
#include "hiding_forest.hpp"
#include "table_in_c.hpp"

using namespace nestgrid_test;

namespace hidden_values_test {

/// A forest's field that has a placeholder at some nodes, or no value there.
template <int dim>
class PlaceholderField : public ForestField<dim> {
public:
    PlaceholderField(const Forest<dim>& forest, const typename ForestField<dim>::Function& f,
                     std::vector<bool> hidden, std::optional<double> placeholder)
        : ForestField<dim>(forest, f),
          forest_{&forest},
          hidden_{std::move(hidden)},
          placeholder_{placeholder} {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        const auto& cell = forest_->cells[forest_->coarse(i).element];
        ForestField<dim>::coarse_values(i, out);
        return hide(std::span(cell.nodes).first(topology(cell.shape).corners), ~NodeMask{0}, out);
    }
    NodeMask new_values(std::uint32_t e, NodeMask which, std::span<double> out) const {
        const auto& cell = forest_->cells[e];
        ForestField<dim>::new_values(e, which, out);
        return hide(std::span(cell.nodes).subspan(topology(cell.shape).corners), which, out);
    }

private:
    NodeMask hide(std::span<const std::uint32_t> nodes, NodeMask which,
                  std::span<double> out) const {
        NodeMask missing = 0;
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            if (!hidden_[nodes[n]] || (which >> n & 1U) == 0) continue;
            if (placeholder_) out[n] = *placeholder_;
            if (!placeholder_) missing |= NodeMask{1} << n;
        }
        return missing;
    }

    const Forest<dim>* forest_;
    std::vector<bool> hidden_;
    std::optional<double> placeholder_;
};

/// All numbers that a drawing holds.
struct Numbers {
    std::vector<double> all;

    void add(const Point& x) { all.insert(all.end(), x.begin(), x.end()); }
    std::vector<double> sorted() const {
        std::vector<double> result = all;
        std::ranges::sort(result);
        return result;
    }
    template <int dim>
    void add(const Surface<dim>& surface) {
        for (const Point& x : surface.vertices) add(x);
        for (const Point& n : surface.normals) add(n);
        all.insert(all.end(), surface.attributes.begin(), surface.attributes.end());
        for (const auto& s : surface.simplices) all.insert(all.end(), s.begin(), s.end());
    }
};

template <int dim>
Numbers everything(const Hierarchy<double>& hierarchy) {
    Numbers numbers;
    const auto draw = [&](const Criterion& criterion, const Bounds& bounds) {
        for (const double isovalue : {0.0, 0.3}) {
            const auto result = isosurface<dim>(hierarchy, isovalue, under(criterion, bounds),
                                                IsosurfaceOptions{.normals = true, .verify = true});
            numbers.add(result.surface);
            numbers.all.push_back(result.error_bound);
        }
        if constexpr (dim == 3) {
            const Plane plane({0.9, 0.8, 0.7}, {1, 0.5, -0.3});
            numbers.add(slice(hierarchy, plane, under(criterion, bounds)).surface);
        } else {
            numbers.add(height_field(hierarchy, 1.0, under(criterion, bounds)).surface);
        }
        std::mt19937 random(5);
        std::vector<Point> points(200);
        for (Point& x : points) {
            for (std::size_t d = 0; d < dim; ++d) x[d] = 2 * uniform(random);
        }
        for (const double u : probe(hierarchy, points, under(criterion, bounds)).values) {
            numbers.all.push_back(std::isnan(u) ? 1e9 : u);
        }
    };
    const HierarchicalIndicator offsets(hierarchy);
    numbers.all.insert(numbers.all.end(), {offsets.least(), offsets.greatest()});
    const HierarchicalIndicator deviations(hierarchy, NodeError::deviation);
    const std::array swept{visual_indicator(hierarchy), wavelet_indicator(hierarchy),
                           numerical_indicator(hierarchy), norm_indicator(hierarchy),
                           geometry_indicator(hierarchy)};
    for (const double threshold : {0.0, 0.05, 0.5}) {
        draw(Threshold(&offsets, threshold), offsets);
        draw(Threshold(&deviations, threshold), deviations);
        for (const SweptIndicator& each : swept) draw(Threshold(&each, threshold), offsets);
    }
    draw(Exact{}, offsets);
    return numbers;
}

template <int dim>
void expect_nobody_looks(Forest<dim> forest, int steps) {
    std::mt19937 random(8);
    refine_randomly(forest, random, steps);
    const HidingForest<dim> grid(std::move(forest), random, 2);
    const std::vector<bool> unseen = grid.unseen();
    ASSERT_GT(std::ranges::count(unseen, true), 5);
    const auto f = [](const Point& x) { return std::sin(3 * x[0]) + x[1] - x[2] * x[0] - 0.4; };
    std::optional<Numbers> first;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const std::optional<double> placeholder :
         {std::optional{nan}, {0.0}, {0.3}, {-1e6}, {infinity}, std::optional<double>{}}) {
        SCOPED_TRACE(placeholder ? std::to_string(*placeholder) : "no value");
        const PlaceholderField<dim> field(grid, f, unseen, placeholder);
        const auto violation = check_grid(grid, field);
        EXPECT_FALSE(violation) << violation->sentence;
        const auto hierarchy = erase(grid, field);
        const Numbers numbers = everything<dim>(hierarchy);
        if (!first) first = numbers;
        EXPECT_EQ(numbers.all, first->all);
        // The order of vertices follows keys, which a copy has of its own.
        EXPECT_EQ(everything<dim>(HierarchyCopy(hierarchy)).sorted(), first->sorted());
    }
    EXPECT_GT(first->all.size(), 1000U);
}

/// Values of its own for every leaf, those of hidden ones being a placeholder.
template <int dim>
struct PlaceholderLeaves {
    const HidingForest<dim>* grid;
    double placeholder;

    void leaf_values(std::uint32_t leaf, std::span<double> out) const {
        const auto& cell = grid->cells[leaf];
        for (std::size_t k = 0; k < out.size(); ++k) {
            const Point& x = grid->positions[cell.nodes[k]];
            out[k] = grid->hidden(leaf) == Hidden::wholly
                         ? placeholder
                         : x[0] - 0.5 * x[1] * x[1] + 0.01 * (leaf % 7);
        }
    }
};

template <int dim>
Numbers everything_that_jumps(const HidingForest<dim>& grid, double placeholder) {
    const PlaceholderLeaves<dim> leaves{&grid, placeholder};
    const DiscontinuousData data(grid, leaves);
    Numbers numbers;
    for (const double threshold : {0.0, 0.02, 0.2}) {
        const DiscontinuousOptions options{.threshold = threshold};
        const auto add = [&](const DiscontinuousSurface& drawn) {
            numbers.add(drawn.surface);
            numbers.all.push_back(drawn.error_bound);
        };
        if constexpr (dim == 3) {
            add(slice(data, Plane({0.9, 0.8, 0.7}, {1, 0.5, -0.3}), options));
        } else {
            add(shading(data, options));
            add(height_field(data, 0.5, options));
        }
    }
    return numbers;
}

/// Through tables in C, between frames, and of data that jump.
template <int dim>
void expect_nobody_looks_elsewhere(Forest<dim> forest, int steps) {
    std::mt19937 random(8);
    refine_randomly(forest, random, steps);
    const HidingForest<dim> grid(std::move(forest), random, 2);
    const std::vector<bool> unseen = grid.unseen();
    const auto f = [](const Point& x) { return std::sin(3 * x[0]) + x[1] - x[2] * x[0] - 0.4; };
    const auto g = [](const Point& x) { return 0.5 - x[0] * x[1]; };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::optional<std::array<Numbers, 3>> first;
    for (const std::optional<double> placeholder :
         {std::optional{0.0}, {nan}, {0.3}, {-1e6}, {infinity}, {1e308}, std::optional<double>{}}) {
        SCOPED_TRACE(placeholder ? std::to_string(*placeholder) : "no value");
        using Field = PlaceholderField<dim>;
        const Field field(grid, f, unseen, placeholder);
        const Field later(grid, g, unseen, placeholder);
        const TableInC table(grid);
        const nestgrid_field in_c = field_in_c(grid, field);
        const Between<Field> between({&field, &later}, std::array{0.25F, 0.75F});
        const std::array<Numbers, 3> numbers{
            everything<dim>(*open_table<double>(table.table, in_c)),
            everything<dim>(erase(grid, between)),
            everything_that_jumps(grid, placeholder.value_or(nan))};
        if (!first) first = numbers;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            EXPECT_EQ(numbers[i].all, (*first)[i].all) << i;
            EXPECT_GT(numbers[i].all.size(), 1000U) << i;
        }
    }
}

TEST(HiddenValues, AreNotLookedAtElsewhereEither) {
    std::mt19937 random(3);
    expect_nobody_looks_elsewhere(boxes<3>(random, 2), 40);
    expect_nobody_looks_elsewhere(kuhn<3>(3), 600);
    expect_nobody_looks_elsewhere(boxes<2>(random, 3), 150);
    expect_nobody_looks_elsewhere(kuhn<2>(2), 300);
}

TEST(HiddenValues, AreNeverLookedAt) {
    std::mt19937 random(3);
    expect_nobody_looks(boxes<3>(random, 2), 40);
    expect_nobody_looks(kuhn<3>(3), 600);
    expect_nobody_looks(kuhn<3>(0), 60);
    expect_nobody_looks(boxes<2>(random, 3), 150);
    expect_nobody_looks(kuhn<2>(2), 300);
}

/// A value that a leaf which is drawn has is checked as ever.
TEST(HiddenValues, DoNotExcuseOthers) {
    std::mt19937 random(3);
    Forest<2> forest = boxes<2>(random, 3);
    refine_randomly(forest, random, 60);
    const HidingForest<2> grid(std::move(forest), random, 2);
    std::vector<bool> some = grid.unseen();
    some.flip();
    const PlaceholderField<2> field(
        grid, [](const Point& x) { return x[0]; }, some, std::numeric_limits<double>::quiet_NaN());
    const auto violation = check_grid(grid, field);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->law, Law::value_finite);
    EXPECT_THROW(HierarchicalIndicator(grid, field), InvalidInput);
}

/// A forest that hides leaves, and does not say which nodes hang.
template <int dim>
class ReticentForest : public HidingForest<dim> {
public:
    using HidingForest<dim>::HidingForest;
    NodeMask constrained(std::uint32_t e) const = delete;
};

/// Values of a field at the nodes of a forest, those that hang being means.
template <int dim>
std::vector<double> resolved(const HidingForest<dim>& grid, std::vector<double> values) {
    for (bool settled = false; !settled;) {
        settled = true;
        for (const auto& cell : grid.cells) {
            if (cell.rule == nullptr) continue;
            std::vector<double> local;
            for (const std::uint32_t node : cell.nodes) local.push_back(values[node]);
            const std::size_t corners = topology(cell.shape).corners;
            for (std::size_t n = corners; n < cell.nodes.size(); ++n) {
                if (!grid.hangs(cell.nodes[n])) continue;
                const double mean =
                    detail::interpolate(cell.rule->new_nodes[n - corners], local.data(), 1);
                double& value = values[cell.nodes[n]];
                if (std::isnan(mean) != std::isnan(value)) settled = false;
                value = mean;
            }
        }
    }
    return values;
}

/// The forest with those leaves hidden, one by one, at whose corners there are no values, and
/// others.
template <int dim>
HidingForest<dim> hidden_one_by_one(const Forest<dim>& forest, const std::vector<double>& values,
                                    std::vector<bool> hides) {
    for (;;) {
        const auto hidden = [&](std::size_t leaf) { return bool{hides[leaf]}; };
        HidingForest<dim> grid(forest, hidden);
        const std::vector<double> at = resolved(grid, values);
        bool any = false;
        for (std::size_t e = 0; e < forest.cells.size(); ++e) {
            const auto& cell = forest.cells[e];
            if (cell.rule != nullptr || hides[e]) continue;
            const bool missing = std::ranges::any_of(
                cell.nodes, [&](std::uint32_t node) { return std::isnan(at[node]); });
            hides[e] = missing;
            any = any || missing;
        }
        if (!any) return grid;
    }
}

std::size_t hidden_leaves(const Hierarchy<double>& hierarchy) {
    const engine::Walk<double> walk(hierarchy, {.values = false, .keys = true});
    std::size_t count = 0;
    engine::for_each_element(walk, false, [&](const auto& view, const engine::Split&) {
        count += view.is_leaf() && view.member->hidden == Hidden::wholly ? 1 : 0;
    });
    return count;
}

template <int dim>
void expect_holes(Forest<dim> forest, int steps, double share) {
    std::mt19937 random(8);
    refine_randomly(forest, random, steps);
    const auto f = [](const Point& x) { return std::sin(3 * x[0]) + x[1] - x[2] * x[0] - 0.4; };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> values;
    std::vector<bool> missing;
    for (const Point& x : forest.positions) {
        missing.push_back(uniform(random) < share);
        values.push_back(missing.back() ? nan : f(x));
    }
    // The grid hides some of its own, too.
    std::vector<bool> hides;
    for (std::size_t e = 0; e < forest.cells.size(); ++e) hides.push_back(random() % 10 == 0);
    const ReticentForest<dim> grid(forest, [&](std::size_t leaf) { return bool{hides[leaf]}; });
    const HidingForest<dim> expected = hidden_one_by_one(forest, values, hides);
    const PlaceholderField<dim> field(grid, f, missing, nan);
    const auto inner = erase(grid, field);
    const Holes<double> holes(inner);
    std::size_t hidden = 0;
    for (std::size_t e = 0; e < forest.cells.size(); ++e) {
        if (forest.cells[e].rule == nullptr &&
            expected.hidden(static_cast<std::uint32_t>(e)) == Hidden::wholly) {
            ++hidden;
        }
    }
    EXPECT_EQ(hidden_leaves(holes), hidden);
    EXPECT_GT(hidden, 0U);
    const PlaceholderField<dim> of_expected(expected, f, missing, nan);
    EXPECT_EQ(everything<dim>(holes).all, everything<dim>(erase(expected, of_expected)).all);
    EXPECT_THROW(Holes<double>(holes, holes.hidden()), InvalidInput);
}

/// Where values are missing, the drawing is that of a grid that hides the leaves around them.
TEST(Holes, AreTheLeavesWithoutValues) {
    std::mt19937 random(3);
    for (const double share : {0.03, 0.1, 0.4}) {
        SCOPED_TRACE(share);
        expect_holes(boxes<3>(random, 2), 40, share);
        expect_holes(kuhn<3>(3), 600, share);
        expect_holes(boxes<2>(random, 3), 150, share);
        expect_holes(kuhn<2>(2), 300, share);
    }
}

/// The samples of a lattice without what makes its preroll go by rows.
template <class Grid, class Sample>
class PlainSamples {
public:
    using value_type = Sample;
    using Element = typename Grid::Element;
    PlainSamples(const Grid& grid, std::span<const Sample> samples) : field_(grid, samples) {}
    NodeMask coarse_values(std::size_t i, std::span<Sample> out) const {
        return field_.coarse_values(i, out);
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<Sample> out) const {
        return field_.new_values(e, which, out);
    }

private:
    LatticeField<Grid, Sample> field_;
};

template <class Sample>
void expect_true_rows() {
    using Grid = LatticeBisection<3>;
    std::mt19937 random(4);
    for (const double share : {0.001, 0.02, 0.3}) {
        const Grid grid(LatticeGeometry<3>{.samples = {19, 17, 33}});
        std::vector<Sample> samples;
        for (std::size_t i = 0; i < grid.sample_count(); ++i) {
            const bool missing = uniform(random) < share;
            const double x = 0.2 * static_cast<double>(i % 19);
            const double y = 0.003 * static_cast<double>(i);
            samples.push_back(missing ? std::numeric_limits<Sample>::quiet_NaN()
                                      : static_cast<Sample>(std::sin(x) + std::sin(y)));
        }
        const LatticeField<Grid, Sample> by_rows(grid, samples);
        const PlainSamples<Grid, Sample> by_walk(grid, samples);
        const auto erased = erase(grid, by_rows);
        const auto plain = erase(grid, by_walk);
        const Holes<Sample> holes(erased);
        const Holes<Sample> walked(plain, holes.hidden());
        ASSERT_TRUE(holes.facts().knows_stars);
        ASSERT_FALSE(walked.facts().knows_stars);
        const HiddenElements in_a_walk(plain);
        ASSERT_TRUE(in_a_walk.any());
        EXPECT_TRUE(*holes.hidden() == in_a_walk);
        for (NodeKey node = 0; node < holes.facts().node_count; ++node) {
            const Point x = grid.node_position(node);
            if (x[0] > 18 || x[1] > 16 || x[2] > 32) continue;  // beyond the samples
            ASSERT_EQ(holes.hidden()->unseen().contains(node), in_a_walk.unseen().contains(node));
        }
        const HierarchicalIndicator rows(holes);
        const HierarchicalIndicator all(walked);
        for (const double threshold : {0.0, 0.02, 0.3}) {
            SCOPED_TRACE(threshold);
            const auto draw = [&](const Holes<Sample>& of, const HierarchicalIndicator& indicator) {
                return isosurface<3>(of, 0.3, under(indicator, threshold),
                                     IsosurfaceOptions{.verify = true});
            };
            const auto fast = draw(holes, rows);
            const auto slow = draw(walked, all);
            if (threshold == 0) {
                EXPECT_EQ(fast.surface.vertices, slow.surface.vertices);
                EXPECT_EQ(fast.surface.simplices, slow.surface.simplices);
            }
            std::vector<Point> points;
            for (std::size_t k = 0; k < 2000; ++k) {
                points.push_back(
                    {18 * uniform(random), 16 * uniform(random), 32 * uniform(random)});
            }
            const auto exact = probe(holes, points).values;
            const auto drawn = probe(holes, points, under(rows, threshold)).values;
            std::size_t inside = 0;
            for (std::size_t k = 0; k < points.size(); ++k) {
                ASSERT_EQ(std::isnan(exact[k]), std::isnan(drawn[k]));
                if (std::isnan(exact[k])) continue;
                EXPECT_LE(std::abs(exact[k] - drawn[k]), fast.error_bound + 1e-6);
                ++inside;
            }
            EXPECT_GT(inside, 20U);
        }
    }
}

/// Prerolls of samples by rows are as true beside holes as those of all elements.
TEST(Holes, InSamplesGoByRows) {
    expect_true_rows<float>();
    expect_true_rows<double>();
}

/// Fields of one grid share the elements that any of them hides.
TEST(Holes, AreSharedByFields) {
    std::mt19937 random(3);
    Forest<2> forest = boxes<2>(random, 3);
    refine_randomly(forest, random, 100);
    const auto f = [](const Point& x) { return x[0] + x[1]; };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    std::array<std::vector<bool>, 3> missing;
    for (std::size_t i = 0; i < forest.positions.size(); ++i) {
        for (std::size_t k = 0; k < 2; ++k) missing[k].push_back(random() % 20 == 0);
        missing[2].push_back(missing[0].back() || missing[1].back());
    }
    const PlaceholderField<2> first(forest, f, missing[0], nan);
    const PlaceholderField<2> second(forest, f, missing[1], nan);
    const PlaceholderField<2> either(forest, f, missing[2], nan);
    const auto of_first = erase(forest, first);
    const auto of_second = erase(forest, second);
    const std::array<const Hierarchy<double>*, 2> fields{&of_first, &of_second};
    const auto shared = HiddenElements::of_all<double>(fields);
    const HiddenElements together(erase(forest, either));
    EXPECT_TRUE(*shared == together);
    EXPECT_FALSE(*shared == HiddenElements(of_first));
    EXPECT_FALSE(*shared == HiddenElements(of_second));
}

}  // namespace hidden_values_test
