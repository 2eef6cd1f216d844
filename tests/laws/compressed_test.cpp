// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compressed values are the values, on every family and under every saturated criterion.
#include <bit>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/compressed_field.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/check_grid.hpp>
#include <walk/for_each_element.hpp>
#include <walk/hanging_nodes.hpp>

#include "copied.hpp"
#include "families.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace compressed_test {

template <class Family>
class Compressed : public testing::Test {};
TYPED_TEST_SUITE(Compressed, Families);

/// Prerolls and surfaces are equal to the last bit at every threshold.
TYPED_TEST(Compressed, IsTheFieldBitForBit) {
    using Grid = typename TypeParam::Grid;
    for_each_field_at_sphere<TypeParam>(3, 31, [](const Grid& grid, const NodalSamples& samples) {
        const NodeField<Grid, double> field(grid, samples.values);
        const CompressedValues<double> values(erase(grid, field));
        const CompressedField<Grid, double> decoded(grid, values);
        const HierarchicalIndicator a(grid, field, Spread{.factor = 1.5});
        const HierarchicalIndicator b(grid, decoded, Spread{.factor = 1.5});
        EXPECT_EQ(a.least(), b.least());
        EXPECT_EQ(a.greatest(), b.greatest());
        for (const double epsilon : {0.0, 0.01, 0.1}) {
            const auto plain = isosurface(grid, field, 0.0, under(a, epsilon));
            expect_same(isosurface(grid, decoded, 0.0, under(b, epsilon)).surface, plain.surface);
            const auto blended = isosurface(grid, field, 0.0, under(Blended(&a, epsilon, 1.5), a));
            expect_same(isosurface(grid, decoded, 0.0, under(Blended(&b, epsilon, 1.5), b)).surface,
                        blended.surface);
        }
        expect_copied<Grid::dimension>(erase(grid, decoded), 0.0);
    });
}

/// Errors of levels do not add up.
TYPED_TEST(Compressed, IsWithinHalfAStep) {
    using Grid = typename TypeParam::Grid;
    for_each_field_at_sphere<TypeParam>(3, 32, [](const Grid& grid, const NodalSamples& samples) {
        const NodeField<Grid, double> field(grid, samples.values);
        for (const double step : {0.1, 0.003}) {
            const CompressedValues<double> values(erase(grid, field), {.step = step});
            const CompressedField<Grid, double> decoded(grid, values);
            const auto plain = erase(grid, field);
            const auto packed = erase(grid, decoded);
            const HangingNodes hanging = engine::find_hanging_nodes(plain);
            const engine::Walk<double> walk(plain, {.values = true, .keys = true}, &hanging);
            std::map<NodeKey, double> expected;
            const auto each = [](const engine::Walk<double>& w, auto&& function) {
                engine::for_each_element(w, false, [&](const auto& view, const auto&) {
                    std::array<NodeKey, max_corners> keys{};
                    w.corners(view, keys.data(), nullptr);
                    for (std::size_t k = 0; k < view.corner_count(); ++k) {
                        function(keys[k], view.value[k]);
                    }
                });
            };
            each(walk, [&](NodeKey node, double value) { expected[node] = value; });
            const engine::Walk<double> other(packed, {.values = true, .keys = true}, &hanging);
            each(other, [&](NodeKey node, double value) {
                EXPECT_LE(std::abs(value - expected.at(node)), step / 2 * (1 + 1e-9));
            });
        }
    });
}

TYPED_TEST(Compressed, PassesCheckGrid) {
    using Grid = typename TypeParam::Grid;
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 2 * TypeParam::steps);
        const auto samples = sample_nodes(grid, [](const Point& x) { return std::sin(9 * x[0]); });
        const NodeField<Grid, double> field(grid, samples);
        const CompressedValues<double> values(erase(grid, field));
        const CompressedField<Grid, double> decoded(grid, values);
        const auto violation = check_grid(grid, decoded);
        EXPECT_FALSE(violation) << (violation ? violation->sentence : "");
    }
}

template <class Grid>
void expect_samples_come_back(int n) {
    const Grid grid({.samples = {n, n, n}});
    for (const SampledField& data : sampled_fields({n, n, n})) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const CompressedValues<float> values(erase(grid, field));
        const CompressedField<Grid, float> decoded(grid, values);
        const HierarchicalIndicator a(grid, field);
        const HierarchicalIndicator b(grid, decoded);
        for (const double part : {0.0, 0.02}) {
            const double epsilon = part * data.range;
            expect_same_simplices(
                isosurface(grid, decoded, data.isovalue, under(b, epsilon)).surface,
                isosurface(grid, field, data.isovalue, under(a, epsilon)).surface);
            const Plane plane({n / 3.0, n / 3.0, n / 3.0}, {1, 2, 3});
            expect_same_simplices(slice(grid, decoded, plane, under(b, epsilon)).surface,
                                  slice(grid, field, plane, under(a, epsilon)).surface);
        }
    }
}

TEST(Compressed, SamplesComeBack) {
    expect_samples_come_back<LatticeOctree<3>>(17);
    expect_samples_come_back<LatticeBisection<3>>(17);
    expect_samples_come_back<LatticeOctree<3>>(14);
}

/// All bits of numbers, whatever they mean: negative zeros, denormalised numbers, all exponents.
TEST(Compressed, KeepsEveryBit) {
    std::mt19937 random(33);
    const int n = 9;
    std::vector<float> samples(static_cast<std::size_t>(n * n * n));
    for (float& value : samples) {
        do {
            value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        } while (!(std::abs(value) < 1e37F));
    }
    samples[100] = -0.0F;
    samples[101] = std::numeric_limits<float>::denorm_min();
    const LatticeOctree<3> grid({.samples = {n, n, n}});
    const LatticeField field(grid, std::span<const float>(samples));
    const CompressedValues<float> values(erase(grid, field));
    const CompressedField<LatticeOctree<3>, float> decoded(grid, values);
    const auto hierarchy = erase(grid, decoded);
    const engine::Walk<float> walk(hierarchy, {.values = true, .keys = true});
    const auto bits_of = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    std::size_t different = 0;
    engine::for_each_element(walk, false, [&](const auto& view, const auto&) {
        std::array<NodeKey, max_corners> keys{};
        walk.corners(view, keys.data(), nullptr);
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            const float stored = samples[static_cast<std::size_t>(keys[k])];
            different += bits_of(stored) != bits_of(view.value[k]) ? 1 : 0;
        }
    });
    EXPECT_EQ(different, 0U);
}

/// Integers are multiples of the step 1, and come back as they were in fewer bits than they took.
TEST(Compressed, IntegersTakeFewBits) {
    const int n = 65;
    std::vector<float> samples = sample({n, n, n}, distance_to_centre);
    for (float& value : samples) value = std::round(250 * value);
    const LatticeOctree<3> grid({.samples = {n, n, n}});
    const LatticeField field(grid, std::span<const float>(samples));
    const CompressedValues<float> values(erase(grid, field), {.step = 1});
    EXPECT_LT(values.memory_bytes(), samples.size());
    const CompressedField<LatticeOctree<3>, float> decoded(grid, values);
    const HierarchicalIndicator a(grid, field);
    const HierarchicalIndicator b(grid, decoded);
    expect_same(isosurface(grid, decoded, 80.5, under(b, 0)).surface,
                isosurface(grid, field, 80.5, under(a, 0)).surface);
}

TEST(Compressed, RefusesWhatCannotBeDecoded) {
    const LatticeOctree<3> grid({.samples = {5, 5, 5}});
    std::vector<float> samples(125, 1);
    const LatticeField field(grid, std::span<const float>(samples));
    expect_refused([&] { CompressedValues<float>(erase(grid, field), {.step = -1}); }, "step");
    const CompressedValues<float> values(erase(grid, field));
    const CompressedField<LatticeOctree<3>, float> decoded(grid, values);
    const HierarchicalIndicator indicator(grid, decoded);
    const auto insists = Unsaturated(Threshold(&indicator, 0.1));
    expect_refused([&] { isosurface(grid, decoded, 0.5, under(insists, indicator)); },
                   "not saturated");
    samples[62] = std::numeric_limits<float>::infinity();
    expect_refused([&] { CompressedValues<float>(erase(grid, field), {.step = 1}); }, "multiples");
}

}  // namespace compressed_test
