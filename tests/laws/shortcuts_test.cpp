// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shortcuts of walks change nothing: plain thresholds decide as any other class of criteria with
// the same S, a threshold at which nothing stops is as good as none, sinks get the same triangles
// in batches, and a stored grid finds the same nodes with what it keeps of earlier questions.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>

#include "families.hpp"
#include "for_each_split.hpp"
#include "same_surface.hpp"

using namespace nestgrid_test;

namespace shortcuts_test {

constexpr double isovalue = 0;  // of all catching fields

/// A threshold that does not say that it is one.
class Disguised final : public Criterion {
public:
    explicit Disguised(const Threshold& threshold) : threshold_{threshold} {}
    NodeMask holds(const NewNodes& nodes) const override { return threshold_.holds(nodes); }
    bool saturated() const override { return threshold_.saturated(); }
    bool made_for(std::uint64_t epoch) const override { return threshold_.made_for(epoch); }

private:
    Threshold threshold_;
};

/// Corners of simplices behind each other, taken in parts alone, or in batches where there are any.
template <int dimension>
class Corners final : public SimplexSink<dimension> {
public:
    Corners(std::vector<double>& to, bool batches) : to_{&to}, batches_{batches} {}

    void take(const Surface<dimension>& part) override {
        for (const auto& simplex : part.simplices) {
            for (const auto vertex : simplex) add(part.vertices[vertex].data());
        }
    }
    bool takes_batches() const override { return batches_; }
    void take_batch(const SimplexBatch& batch) override {
        EXPECT_TRUE(batches_);
        for (const auto& simplex : batch.simplices) {
            for (int i = 0; i < dimension; ++i) add(batch.at(simplex[static_cast<std::size_t>(i)]));
        }
    }

private:
    void add(const double* x) { to_->insert(to_->end(), x, x + 3); }

    std::vector<double>* to_;
    bool batches_;
};

template <int dimension>
std::vector<double> corners(const Hierarchy<double>& h, const HierarchicalIndicator& indicator,
                            double threshold, bool batches) {
    std::vector<double> result;
    std::vector<Corners<dimension>> sinks;
    sinks.emplace_back(result, batches);
    extract_isosurfaces<dimension>(h, std::span<const double>(&isovalue, 1), std::move(sinks),
                                   under(Threshold{&indicator, threshold}, indicator));
    return result;
}

/// The simplices of a surface as the positions of their corners, sorted.
template <int dimension>
auto sorted_simplices(const Surface<dimension>& s) {
    std::vector<std::array<Point, static_cast<std::size_t>(dimension)>> simplices;
    for (const auto& simplex : s.simplices) {
        auto& of = simplices.emplace_back();
        for (std::size_t i = 0; i < of.size(); ++i) of[i] = s.vertices[simplex[i]];
        std::ranges::rotate(of, std::ranges::min_element(of));
    }
    std::ranges::sort(simplices);
    return simplices;
}

/// Samples of a family at a sphere, as a hierarchy with its indicator.
template <class Family, class Test>
void for_each_hierarchy(Test&& test) {
    for_each_field_at_sphere<Family>(3, 4, [&](const auto& grid, const NodalSamples& samples) {
        const NodeField<typename Family::Grid, double> field(grid, samples.values);
        const auto h = erase(grid, field);
        test(h, HierarchicalIndicator(h));
    });
}

template <class Family>
class Shortcuts : public testing::Test {};
TYPED_TEST_SUITE(Shortcuts, Families);

TYPED_TEST(Shortcuts, APlainThresholdDecidesAsAnyCriterion) {
    constexpr int dimension = TypeParam::Grid::dimension;
    for_each_hierarchy<TypeParam>([&](const auto& h, const auto& indicator) {
        for (const double threshold : {0.0, 0.02, 0.2, 0.7}) {
            if (threshold < indicator.least_stop()) continue;
            const Threshold plain(&indicator, threshold);
            const auto a = isosurface<dimension>(h, isovalue, under(plain, indicator));
            const auto b = isosurface<dimension>(h, isovalue, under(Disguised(plain), indicator));
            expect_same(a.surface, b.surface);
            EXPECT_EQ(a.counts.calls, b.counts.calls);
            EXPECT_EQ(a.counts.visited, b.counts.visited);
            EXPECT_EQ(a.error_bound, b.error_bound);
        }
    });
}

TYPED_TEST(Shortcuts, NoElementStopsBelowTheLeastStop) {
    constexpr int dimension = TypeParam::Grid::dimension;
    for_each_hierarchy<TypeParam>([&](const auto& h, const auto& indicator) {
        double least = std::numeric_limits<double>::infinity();
        for_each_split<double>(
            h, indicator.hanging(),
            [&](const auto& view, const engine::Split&, std::span<const NodeKey> keys, auto) {
                double greatest = 0;
                for (const NodeKey node : keys.subspan(view.corner_count())) {
                    greatest = std::max(greatest, indicator.stop(node));
                }
                if (keys.size() > view.corner_count()) least = std::min(least, greatest);
            });
        EXPECT_LE(indicator.least_stop(), least);
        EXPECT_EQ(indicator.least_stop() > 0, least > 0);
        for (const double threshold : {0.0, least / 2, std::nextafter(least, 0)}) {
            if (!(threshold < indicator.least_stop())) continue;
            const Threshold below(&indicator, threshold);
            const auto once = isosurface<dimension>(h, isovalue, under(below, indicator));
            const auto twice =
                isosurface<dimension>(h, isovalue, under(Disguised(below), indicator));
            EXPECT_EQ(sorted_simplices(once.surface), sorted_simplices(twice.surface));
            EXPECT_EQ(once.counts.extracted, twice.counts.extracted);
        }
    });
}

TYPED_TEST(Shortcuts, SinksTakeTheSameTrianglesInBatches) {
    constexpr int dimension = TypeParam::Grid::dimension;
    for_each_hierarchy<TypeParam>([&](const auto& h, const auto& indicator) {
        for (const double threshold : {0.0, 0.02, 0.2}) {
            const auto in_parts = corners<dimension>(h, indicator, threshold, false);
            const auto batches = corners<dimension>(h, indicator, threshold, true);
            expect_same_bits(in_parts, batches, "corners");
        }
    });
}

template <class Grid>
void collect(const Grid& grid, const typename Grid::Element& e,
             std::vector<typename Grid::Element>& to) {
    const Rule* const rule = grid.split(e);
    if (rule == nullptr) return;
    to.push_back(e);
    auto context = grid.make_context();
    std::vector<typename Grid::Element> children(rule->children.size());
    grid.children(e, children, context);
    for (const auto& child : children) collect(grid, child, to);
}

TYPED_TEST(Shortcuts, AStoredGridFindsNodesWhateverItKeeps) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        std::vector<typename TypeParam::Grid::Element> elements;
        for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
            collect(grid, grid.coarse(i).element, elements);
        }
        std::mt19937 random(5);
        auto kept = grid.make_context();
        for (std::size_t i = 0; i < 4 * elements.size(); ++i) {
            const auto& e = elements[random() % elements.size()];
            auto fresh = grid.make_context();
            ASSERT_TRUE(std::ranges::equal(grid.new_nodes(e, kept), grid.new_nodes(e, fresh)));
        }
    }
}

}  // namespace shortcuts_test
