// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Times between frames on one grid (paper, section 5.3), on every family.
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <walk/project.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "for_each_split.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace time_test {

const std::vector<double> four_times{0, 1, 2.5, 3};

/// Several frames on a grid, with their prerolls.
template <class Grid, class Real>
class Frames {
public:
    using Field = NodeField<Grid, Real>;

    Frames(const Grid& grid, const std::vector<NodalSamples>& samples) : grid_{&grid} {
        for (const NodalSamples& s : samples)
            values_.emplace_back(s.values.begin(), s.values.end());
        for (const auto& v : values_) fields_.emplace_back(grid, v);
        for (const Field& f : fields_) indicators_.emplace_back(grid, f);
    }
    Frames(const Frames&) = delete;
    Frames& operator=(const Frames&) = delete;

    const Grid& grid() const { return *grid_; }
    std::size_t count() const { return fields_.size(); }
    const Field& field(std::size_t i) const { return fields_[i]; }
    const HierarchicalIndicator& indicator(std::size_t i) const { return indicators_[i]; }
    Between<Field> between(std::span<const float> weights) const {
        std::vector<const Field*> all;
        for (const Field& f : fields_) all.push_back(&f);
        return Between<Field>(all, weights);
    }
    KeyFrames key_frames(std::span<const float> weights) const {
        std::vector<const HierarchicalIndicator*> all;
        for (const HierarchicalIndicator& i : indicators_) all.push_back(&i);
        return {all, weights};
    }

private:
    const Grid* grid_;
    std::vector<std::vector<Real>> values_;
    std::vector<Field> fields_;
    std::vector<HierarchicalIndicator> indicators_;
};

/// Linear, cubic and arbitrary weights of four frames.
std::vector<std::vector<float>> some_weights(std::mt19937& random) {
    std::vector<std::vector<float>> weights;
    weights.push_back(linear_weights(four_times, 3 * uniform(random)));
    weights.push_back(catmull_rom_weights(four_times, 3 * uniform(random)));
    weights.push_back({0.5F, -1.0F / 3, 0.0F, 1.25F});
    auto& any = weights.emplace_back();
    for (int i = 0; i < 4; ++i) any.push_back(static_cast<float>(2 * uniform(random) - 1));
    return weights;
}

/// Calls test(frames, random) for refined grids of a family and four of the catching fields each.
template <class Family, class Real = double, class Test>
void for_each_four_frames(int levels, unsigned seed, Test&& test) {
    std::mt19937 random(seed);
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, levels * Family::steps);
        const auto fields = catching_fields(grid.node_positions(), seed);
        for (std::size_t first = 0; first < fields.size(); first += 3) {
            std::vector<NodalSamples> four;
            for (std::size_t i = 0; i < 4; ++i) four.push_back(fields[(first + i) % fields.size()]);
            SCOPED_TRACE(four[0].name + " to " + four[3].name);
            const Frames<typename Family::Grid, Real> frames(grid, four);
            test(frames, random);
        }
    }
}

// Indicators and bounds.

template <class Family>
class Time : public testing::Test {};
TYPED_TEST_SUITE(Time, Families);

/// eta at every corner of a split element is at least eta at all its new nodes, and eta is at least
/// the offset of U(t) up to rounding.
template <class Real, class Frames>
void expect_full_condition(const Frames& frames, std::span<const float> weights) {
    const auto field = frames.between(weights);
    const KeyFrames indicator = frames.key_frames(weights);
    const auto hierarchy = erase(frames.grid(), field);
    std::size_t broken = 0;
    std::size_t wrong_masks = 0;
    std::size_t below = 0;
    for_each_split<Real>(
        hierarchy, indicator.hanging(),
        [&](const auto& view, const auto& split, std::span<const NodeKey> keys,
            const Real* values) {
            const std::size_t corners = view.corner_count();
            const double epsilon = indicator.stop(split.keys.back());
            const NodeMask mask = indicator.stops_at_most(*split.rule, split.keys, epsilon);
            for (std::size_t n = 0; n < split.keys.size(); ++n) {
                const double stop = indicator.stop(split.keys[n]);
                wrong_masks += ((mask >> n & 1U) != 0) == (stop <= epsilon) ? 0U : 1U;
                for (const NodeKey corner : keys.first(corners)) {
                    broken += indicator.stop(corner) >= stop ? 0U : 1U;
                }
                const Real mean =
                    nestgrid::detail::interpolate(split.rule->new_nodes[n], values, 1);
                const double offset =
                    std::abs(static_cast<double>(values[corners + n]) - static_cast<double>(mean));
                below += offset <= stop + indicator.rounding() ? 0U : 1U;
            }
        });
    EXPECT_EQ(broken, 0U);
    EXPECT_EQ(wrong_masks, 0U);
    EXPECT_EQ(below, 0U);
}

TYPED_TEST(Time, HasTheFullConditionAtEverySplit) {
    for_each_four_frames<TypeParam>(3, 2, [](const auto& frames, std::mt19937& random) {
        for (const auto& w : some_weights(random)) expect_full_condition<double>(frames, w);
    });
    for_each_four_frames<TypeParam, float>(2, 3, [](const auto& frames, std::mt19937& random) {
        for (const auto& w : some_weights(random)) expect_full_condition<float>(frames, w);
    });
}

/// On every element, U(t) at all nodes created in it, at any depth, stays within the values at the
/// corners and the bound, to the last bit.
template <class Real, class Frames>
void expect_bounds(const Frames& frames, std::span<const float> weights) {
    struct Range {
        double low;
        double high;
    };
    const auto field = frames.between(weights);
    const KeyFrames bounds = frames.key_frames(weights);
    std::vector<Range> around;  // of the elements on the way down
    std::size_t beyond = 0;
    for_each_split<Real>(
        erase(frames.grid(), field), bounds.hanging(),
        [&](const auto& view, const auto& split, std::span<const NodeKey>, const Real* values) {
            const std::size_t corners = view.corner_count();
            const auto [low, high] = std::minmax_element(values, values + corners);
            const double bound = bounds.bound(*split.rule, split.keys);
            around.resize(static_cast<std::size_t>(view.level));
            around.push_back(
                {static_cast<double>(*low) - bound, static_cast<double>(*high) + bound});
            for (std::size_t n = 0; n < split.keys.size(); ++n) {
                const auto value = static_cast<double>(values[corners + n]);
                for (const Range& range : around) {
                    beyond += range.low <= value && value <= range.high ? 0U : 1U;
                }
                EXPECT_LE(bounds.least(), value);
                EXPECT_GE(bounds.greatest(), value);
            }
        });
    EXPECT_EQ(beyond, 0U);
}

TYPED_TEST(Time, KeepsWithinItsBounds) {
    for_each_four_frames<TypeParam>(3, 4, [](const auto& frames, std::mt19937& random) {
        for (const auto& w : some_weights(random)) expect_bounds<double>(frames, w);
    });
    for_each_four_frames<TypeParam, float>(3, 5, [](const auto& frames, std::mt19937& random) {
        for (const auto& w : some_weights(random)) expect_bounds<float>(frames, w);
    });
}

// Surfaces.

template <class Frames>
auto surface_at(const Frames& frames, std::span<const float> weights, double threshold,
                double isovalue = 0) {
    const KeyFrames indicator = frames.key_frames(weights);
    return isosurface(frames.grid(), frames.between(weights), isovalue, under(indicator, threshold),
                      {.verify = true});
}

TYPED_TEST(Time, DrawsClosedSurfacesAndSlices) {
    for_each_four_frames<TypeParam>(3, 6, [](const auto& frames, std::mt19937& random) {
        for (const auto& weights : some_weights(random)) {
            for (const double threshold : {0.0, 0.01, 0.1, 0.5}) {
                expect_closed(surface_at(frames, weights, threshold).surface);
                if constexpr (TypeParam::Grid::dimension == 3) {
                    const KeyFrames indicator = frames.key_frames(weights);
                    const Plane plane({0.4, 0.5, 0.49}, {0.3, 0.5, 0.81});
                    const Slice slice = nestgrid::slice(frames.grid(), frames.between(weights),
                                                        plane, under(indicator, threshold));
                    expect_closed(slice.surface);
                }
            }
        }
    });
}

/// Rounding alone decides which side of the isovalue a node is on.
TYPED_TEST(Time, DrawsClosedSurfacesOfFloats) {
    for_each_four_frames<TypeParam, float>(3, 7, [](const auto& frames, std::mt19937& random) {
        for (const auto& weights : some_weights(random)) {
            for (const double threshold : {0.0, 1e-7, 0.05}) {
                expect_closed(surface_at(frames, weights, threshold).surface);
            }
        }
    });
}

/// On surfaces U(t) on the finest grid is within the error bound of the isovalue.
TYPED_TEST(Time, KeepsWithinTheErrorBoundOfSurfaces) {
    for_each_four_frames<TypeParam>(3, 8, [](const auto& frames, std::mt19937& random) {
        for (const auto& weights : some_weights(random)) {
            for (const double threshold : {0.01, 0.1}) {
                const auto result = surface_at(frames, weights, threshold);
                const auto field = frames.between(weights);
                const auto probed = probe(frames.grid(), field, result.surface.vertices);
                double worst = 0;
                for (std::size_t v = 0; v < probed.level.size(); ++v) {
                    if (probed.found(v)) worst = std::max(worst, std::abs(probed.values[v]));
                }
                EXPECT_LE(worst, result.error_bound + 1e-5);
            }
        }
    });
}

TYPED_TEST(Time, IsAFrameAtItsTimeToTheLastBit) {
    for_each_four_frames<TypeParam>(3, 9, [](const auto& frames, std::mt19937&) {
        for (std::size_t i = 0; i < frames.count(); ++i) {
            const auto weights = linear_weights(four_times, four_times[i]);
            const HierarchicalIndicator& own = frames.indicator(i);
            const KeyFrames indicator = frames.key_frames(weights);
            EXPECT_EQ(indicator.least(), own.least());
            EXPECT_EQ(indicator.greatest(), own.greatest());
            for (const double threshold : {0.0, 0.02, 0.3}) {
                const IsosurfaceOptions options{.verify = true};
                const auto expected =
                    isosurface(frames.grid(), frames.field(i), 0.0, under(own, threshold), options);
                const auto drawn = surface_at(frames, weights, threshold);
                expect_same_simplices(drawn.surface, expected.surface);
                EXPECT_EQ(drawn.error_bound, expected.error_bound);
            }
        }
    });
}

/// Two frames that are equal have the same grid at every time.
TYPED_TEST(Time, LeavesFramesThatAreEqualAsTheyAre) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        for (const NodalSamples& samples : catching_fields(grid.node_positions(), 10)) {
            SCOPED_TRACE(samples.name);
            const Frames<typename TypeParam::Grid, float> frames(grid, {samples, samples});
            const auto still = surface_at(frames, std::array{1.0F, 0.0F}, 0.05);
            for (const double t : {0.1, 1.0 / 3, 0.5, 0.777}) {
                const auto weights = linear_weights(std::array{0.0, 1.0}, t);
                const KeyFrames indicator = frames.key_frames(weights);
                for_each_split<float>(
                    erase(grid, frames.field(0)), indicator.hanging(),
                    [&](const auto&, const auto&, std::span<const NodeKey> keys, const float*) {
                        for (const NodeKey key : keys) {
                            EXPECT_EQ(indicator.stop(key), frames.indicator(0).stop(key));
                        }
                    });
                expect_same(surface_at(frames, weights, 0.05).surface, still.surface);
            }
        }
    }
}

/// P_S U(t) at the nodes of the adaptive grid.
template <class Grid, class Field>
std::map<NodeKey, double> projection(const Grid& grid, const Field& field,
                                     const Criterion& criterion, const Bounds& bounds) {
    std::map<NodeKey, double> values;
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.keys = true}, bounds.hanging());
    engine::project(walk, criterion, [&](const engine::ElementView<double>& view) {
        std::array<NodeKey, max_corners> keys{};
        walk.corners(view, keys.data(), nullptr);
        for (std::size_t i = 0; i < view.corner_count(); ++i) {
            const auto [at, is_new] = values.emplace(keys[i], view.value[i]);
            EXPECT_EQ(at->second, view.value[i]) << "two elements disagree about a node";
        }
    });
    return values;
}

/// While S stays, P_S U(t) changes by at most the change of the weights times the values.
TYPED_TEST(Time, MovesTheProjectionContinuously) {
    for_each_four_frames<TypeParam>(3, 11, [](const auto& frames, std::mt19937& random) {
        const double t = 0.1 + 2.8 * uniform(random);
        const auto before = catmull_rom_weights(four_times, t);
        const auto after = catmull_rom_weights(four_times, t + 1e-4);
        double modulus = 1e-12;
        for (std::size_t i = 0; i < frames.count(); ++i) {
            const HierarchicalIndicator& own = frames.indicator(i);
            modulus += static_cast<double>(std::abs(after[i] - before[i])) *
                       std::max(std::abs(own.least()), std::abs(own.greatest()));
        }
        const KeyFrames indicator = frames.key_frames(before);
        const Threshold s(&indicator, 0.05);
        const auto earlier = projection(frames.grid(), frames.between(before), s, indicator);
        const auto later = projection(frames.grid(), frames.between(after), s, indicator);
        ASSERT_EQ(earlier.size(), later.size());
        for (const auto& [key, value] : earlier) {
            EXPECT_LE(std::abs(later.at(key) - value), modulus);
        }
    });
}

TYPED_TEST(Time, DoesNotDependOnThreads) {
    for_each_four_frames<TypeParam>(3, 12, [](const auto& frames, std::mt19937& random) {
        for (const auto& weights : some_weights(random)) {
            const KeyFrames indicator = frames.key_frames(weights);
            const Threshold s(&indicator, 0.03);
            const auto alone =
                isosurface(frames.grid(), frames.between(weights), 0.0, under(s, indicator));
            const auto threaded = isosurface(frames.grid(), frames.between(weights), 0.0,
                                             under(s, indicator), {}, {ThreadExecutor(3)});
            expect_same(threaded.surface, alone.surface);
            EXPECT_EQ(threaded.error_bound, alone.error_bound);
        }
    });
}

/// A new time needs no preroll: weights that are set anew are those that were there from the start.
TYPED_TEST(Time, IsSetAnewWithoutAPreroll) {
    for_each_four_frames<TypeParam>(2, 13, [](const auto& frames, std::mt19937& random) {
        KeyFrames indicator = frames.key_frames(std::array{1.0F, 0.0F, 0.0F, 0.0F});
        auto field = frames.between(std::array{1.0F, 0.0F, 0.0F, 0.0F});
        for (const auto& weights : some_weights(random)) {
            indicator.set_weights(weights);
            field.set_weights(weights);
            expect_same(
                isosurface(frames.grid(), field, 0.0, under(indicator, 0.02), {.verify = true}),
                surface_at(frames, weights, 0.02));
        }
    });
}

// Refusals.

struct TwoGrids {
    OctreeGrid<3> coarse{hexahedra(1)};
    OctreeGrid<3> fine{hexahedra(1)};
    TwoGrids() {
        refine_at_sphere(coarse, 2);
        refine_at_sphere(fine, 2);
        fine.adapt([](const Leaf&) { return Mark::refine; });
    }
    static std::vector<NodalSamples> zeros(const OctreeGrid<3>& grid) {
        return {{"zeros", std::vector<double>(grid.node_count(), 0.0), false}};
    }
};

TEST(KeyFrames, RefuseFramesOfSeveralGrids) {
    const TwoGrids grids;
    const Frames<OctreeGrid<3>, double> a(grids.coarse, TwoGrids::zeros(grids.coarse));
    const Frames<OctreeGrid<3>, double> b(grids.fine, TwoGrids::zeros(grids.fine));
    const auto sentence = refusal<GridError>([&] {
        KeyFrames({&a.indicator(0), &b.indicator(0)}, std::array{0.5F, 0.5F});
    });
    EXPECT_NE(sentence.find("is not of the grid of frame 0"), std::string::npos) << sentence;
}

TEST(KeyFrames, RefuseWeightsThatDoNotFit) {
    const TwoGrids grids;
    const Frames<OctreeGrid<3>, double> a(grids.coarse, TwoGrids::zeros(grids.coarse));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto try_both = [&](const std::vector<float>& weights, const std::string& part) {
        expect_refused([&] { a.key_frames(weights); }, part);
        expect_refused([&] { a.between(weights); }, part);
    };
    try_both({0.5F, 0.5F}, "1 frames need as many weights, not 2");
    try_both({nan}, "not a finite number");
    try_both({std::numeric_limits<float>::infinity()}, "not a finite number");
    expect_refused([] { KeyFrames({}, {}); }, "no frames");
}

TEST(KeyFrames, RefuseValuesBetweenFramesThatAreNoNumbers) {
    OctreeGrid<3> grid(hexahedra(1));
    grid.adapt([](const Leaf&) { return Mark::refine; });
    std::vector<NodalSamples> samples = TwoGrids::zeros(grid);
    samples.push_back(samples[0]);
    samples[1].values.back() = 1e37;
    const Frames<OctreeGrid<3>, float> frames(grid, samples);
    EXPECT_NO_THROW(surface_at(frames, std::array{0.0F, 1.0F}, 0.0, 0.5));
    expect_refused(
        [&] {
            surface_at(frames, std::array{0.0F, 1e9F}, 0.0, 0.5);
        },
        "may be no usable number, as great as 9999999");
}

// Volumes, which offer gradients and rows of values.

template <class Grid>
class TimeOfVolumes : public testing::Test {};
using Volumes = testing::Types<LatticeBisection<3>, LatticeOctree<3>>;
TYPED_TEST_SUITE(TimeOfVolumes, Volumes);

template <class Grid>
struct VolumeFrames {
    Samples n{17, 17, 17};
    Grid grid{{.samples = n}};
    std::vector<SampledField> data = sampled_fields(n);
    LatticeField<Grid, float> first{grid, std::span<const float>(data[0].values)};
    LatticeField<Grid, float> second{grid, std::span<const float>(data[1].values)};
    HierarchicalIndicator first_indicator{grid, first};
    HierarchicalIndicator second_indicator{grid, second};

    auto between(std::span<const float> weights) const {
        return Between<LatticeField<Grid, float>>({&first, &second}, weights);
    }
    KeyFrames key_frames(std::span<const float> weights) const {
        return {{&first_indicator, &second_indicator}, weights};
    }
};

/// The samples of U(t), computed beforehand, give the same field, gradients included.
TYPED_TEST(TimeOfVolumes, AreThoseOfTheirSamples) {
    const VolumeFrames<TypeParam> frames;
    for (const double t : {0.25, 0.6, 1.0}) {
        const auto weights = linear_weights(std::array{0.0, 1.0}, t);
        std::vector<float> sums;
        for (std::size_t i = 0; i < frames.data[0].values.size(); ++i) {
            sums.push_back(static_cast<float>(
                static_cast<double>(weights[0]) * static_cast<double>(frames.data[0].values[i]) +
                static_cast<double>(weights[1]) * static_cast<double>(frames.data[1].values[i])));
        }
        const LatticeField<TypeParam, float> expected(frames.grid, std::span<const float>(sums));
        const auto field = frames.between(weights);
        const HierarchicalIndicator own(frames.grid, expected);
        const HierarchicalIndicator by_rows(frames.grid, field);
        const KeyFrames indicator = frames.key_frames(weights);
        std::size_t different = 0;
        std::size_t looser = 0;
        for (std::size_t node = 0; node < own.node_count(); ++node) {
            const auto key = static_cast<NodeKey>(node);
            different += own.stop(key) == by_rows.stop(key) && own.bound(key) == by_rows.bound(key)
                             ? 0U
                             : 1U;
            looser += own.stop(key) > 1.01 * (indicator.stop(key) + indicator.rounding()) ? 1U : 0U;
        }
        EXPECT_EQ(different, 0U);
        EXPECT_EQ(looser, 0U);
        const IsosurfaceOptions options{.normals = true};
        const Threshold s(&indicator, 0.02);
        const auto drawn = isosurface(frames.grid, field, 0.4, under(s, indicator), options);
        const auto same = isosurface(frames.grid, expected, 0.4, under(s, indicator), options);
        expect_closed(drawn.surface);
        expect_same_bits(drawn.surface.vertices, same.surface.vertices, "vertices");
        ASSERT_EQ(drawn.surface.normals.size(), same.surface.normals.size());
        for (std::size_t v = 0; v < drawn.surface.normals.size(); ++v) {
            EXPECT_GT(dot(drawn.surface.normals[v], same.surface.normals[v]), 1 - 1e-4);
        }
    }
}

}  // namespace time_test
