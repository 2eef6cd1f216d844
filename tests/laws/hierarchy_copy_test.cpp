// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Copies of hierarchies, on every family and on lattices with padding; copies of solvers' grids are
// in solver_laws.hpp, those of hidden leaves in hidden_values_test.cpp.
#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>

#include "copied.hpp"
#include "families.hpp"

using namespace nestgrid_test;

namespace hierarchy_copy_test {

template <class Family>
class HierarchyCopies : public testing::Test {};
TYPED_TEST_SUITE(HierarchyCopies, Families);

TYPED_TEST(HierarchyCopies, AreDrawnAsTheOriginal) {
    using Grid = typename TypeParam::Grid;
    for_each_field_at_sphere<TypeParam>(3, 51, [](const Grid& grid, const NodalSamples& samples) {
        const NodeField<Grid, double> field(grid, samples.values);
        const auto hierarchy = erase(grid, field);
        expect_copied<Grid::dimension>(hierarchy, 0.01);
    });
}

/// Masked elements, new nodes at which none may stop, and faces on the boundary.
template <class Grid>
void expect_padded_copies(const Grid& grid, double isovalue) {
    std::vector<float> samples(grid.sample_count());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = std::sin(0.37F * static_cast<float>(i)) + 0.01F * static_cast<float>(i % 91);
    }
    const LatticeField field(grid, std::span<const float>(samples));
    const auto hierarchy = erase(grid, field);
    ASSERT_TRUE(hierarchy.offers(Feature::masked));
    expect_copied<Grid::dimension>(hierarchy, isovalue);
}

TEST(HierarchyCopies, KnowWhatIsPadded) {
    expect_padded_copies(LatticeOctree<3>({.samples = {14, 11, 9}}), 0.4);
    expect_padded_copies(LatticeOctree<2>({.samples = {21, 18}}), 0.4);
    expect_padded_copies(LatticeBisection<3>({.samples = {14, 11, 9}}), 0.4);
    expect_padded_copies(LatticeBisection<2>({.samples = {21, 18}}), 0.4);
}

/// A field that has no value at the first new node of any element.
class IncompleteField {
public:
    using value_type = double;
    using Grid = OctreeGrid<3>;

    IncompleteField(const Grid& grid, const std::vector<double>& values) : values_(grid, values) {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return values_.coarse_values(i, out);
    }
    NodeMask new_values(const Grid::Element& e, NodeMask which, std::span<double> out,
                        Grid::Context& context) const {
        return values_.new_values(e, which, out, context) | (which & 1U);
    }

private:
    NodeField<Grid, double> values_;
};

TEST(HierarchyCopies, MissTheSameValues) {
    OctreeGrid<3> grid(hexahedra(1));
    refine_at_sphere(grid, 2);
    const std::vector<double> values(grid.node_count(), 1.0);
    const IncompleteField field(grid, values);
    const auto hierarchy = erase(grid, field);
    const HierarchyCopy copy(hierarchy);
    EXPECT_THROW(isosurface<3>(Prerolls(hierarchy), 0.5), GridError);
    EXPECT_THROW(isosurface<3>(Prerolls(copy), 0.5), GridError);
}

TEST(HierarchyCopies, TakeTheMemoryThatTheyTell) {
    OctreeGrid<3> grid(hexahedra(1));
    refine_at_sphere(grid, 5);
    const std::vector<double> values(grid.node_count(), 1.0);
    const NodeField<OctreeGrid<3>, double> field(grid, values);
    const HierarchyCopy copy(erase(grid, field));
    const double split = static_cast<double>(grid.leaf_count() - 1) / 7;
    const double words = 3 + 27 + 8;
    const double told = 4 * words * split + 32.0 * static_cast<double>(values.size());
    EXPECT_NEAR(static_cast<double>(copy.memory_bytes()) / told, 1, 0.01);
}

}  // namespace hierarchy_copy_test
