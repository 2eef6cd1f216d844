// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How an indicator is made from what is measured at the splits of a hierarchy: a source is shown
// all splits in one walk, raises eta at nodes, and the sweep saturates what it has raised.
#pragma once

#include <algorithm>
#include <bit>

#include <indicators/fine_to_coarse.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid::engine {

/// eta of all nodes, by number, before the sweep.
class NodeEtas {
public:
    /// \param dense how many dense keys there are, or 0
    explicit NodeEtas(std::size_t dense) : maxima_{dense, 0} {}

    /// Raises eta of a node to a number that is not below the given one.
    /// \throw InvalidInput where this is negative or not a number
    void raise(std::size_t node, double eta) {
        if (!(eta >= 0)) refuse(eta);
        std::uint16_t& at = maxima_[node];
        at = std::max(at, detail::bfloat16_above(detail::float_above(eta)));
    }
    /// Sets eta to infinity at the new nodes of a split at which no element may stop.
    /// \param outside these, one bit each
    /// \param nodes numbers of the corners and, behind them, of the new nodes
    void put_outside(const Rule& rule, NodeMask outside, std::span<const std::size_t> nodes) {
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        for (NodeMask left = outside & rule.all(); left != 0; left &= left - 1) {
            maxima_[nodes[corners + static_cast<std::size_t>(std::countr_zero(left))]] =
                detail::bfloat16_infinity;
        }
    }
    NodeMaxima<std::uint16_t>& maxima() { return maxima_; }
    /// Sweeps over all splits, and moves the numbers out. Collective where nodes are shared.
    /// \param shared the nodes that other ranks have, too, or null
    detail::NodeTable<std::uint16_t> saturate(const Spread& spread,
                                              const SharedNodes* shared = nullptr);
    /// Moves the numbers out as they are.
    detail::NodeTable<std::uint16_t> take() { return maxima_.take_table(); }

private:
    [[noreturn]] static void refuse(double eta);

    NodeMaxima<std::uint16_t> maxima_;
};

/// |offset|.
/// \throw InvalidInput where the offset is not finite
double finite_offset(double offset);
/// The least eta above 0 where the offset of a node is not 0, so that no node is dropped at
/// threshold 0.
/// \throw InvalidInput where the offset is not finite
double trace_of(double offset);

/// Measures eta at the splits of a hierarchy. A source may keep numbers by node until finish().
class EtaSource {
public:
    /// What it is, as ranks compare it. Sources without a name are refused on distributed grids.
    virtual std::string name() const { return {}; }
    /// Whether the source looks at values.
    virtual bool wants_values() const { return true; }
    /// \param nodes numbers of the corners and, behind them, of the new nodes
    virtual void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
                       NodeEtas& etas) = 0;
    /// Called behind split(), with the children of it that are leaves, one bit each.
    virtual void leaves(const MeasuredSplit& /*split*/, std::span<const std::size_t> /*nodes*/,
                        NodeMask /*which*/) {}
    /// Called when all splits of this rank were shown: takes what other ranks have kept of nodes,
    /// but for eta, of which the sweep takes the greatest. Collective.
    virtual void agree(const SharedNodes& /*shared*/, NodeEtas& /*etas*/) {}
    /// Called when all splits were shown.
    virtual void finish(NodeEtas& /*etas*/) {}

protected:
    EtaSource() = default;
    ~EtaSource() = default;
    EtaSource(const EtaSource&) = default;
    EtaSource& operator=(const EtaSource&) = default;
    EtaSource(EtaSource&&) noexcept = default;
    EtaSource& operator=(EtaSource&&) noexcept = default;
};

/// Shows a source all splits, hidden ones included, and sweeps. Nodes at which no element may stop
/// have the indicator infinity. Collective where the grid is distributed.
template <class Real>
SweptIndicator sweep_source(const Hierarchy<Real>& hierarchy, EtaSource& source,
                            const Spread& spread);

}  // namespace nestgrid::engine
