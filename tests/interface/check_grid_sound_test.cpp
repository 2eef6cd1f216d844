// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// check_grid raises no alarm on a thousand sound grids.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/check_grid.hpp>

#include "forest.hpp"

using namespace nestgrid_test;

namespace {

double wave(const Point& x) { return std::sin(3 * x[0]) + std::cos(2 * x[1] + x[2]); }

template <class Grid, class Field>
void expect_sound(const Grid& grid, const Field& field) {
    const auto violation = check_grid(grid, field);
    EXPECT_FALSE(violation) << violation->sentence;
}

template <int dim>
void expect_sound_forest(Forest<dim> forest, std::mt19937& random) {
    refine_randomly(forest, random, 5 + static_cast<int>(random() % 60));
    expect_sound(forest, ForestField<dim>(forest, wave));
}

TEST(CheckGrid, IsSilentOnSoundForests) {
    for (unsigned seed = 0; seed < 130; ++seed) {
        std::mt19937 random(seed);
        expect_sound_forest(boxes<2>(random, 1 + seed % 3), random);
        expect_sound_forest(boxes<3>(random, 1 + seed % 2), random);
        expect_sound_forest(kuhn<2>(2), random);
        expect_sound_forest(kuhn<3>(3), random);
        expect_sound_forest(kuhn<3>(0), random);
    }
}

TEST(CheckGrid, IsSilentOnLattices) {
    for (unsigned seed = 0; seed < 175; ++seed) {
        std::mt19937 random(seed);
        const auto size = [&] { return 2 + static_cast<int>(random() % 8); };
        const LatticeBisection<3> volume({.samples = {size(), size(), size()},
                                          .spacing = {0.5, -0.25, 3},
                                          .origin = {7, 0.1, -3},
                                          .block_levels = static_cast<int>(random() % 4)});
        std::vector<std::uint8_t> bytes(volume.sample_count());
        for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
        expect_sound(volume, LatticeField(volume, std::span<const std::uint8_t>(bytes)));
        const LatticeBisection<2> image({.samples = {3 * size(), size()}});
        std::vector<double> reals(image.sample_count());
        for (auto& v : reals) v = double(random());
        expect_sound(image, LatticeField(image, std::span<const double>(reals)));
    }
}

}  // namespace
