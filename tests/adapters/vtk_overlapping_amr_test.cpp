// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK's overlapping AMR in place: the boxes, values and surfaces of the blocks it was made of.
#include <gtest/gtest.h>

#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>

#include <nestgrid/adapters/vtk_overlapping_amr.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "block_samples.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"

using namespace nestgrid_test;

namespace vtk_overlapping_amr_test {

double ball(const Point& x) { return norm(x - Point{0.5, 0.45, 0.4}) - 0.3; }

using HasData = std::function<bool(unsigned level, unsigned block)>;
bool everywhere(unsigned, unsigned) { return true; }

/// Blocks as VTK has them, with two components: the number of the cell, and a function where cells
/// are leaves.
/// \param has_data whether a block of a level has them
vtkNew<vtkOverlappingAMR> amr_of(const Blocks<3>& blocks, const HasData& has_data = everywhere) {
    vtkNew<vtkOverlappingAMR> amr;
    std::vector<int> counts;
    for (const auto& level : blocks.levels) counts.push_back(static_cast<int>(level.boxes.size()));
    amr->Initialize(static_cast<int>(counts.size()), counts.data());
    amr->SetGridDescription(VTK_XYZ_GRID);
    const CellsOfBlocks<3> cells(blocks);
    Point spacing = blocks.spacing;
    Cell<3> begin = blocks.levels[0].boxes[0].lower;
    for (const BlockBox<3>& box : blocks.levels[0].boxes) {
        for (std::size_t d = 0; d < 3; ++d) begin[d] = std::min(begin[d], box.lower[d]);
    }
    Point origin = blocks.origin;
    for (std::size_t d = 0; d < 3; ++d) origin[d] -= begin[d] * spacing[d];
    amr->SetOrigin(origin.data());
    for (unsigned l = 0; l < counts.size(); ++l) {
        if (l > 0) spacing = (1.0 / blocks.levels[l].ratio[0]) * spacing;
        amr->SetSpacing(l, spacing.data());
        for (unsigned b = 0; b < blocks.levels[l].boxes.size(); ++b) {
            const BlockBox<3>& box = blocks.levels[l].boxes[b];
            amr->SetAMRBox(l, b, vtkAMRBox(box.lower.data(), box.upper.data()));
            if (!has_data(l, b)) continue;
            vtkNew<vtkUniformGrid> grid;
            grid->SetSpacing(spacing.data());
            std::array<int, 3> points{};
            Point low{};
            for (std::size_t d = 0; d < 3; ++d) {
                points[d] = box.upper[d] - box.lower[d] + 2;
                low[d] = origin[d] + box.lower[d] * spacing[d];
            }
            grid->SetOrigin(low.data());
            grid->SetDimensions(points.data());
            vtkNew<vtkDoubleArray> values;
            values->SetName("ball");
            values->SetNumberOfComponents(2);
            for_each_cell(box, [&](const Cell<3>& c) {
                const double value = cells.is_leaf(l, c) ? ball(cells.centre(l, c))
                                                         : std::numeric_limits<double>::quiet_NaN();
                values->InsertNextTuple2(static_cast<double>(values->GetNumberOfTuples()), value);
            });
            grid->GetCellData()->AddArray(values);
            amr->SetDataSet(l, b, grid);
        }
    }
    return amr;
}

TEST(VtkOverlappingAmr, HasTheSurfacesOfItsBlocks) {
    for (unsigned seed = 1; seed < 6; ++seed) {
        const Blocks<3> blocks = random_blocks<3>({.seed = seed, .side = 6});
        const auto amr = amr_of(blocks);
        const BlockGrid<3> grid(vtk_blocks<3>(*amr));
        const BlockCells<3, double> field(grid, vtk_block_arrays<3, double>(*amr, "ball", 1));
        const BlockGrid<3> expected_grid(blocks);
        const BlockData<3> data(blocks, ball);
        const BlockCells<3, double> expected(expected_grid, data.arrays());
        EXPECT_EQ(grid.epoch(), expected_grid.epoch());
        for (const double threshold : {0.0, 0.02}) {
            const auto found = isosurface(grid, field, 0, {.threshold = threshold});
            const auto wanted = isosurface(expected_grid, expected, 0, {.threshold = threshold});
            ASSERT_EQ(found.surface.simplices, wanted.surface.simplices);
            for (std::size_t v = 0; v < found.surface.vertices.size(); ++v) {
                ASSERT_LT(norm(found.surface.vertices[v] - wanted.surface.vertices[v]), 1e-12);
            }
        }
    }
}

/// As a reader leaves them that was told to read the first levels.
TEST(VtkOverlappingAmr, IsReadUpToTheLastLevelWithData) {
    const Blocks<3> blocks = random_blocks<3>({.seed = 3, .side = 6});
    ASSERT_EQ(blocks.levels.size(), 3U);
    EXPECT_EQ(vtk_blocks<3>(*amr_of(blocks)).levels.size(), 3U);
    const auto amr = amr_of(blocks, [](unsigned level, unsigned) { return level < 1; });
    EXPECT_EQ(vtk_blocks<3>(*amr).levels.size(), 1U);
    EXPECT_EQ((vtk_block_arrays<3, double>(*amr, "ball").size()), 1U);
}

TEST(VtkOverlappingAmr, IsRefusedWithASentence) {
    const Blocks<3> blocks = random_blocks<3>({.seed = 2, .side = 6});
    ASSERT_GT(blocks.levels[1].boxes.size(), 1U);
    ASSERT_GT(blocks.levels[0].boxes.size(), 1U);
    const auto amr = amr_of(blocks);
    const auto arrays = [&](const char* name, int component = 0) {
        return refusal([&] { vtk_block_arrays<3, double>(*amr, name, component); });
    };
    EXPECT_EQ(arrays("bal"), "block 0 of level 0 has no array 'bal' of its cells");
    EXPECT_EQ(arrays("ball", 2),
              "block 0 of level 0 has an array 'ball' of 2 components, without component 2");
    EXPECT_EQ(
        refusal([&] { vtk_block_arrays<3, float>(*amr, "ball"); }),
        "block 0 of level 0 has an array 'ball' of the type vtkDoubleArray, not of floats one "
        "behind the other");
    EXPECT_EQ(refusal([&] { vtk_blocks<2>(*amr); }),
              "the overlapping AMR does not lie in a plane across an axis");
    EXPECT_EQ(
        refusal([&] { vtk_blocks<3>(*amr_of(blocks, [](unsigned, unsigned) { return false; })); }),
        "the overlapping AMR has no data");
    vtkUniformGrid* const block = amr->GetDataSet(1, 0);
    std::array<int, 3> points{};
    block->GetDimensions(points.data());
    block->SetDimensions(points[0] + 1, points[1], points[2]);
    EXPECT_EQ(arrays("ball"), "block 0 of level 1 has " + std::to_string(points[0]) +
                                  " cells in direction 0, but its box " +
                                  std::to_string(points[0] - 1));
    block->SetDimensions(points.data());
    block->GetCellData()->GetArray("ball")->Resize(1);
    EXPECT_EQ(arrays("ball"),
              "block 0 of level 1 has an array 'ball' that is shorter than its cells");
    const double* const low = amr->GetDataSet(1, 1)->GetOrigin();
    amr->GetDataSet(1, 1)->SetOrigin(low[0] + 0.1, low[1], low[2]);
    EXPECT_EQ(refusal([&] { vtk_blocks<3>(*amr); }),
              "block 1 of level 1 does not lie in its box: it is of another level, or of another "
              "place");
    const auto but_one = [](unsigned l, unsigned b) { return l != 1 || b != 2; };
    EXPECT_EQ(refusal([&] { vtk_blocks<3>(*amr_of(blocks, but_one)); }),
              "block 2 of level 1 has no data, but other blocks of the level do");
}

}  // namespace vtk_overlapping_amr_test
