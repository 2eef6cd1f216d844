// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A field on a grid as a value, whatever the type of its values and whoever owns it.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include <nestgrid/detail/erase.hpp>

namespace nestgrid {

namespace detail {

/// What may be a field on a grid, and no hierarchy.
template <class Field, class Grid>
concept FieldOfGrid = requires {
    Grid::dimension;
    typename Field::value_type;
};

}  // namespace detail

/// A hierarchy with values of either type: borrowed, or shared with what it is made of. Copies are
/// of the same field.
class FieldOnGrid {
public:
    /// Borrows the hierarchy.
    FieldOnGrid(const Hierarchy<float>& hierarchy) : hierarchy_{borrowed(hierarchy)} {}
    FieldOnGrid(const Hierarchy<double>& hierarchy) : hierarchy_{borrowed(hierarchy)} {}
    /// Keeps the hierarchy alive.
    FieldOnGrid(std::shared_ptr<const Hierarchy<float>> hierarchy)
        : hierarchy_{std::move(hierarchy)} {}
    FieldOnGrid(std::shared_ptr<const Hierarchy<double>> hierarchy)
        : hierarchy_{std::move(hierarchy)} {}
    /// Borrows the grid and the field.
    template <class Grid, class Field>
        requires detail::FieldOfGrid<Field, Grid> FieldOnGrid(const Grid& grid, const Field& field)
            : hierarchy_{Shared<typename Field::value_type>(
                  std::make_shared<const detail::ErasedHierarchy<Grid, Field>>(grid, field))} {}

        /// Calls function(hierarchy) with the Hierarchy<float> or the Hierarchy<double>.
        template <class Function>
        decltype(auto) visit(Function&& function) const {
            return std::visit(
                [&](const auto& hierarchy) -> decltype(auto) { return function(*hierarchy); },
                hierarchy_);
        }

        const HierarchyFacts& facts() const {
            return visit([](const auto& each) -> const HierarchyFacts& { return each.facts(); });
        }
        int dimension() const { return facts().dimension; }

    private:
        template <class Real>
        using Shared = std::shared_ptr<const Hierarchy<Real>>;

        template <class Real>
        static Shared<Real> borrowed(const Hierarchy<Real>& hierarchy) {
            return Shared<Real>(Shared<Real>{}, &hierarchy);
        }

        std::variant<Shared<float>, Shared<double>> hierarchy_;
};

}  // namespace nestgrid
