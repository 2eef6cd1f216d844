// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/eta_source.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <indicators/spread.hpp>
#include <indicators/star_sweep.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/agreement.hpp>
#include <walk/hanging_nodes.hpp>
#include <walk/unusable_values.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

void NodeEtas::refuse(double eta) {
    throw UnusableValue("the measure of a node is not a usable number: " + std::to_string(eta));
}

detail::NodeTable<std::uint16_t> NodeEtas::saturate(const Spread& spread,
                                                    const SharedNodes* shared) {
    maxima_.saturate([&](std::uint16_t stop, float reach) { return hand_on(spread, stop, reach); },
                     shared);
    return maxima_.take_table();
}

double finite_offset(double offset) {
    if (std::isfinite(offset)) return std::abs(offset);
    throw UnusableValue("a value of the field is not a usable number");
}

double trace_of(double offset) {
    return finite_offset(offset) == 0 ? 0 : double{std::numeric_limits<float>::denorm_min()};
}

namespace {

/// Which numbers of a split the visitor keeps for the sweep over all splits.
enum class Kept { nothing, nodes, nodes_and_reach };

/// Shows a source the splits that a walk meets.
template <class Real>
class SourceVisitor final : public Visitor<Real> {
public:
    using View = ElementView<Real>;

    SourceVisitor(const Walk<Real>& walk, EtaSource& source, Kept kept, NodeEtas& etas)
        : walk_{&walk}, source_{&source}, kept_{kept}, etas_{&etas} {}

    bool sees_hidden() const override { return true; }
    Leaves leaves(const Rule& rule, const Real*, NodeMask which, bool) override {
        // entered() is not called for copies.
        if (!rule.new_nodes.empty()) source_->leaves(measured(rule), nodes_of(rule), which);
        return {};
    }
    Decision inspect(const View&, const Split&) override { return {}; }
    void extract(const View&) override {}

    void entered(const View& view, const Split& split, const Real* value) override {
        const Rule& rule = *split.rule;
        const std::size_t corners = view.corner_count();
        const std::size_t count = corners + rule.new_nodes.size();
        level_ = view.level;
        components_ = source_->wants_values() ? walk_->components() : 0;
        walk_->split_positions(view, split, positions_);
        values_.assign(value, value + count * components_);
        means_.resize(rule.new_nodes.size() * components_);
        double* mean = means_.data();
        for (const Stencil& stencil : rule.new_nodes) {
            for (std::size_t c = 0; c < components_; ++c) {
                *mean++ = nestgrid::detail::interpolate(stencil, value + c, components_);
            }
        }
        etas_->maxima().find(walk_->split_keys(view, split, keys_), std::span(nodes_).first(count));
        const auto nodes = nodes_of(rule);
        const MeasuredSplit all = measured(rule);
        source_->split(all, nodes, *etas_);
        etas_->put_outside(rule, split.outside, nodes);
        if (kept_ == Kept::nothing) return;
        const float reach = kept_ == Kept::nodes_and_reach ? reach_of(rule, all.positions) : 0;
        etas_->maxima().add_split(view.level, rule, nodes, reach);
    }

private:
    /// The split that was entered last, and the numbers of its nodes.
    MeasuredSplit measured(const Rule& rule) const {
        const std::size_t count = nodes_of(rule).size();
        return {rule, level_, std::span(positions_).first(count), values_, means_, components_};
    }
    std::span<const std::size_t> nodes_of(const Rule& rule) const {
        return std::span(nodes_).first(static_cast<std::size_t>(rule.corner_count()) +
                                       rule.new_nodes.size());
    }
    const Walk<Real>* walk_;
    EtaSource* source_;
    Kept kept_;
    NodeEtas* etas_;
    SplitKeys keys_;
    int level_ = 0;
    std::size_t components_ = 0;
    SplitPositions positions_;
    std::array<std::size_t, max_corners + max_new_nodes> nodes_{};
    std::vector<double> values_;
    std::vector<double> means_;
};

}  // namespace

template <class Real>
SweptIndicator sweep_source(const Hierarchy<Real>& hierarchy, EtaSource& source,
                            const Spread& spread) {
    const SharedNodes* const shared = hierarchy.facts().shared;
    HangingNodes hanging;
    std::optional<Walk<Real>> walk_here;
    const auto asked = [&] {
        return source.name() + ", factor " + all_digits(spread.factor) + ", slope " +
               all_digits(spread.slope);
    };
    const bool on_ranks = !source.name().empty();
    if (!on_ranks) hierarchy.facts().require_one_process("this indicator");
    together(shared, asked, [&] {
        require_spread(spread);
        if (shared != nullptr) require_same_state(hierarchy);
        hanging = find_hanging_nodes(hierarchy);
        const Needs needs{
            .values = source.wants_values(), .keys = true, .positions = true, .on_ranks = on_ranks};
        walk_here.emplace(hierarchy, needs, &hanging);
    });
    const Walk<Real>& walk = *walk_here;
    const std::size_t dense = hierarchy.facts().node_count;
    NodeEtas etas(dense);
    const bool in_rows = hierarchy.facts().knows_star_positions;
    const Kept for_splits = spread.slope > 0 ? Kept::nodes_and_reach : Kept::nodes;
    SourceVisitor<Real> visitor(walk, source, in_rows ? Kept::nothing : for_splits, etas);
    together(shared, "an indicator of measures",
             [&] { with_places(hierarchy, [&] { walk.run(visitor); }); });
    if (shared != nullptr) source.agree(*shared, etas);
    together(shared, "an indicator of measures",
             [&] { with_places(hierarchy, [&] { source.finish(etas); }); });
    if (!in_rows) return {etas.saturate(spread, shared), spread, hierarchy.epoch()};
    auto table = etas.take();
    sweep_rows(hierarchy, spread, table.dense);
    return {std::move(table), spread, hierarchy.epoch()};
}

template SweptIndicator sweep_source(const Hierarchy<float>&, EtaSource&, const Spread&);
template SweptIndicator sweep_source(const Hierarchy<double>&, EtaSource&, const Spread&);

}  // namespace nestgrid::engine
