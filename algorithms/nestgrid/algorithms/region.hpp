// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fine inside a region, coarse outside (the lens of the paper, section 4.3).
//
// Two thresholds on one indicator would crack: which of them holds at a node would depend on the
// node alone, and a node outside may have finer nodes inside. So a node belongs to the region if it
// or any node created, at any depth, in elements it is a corner of, lies there: a saturated
// indicator with the values 0 and 1. Then
//     S = S_out and (S_in or not in the region)
// is saturated, for where both (one) of two saturated criteria hold(s) at a corner, the same hold
// at the new nodes.
// Memory: a byte a node (a key a node where keys are not dense); while it is made without stars, 4
// bytes for each node of each split. Cost: one pass over the stars, where the grid offers them,
// else one walk and a few sweeps over its splits.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/detail/key_table.hpp>

namespace nestgrid {

/// A part of space that is drawn finely.
class Region final : public Indicator {
public:
    /// An empty region.
    Region() = default;
    /// \param inside whether a point lies in the region: bool(const Point&)
    template <class Grid, class Inside>
        requires(!std::convertible_to<const Grid&, FieldOnGrid>)
    Region(const Grid& grid, Inside&& inside)
        : Region(FieldOnGrid(erase(grid, ZeroField<Grid>{})),
                 std::function<bool(const Point&)>(std::ref(inside))) {}
    /// \param field whose values are not asked for
    Region(const FieldOnGrid& field, const std::function<bool(const Point&)>& inside);

    bool contains(NodeKey node) const {
        return dense_.empty() ? sparse_.find(node) != nullptr
                              : dense_[static_cast<std::size_t>(node)] != 0;
    }

    /// 1 in the region, 0 outside.
    double stop(NodeKey node) const override { return contains(node) ? 1 : 0; }
    /// An empty region is one of every grid.
    bool made_for(std::uint64_t epoch) const override { return !epoch_ || epoch == *epoch_; }

private:
    struct Present {};

    template <class Real>
    void sweep_stars(const Hierarchy<Real>& hierarchy,
                     const std::function<bool(const Point&)>& inside);
    template <class Real>
    void sweep_levels(const Hierarchy<Real>& hierarchy,
                      const std::function<bool(const Point&)>& inside);

    std::optional<std::uint64_t> epoch_;  // of the grid, where there is one
    std::vector<std::uint8_t> dense_;
    KeyTable<NodeKey, Present> sparse_;
};

/// S for a threshold outside a region and a smaller one inside; both must outlive the criterion.
inline auto fine_inside(const Region& region, const Indicator& indicator, double outside,
                        double inside) {
    return Threshold(&indicator, outside) &&
           (Threshold(&indicator, inside) || Threshold(&region, 0.5));
}

}  // namespace nestgrid
