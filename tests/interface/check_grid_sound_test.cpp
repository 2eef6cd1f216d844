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

/// Adds a last bit in some elements, as a solver does that rounds in each.
class RoundedField {
public:
    using value_type = double;

    explicit RoundedField(const Forest<3>& forest) : exact_(forest, wave) {}
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return exact_.coarse_values(i, out);
    }
    NodeMask new_values(const Forest<3>::Element& e, NodeMask which, std::span<double> out) const {
        const NodeMask missing = exact_.new_values(e, which, out);
        for (double& value : out) value = std::nextafter(value, e % 2 == 0 ? 10.0 : -10.0);
        return missing;
    }

private:
    ForestField<3> exact_;
};

TEST(CheckGrid, TellsBothValuesOfANodeAndTakesATolerance) {
    std::mt19937 random(1);
    Forest<3> forest = boxes<3>(random, 2);
    refine_randomly(forest, random, 40);
    const RoundedField field(forest);
    const auto violation = check_grid(forest, field);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->law, Law::value_unique);
    double one = 0;
    double other = 0;
    ASSERT_EQ(
        std::sscanf(violation->sentence.c_str(),
                    "the field gives one node two values, %lf and %lf: as node", &one, &other),
        2)
        << violation->sentence;
    EXPECT_NE(one, other);
    EXPECT_NEAR(one, other, 1e-14);
    EXPECT_FALSE(check_grid(forest, field, {.node_value_tolerance = 1e-14}));
}

/// A square whose corners are numbered around.
class AroundSquare : public Forest<2> {
public:
    explicit AroundSquare(Forest<2> forest) : Forest<2>(std::move(forest)) {}
    CoarseElement<Element> coarse(std::size_t i) const {
        CoarseElement<Element> result = Forest<2>::coarse(i);
        std::swap(result.corners[2], result.corners[3]);
        std::swap(result.ids[2], result.ids[3]);
        return result;
    }
};

TEST(CheckGrid, SaysHowCornersAreNumbered) {
    Forest<2> forest;
    for (const double y : {0.0, 1.0}) {
        for (const double x : {0.0, 1.0}) forest.add_node({x, y, 0});
    }
    forest.add_coarse(Shape::quadrilateral, {0, 1, 2, 3}, 1);
    const AroundSquare square(forest);
    const auto violation = check_grid(square, ForestField<2>(square, wave));
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->law, Law::coarse_element);
    EXPECT_NE(violation->sentence.find("tensor order"), std::string::npos) << violation->sentence;
}

/// Coarse elements that count their ids themselves.
class Islands : public Forest<3> {
public:
    explicit Islands(Forest<3> forest) : Forest<3>(std::move(forest)) {}
    CoarseElement<Element> coarse(std::size_t i) const {
        CoarseElement<Element> result = Forest<3>::coarse(i);
        for (std::size_t k = 0; k < 8; ++k) result.ids[k] = 8 * i + k;
        return result;
    }
};

TEST(CheckGrid, NotesCoarseCornersAtOnePlaceWithDifferentIds) {
    std::mt19937 random(1);
    const Forest<3> forest = boxes<3>(random, 2);
    const Islands islands(forest);
    const ForestField<3> field(forest, wave);
    std::vector<std::string> notes;
    CheckOptions options;
    options.notes = &notes;
    const auto note = [&] { return notes.back(); };
    EXPECT_FALSE(check_grid(forest, field, options));
    EXPECT_EQ(note().find("different ids"), std::string::npos) << note();
    EXPECT_FALSE(check_grid(islands, field, options));
    EXPECT_NE(note().find("different ids at 19 of 27 places"), std::string::npos) << note();
    const std::string sentence = note();
    options.one_id_a_place = true;
    EXPECT_FALSE(check_grid(forest, field, options));
    const auto violation = check_grid(islands, field, options);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->law, Law::coarse_ids);
    EXPECT_EQ(violation->sentence, sentence);
}

}  // namespace
