// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// No point inside is lost on grids of every family whose new nodes lie beside the means of their
// parents, and in elements that are hard to invert.
#include <cmath>

#include "bent_grid.hpp"
#include "curved.hpp"
#include "families.hpp"
#include "probe_laws.hpp"

using namespace nestgrid_test;

namespace probe_inside_test {

template <class Family>
class ProbesInside : public testing::Test {};
TYPED_TEST_SUITE(ProbesInside, Families);

TYPED_TEST(ProbesInside, LoseNoPointOfACurvedGrid) {
    for (auto& straight : TypeParam::grids()) {
        refine_at_sphere(straight, 3 * TypeParam::steps);
        // Off the plane of bent surfaces in space a linear function has no one value.
        if (straight.node_positions().front()[2] != 0 && TypeParam::Grid::dimension == 2) continue;
        expect_no_point_lost(Bent<typename TypeParam::Grid>(straight), 10'000, 1);
    }
}

/// Unbalanced: level 0 beside level 3, nodes that hang on nodes that hang.
TEST(ProbesInsideCases, LoseNoPointBesideMuchFinerElements) {
    std::mt19937 random(3);
    for (int i = 0; i < 3; ++i) {
        Forest<3> forest = boxes<3>(random, 2);
        refine_randomly(forest, random, 80);
        expect_no_point_lost(CurvedGrid(forest), 20'000, 2);
    }
}

/// A point of a valid element is found though Newton's method from the middle ends elsewhere.
TEST(ProbesInsideCases, ElementsThatAreHardToInvert) {
    std::mt19937 random(4);
    for (const Shape shape :
         {Shape::quadrilateral, Shape::pyramid, Shape::prism, Shape::hexahedron}) {
        const Topology& t = topology(shape);
        std::size_t lost = 0;
        std::size_t tried = 0;
        for (int i = 0; i < 2000; ++i) {
            std::vector<Point> corners(t.reference.begin(), t.reference.begin() + t.corners);
            for (Point& x : corners) {
                for (std::size_t d = 0; d < std::size_t(t.dimension); ++d) {
                    x[d] += 0.9 * (uniform(random) - 0.5);
                }
            }
            const engine::InverseMap map(shape, corners);
            for (int k = 0; k < 5; ++k) {
                std::array<double, max_corners> weight{};
                double sum = 0;
                for (std::size_t c = 0; c < t.corners; ++c) sum += weight[c] = uniform(random);
                Point s{0, 0, 0};
                for (std::size_t c = 0; c < t.corners; ++c) {
                    s = s + weight[c] / sum * t.reference[c];
                }
                const Point x = engine::place_of(shape, corners, s);
                Point found;
                ++tried;
                if (!map.find(x, 1e-9, found) ||
                    !(norm(engine::place_of(shape, corners, found) - x) < 1e-9)) {
                    ++lost;
                }
            }
        }
        EXPECT_EQ(lost, 0U) << t.name << ", of " << tried;
    }
}

}  // namespace probe_inside_test
