// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is a grid, what is not, and the two smallest adapters.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/check_grid.hpp>

#include "archetype.hpp"
#include "identity.hpp"
#include "sample_fields.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

struct NoSplit : ArchetypeGrid {
    void split() const = delete;
};
struct NoChildren : ArchetypeGrid {
    void children() const = delete;
};
struct NoCoarse : ArchetypeGrid {
    void coarse() const = delete;
};
struct NoCount : ArchetypeGrid {
    void coarse_count(int) const;
};
struct FourDimensions : ArchetypeGrid {
    static constexpr int dimension = 4;
};
struct IntegerValues : ArchetypeField {
    using value_type = int;
};
struct NoNewValues : ArchetypeField {
    void new_values() const = delete;
};

static_assert(!NestedGrid<NoSplit>);
static_assert(!NestedGrid<NoChildren>);
static_assert(!NestedGrid<NoCoarse>);
static_assert(!NestedGrid<NoCount>);
static_assert(!NestedGrid<FourDimensions>);
static_assert(!NestedGrid<int>);
static_assert(!NodalField<IntegerValues, ArchetypeGrid>);
static_assert(!NodalField<NoNewValues, ArchetypeGrid>);

/// Members whose constraints are not satisfied are not there.
template <bool has>
struct Constrained : ArchetypeGrid {
    bool conforming() const requires(has) { return true; }
    int masked() const requires(has) { return 0; }
};
static_assert(require_fitting_operations<Constrained<false>, ArchetypeField>());

struct Misspelt : ArchetypeGrid {
    bool conforming() const { return true; }
    void new_positons(const Element&, NodeMask, std::span<Point>) const {}
};

TEST(CheckGrid, NotesTheOptionalOperationsThatItFinds) {
    std::vector<std::string> notes;
    EXPECT_FALSE(check_grid(Misspelt{}, ArchetypeField{}, {.notes = &notes}));
    EXPECT_EQ(notes, (std::vector<std::string>{
                         "optional operations found in the grid: conforming",
                         "optional operations found in the field: none",
                     }));
}

/// Every operation that a lattice has is in the list, in the order of optional.hpp.
TEST(OfferedOperations, AreListed) {
    const Samples n{5, 5, 5};
    const LatticeBisection<3> grid({.samples = n});
    EXPECT_EQ(offered_operations(grid),
              (std::vector<std::string>{"corner_keys", "new_keys", "node_count", "corner_positions",
                                        "conforming", "masked", "outside", "boundary_faces",
                                        "for_each_star_row", "node_position", "max_corners",
                                        "max_children"}));
    const std::vector<float> values(125);
    const LatticeField field(grid, std::span<const float>(values));
    EXPECT_EQ(offered_field_operations<LatticeBisection<3>>(field),
              (std::vector<std::string>{"corner_gradients", "row_values"}));
}

TEST(Archetype, WorksWithEveryAlgorithm) {
    const ArchetypeGrid grid;
    const ArchetypeField field;
    EXPECT_FALSE(check_grid(grid, field));
    const HierarchicalIndicator indicator(grid, field);
    EXPECT_EQ(indicator.node_count(), 4U);
    EXPECT_EQ(indicator.greatest(), 4);
    EXPECT_EQ(isosurface(grid, field, 3.0, under(indicator, 0)).surface.simplices.size(), 2U);
    EXPECT_EQ(isosurface(grid, field, 3.0, under(indicator, 3)).surface.simplices.size(), 0U);
}

TEST(Identity, GivesTheSameSurfaceFromRequiredOperationsAlone) {
    const Samples n{9, 17, 17};  // no padding: the required operations know no domain
    const LatticeBisection<3> grid({.samples = n, .block_levels = 3});
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const IdentityGrid identity(grid);
        const IdentityField<LatticeBisection<3>, decltype(field)> same(identity, field);
        const HierarchicalIndicator offsets(grid, field);
        const HierarchicalIndicator same_offsets(identity, same);
        for (const double threshold : {0.0, 0.05}) {
            const IsosurfaceOptions options{.cap = true};
            const auto a =
                isosurface(grid, field, data.isovalue, under(offsets, threshold), options);
            const auto b =
                isosurface(identity, same, data.isovalue, under(same_offsets, threshold), options);
            EXPECT_EQ(a.surface.vertices, b.surface.vertices);
            EXPECT_EQ(a.surface.simplices, b.surface.simplices);
            EXPECT_EQ(a.surface.boundary, b.surface.boundary);
            EXPECT_EQ(a.counts.visited, b.counts.visited);
            EXPECT_EQ(a.error_bound, b.error_bound);
        }
        EXPECT_FALSE(check_grid(identity, same));
    }
}

}  // namespace
