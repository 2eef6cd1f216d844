// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A value that is no number is refused with its place wherever it would be drawn, on every family.
#include <cmath>
#include <functional>
#include <limits>

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "families.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace unusable_values_test {

template <class Family>
class UnusableValues : public testing::Test {};
TYPED_TEST_SUITE(UnusableValues, Families);

TYPED_TEST(UnusableValues, AreRefusedWithTheirPlace) {
    using Grid = typename TypeParam::Grid;
    std::mt19937 random(41);
    for (Grid& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 2 * TypeParam::steps);
        const std::vector<Point> x = grid.node_positions();
        const HangingNodes hanging = derive_hanging_nodes(grid);
        for (int i = 0; i < 5; ++i) {
            std::vector<double> values = sample_nodes(grid, [](const Point& p) { return norm(p); });
            std::size_t node = 0;  // hanging ones have interpolants, whatever the field holds there
            do {
                node = random() % values.size();
            } while (hanging.contains(node));
            values[node] = i % 2 == 0 ? std::nan("") : std::numeric_limits<double>::infinity();
            const NodeField<Grid, double> field(grid, values);
            std::vector<std::function<void()>> uses{
                [&] { isosurface(grid, field, 0.5); },
                [&] { HierarchicalIndicator(grid, field, NodeError::deviation); },
                [&] {
                    norm_indicator({grid, field});
                },
                [&] {
                    numerical_indicator({grid, field});
                },
                [&] {
                    visual_indicator({grid, field});
                },
                [&] {
                    wavelet_indicator({grid, field});
                },
            };
            if constexpr (Grid::dimension == 2) {
                uses.push_back([&] { height_field(grid, field, 1.0); });
            } else {
                uses.push_back([&] { slice(grid, field, Plane{x[node], {0.3, 0.5, 0.7}}); });
            }
            for (std::size_t use = 0; use < uses.size(); ++use) {
                const std::string sentence = refusal(uses[use]);
                EXPECT_NE(sentence.find("not a usable number"), std::string::npos)
                    << use << sentence;
                // A node that hangs between others may be met first.
                constexpr bool conforms = requires { grid.conforming(); };
                const std::string place = conforms ? text_of(x[node]) : ")";
                EXPECT_NE(sentence.find(place + " in coarse element "), std::string::npos)
                    << use << sentence;
                EXPECT_EQ(sentence.find("component"), std::string::npos) << sentence;
            }
        }
    }
}

}  // namespace unusable_values_test
