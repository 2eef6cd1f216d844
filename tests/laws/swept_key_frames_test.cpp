// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators other than offsets between frames on one grid (paper, section 5.3), on every family.
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/swept_key_frames.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "for_each_split.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace swept_key_frames_test {

constexpr std::array three_times{0.0, 1.0, 2.5};

using MakeIndicator = std::function<SweptIndicator(const Hierarchy<double>&)>;
const std::vector<std::pair<std::string, MakeIndicator>> seminorms{
    {"numerical", [](const Hierarchy<double>& h) { return numerical_indicator(h); }},
    {"wavelet", [](const Hierarchy<double>& h) { return wavelet_indicator(h); }},
    {"numerical, spread",
     [](const Hierarchy<double>& h) {
         return numerical_indicator(h, {.spread = {.factor = 1.5, .slope = 0.01}});
     }},
};

/// Three frames on a grid, with an indicator and a preroll of each.
template <class Grid>
struct ThreeFrames {
    using Field = NodeField<Grid, double>;

    const Grid* grid;
    std::vector<Field> fields;
    std::vector<SweptIndicator> swept;
    std::vector<HierarchicalIndicator> offsets;

    ThreeFrames(const Grid& on, const std::vector<const std::vector<double>*>& values,
                const MakeIndicator& make)
        : grid{&on} {
        for (const auto* v : values) fields.emplace_back(on, *v);
        for (const Field& f : fields) {
            swept.push_back(make(erase(on, f)));
            offsets.emplace_back(on, f);
        }
    }
    template <class All>
    static auto pointers(const All& all) {
        std::vector<const typename All::value_type*> to;
        for (const auto& each : all) to.push_back(&each);
        return to;
    }
    Between<Field> between(std::span<const float> weights) const {
        return {pointers(fields), weights};
    }
    SweptKeyFrames at(std::span<const float> weights) const { return {pointers(swept), weights}; }
};

/// Calls test(frames, make, random) for refined grids of a family, some fields and each indicator.
template <class Family, class Test>
void for_each_three_frames(unsigned seed, Test&& test) {
    std::mt19937 random(seed);
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, 2 * Family::steps);
        const auto fields = catching_fields(grid.node_positions(), seed);
        for (std::size_t first = 0; first + 2 < fields.size(); first += 4) {
            for (const auto& [name, make] : seminorms) {
                SCOPED_TRACE(name + " of " + fields[first].name + " to " + fields[first + 2].name);
                const ThreeFrames<typename Family::Grid> frames(
                    grid,
                    {&fields[first].values, &fields[first + 1].values, &fields[first + 2].values},
                    make);
                test(frames, make, random);
            }
        }
    }
}

std::vector<std::vector<float>> some_weights(std::mt19937& random) {
    return {linear_weights(three_times, 2.5 * uniform(random)),
            catmull_rom_weights(three_times, 2.5 * uniform(random)),
            {0.5F, -1.0F / 3, 1.25F}};
}

/// Calls met(keys of the corners, keys of the new nodes) for every split of one frame.
template <class Frames, class Met>
void for_each_split_of(const Frames& frames, const Met& met) {
    for_each_split<double>(
        erase(*frames.grid, frames.fields[0]), frames.offsets[0].hanging(),
        [&](const auto& view, const auto& split, std::span<const NodeKey> keys, const double*) {
            met(keys.first(view.corner_count()), split.keys);
        });
}

template <class Family>
class SweptTime : public testing::Test {};
TYPED_TEST_SUITE(SweptTime, Families);

TYPED_TEST(SweptTime, IsSaturatedAndNotBelowTheIndicatorOfTheTime) {
    for_each_three_frames<TypeParam>(11, [](const auto& frames, const auto& make, auto& random) {
        for (const auto& weights : some_weights(random)) {
            const auto field = frames.between(weights);
            const SweptIndicator anew = make(erase(*frames.grid, field));
            const SweptKeyFrames at = frames.at(weights);
            // Each generation rounds a number of the indicator made anew up by at most 2^-7 of it.
            const double rounded_down = std::pow(1 + 0x1p-7, -frames.offsets[0].generations() - 1);
            const Spread spread = at.spread();
            std::size_t broken = 0;
            std::size_t below = 0;
            for_each_split_of(
                frames, [&](std::span<const NodeKey> corners, std::span<const NodeKey> made) {
                    for (const NodeKey node : made) {
                        const double stop = at.stop(node);
                        below += stop + 1e-12 >= rounded_down * anew.stop(node) ? 0 : 1;
                        for (const NodeKey corner : corners) {
                            broken += at.stop(corner) >= spread.factor * stop ? 0 : 1;
                        }
                    }
                });
            EXPECT_EQ(broken, 0U);
            EXPECT_EQ(below, 0U);
        }
    });
}

TYPED_TEST(SweptTime, IsThatOfAFrameAtItsTimeAndOfStillDataAtEveryTime) {
    for_each_three_frames<TypeParam>(12, [](const auto& frames, const auto&, auto& random) {
        const auto expect_same = [&](const SweptKeyFrames& at, const SweptIndicator& frame) {
            std::size_t different = 0;
            for_each_split_of(frames, [&](std::span<const NodeKey>, std::span<const NodeKey> made) {
                for (const NodeKey n : made) different += at.stop(n) != frame.stop(n);
            });
            EXPECT_EQ(different, 0U);
        };
        for (std::size_t i = 0; i < 3; ++i) {
            expect_same(frames.at(linear_weights(three_times, three_times[i])), frames.swept[i]);
        }
        const SweptIndicator* const still = &frames.swept[1];
        expect_same({{still, still, still}, linear_weights(three_times, 2.5 * uniform(random))},
                    *still);
    });
}

TYPED_TEST(SweptTime, DrawsClosedSurfacesWithinTheirBounds) {
    for_each_three_frames<TypeParam>(13, [](const auto& frames, const auto&, auto& random) {
        for (const auto& weights : some_weights(random)) {
            const SweptKeyFrames at = frames.at(weights);
            const KeyFrames bounds(frames.pointers(frames.offsets), weights);
            for (const double threshold : {0.0, 0.05, 0.4}) {
                const auto drawn =
                    isosurface(*frames.grid, frames.between(weights), 0.0,
                               under(Threshold(&at, threshold), bounds), {.verify = true});
                expect_closed(drawn.surface);
            }
        }
    });
}

TEST(SweptTime, RefusesWhatIsNoFrames) {
    EXPECT_EQ(refusal<InvalidInput>([] { SweptKeyFrames({}, {}); }),
              "there are no frames to interpolate between");
    const LatticeBisection<2> grid({.samples = {5, 5}});
    const std::vector<float> values(25, 1.0F);
    const LatticeField field(grid, std::span<const float>(values));
    const SweptIndicator indicator = numerical_indicator({grid, field});
    const std::array<float, 2> two{0.5F, 0.5F};
    const std::array<float, 1> none{std::numeric_limits<float>::quiet_NaN()};
    EXPECT_NE(refusal<InvalidInput>([&] { SweptKeyFrames({&indicator}, two); }), "");
    EXPECT_NE(refusal<InvalidInput>([&] { SweptKeyFrames({&indicator}, none); }), "");
}

}  // namespace swept_key_frames_test
