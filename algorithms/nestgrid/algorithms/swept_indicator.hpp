// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators by any measure of the new nodes of a split (paper, sections 2, 4 and 5), saturated by
// one sweep, fine to coarse.
//
// Invariant: eta(corner) >= factor * (eta(new node) + slope * |corner - new node|) for every split
// element, also for a parent of a new node that is a new node of the same split. eta is the least
// such function that is nowhere below the measure, rounded up to bfloat16.
// Consequence: S(x) = (eta(x) <= epsilon) is a saturated criterion, whatever is measured. Bounds,
// for the search and for the error, come from the data: take those of a HierarchicalIndicator.
// Memory: 2 bytes a node (with its key where keys are not dense); while it is made, 4 for each node
// of each split more, or 2 a node at most where the grid knows stars.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <nestgrid/algorithms/detail/node_table.hpp>
#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid {

/// One split with the true positions and values of its nodes; hanging nodes are interpolated.
struct MeasuredSplit {
    const Rule& rule;
    int level;                         ///< of the element that is split
    std::span<const Point> positions;  ///< of the corners and, behind them, of the new nodes
    std::span<const double> values;    ///< component c of node k at k * components + c
    std::span<const double> means;     ///< sum omega U at the new nodes, as the projection takes it
    std::size_t components;

    std::size_t corner_count() const { return static_cast<std::size_t>(rule.corner_count()); }
    /// U - sum omega U at new node n.
    double offset(std::size_t n, std::size_t component = 0) const {
        const std::size_t at = n * components + component;
        return values[corner_count() * components + at] - means[at];
    }
    /// x - sum omega x at new node n.
    Point position_offset(std::size_t n) const;
    /// The greatest distance between two corners.
    double diameter() const;
};

/// Sets eta[n], which starts as 0, of each new node n to a number that is not negative. Where
/// several elements make a node, the greatest of their numbers counts.
using Measure = std::function<void(const MeasuredSplit& split, std::span<double> eta)>;

/// An indicator that keeps eta for every node. Movable; functions that measure return it.
class SweptIndicator final : public Indicator {
public:
    /// \param epoch of the grid that the numbers were computed on
    /// \param isovalues of which the numbers promise a surface_error(); none by default
    SweptIndicator(detail::NodeTable<std::uint16_t> stops, const Spread& spread,
                   std::uint64_t epoch, std::span<const double> isovalues = {})
        : stops_{std::move(stops)},
          spread_{spread},
          epoch_{epoch},
          isovalues_(isovalues.begin(), isovalues.end()) {}

    double stop(NodeKey node) const override { return detail::bfloat16_value(stops_.at(node)); }
    NodeMask stops_at_most(const Rule& /*rule*/, std::span<const NodeKey> nodes,
                           double epsilon) const override;
    Spread spread() const override { return spread_; }
    bool made_for(std::uint64_t epoch) const override { return epoch == epoch_; }
    /// The greatest number that is at most epsilon: all others are those of elements that are
    /// entered. Looks at all nodes.
    double surface_error(std::span<const double> isovalues, double epsilon) const override;
    std::size_t memory_bytes() const { return stops_.memory_bytes(); }

private:
    detail::NodeTable<std::uint16_t> stops_;  // bfloat16
    Spread spread_;
    std::uint64_t epoch_;
    std::vector<double> isovalues_;
};

/// The indicator of a measure of all components of a field.
/// \throw InvalidInput where the measure is negative or not a number, and where the factor of the
///        spread is below 1 or its slope below 0
SweptIndicator measured_indicator(const FieldOnGrid& field, const Measure& measure,
                                  const Spread& spread = {});

}  // namespace nestgrid
