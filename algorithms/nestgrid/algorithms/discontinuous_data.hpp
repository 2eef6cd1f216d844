// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A grid with data that jump between its elements: every leaf has values of its own at its corners.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include <nestgrid/detail/erase.hpp>

namespace nestgrid {

namespace detail {

/// Puts the values at the corners of a leaf, component c of corner k at out[k * components + c].
using LeafValues = std::function<void(const Handle& leaf, std::span<double> out)>;

}  // namespace detail

/// A grid with values of its own for every leaf. Both are borrowed.
class DiscontinuousData {
public:
    /// \tparam Field has, for every leaf of the grid,
    ///             void leaf_values(const Element& leaf, std::span<double> out) const
    ///         which puts component c at corner k into out[k * components + c], and, where it has
    ///         several components, `static constexpr int components`
    template <class Grid, class Field>
        requires requires(const Field& field, const ElementOf<Grid>& leaf, std::span<double> out) {
            field.leaf_values(leaf, out);
        }
    DiscontinuousData(const Grid& grid, const Field& field)
        : DiscontinuousData(hierarchy_of(grid), detail::components_of<Field>(),
                            [&field](const Handle& leaf, std::span<double> out) {
                                field.leaf_values(detail::element_of<ElementOf<Grid>>(leaf), out);
                            }) {}

    /// Data that are constant on each leaf.
    /// \tparam LeafValue callable as a number of LeafValue(const Element&) for every leaf
    template <class Grid, class LeafValue>
        requires std::convertible_to < std::invoke_result_t < const LeafValue&,
            const ElementOf<Grid>
    & >, double > DiscontinuousData(const Grid& grid, const LeafValue& leaf_value)
        : DiscontinuousData(
              hierarchy_of(grid), 1, [&leaf_value](const Handle& leaf, std::span<double> out) {
                  std::ranges::fill(
                      out,
                      static_cast<double>(leaf_value(detail::element_of<ElementOf<Grid>>(leaf))));
              }) {}

    /// Data on what a grid was erased to: a table of C, say.
    /// \param grid with a field that is zero
    /// \param leaf_values called by all threads that draw
    DiscontinuousData(std::unique_ptr<const Hierarchy<float>> grid, int components,
                      detail::LeafValues leaf_values)
        : grid_{std::move(grid)}, components_{components}, leaf_values_{std::move(leaf_values)} {}

    /// The grid, with a field that is zero.
    const Hierarchy<float>& grid() const { return *grid_; }
    int components() const { return components_; }
    void leaf_values(const Handle& leaf, std::span<double> out) const { leaf_values_(leaf, out); }

private:
    template <class Grid>
    static std::unique_ptr<const Hierarchy<float>> hierarchy_of(const Grid& grid) {
        static constexpr ZeroField<Grid> zero;
        using Erased = decltype(erase(grid, zero));
        return std::make_unique<Erased>(grid, zero);
    }

    std::unique_ptr<const Hierarchy<float>> grid_;
    int components_;
    detail::LeafValues leaf_values_;
};

}  // namespace nestgrid
