// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is hidden is never looked at: whatever a field has at the nodes of hidden leaves alone, be
// it no number or no value at all, every indicator and every drawing is the same to the last bit.
#include <cmath>
#include <limits>

#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>
#include <nestgrid/check_grid.hpp>

#include "closedness.hpp"
#include "hiding_forest.hpp"

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
    template <int dim>
    void add(const Surface<dim>& surface) {
        for (const Point& x : surface.vertices) add(x);
        for (const Point& n : surface.normals) add(n);
        all.insert(all.end(), surface.attributes.begin(), surface.attributes.end());
        for (const auto& s : surface.simplices) all.insert(all.end(), s.begin(), s.end());
    }
};

template <int dim, class Grid, class Field>
Numbers everything(const Grid& grid, const Field& field) {
    Numbers numbers;
    const auto draw = [&](const Criterion& criterion, const Bounds& bounds) {
        for (const double isovalue : {0.0, 0.3}) {
            const auto result = isosurface(grid, field, isovalue, criterion, bounds,
                                           IsosurfaceOptions{.normals = true, .verify = true});
            numbers.add(result.surface);
            numbers.all.push_back(result.error_bound);
        }
        if constexpr (dim == 3) {
            const Plane plane({0.9, 0.8, 0.7}, {1, 0.5, -0.3});
            numbers.add(slice(grid, field, plane, criterion, bounds).surface);
        } else {
            numbers.add(height_field(grid, field, 1.0, criterion, bounds).surface);
        }
        std::mt19937 random(5);
        std::vector<Point> points(200);
        for (Point& x : points) {
            for (std::size_t d = 0; d < dim; ++d) x[d] = 2 * uniform(random);
        }
        for (const double u : probe(grid, field, points, criterion, bounds).values) {
            numbers.all.push_back(std::isnan(u) ? 1e9 : u);
        }
    };
    const HierarchicalIndicator offsets(grid, field);
    numbers.all.insert(numbers.all.end(), {offsets.least(), offsets.greatest()});
    const HierarchicalIndicator deviations(grid, field, NodeError::deviation);
    const std::array swept{visual_indicator(grid, field), wavelet_indicator(grid, field),
                           numerical_indicator(grid, field), norm_indicator(grid, field),
                           geometry_indicator(grid, field)};
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
        const Numbers numbers = everything<dim>(grid, field);
        if (!first) first = numbers;
        EXPECT_EQ(numbers.all, first->all);
    }
    EXPECT_GT(first->all.size(), 1000U);
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

}  // namespace hidden_values_test
