// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Generating the C tables of nestgrid.h from any model of NestedGrid and NodalField.
#pragma once

#include <algorithm>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>

#include <nestgrid/nestgrid.h>
#include <nestgrid/erased_bisections.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/operations.hpp>

namespace nestgrid {

namespace detail {

static_assert(NESTGRID_SEGMENT == static_cast<int>(Shape::segment));
static_assert(NESTGRID_TRIANGLE == static_cast<int>(Shape::triangle));
static_assert(NESTGRID_QUADRILATERAL == static_cast<int>(Shape::quadrilateral));
static_assert(NESTGRID_TETRAHEDRON == static_cast<int>(Shape::tetrahedron));
static_assert(NESTGRID_PYRAMID == static_cast<int>(Shape::pyramid));
static_assert(NESTGRID_PRISM == static_cast<int>(Shape::prism));
static_assert(NESTGRID_HEXAHEDRON == static_cast<int>(Shape::hexahedron));

template <class Real>
constexpr int value_type_code() {
    return std::is_same_v<Real, float> ? NESTGRID_FLOAT : NESTGRID_DOUBLE;
}

using Rows = double (*)[3];  // NOLINT(modernize-avoid-c-arrays)

inline Rows as_rows(std::span<Point> points) {
    static_assert(sizeof(Point) == 3 * sizeof(double));
    return reinterpret_cast<Rows>(points.data());
}
inline std::span<Point> as_points(Rows rows, std::size_t count) {
    return {reinterpret_cast<Point*>(rows), count};
}

inline void check_code(int code, const char* what, const char* operation) {
    if (code == 0) return;
    throw GridError("the operation '" + std::string(operation) + "' of the " + what +
                    " failed with code " + std::to_string(code));
}

/// Nothing is thrown through a table: 1 stands for InvalidInput, 2 for GridError, 3 for the rest.
template <class Function>
int guarded(Function&& function) noexcept {
    try {
        function();
        return 0;
    } catch (const InvalidInput&) {
        return 1;
    } catch (const GridError&) {
        return 2;
    } catch (...) {
        return 3;
    }
}

template <class Grid>
struct GridTable {
    using Element = ElementOf<Grid>;
    static_assert(std::is_trivially_copyable_v<Element> &&
                      sizeof(Element) <= sizeof(nestgrid_element),
                  "Type erasure needs elements that are trivially copyable and at most 48 bytes.");

    static const Grid& grid(const void* self) { return *static_cast<const Grid*>(self); }
    static Element load(const nestgrid_element* e) {
        Element element;
        std::memcpy(static_cast<void*>(&element), e, sizeof(element));
        return element;
    }
    static void store(const Element& element, nestgrid_element* e) { *e = erased(element); }
    /// Hands the task's state to function, or an empty one where the grid has none.
    template <class Function>
    static decltype(auto) with(void* context, Function&& function) {
        if constexpr (std::is_same_v<Context<Grid>, NoContext>) {
            NoContext none;
            return function(none);
        } else {
            if (context == nullptr) throw GridError("the grid's make_context failed");
            return function(*static_cast<Context<Grid>*>(context));
        }
    }

    static int coarse_count(const void* self, std::size_t* count) {
        return guarded([&] { *count = grid(self).coarse_count(); });
    }
    static int coarse(const void* self, void* context, std::size_t i, nestgrid_coarse* out) {
        return guarded([&] {
            const auto c =
                with(context, [&](auto& ctx) { return call_coarse(grid(self), ctx, i); });
            store(c.element, &out->element);
            out->shape = static_cast<int>(c.shape);
            for (std::size_t k = 0; k < max_corners; ++k) {
                std::copy_n(c.corners[k].begin(), 3, &out->corners[k][0]);
                out->ids[k] = c.ids[k];
            }
            out->orientation = c.orientation;
        });
    }
    static int library_split(const void* self, void* context, const nestgrid_element* e,
                             const void** rule) {
        return guarded([&] {
            *rule = with(context, [&](auto& ctx) { return call_split(grid(self), ctx, load(e)); });
        });
    }
    /// \param function a std::function of rows; what it throws passes
    static int library_star_rows(const void* self, const void* function) {
        grid(self).for_each_star_row(
            *static_cast<const std::function<void(const StarRow&)>*>(function));
        return 0;
    }
    static int children(const void* self, void* context, const nestgrid_element* e,
                        std::size_t count, nestgrid_element* out) {
        return guarded([&] {
            std::array<Element, max_children> children;
            const std::span<Element> wanted = std::span(children).first(count);
            with(context, [&](auto& ctx) { call_children(grid(self), ctx, load(e), wanted); });
            for (std::size_t k = 0; k < count; ++k) store(children[k], out + k);
        });
    }
    static int corner_keys(const void* self, void* context, const nestgrid_element* e,
                           std::size_t count, std::uint64_t* out) {
        return guarded([&] {
            std::array<NodeKey, max_corners> keys;
            const std::span<NodeKey> wanted = std::span(keys).first(count);
            with(context, [&](auto& ctx) { call_corner_keys(grid(self), ctx, load(e), wanted); });
            std::transform(wanted.begin(), wanted.end(), out, narrow);
        });
    }
    static int new_keys(const void* self, void* context, const nestgrid_element* e,
                        std::size_t count, std::uint64_t* out) {
        return guarded([&] {
            std::array<NodeKey, max_new_nodes> keys;
            const std::span<NodeKey> wanted = std::span(keys).first(count);
            with(context, [&](auto& ctx) { call_new_keys(grid(self), ctx, load(e), wanted); });
            std::transform(wanted.begin(), wanted.end(), out, narrow);
        });
    }
    static int corner_positions(const void* self, void* context, const nestgrid_element* e,
                                std::size_t count, Rows out) {
        return guarded([&] {
            with(context, [&](auto& ctx) {
                call_corner_positions(grid(self), ctx, load(e), as_points(out, count));
            });
        });
    }
    static int new_positions(const void* self, void* context, const nestgrid_element* e,
                             std::uint64_t which, std::size_t count, Rows out) {
        return guarded([&] {
            with(context, [&](auto& ctx) {
                call_new_positions(grid(self), ctx, load(e), NodeMask{which},
                                   as_points(out, count));
            });
        });
    }
    static int constrained(const void* self, void* context, const nestgrid_element* e,
                           std::uint64_t* nodes) {
        return guarded([&] {
            *nodes = with(context,
                          [&](auto& ctx) { return call_constrained(grid(self), ctx, load(e)); });
        });
    }
    static int masked(const void* self, void* context, const nestgrid_element* e, int* answer) {
        return guarded([&] {
            *answer =
                with(context, [&](auto& ctx) { return call_masked(grid(self), ctx, load(e)); }) ? 1
                                                                                                : 0;
        });
    }
    static int hidden(const void* self, void* context, const nestgrid_element* e, int* answer) {
        return guarded([&] {
            *answer = static_cast<int>(
                with(context, [&](auto& ctx) { return call_hidden(grid(self), ctx, load(e)); }));
        });
    }
    static int outside(const void* self, void* context, const nestgrid_element* e,
                       std::uint64_t* nodes) {
        return guarded([&] {
            *nodes =
                with(context, [&](auto& ctx) { return call_outside(grid(self), ctx, load(e)); });
        });
    }
    static int boundary_faces(const void* self, void* context, const nestgrid_element* e,
                              unsigned* faces) {
        return guarded([&] {
            *faces = with(context,
                          [&](auto& ctx) { return call_boundary_faces(grid(self), ctx, load(e)); });
        });
    }
    static int grid_epoch(const void* self, std::uint64_t* out) {
        return guarded([&] { *out = epoch(grid(self)); });
    }
    /// NULL where the grid throws: every operation of the task then fails.
    static void* make(const void* self) {
        void* context = nullptr;
        guarded([&] { context = new Context<Grid>(make_context(grid(self))); });
        return context;
    }
    static void free(const void*, void* context) { delete static_cast<Context<Grid>*>(context); }

private:
    static std::uint64_t narrow(NodeKey key) { return static_cast<std::uint64_t>(key); }
};

template <class Grid, class Field>
struct FieldTable {
    using Real = typename Field::value_type;
    using Bridge = GridTable<Grid>;
    static constexpr std::size_t components = static_cast<std::size_t>(components_of<Field>());

    static const Field& field(const void* self) { return *static_cast<const Field*>(self); }
    static int coarse_values(const void* self, void* context, std::size_t i, std::size_t count,
                             void* out, std::uint64_t* missing) {
        return guarded([&] {
            *missing = Bridge::with(context, [&](auto& ctx) {
                return call_coarse_values(
                    field(self), ctx, i,
                    std::span<Real>(static_cast<Real*>(out), count * components));
            });
        });
    }
    static int new_values(const void* self, void* context, const nestgrid_element* e,
                          std::uint64_t which, std::size_t count, void* out,
                          std::uint64_t* missing) {
        return guarded([&] {
            *missing = Bridge::with(context, [&](auto& ctx) {
                return call_new_values(
                    field(self), ctx, Bridge::load(e), NodeMask{which},
                    std::span<Real>(static_cast<Real*>(out), count * components));
            });
        });
    }
    static int corner_gradients(const void* self, void* context, const nestgrid_element* e,
                                std::size_t count, Rows out) {
        return guarded([&] {
            Bridge::with(context, [&](auto& ctx) {
                call_corner_gradients(field(self), ctx, Bridge::load(e), as_points(out, count));
            });
        });
    }

    static int library_row_values(const void* self, std::uint64_t first, std::size_t stride,
                                  std::size_t count, void* out) {
        field(self).row_values(NodeKey{first}, stride, std::span(static_cast<Real*>(out), count));
        return 0;
    }

    /// Walks down from an element with these values. Lets exceptions of the visitor pass.
    /// \param visitor an ErasedBisectionVisitor of the grid's dimension, or null to ask only
    /// \return 0, or 1 where the table is not that of such a grid
    static int library_bisect(const void* self, const nestgrid_grid* table,
                              const nestgrid_element* e, const void* values, int level,
                              int orientation, void* visitor) {
        if (table->library_split != Bridge::library_split) return 1;
        if (visitor == nullptr) return 0;
        const Grid& grid = Bridge::grid(table->self);
        using Visitor = ErasedBisectionVisitor<Grid::dimension, Real>;
        Visitor& to = *static_cast<Visitor*>(visitor);
        walk_for(to, grid, field(self), Bridge::load(e), static_cast<const Real*>(values), level,
                 orientation);
        return 0;
    }
};

}  // namespace detail

/// The table of a grid; the grid is borrowed.
template <class Grid>
nestgrid_grid make_table(const Grid& grid) {
    static_assert(require_nested_grid<Grid>());
    using Table = detail::GridTable<Grid>;
    nestgrid_grid t{};
    t.size = sizeof(t);
    t.self = &grid;
    t.dimension = Grid::dimension;
    t.coarse_count = Table::coarse_count;
    t.coarse = Table::coarse;
    t.library_split = Table::library_split;
    t.children = Table::children;
    if constexpr (may_offer<Grid>(Feature::own_keys)) {
        if (offers(grid, Feature::own_keys)) {
            t.corner_keys = Table::corner_keys;
            t.new_keys = Table::new_keys;
            t.node_count = dense_key_count(grid);
        }
    }
    if constexpr (may_offer<Grid>(Feature::own_positions)) {
        if (offers(grid, Feature::own_positions)) t.corner_positions = Table::corner_positions;
    }
    if constexpr (may_offer<Grid>(Feature::new_positions)) {
        if (offers(grid, Feature::new_positions)) t.new_positions = Table::new_positions;
    }
    if constexpr (may_offer<Grid>(Feature::constrained)) {
        if (offers(grid, Feature::constrained)) t.constrained = Table::constrained;
    }
    if constexpr (may_offer<Grid>(Feature::masked)) {
        if (offers(grid, Feature::masked)) t.masked = Table::masked;
    }
    if constexpr (may_offer<Grid>(Feature::hidden)) {
        if (offers(grid, Feature::hidden)) t.hidden = Table::hidden;
    }
    if constexpr (may_offer<Grid>(Feature::outside)) {
        if (offers(grid, Feature::outside)) t.outside = Table::outside;
    }
    if constexpr (may_offer<Grid>(Feature::boundary_faces)) {
        if (offers(grid, Feature::boundary_faces)) t.boundary_faces = Table::boundary_faces;
    }
    if constexpr (requires { grid.conforming(); }) t.conforming = grid.conforming() ? 1 : 0;
    t.epoch = Table::grid_epoch;
    if constexpr (requires { grid.for_each_star_row([](const StarRow&) {}); }) {
        if (knows_stars(grid)) t.library_star_rows = Table::library_star_rows;
    }
    if constexpr (!std::is_same_v<Context<Grid>, NoContext>) {
        t.make_context = Table::make;
        t.free_context = Table::free;
    }
    return t;
}

/// The table of a field on a grid of the same type as the first argument; the field is borrowed.
template <class Grid, class Field>
nestgrid_field make_table(const Grid&, const Field& field) {
    static_assert(require_nodal_field<Field, Grid>());
    using Table = detail::FieldTable<Grid, Field>;
    nestgrid_field t{};
    t.size = sizeof(t);
    t.self = &field;
    t.value_type = detail::value_type_code<typename Field::value_type>();
    t.components = detail::components_of<Field>();
    t.coarse_values = Table::coarse_values;
    t.new_values = Table::new_values;
    if constexpr (detail::offers_corner_gradients<Field, Context<Grid>, const ElementOf<Grid>&,
                                                  std::span<Point>>) {
        if (offers_gradients<Grid>(field)) t.corner_gradients = Table::corner_gradients;
    }
    if constexpr (KnowsBisections<Grid, Field> && HasMaubachBlocks<Grid> &&
                  detail::components_of<Field>() == 1) {
        t.library_bisect = Table::library_bisect;
    }
    if constexpr (KnowsRows<Field>) {
        if (knows_stars(field)) t.library_row_values = Table::library_row_values;
    }
    return t;
}

}  // namespace nestgrid
