// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A walk cut into tasks: subtrees of one level, in the order in which one walk meets them.
//
// Invariants:
//   - an entry is an element on the frontier's level, or an extracted element above that level;
//     every element of interest lies above the frontier, or is or lies below exactly one entry;
//   - the frontier keeps the elements above it in preorder, so that a task finds its entries by
//     walking down to them from the coarse grid, and skips all other elements. The frontier stores
//     the place of an element and nothing else; fathers, keys and values come from the walk.
// Memory: 20 bytes for each element above the frontier and on it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <nestgrid/algorithms/executor.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// Thrown where who is told of the progress of a walk ends it.
struct Cancelled {};

/// A visitor whose walk can be cut into tasks.
template <class Real>
class TaskVisitor : public Visitor<Real> {
public:
    /// Takes back the last inspect(), because a task will repeat it.
    virtual void undo() = 0;
    /// Takes back all calls.
    virtual void restart() = 0;
    /// Decides like inspect(), without counting the element.
    virtual Decision look(const ElementView<Real>& view, const Split& split) = 0;
    /// Told the number of an entry, from 0, before walk_below(): how many entries' inspect() calls
    /// were taken back before.
    virtual void begin_entry(std::size_t /*number*/) {}
    /// Visits an element and all below it. A final visitor has the walk compiled for its class.
    virtual void walk_below(const Walk<Real>& walk, const ElementView<Real>& view) {
        walk.walk_below(view, *this);
    }

protected:
    TaskVisitor() = default;
    ~TaskVisitor() = default;
    TaskVisitor(const TaskVisitor&) = default;
    TaskVisitor& operator=(const TaskVisitor&) = default;
    TaskVisitor(TaskVisitor&&) noexcept = default;
    TaskVisitor& operator=(TaskVisitor&&) noexcept = default;
};

template <class Real>
class Frontier {
public:
    /// Chooses the first level with enough entries whose children the visitor enters, or else the
    /// first one without any such entry.
    /// \param visitor decides about the elements above the frontier as in an ordinary walk
    /// \throw GridError where the coarse grid has 2^32 elements or more
    Frontier(const Walk<Real>& walk, TaskVisitor<Real>& visitor, std::size_t wanted);

    std::size_t entry_count() const { return entries_; }

    /// Shows a visitor the entries first ... last - 1 and all elements below them.
    /// \param walk the walk with which the frontier was made
    void run(const Walk<Real>& walk, std::size_t first, std::size_t last,
             TaskVisitor<Real>& visitor) const;

private:
    class Enumeration;
    class Part;

    struct Item {
        std::uint32_t coarse;
        std::uint32_t first_entry;  ///< number of the first entry below the item, or of the item
        std::uint32_t next;         ///< number of the item behind its subtree
        std::uint16_t head;         ///< level of the first of the copies that lead to the item
        std::uint16_t level;
        bool entry;
    };

    void close_subtrees();
    /// The coarse element above an entry.
    std::size_t item_of_coarse(std::size_t entry) const;

    std::vector<Item> items_;
    std::size_t entries_ = 0;
};

/// How many tasks run_tasks() makes at most.
inline std::size_t most_tasks(const Executor& executor) { return 16 * executor.concurrency(); }

/// Walks for a leader by the tasks of an executor: enough of them that threads end together, and
/// few, because a walk begins anew at each.
/// \param begin begin(i) returns the visitor of task i, which must outlive end(i); several threads
///        call it
/// \param end end(i) takes what task i has done; called in the order of the tasks, by one thread at
///        a time, while others run
template <class Real, class Begin, class End>
void run_tasks(const Walk<Real>& walk, TaskVisitor<Real>& leader, const Executor& executor,
               Begin&& begin, End&& end) {
    const std::size_t wanted = most_tasks(executor);
    const Frontier<Real> frontier(walk, leader, 2 * wanted);
    const std::size_t entries = frontier.entry_count();
    const std::size_t tasks = std::min(entries, wanted);
    executor.run(
        tasks,
        [&](std::size_t i) {
            frontier.run(walk, i * entries / tasks, (i + 1) * entries / tasks, begin(i));
        },
        [&](std::size_t i) { end(i); });
}

}  // namespace nestgrid::engine
