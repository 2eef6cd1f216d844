// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/lattice_deviations.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include <indicators/rules_by_level.hpp>
#include <indicators/split_kinds.hpp>
#include <indicators/star_sweep.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

namespace {

constexpr std::size_t most_corners = 4;  // of a simplex

/// The mean of two keys whose sum is even.
NodeKey middle_key(NodeKey a, NodeKey b) { return (a & b) + ((a ^ b) >> 1U); }

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

/// Raises a number that several threads may raise.
void raise(std::atomic<std::uint16_t>& number, std::uint16_t to) {
    std::uint16_t now = number.load(std::memory_order_relaxed);
    while (now < to && !number.compare_exchange_weak(now, to, std::memory_order_relaxed)) {
    }
}

/// Walks the elements below one coarse element after the other.
///
/// A node has a row: in column a the value there of the interpolant of the element on level a
/// around it, down to the element that makes it, and its own value behind.
template <class Real>
class DeviationWalk {
public:
    DeviationWalk(std::span<const Rule* const> rules, std::span<const Real> values,
                  std::span<std::atomic<std::uint16_t>> deviations)
        : rules_{rules},
          values_{values},
          deviations_{deviations},
          columns_{(rules.size() + lanes) / lanes * lanes},
          rows_((most_corners + rules.size()) * columns_),
          greatest_(columns_) {}

    /// \param keys of the corners of a coarse element
    void run(std::span<const NodeKey> keys) {
        Corners corners;
        for (std::size_t k = 0; k < keys.size(); ++k) {
            corners.key[k] = keys[k];
            corners.row[k] = rows_.data() + k * columns_;
            std::fill_n(corners.row[k], columns_, value(keys[k]));
        }
        below(corners, 0);
    }

private:
    static constexpr std::size_t lanes = 4;

    struct Corners {
        std::array<NodeKey, most_corners + 1> key;  // the new node is the last one
        std::array<double*, most_corners + 1> row;
    };

    double value(NodeKey key) const {
        return static_cast<double>(values_[static_cast<std::size_t>(key)]);
    }

    void below(Corners& nodes, std::size_t level) {
        const Rule& rule = *rules_[level];
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        const auto& parent = rule.new_nodes[0].parent;
        const NodeKey made = middle_key(nodes.key[parent[0]], nodes.key[parent[1]]);
        nodes.key[corners] = made;
        double* const row = rows_.data() + (most_corners + level) * columns_;
        nodes.row[corners] = row;
        greatest_[level] = 0;
        look_at(value(made), nodes.row[parent[0]], nodes.row[parent[1]], row, level);
        if (level + 1 < rules_.size()) {
            for (const Child& child : rule.children) {
                Corners next;
                for (std::size_t k = 0; k < corners; ++k) {
                    next.key[k] = nodes.key[child.corner[k]];
                    next.row[k] = nodes.row[child.corner[k]];
                }
                below(next, level + 1);
            }
        }
        raise(deviations_[static_cast<std::size_t>(made)],
              bfloat16_above(float_above(greatest_[level])));
    }

    /// Makes the row of a new node, and compares its columns with the value there.
    void look_at(double u, const double* a, const double* b, double* row, std::size_t level) {
        const std::size_t columns = level / lanes * lanes + lanes;
        double* const greatest = greatest_.data();
        for (std::size_t i = 0; i < columns; ++i) {
            row[i] = 0.5 * (a[i] + b[i]);
            const double off = std::abs(u - row[i]);
            greatest[i] = greatest[i] < off ? off : greatest[i];
        }
        std::fill(row + level + 1, row + columns_, u);
    }

    std::span<const Rule* const> rules_;
    std::span<const Real> values_;
    std::span<std::atomic<std::uint16_t>> deviations_;
    std::size_t columns_;
    std::vector<double> rows_;      // of the corners of the coarse element, then by level
    std::vector<double> greatest_;  // by level: the deviation of the element that the walk is in
};

}  // namespace

template <class Real>
bool bisects_by_keys(const Hierarchy<Real>& hierarchy) {
    const HierarchyFacts& facts = hierarchy.facts();
    if (!facts.knows_stars || !facts.knows_star_positions) return false;
    bool holds = true;
    const Walk<Real> walk(hierarchy, {.values = false, .keys = true});
    for_each_split_kind(walk, [&](const ElementView<Real>& view, const Split& split,
                                  std::span<const NodeKey> keys) {
        const Rule& rule = *split.rule;
        const std::size_t corners = view.corner_count();
        const Stencil& made = rule.new_nodes[0];
        holds = holds && corners == view.topology().dimension + 1U && rule.new_nodes.size() == 1 &&
                made.mean == Mean::midpoint;
        if (!holds) return;
        const NodeKey a = keys[made.parent[0]];
        const NodeKey b = keys[made.parent[1]];
        holds = ((a ^ b) & 1U) == 0 && keys[corners] == middle_key(a, b);
    });
    return holds;
}

template <class Real>
void sweep_lattice_deviations(const Hierarchy<Real>& hierarchy, const Spread& spread,
                              detail::IndicatorEntries& entries, const Executor& executor) {
    const std::vector<const Rule*> rules = rules_by_level(hierarchy);
    const std::vector<Real> values = values_by_key(hierarchy);
    std::vector<std::atomic<std::uint16_t>> deviations(values.size());
    if (!rules.empty()) {
        const std::size_t coarse = hierarchy.coarse_count();
        const std::size_t tasks = std::min(coarse, 16 * executor.concurrency());
        executor.run(
            tasks,
            [&](std::size_t i) {
                DeviationWalk<Real> walk(rules, values, deviations);
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
    std::vector<std::uint16_t> stops(deviations.begin(), deviations.end());
    sweep_rows(hierarchy, spread, stops);
    for (std::size_t node = 0; node < stops.size(); ++node) {
        entries.dense[node] = {stops[node], deviations[node]};
    }
}

template bool bisects_by_keys(const Hierarchy<float>&);
template bool bisects_by_keys(const Hierarchy<double>&);
template void sweep_lattice_deviations(const Hierarchy<float>&, const Spread&,
                                       detail::IndicatorEntries&, const Executor&);
template void sweep_lattice_deviations(const Hierarchy<double>&, const Spread&,
                                       detail::IndicatorEntries&, const Executor&);

}  // namespace nestgrid::engine
