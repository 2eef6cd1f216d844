// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What changed is refused: whatever was made for a grid, and is used after the grid was refined,
// says so in a sentence, on every family.
#include <functional>

#include <nestgrid/adapters/union.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/discontinuous.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/probe.hpp>

#include "families.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace changed_grid_test {

template <class Family>
class ChangedGrids : public testing::Test {};
TYPED_TEST_SUITE(ChangedGrids, Families);

TYPED_TEST(ChangedGrids, AreRefusedByWhatWasMadeForThem) {
    using Grid = typename TypeParam::Grid;
    using Field = NodeField<Grid, double>;
    const auto f = [](const Point& x) { return x[0] + x[1] * x[1] - 0.4; };
    for (Grid& grid : TypeParam::grids()) {
        const std::vector<double> values = sample_nodes(grid, f);
        const Field field(grid, values);
        const auto hierarchy = erase(grid, field);
        const HierarchicalIndicator indicator(grid, field);
        const CellAverages averages(grid, [](const ElementOf<Grid>&) { return 1.0; });
        const auto one = [](const ElementOf<Grid>&) { return 1.0; };
        const DiscontinuousData jumping(grid, one);
        const auto coarse = grid.coarse_grid().element(0);  // the middle of this element
        std::vector<Point> points(1);
        for (const std::uint32_t node : coarse) {
            points[0] = points[0] + (1.0 / double(coarse.size())) * grid.coarse_grid().nodes[node];
        }
        refine_at_sphere(grid, 1);
        const std::vector<double> finer_values = sample_nodes(grid, f);
        const Field finer(grid, finer_values);
        const std::vector<std::pair<const char*, std::function<void()>>> uses{
            {"field", [&] { HierarchicalIndicator(grid, field); }},
            {"field, probed", [&] { probe(grid, field, points); }},
            {"averages", [&] { HierarchicalIndicator(grid, averages); }},
            {"hierarchy", [&] { probe<double>(hierarchy, points); }},
            {"hierarchy, for a preroll", [&] { HierarchicalIndicator{hierarchy}; }},
            {"preroll", [&] { isosurface(grid, finer, 0.1, Exact{}, indicator); }},
            {"preroll, probed", [&] { probe(grid, finer, points, Exact{}, indicator); }},
            {"data that jump", [&] { probe(jumping, points); }},
        };
        for (const auto& [name, use] : uses) {
            const std::string sentence = refusal<GridError>(use);
            EXPECT_NE(sentence.find("changed since"), std::string::npos) << name << sentence;
        }
        EXPECT_NO_THROW(probe(grid, finer, points));
    }
}

TEST(ChangedGridCases, UnionsRefuseChangedSides) {
    OctreeGrid<3> grid(hexahedra(2));
    OctreeGrid<3> other(hexahedra(2));
    refine_at_sphere(other, 2);
    const auto one = [](const Point&) { return 1.0; };
    const std::vector<double> values = sample_nodes(grid, one);
    const std::vector<double> other_values = sample_nodes(other, one);
    const NodeField<OctreeGrid<3>, double> field(grid, values);
    const NodeField<OctreeGrid<3>, double> other_field(other, other_values);
    const Union both(grid, field, other, other_field);
    refine_at_sphere(other, 1);
    auto context = both.make_context();
    EXPECT_EQ(refusal<GridError>([&] { both.coarse(0, context); }),
              "the grid has changed since the union was made for it: make another one");
}

}  // namespace changed_grid_test
