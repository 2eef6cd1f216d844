// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Optional operations with other signatures than those of optional.hpp: each refused in English.
#include <nestgrid/check_grid.hpp>

#include "archetype.hpp"

using namespace nestgrid;
using nestgrid_test::ArchetypeField;
using nestgrid_test::ArchetypeGrid;

struct LacksMask : ArchetypeGrid {
    void new_positions(const Element&, std::span<Point>) const;
};
struct SaysYes : ArchetypeGrid {
    bool constrained(const Element&) const;
};
struct IsNoFunction : ArchetypeGrid {
    static constexpr bool conforming = true;
};
struct IsNotConst : ArchetypeGrid {
    NodeMask outside(const Element&);
};
struct HalfOfTheKeys : ArchetypeGrid {
    void new_keys(const Element&, std::span<NodeKey>) const;
};
struct OneParent : ArchetypeGrid {
    NodeKey hanging_parents(NodeKey) const;
};
struct CountsRows : ArchetypeGrid {
    void for_each_star_row(std::size_t) const;
};
struct OneGradient : ArchetypeField {
    Point corner_gradients(const ArchetypeGrid::Element&) const;
};

static_assert(require_fitting_operations<LacksMask, ArchetypeField>());
static_assert(require_fitting_operations<SaysYes, ArchetypeField>());
static_assert(require_fitting_operations<IsNoFunction, ArchetypeField>());
static_assert(require_fitting_operations<IsNotConst, ArchetypeField>());
static_assert(require_fitting_operations<HalfOfTheKeys, ArchetypeField>());
static_assert(require_fitting_operations<OneParent, ArchetypeField>());
static_assert(require_fitting_operations<CountsRows, ArchetypeField>());
static_assert(require_fitting_operations<ArchetypeGrid, OneGradient>());
