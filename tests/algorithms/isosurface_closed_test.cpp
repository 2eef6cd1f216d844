// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces on bisection are closed, oriented manifolds at every threshold, for every field and
// every dimension; and the two numbers per node are both needed for it.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "sample_fields.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace isosurface_closed_test {

void expect_closed(const SurfaceReport& report) {
    EXPECT_EQ(report.open_edges, 0U);
    EXPECT_EQ(report.nonmanifold_edges, 0U);
    EXPECT_EQ(report.misoriented_edges, 0U);
    EXPECT_EQ(report.nonmanifold_vertices, 0U);
    EXPECT_EQ(report.degenerate_triangles, 0U);
}

std::string dimensions_name(const Samples& n) {
    return std::to_string(n[0]) + "x" + std::to_string(n[1]) + "x" + std::to_string(n[2]);
}

class ClosedSurface : public testing::TestWithParam<Samples> {};

TEST_P(ClosedSurface, AtEveryThreshold) {
    const Samples n = GetParam();
    const LatticeBisection<3> grid({.samples = n});
    for (const SampledField& data : sampled_fields(n)) {
        const LatticeField field(grid, std::span<const float>(data.values));
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : thresholds) {
            SCOPED_TRACE(data.name + " at " + std::to_string(threshold));
            const auto result =
                isosurface(grid, field, data.isovalue, under(indicator, threshold * data.range),
                           {.verify = true});
            const SurfaceReport report = surface_report(result.surface);
            EXPECT_GT(report.triangles, 0U);
            EXPECT_EQ(report.boundary_edges, result.surface.boundary.size());
            expect_closed(report);
        }
    }
}

TEST_P(ClosedSurface, CappedEnclosesTheRegionAboveTheIsovalue) {
    const Samples n = GetParam();
    const LatticeBisection<3> grid({.samples = n});
    const double total = double(n[0] - 1) * (n[1] - 1) * (n[2] - 1);
    for (SampledField data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        double volume = 0;
        for (const int sign : {1, -1}) {  // the region and what it leaves
            for (float& v : data.values) v = static_cast<float>(sign) * v;
            // Half a step beside the integers, so that no node belongs to both.
            const double isovalue = sign * (data.isovalue - (data.range > 1 ? 0.25 : 0));
            const LatticeField field(grid, std::span<const float>(data.values));
            const auto result =
                isosurface(grid, field, isovalue, {.threshold = 0.01}, {.cap = true});
            const SurfaceReport report = surface_report(result.surface);
            expect_closed(report);
            EXPECT_TRUE(report.closed());
            EXPECT_GT(report.volume, 0);
            volume += report.volume;
            for (float& v : data.values) v = static_cast<float>(sign) * v;
        }
        EXPECT_NEAR(volume, total, 1e-4 * total);
    }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, ClosedSurface,
                         testing::Values(Samples{33, 33, 33}, Samples{17, 22, 30},
                                         Samples{3, 40, 19}, Samples{36, 5, 3}),
                         [](const auto& test) { return dimensions_name(test.param); });

/// The indicator with its stopping number in the place of the bound.
class StopAsBound final : public Bounds {
public:
    explicit StopAsBound(const HierarchicalIndicator& good) : good_{&good} {}

    double offset_bound(NodeKey node) const override { return good_->offset_bound(node); }
    double bound(const Rule&, std::span<const NodeKey> nodes) const override {
        double largest = 0;
        for (const NodeKey node : nodes) largest = std::max(largest, good_->stop(node));
        return largest;
    }
    const HangingNodes* hanging() const override { return good_->hanging(); }
    bool made_for(std::uint64_t epoch) const override { return good_->made_for(epoch); }

private:
    const HierarchicalIndicator* good_;
};

TEST(Bound, StoppingNumberInItsPlaceOpensHolesInNoise) {
    const Samples n{65, 65, 65};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[3];
    ASSERT_EQ(data.name, "noise");
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field);
    const auto sound = isosurface(grid, field, data.isovalue, under(indicator, 0));
    const auto holed = isosurface(grid, field, data.isovalue,
                                  under(Threshold{&indicator, 0}, StopAsBound{indicator}), {});
    EXPECT_EQ(surface_report(sound.surface).open_edges, 0U);
    EXPECT_LT(holed.surface.simplices.size(), sound.surface.simplices.size());
    EXPECT_GT(surface_report(holed.surface).open_edges, 0U);
}

/// The offsets before saturation: each node's own.
class OwnOffsets final : public Indicator, public Bounds {
public:
    OwnOffsets(const LatticeBisection<3>& grid,
               const LatticeField<LatticeBisection<3>, float>& field,
               const HierarchicalIndicator& good)
        : good_{&good}, offset_(grid.node_count(), 0.0) {
        grid.for_each_star_row([&](const StarRow& row) {
            for (std::size_t i = 0; !row.parents.empty() && i < row.count; ++i) {
                const std::size_t node = row.first + i * row.stride;
                const auto value = [&](std::ptrdiff_t offset) {
                    std::array<float, 1> at{};
                    field.row_values(node + static_cast<std::size_t>(offset), row.stride, at);
                    return double{at[0]};
                };
                offset_[node] =
                    std::abs(value(0) - (value(row.parents[0]) + value(row.parents[1])) / 2);
            }
        });
    }
    double stop(NodeKey node) const override { return offset_[static_cast<std::size_t>(node)]; }
    bool saturated() const override { return false; }
    double offset_bound(NodeKey node) const override { return stop(node); }
    double bound(const Rule& rule, std::span<const NodeKey> nodes) const override {
        return good_->bound(rule, nodes);
    }
    const HangingNodes* hanging() const override { return nullptr; }
    bool made_for(std::uint64_t epoch) const override { return good_->made_for(epoch); }

private:
    const HierarchicalIndicator* good_;
    std::vector<double> offset_;
};

TEST(Saturation, WithoutItAGyroidIsLostWhole) {
    const Samples n{33, 33, 33};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data{"gyroid",
                            sample(n,
                                   [](double x, double y, double z) {
                                       const double k = 8 * 3.14159265358979;
                                       return std::sin(k * x) * std::cos(k * y) +
                                              std::sin(k * y) * std::cos(k * z) +
                                              std::sin(k * z) * std::cos(k * x);
                                   }),
                            0.5, 3};
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field);
    const OwnOffsets offsets(grid, field, indicator);
    const double threshold = 1e-4;  // the centre of the cube is interpolated to rounding
    const auto sound = isosurface(grid, field, data.isovalue, under(indicator, threshold));
    const Threshold unsaturated{&offsets, threshold};
    const auto lost =
        isosurface(grid, field, data.isovalue, under(Unsaturated{unsaturated}, offsets));
    EXPECT_THROW(isosurface(grid, field, data.isovalue, under(unsaturated, offsets)), InvalidInput);
    EXPECT_GT(sound.surface.simplices.size(), 10000U);
    EXPECT_EQ(lost.surface.simplices.size(), 0U);
}

}  // namespace isosurface_closed_test
