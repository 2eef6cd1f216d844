// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A walk over lattices of bisected simplices, by arithmetic on keys: the new node of an element has
// the mean of the keys of its two parents, and all elements of a level are split alike. Requires
// bisects_by_keys() (lattice_deviations.hpp). It also shows elements beyond the domain where those
// around them lie within.
//
// A node has a row: in column a the value there of the interpolant of the element on level a around
// it, down to the element that makes it, and its own value behind, at least in one column more than
// there are levels.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// Keys and rows of the corners of a simplex.
struct LatticeCorners {
    static constexpr std::size_t most = 4;
    std::size_t count;
    std::array<NodeKey, most> key;
    std::array<double*, most> row;
};

/// The mean of two keys whose sum is even.
inline NodeKey middle_key(NodeKey a, NodeKey b) { return (a & b) + ((a ^ b) >> 1U); }

/// The values at all nodes, by key.
template <class Real>
std::vector<Real> values_by_key(const Hierarchy<Real>& hierarchy) {
    std::vector<Real> values(hierarchy.facts().node_count);
    std::vector<Real> run;
    hierarchy.star_rows([&](const StarRow& row) {
        if (row.gathers) return;
        run.resize(row.count);
        hierarchy.row_values(static_cast<NodeKey>(row.first), row.stride, run);
        for (std::size_t i = 0; i < row.count; ++i) values[row.first + i * row.stride] = run[i];
    });
    return values;
}

/// Numbers of nodes, by key, which several threads may raise.
using RaisedNumbers = std::vector<std::atomic<std::uint16_t>>;

/// Raises the number of a node to one that is not below the given one.
inline void raise(RaisedNumbers& numbers, NodeKey node, double to) {
    const std::uint16_t least = detail::bfloat16_above(detail::float_above(to));
    std::atomic<std::uint16_t>& number = numbers[static_cast<std::size_t>(node)];
    std::uint16_t now = number.load(std::memory_order_relaxed);
    while (now < least && !number.compare_exchange_weak(now, least, std::memory_order_relaxed)) {
    }
}

/// Walks the elements below one coarse element after the other.
/// \tparam Measure has enters(corners, level, made), whether to walk below an element, of which
///         `made` is the new node; make_row(u, a, b, row, level), which makes columns 0 ... level
///         of the row of a new node with the value u of those of its parents; leave(level, made);
///         and leaf(corners), if sees_leaves
template <class Real, class Measure>
class LatticeWalk {
public:
    LatticeWalk(std::span<const Rule* const> rules, std::span<const Real> values, Measure& measure)
        : rules_{rules},
          values_{values},
          measure_{&measure},
          columns_{row_size(rules.size())},
          rows_((LatticeCorners::most + rules.size()) * columns_) {}

    /// \param levels on which elements are split
    static std::size_t row_size(std::size_t levels) { return (levels + lanes) / lanes * lanes; }
    /// \param keys of the corners of a coarse element
    void run(std::span<const NodeKey> keys) {
        LatticeCorners corners{keys.size(), {}, {}};
        for (std::size_t k = 0; k < keys.size(); ++k) {
            corners.key[k] = keys[k];
            corners.row[k] = rows_.data() + k * columns_;
            std::fill_n(corners.row[k], columns_, value(keys[k]));
        }
        below(corners, 0);
    }

private:
    static constexpr std::size_t lanes = 4;

    double value(NodeKey key) const {
        return static_cast<double>(values_[static_cast<std::size_t>(key)]);
    }

    void below(const LatticeCorners& corners, std::size_t level) {
        const Rule& rule = *rules_[level];
        const auto& parent = rule.new_nodes[0].parent;
        const NodeKey made = middle_key(corners.key[parent[0]], corners.key[parent[1]]);
        if (!measure_->enters(corners, level, made)) return;
        double* const row = rows_.data() + (LatticeCorners::most + level) * columns_;
        const double u = value(made);
        measure_->make_row(u, corners.row[parent[0]], corners.row[parent[1]], row, level);
        std::fill(row + level + 1, row + columns_, u);
        const bool leaves = level + 1 == rules_.size();
        if (!leaves || Measure::sees_leaves) {
            for (const Child& child : rule.children) {
                LatticeCorners next{corners.count, {}, {}};
                for (std::size_t k = 0; k < corners.count; ++k) {
                    const std::size_t node = child.corner[k];
                    next.key[k] = node < corners.count ? corners.key[node] : made;
                    next.row[k] = node < corners.count ? corners.row[node] : row;
                }
                if (!leaves) {
                    below(next, level + 1);
                } else if constexpr (Measure::sees_leaves) {
                    measure_->leaf(next);
                }
            }
        }
        measure_->leave(level, made);
    }

    std::span<const Rule* const> rules_;
    std::span<const Real> values_;
    Measure* measure_;
    std::size_t columns_;
    std::vector<double> rows_;  // of the corners of the coarse element, then by level
};

/// Walks a whole lattice with the threads of an executor.
/// \param make make() returns the measure of a task; several threads call it
template <class Real, class Make>
void walk_lattice(const Hierarchy<Real>& hierarchy, std::span<const Rule* const> rules,
                  std::span<const Real> values, const Executor& executor, const Make& make) {
    if (rules.empty()) return;
    const std::size_t coarse = hierarchy.coarse_count();
    const std::size_t tasks = std::min(coarse, 16 * executor.concurrency());
    executor.run(
        tasks,
        [&](std::size_t i) {
            auto measure = make();
            LatticeWalk<Real, decltype(measure)> walk(rules, values, measure);
            const std::unique_ptr<Task> task = hierarchy.open();
            Coarse element;
            Family family;
            std::array<NodeKey, max_corners> keys{};
            for (std::size_t c = i * coarse / tasks; c < (i + 1) * coarse / tasks; ++c) {
                hierarchy.coarse(task.get(), c, element, family);
                if ((family.split | family.leaves) == 0) continue;  // masked
                const std::size_t corners = topology(element.shape).corners;
                hierarchy.corners(task.get(), family.members[0].element, corners, keys.data(),
                                  nullptr, nullptr);
                walk.run(std::span<const NodeKey>(keys).first(corners));
            }
        },
        [](std::size_t) {});
}

}  // namespace nestgrid::engine
