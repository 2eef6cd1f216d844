// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rules found in a grid: for solvers that tell where children lie in their father, but not by which
// rule they were made.
#pragma once

#include <deque>
#include <span>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

/// A child as it lies in the reference element of its father.
struct PlacedChild {
    Shape shape = Shape::point;
    std::array<Point, max_corners> corners{};
};

/// Rules by how the children lie, each made and checked once. Add those of a whole grid in the
/// constructor of its adapter: find() is const, and rules keep their addresses.
class RuleTable {
public:
    /// The rule of an element of a shape with these children. New nodes are numbered as the corners
    /// of the children name them first; their weights are the shape functions of the parent.
    /// \throw InvalidInput with the sentence of find_violation() where the children do not tile the
    ///        parent
    const Rule& add(Shape parent, std::span<const PlacedChild> children);

    /// The same without adding: null where there is no such rule.
    const Rule* find(Shape parent, std::span<const PlacedChild> children) const;

    std::size_t size() const { return rules_.size(); }

private:
    std::deque<Rule> rules_;
    KeyTable<std::uint64_t, const Rule*> by_children_;  // by a hash of how they lie
};

}  // namespace nestgrid
