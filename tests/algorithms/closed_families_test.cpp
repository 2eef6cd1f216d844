// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The promise: at any threshold, on any hierarchy, a level set has no open edge inside the domain.
#include <gtest/gtest.h>

#include <nestgrid/adapters/lattice.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <walk/walk.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace closed_families_test {

using namespace engine;

const std::vector<double> epsilons(six_thresholds.begin(), six_thresholds.end());

/// Inspects every element that is met, leaves too, for the level 0.
class Inspection final : public Visitor<double> {
public:
    using View = ElementView<double>;

    Inspection(const HierarchicalIndicator& indicator, double threshold)
        : indicator_{&indicator}, criterion_{&indicator, threshold} {}

    Decision inspect(const View& view, const Split& split) override {
        const std::span values(view.value, view.corner_count());
        const double bound =
            split.rule == nullptr ? 0.0 : indicator_->bound(*split.rule, split.keys);
        ++counts.calls;
        if (-std::ranges::max(values) > bound) return {Visit::skip};
        if (std::ranges::min(values) - std::nextafter(0.0, -1.0) > bound) return {Visit::skip};
        ++counts.visited;
        if (split.rule == nullptr) return {Visit::stop};
        const NodeMask stops =
            criterion_.holds({*split.rule, split.keys, view.level + 1, split.outside});
        return {stops == split.rule->all() ? Visit::stop : Visit::descend, stops};
    }
    void extract(const View&) override {}

    TraversalCounts counts;

private:
    const HierarchicalIndicator* indicator_;
    Threshold criterion_;
};

/// Leaves are not inspected one by one, but counted as if they were.
template <class Grid, class Field>
void expect_counts_of_inspection(const TraversalCounts& counts, const Grid& grid,
                                 const Field& field, const HierarchicalIndicator& indicator,
                                 double threshold) {
    Inspection inspection(indicator, threshold);
    const auto hierarchy = erase(grid, field);
    Walk<double>(hierarchy, {.keys = true}, indicator.hanging()).run(inspection);
    EXPECT_EQ(counts.calls, inspection.counts.calls);
    EXPECT_EQ(counts.visited, inspection.counts.visited);
}

/// Below an element no value lies further from those at its corners than the bound.
template <class Real>
struct Bounded final : Visitor<Real> {
    using View = ElementView<Real>;
    struct Above {
        NodeKey path;
        double least;
        double greatest;
        double bound;
    };
    const HierarchicalIndicator* indicator;
    std::vector<Above> above;
    std::size_t split = 0;
    std::size_t compared = 0;

    explicit Bounded(const HierarchicalIndicator& by) : indicator{&by} {}

    static bool lies_below(const View& view, const Above& element) {
        for (const View* at = view.father; at != nullptr; at = at->father) {
            if (at->path == element.path) return true;
        }
        return false;
    }
    Decision inspect(const View& view, const Split& of) override {
        while (!above.empty() && !lies_below(view, above.back())) above.pop_back();
        const std::span values(view.value, view.corner_count());
        const auto [least, greatest] = std::ranges::minmax(values);
        for (const Above& element : above) {
            EXPECT_LE(greatest - element.greatest, element.bound);
            EXPECT_LE(element.least - least, element.bound);
            ++compared;
        }
        if (of.rule != nullptr) {
            above.push_back({view.path, least, greatest, indicator->bound(*of.rule, of.keys)});
            ++split;
        }
        return {};
    }
    void extract(const View&) override {}
};

template <class Grid, class Field>
void expect_bounds_hold(const Grid& grid, const Field& field,
                        const HierarchicalIndicator& indicator) {
    using Real = typename Field::value_type;
    Bounded<Real> bounded(indicator);
    const auto hierarchy = erase(grid, field);
    const Needs all{.keys = true, .positions = true, .closed = true};  // for the paths
    Walk<Real>(hierarchy, all, indicator.hanging()).run(bounded);
    EXPECT_EQ(bounded.compared > 0, bounded.split > 0);
}

template <class Grid>
void expect_closed_at(const Grid& grid, const NodalSamples& samples,
                      const std::vector<double>& thresholds) {
    const NodeField<Grid, double> field(grid, samples.values);
    const HierarchicalIndicator indicator(grid, field);
    expect_bounds_hold(grid, field, indicator);
    for (const double threshold : thresholds) {
        for (const bool cap : {false, true}) {
            SCOPED_TRACE(samples.name + " at threshold " + std::to_string(threshold) +
                         (cap ? ", capped" : ""));
            const auto result = isosurface(grid, field, 0.0, under(indicator, threshold),
                                           {.cap = cap, .verify = true});
            expect_closed(result.surface, cap);
            if (!cap) {
                expect_counts_of_inspection(result.counts, grid, field, indicator, threshold);
            }
            if constexpr (Grid::dimension == 3) {
                if (samples.generic && !cap) {
                    EXPECT_EQ(surface_report(result.surface).degenerate_triangles, 0U);
                }
            }
        }
    }
}

template <class Family>
class ClosedLevelSets : public testing::Test {};
TYPED_TEST_SUITE(ClosedLevelSets, Families);

TYPED_TEST(ClosedLevelSets, OnUniformGrids) {
    for (auto& grid : TypeParam::grids()) {
        for (int i = 0; i < 2 * TypeParam::steps; ++i) {
            grid.adapt([](const Leaf&) { return Mark::refine; });
        }
        for (const NodalSamples& samples : catching_fields(grid.node_positions(), 1)) {
            expect_closed_at(grid, samples, epsilons);
        }
    }
}

TYPED_TEST(ClosedLevelSets, AroundASphere) {
    for_each_field_at_sphere<TypeParam>(3, 2, [](const auto& grid, const auto& samples) {
        expect_closed_at(grid, samples, epsilons);
    });
}

TYPED_TEST(ClosedLevelSets, OnRandomGridsWithDeepSpots) {
    std::mt19937 random(3);
    for (auto& grid : TypeParam::grids()) {
        const int steps = TypeParam::steps;
        refine_at_random(grid, random, 12 * steps, 6 * steps, 10, 1500);
        for (const NodalSamples& samples : catching_fields(grid.node_positions(), 4)) {
            expect_closed_at(grid, samples, {0, 0.1, 1});
        }
    }
}

/// Many small hierarchies with random values, about 10,000 over all families.
TYPED_TEST(ClosedLevelSets, OnSmallRandomGridsWithRandomValues) {
    std::mt19937 random(5);
    const auto grids = TypeParam::grids();
    for (int i = 0; i < 920 && !testing::Test::HasFailure(); ++i) {
        auto grid = grids[0];
        const int steps = TypeParam::steps;
        refine_at_random(grid, random, 1 + static_cast<int>(random() % 5) * steps, 5 * steps, 12,
                         80);
        NodalSamples samples{"case " + std::to_string(i), {}, false};
        const auto kind = random() % 3;
        for (std::size_t n = 0; n < grid.node_positions().size(); ++n) {
            const double r = uniform(random);
            samples.values.push_back(kind == 0   ? r - 0.5
                                     : kind == 1 ? std::floor(5 * r) - 2
                                                 : (std::floor(9 * r) - 4) * 0x1p-51);
        }
        expect_closed_at(grid, samples, {epsilons[random() % epsilons.size()]});
    }
}

/// Not stored at all: a saturated full octree over samples.
TEST(ClosedLevelSetsOfSamples, OnTheImplicitOctree) {
    for (const Samples& n : {Samples{17, 17, 17}, Samples{33, 33, 33}, Samples{14, 9, 20}}) {
        const LatticeOctree<3> grid({.samples = n});
        for (const SampledField& data : sampled_fields(n)) {
            const LatticeField field(grid, std::span<const float>(data.values));
            const HierarchicalIndicator indicator(grid, field);
            expect_bounds_hold(grid, field, indicator);
            for (const double threshold : thresholds) {
                for (const bool cap : {false, true}) {
                    SCOPED_TRACE(data.name + " at " + std::to_string(threshold));
                    const auto result = isosurface(grid, field, data.isovalue,
                                                   under(indicator, threshold * data.range),
                                                   {.cap = cap, .verify = true});
                    expect_closed(result.surface, cap);
                    EXPECT_GT(result.surface.simplices.size(), 0U);
                }
            }
        }
    }
}

}  // namespace closed_families_test
