// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The data behind HighOrder: a few numbers of each leaf and the table of nodes, made once for a
// solution; and the polynomials and records of the leaves that a drawing looks at, which are
// gathered for it. Those gathered last are kept for the next drawing.
#pragma once

#include <mutex>
#include <optional>

#include <high_order/lens_sizes.hpp>
#include <high_order/real_nodes.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <walk/position_functions.hpp>

namespace nestgrid::engine {

/// A few numbers of each leaf, and the nodes that the hierarchy itself makes.
struct PolynomialFacts {
    LeafSummary summary;
    RealNodes nodes;

    PolynomialFacts(const LeafFunction& function, const BaseWalk& walk, std::uint64_t epoch,
                    const Executor& executor)
        : summary{function}, nodes{epoch, function, walk, summary, executor} {}
    std::size_t memory_bytes() const { return summary.memory_bytes() + nodes.memory_bytes(); }
};

/// The polynomials and records of some leaves.
struct GatheredLeaves {
    LeafChoice choice;
    LeafRecords field;
    std::optional<LeafRecords> places;  // where a leaf is curved

    std::size_t memory_bytes() const {
        return choice.memory_bytes() + field.memory_bytes() + (places ? places->memory_bytes() : 0);
    }
};

/// A solution: the hierarchy, facts of its leaves, and the leaves gathered last.
struct HighOrderData {
    std::optional<WidenedHierarchy<float>> widened;  // where the values are float
    const Hierarchy<double>* base;
    BaseWalk walk;
    std::uint64_t epoch;
    PolynomialFacts field;
    std::optional<PolynomialFacts> places;  // where a leaf is curved

    HighOrderData(const Hierarchy<float>& single, const Executor& executor);
    HighOrderData(const Hierarchy<double>& base, const Executor& executor);

    /// The tolerance of positions beside one of the data that asks for none.
    double default_position_tolerance(double tolerance) const;
    /// The leaves that the options ask for.
    /// \throw GridError where the hierarchy has changed, or as HighOrder
    std::shared_ptr<const GatheredLeaves> gathered(const VirtualOptions& options) const;
    /// Polynomials, and records unless these are not needed, of the leaves that `chooses` returns
    /// true for; not kept for another drawing.
    GatheredLeaves gather(const LeafChoice::Chooses& chooses,
                          LeafChoice::Needs needs = LeafChoice::Needs::records) const;
    /// Made when a lens first asks for them.
    const LeafCorners& corners() const;
    std::size_t memory_bytes() const;

private:
    void look_at_places(const Executor& executor);
    GatheredLeaves gather_none() const;
    /// A leaf a bit, in the order of the walk.
    std::vector<bool> looked_at(const VirtualOptions& options) const;
    void look_at_places(const VirtualOptions& options, std::vector<bool>& leaves) const;

    mutable std::once_flag corners_made_;
    mutable std::optional<LeafCorners> corners_;
    mutable std::mutex gathering_;
    mutable std::optional<std::vector<bool>> last_leaves_;  // nothing: all
    mutable std::shared_ptr<const GatheredLeaves> last_;
};

}  // namespace nestgrid::engine
