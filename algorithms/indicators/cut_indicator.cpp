// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/cut_indicator.hpp>

#include <cmath>

#include <indicators/eta_source.hpp>
#include <indicators/lattice_cuts.hpp>
#include <indicators/lattice_deviations.hpp>
#include <indicators/spread.hpp>
#include <indicators/star_sweep.hpp>
#include <indicators/walk_in_logs.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid {

namespace engine {

namespace {

/// What the walk over all splits is to do.
struct CutWalk {
    CutRequest request;
    bool logs_splits;  ///< the sweep needs all splits
    bool measures;     ///< the sweep needs distances between nodes
};

/// The numbers of all nodes, and the splits where the sweep needs them.
class CutEtas {
public:
    explicit CutEtas(std::size_t dense) : etas_{dense} {}

    template <class Offset>
    void split(const PrerollSplit& s, Offset&&) {
        const auto of = numbers(s.keys);
        etas_.put_outside(*s.rule, s.outside, of);
        etas_.maxima().add_split(s.level, *s.rule, of, s.reach);
    }
    void leaf(std::span<const NodeKey>, float) {}
    void deviation(const Deviation& d) {
        for (const std::size_t node : numbers(d.made)) etas_.raise(node, d.stop);
    }
    NodeEtas& etas() { return etas_; }

private:
    std::span<const std::size_t> numbers(std::span<const NodeKey> keys) {
        etas_.maxima().find(keys, numbers_);
        return std::span(numbers_).first(keys.size());
    }

    NodeEtas etas_;
    std::array<std::size_t, max_corners + max_new_nodes> numbers_{};
};

/// Tells a receiver of the numbers of the elements that a walk meets, and of splits.
/// \tparam Receiver CutEtas or PrerollLog
template <class Real, class Receiver>
class CutVisitor final : public TaskVisitor<Real> {
public:
    using View = ElementView<Real>;

    CutVisitor(const Walk<Real>& walk, const CutWalk& what, Receiver& receiver)
        : walk_{&walk},
          what_{&what},
          receiver_{&receiver},
          cuts_{walk, what.request, [this](std::span<const NodeKey> made, double eta) {
                    receiver_->deviation({made, eta, eta});
                }} {}

    bool sees_hidden() const override { return true; }
    Leaves leaves(const Rule& rule, const Real*, NodeMask which, bool) override {
        // entered() is not called for copies.
        return {0, in_sight_ || rule.new_nodes.empty() ? which : NodeMask{0}};
    }
    Decision inspect(const View& view, const Split& split) override {
        const bool seen = cuts_.enter(view, split);
        return {seen || what_->logs_splits ? Visit::descend : Visit::skip, 0};
    }
    void entered(const View& view, const Split& split, const Real* value) override {
        if (what_->logs_splits) tell_of(view, split);
        in_sight_ = cuts_.is_in(view);
        if (in_sight_) cuts_.split(split, value);
    }
    void extract(const View&) override {}
    void finish() { cuts_.finish(); }

    Decision look(const View&, const Split&) override { return {}; }
    void undo() override {}
    void restart() override {
        cuts_.clear();
        if constexpr (std::is_same_v<Receiver, PrerollLog>) receiver_->clear();
    }

private:
    void tell_of(const View& view, const Split& split) {
        SplitKeys keys;
        SplitPositions x;
        const float reach =
            what_->measures ? reach_of(*split.rule, walk_->split_positions(view, split, x)) : 0;
        receiver_->split(
            {split.rule, view.level, split.outside, reach, walk_->split_keys(view, split, keys)},
            [](std::size_t) { return 0.0F; });
    }

    const Walk<Real>* walk_;
    const CutWalk* what_;
    Receiver* receiver_;
    PathCuts<Real> cuts_;
    bool in_sight_ = false;  // PathCuts wants to see the leaves of the split that was entered last
};

template <class Real>
void walk_cuts(const Walk<Real>& walk, const CutWalk& what, CutEtas& etas,
               const Executor& executor) {
    if (executor.concurrency() > 1) {
        using Visitor = CutVisitor<Real, PrerollLog>;
        walk_in_logs(
            walk, executor,
            [&](PrerollLog& log) { return std::make_unique<Visitor>(walk, what, log); },
            [&](const Visitor&, const PrerollLog& log) { log.repeat(etas); });
        return;
    }
    CutVisitor<Real, CutEtas> visitor(walk, what, etas);
    walk.run(visitor);
    visitor.finish();
}

/// \throw InvalidInput, GridError where what is asked for is not sound
template <class Real>
void require_sound(const Hierarchy<Real>& hierarchy, const CutRequest& request,
                   const Spread& spread) {
    require_spread(spread);
    for (const double isovalue : request.isovalues) {
        if (!std::isfinite(isovalue)) throw InvalidInput("the isovalue is not a finite number");
    }
    if (request.bounds->made_for(hierarchy.epoch())) return;
    throw GridError("the grid has changed since its bounds were computed");
}

template <class Real>
SweptIndicator measure_cuts(const Hierarchy<Real>& hierarchy, const CutRequest& request,
                            const Spread& spread, const Executor& executor) {
    const HierarchyFacts& facts = hierarchy.facts();
    const auto asked = [&] {
        std::string text = request.distances ? "distances of cuts at " : "deviations of cuts at ";
        for (const double isovalue : request.isovalues) text += all_digits(isovalue) + ", ";
        return text + "factor " + all_digits(spread.factor) + ", slope " + all_digits(spread.slope);
    };
    together(facts.shared, asked, [&] {
        if (facts.shared != nullptr) require_same_state(hierarchy);
        require_sound(hierarchy, request, spread);
    });
    // Distances keep no promise.
    const auto promised = request.distances ? std::span<const double>{} : request.isovalues;
    const bool in_rows = facts.knows_star_positions;
    detail::NodeTable<std::uint16_t> table;
    if (bisects_by_keys(hierarchy)) {
        table.dense = lattice_cuts(hierarchy, request, executor);
    } else {
        const bool measures = spread.slope > 0 && !in_rows;
        const Needs needs{
            .values = true,
            .keys = true,
            .positions = measures || request.distances || !detail::cuts_are_errors(facts),
            .on_ranks = true};
        CutEtas etas(facts.node_count);
        together(facts.shared, "deviations of cuts", [&] {
            walk_cuts(Walk<Real>(hierarchy, needs, request.bounds->hanging()),
                      CutWalk{request, !in_rows, measures}, etas, executor);
        });
        table = in_rows ? etas.etas().take() : etas.etas().saturate(spread, facts.shared);
    }
    if (in_rows) sweep_rows(hierarchy, spread, table.dense);
    return {std::move(table), spread, hierarchy.epoch(), promised};
}

}  // namespace

}  // namespace engine

bool detail::cuts_are_errors(const HierarchyFacts& facts) {
    return facts.only_shape == Shape::tetrahedron || facts.only_shape == Shape::triangle;
}

SweptIndicator cut_deviations(const FieldOnGrid& field, std::span<const double> isovalues,
                              const Bounds& bounds, const Spread& spread,
                              const Executor& executor) {
    return field.visit([&](const auto& hierarchy) {
        return engine::measure_cuts(hierarchy, {isovalues, &bounds, false}, spread, executor);
    });
}

SweptIndicator slope_deviations(const FieldOnGrid& field, std::span<const double> isovalues,
                                const Bounds& bounds, const Spread& spread,
                                const Executor& executor) {
    return field.visit([&](const auto& hierarchy) {
        return engine::measure_cuts(hierarchy, {isovalues, &bounds, true}, spread, executor);
    });
}

}  // namespace nestgrid
