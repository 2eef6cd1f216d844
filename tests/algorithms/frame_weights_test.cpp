// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Weights of frames at a time between them (paper, section 5.3).
#include <cmath>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/frame_weights.hpp>

#include "closedness.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace frame_weights_test {

const std::vector<double> four_times{0, 1, 2.5, 3};

TEST(FrameWeights, AddUpToOneAndFollowLines) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<double> times{-1 + uniform(random)};
        const std::size_t count = 1 + random() % 6;
        while (times.size() < count) times.push_back(times.back() + 0.01 + uniform(random));
        const double t = times.front() + uniform(random) * (times.back() - times.front());
        for (const auto& weights : {linear_weights(times, t), catmull_rom_weights(times, t)}) {
            ASSERT_EQ(weights.size(), times.size());
            double sum = 0;
            double mean = 0;
            for (std::size_t i = 0; i < count; ++i) {
                sum += static_cast<double>(weights[i]);
                mean += static_cast<double>(weights[i]) * times[i];
            }
            EXPECT_EQ(sum, 1);
            EXPECT_NEAR(mean, t, 6 * 0x1p-22 * (times.back() - times.front() + 1));
        }
    }
}

TEST(FrameWeights, AreThoseOfAFrameAtItsTime) {
    for (std::size_t i = 0; i < 4; ++i) {
        std::vector<float> expected(4, 0.0F);
        expected[i] = 1;
        EXPECT_EQ(linear_weights(four_times, four_times[i]), expected);
        EXPECT_EQ(catmull_rom_weights(four_times, four_times[i]), expected);
    }
    EXPECT_EQ(catmull_rom_weights(std::vector{2.0}, 2), std::vector{1.0F});
}

/// Between equal intervals the cubic ones are those of Catmull and Rom, and quadratic functions of
/// time are followed inside.
TEST(FrameWeights, AreThoseOfCatmullAndRomInTheMiddle) {
    const std::vector<double> times{0, 1, 2, 3};
    const std::vector<float> expected{-0.0625F, 0.5625F, 0.5625F, -0.0625F};
    EXPECT_EQ(catmull_rom_weights(times, 1.5), expected);
    for (const double t : {1.1, 1.37, 1.9}) {
        const auto weights = catmull_rom_weights(times, t);
        double square = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            square += static_cast<double>(weights[i]) * times[i] * times[i];
        }
        EXPECT_NEAR(square, t * t, 1e-5);
    }
}

TEST(FrameWeights, AreRefusedOutsideAndForDisorder) {
    for (const auto& weights : {linear_weights, catmull_rom_weights}) {
        expect_refused([&] { weights(std::vector<double>{}, 0); }, "no frames");
        expect_refused([&] { weights(four_times, -0.1); }, "does not lie between");
        expect_refused([&] { weights(four_times, std::nan("")); }, "does not lie between");
        expect_refused([&] { weights(std::vector<double>{0, 1, 1}, 0.5); }, "ascend");
        expect_refused([&] { weights(std::vector<double>{0, std::nan(""), 1}, 0.5); }, "ascend");
        expect_refused([&] { weights(std::vector<double>{-1e308, 1e308}, 0.5); }, "finite");
    }
}

}  // namespace frame_weights_test
