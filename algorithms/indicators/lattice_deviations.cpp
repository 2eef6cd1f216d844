// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/lattice_deviations.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <indicators/lattice_walk.hpp>
#include <indicators/rules_by_level.hpp>
#include <indicators/split_kinds.hpp>
#include <indicators/star_sweep.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

namespace {

/// Takes the greatest difference between the interpolants of elements and the values at new nodes.
class DeviationMeasure {
public:
    static constexpr bool sees_leaves = false;

    /// \param columns the size of a row
    DeviationMeasure(std::size_t columns, RaisedNumbers& deviations)
        : deviations_{&deviations}, greatest_(columns) {}

    bool enters(const LatticeCorners&, std::size_t level, NodeKey) {
        greatest_[level] = 0;
        return true;
    }
    void make_row(double u, const double* a, const double* b, double* row, std::size_t level) {
        constexpr std::size_t lanes = 4;
        const std::size_t columns = level / lanes * lanes + lanes;
        double* const greatest = greatest_.data();
        for (std::size_t i = 0; i < columns; ++i) {
            row[i] = 0.5 * (a[i] + b[i]);
            const double off = std::abs(u - row[i]);
            greatest[i] = greatest[i] < off ? off : greatest[i];
        }
    }
    void leave(std::size_t level, NodeKey made) { raise(*deviations_, made, greatest_[level]); }

private:
    RaisedNumbers* deviations_;
    std::vector<double> greatest_;  // by level: the deviation of the element that the walk is in
};

}  // namespace

template <class Real>
bool bisects_by_keys(const Hierarchy<Real>& hierarchy) {
    const HierarchyFacts& facts = hierarchy.facts();
    // Walks by keys ask for values that hidden leaves alone have.
    if (!facts.knows_stars || !facts.knows_star_positions || facts.offers(Feature::hidden)) {
        return false;
    }
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
    RaisedNumbers deviations(values.size());
    const std::size_t columns = LatticeWalk<Real, DeviationMeasure>::row_size(rules.size());
    walk_lattice<Real>(hierarchy, rules, values, executor,
                       [&] { return DeviationMeasure(columns, deviations); });
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
