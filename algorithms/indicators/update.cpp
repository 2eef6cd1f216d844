// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/update.hpp>

#include <indicators/preroll_visitor.hpp>

namespace nestgrid::engine {

/// Marks the dirty nodes that one walk can tell.
template <class Real>
class DirtyNodes::Marker final : public Visitor<Real> {
public:
    Marker(const Walk<Real>& walk, const ChangedPlaces& changed, bool refined, DirtyNodes& dirty)
        : walk_{&walk}, changed_{&changed}, refined_{refined}, dirty_{&dirty} {}

    bool sees_hidden() const override { return true; }
    Leaves leaves(const Rule&, const Real*, NodeMask which, bool) override {
        return {0, refined_ ? which : NodeMask{0}};
    }
    Decision inspect(const ElementView<Real>& view, const Split& split) override {
        SplitKeys room;
        const auto keys = walk_->split_keys(view, split, room);
        const auto corners = keys.first(view.corner_count());
        walk_->corners(view, nullptr, positions_.data());
        const bool touched = touches(corners);
        if (!touched && !dirty_->any(corners)) return {Visit::skip, 0};
        if (split.rule == nullptr) {
            if (touched && refined_) mark(corners);
            return {};
        }
        if (touched) mark_moved(view, split, keys);
        const auto made = keys.subspan(corners.size());
        const std::size_t inside = split.rule->inside;
        if (inside != no_new_node && dirty_->any(made)) mark(made.subspan(inside, 1));
        splits_.find(keys, nodes_);
        const auto nodes = std::span(nodes_).first(keys.size());
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (dirty_->contains(keys[i])) splits_[nodes[i]] = 1;
        }
        splits_.add_split(view.level, *split.rule, nodes);
        return {};
    }
    void extract(const ElementView<Real>&) override {}

    /// Marks the nodes that dirty ones depend on.
    void saturate() {
        splits_.saturate();
        const std::vector<std::uint8_t> marks = splits_.take();
        splits_.for_each([&](NodeKey key, std::size_t node) {
            if (marks[node] != 0) dirty_->state_.insert(key, {});
        });
    }

private:
    bool moved(NodeKey node) const {
        const State* const state = dirty_->state_.find(node);
        return state != nullptr && state->moved;
    }
    bool touches(std::span<const NodeKey> corners) const {
        return std::ranges::any_of(corners, [&](NodeKey node) { return moved(node); }) ||
               (*changed_)(std::span<const Point>(positions_).first(corners.size()));
    }
    void mark(std::span<const NodeKey> nodes) {
        for (const NodeKey node : nodes) dirty_->state_.insert(node, {});
    }

    /// Marks the new nodes whose value or parents have changed.
    void mark_moved(const ElementView<Real>& view, const Split& split,
                    std::span<const NodeKey> keys) {
        const Rule& rule = *split.rule;
        const std::size_t corners = view.corner_count();
        const std::size_t made = rule.new_nodes.size();
        walk_->split_positions(view, split, positions_);
        std::array<bool, max_corners + max_new_nodes> moves;
        for (std::size_t k = 0; k < corners; ++k) {
            moves[k] = moved(keys[k]) || (*changed_)({&positions_[k], 1});
        }
        for (std::size_t n = 0; n < made; ++n) {
            const std::size_t at = corners + n;
            const Stencil& stencil = rule.new_nodes[n];
            bool parent_moves = (split.crossing >> n & 1U) != 0;  // its parents lie elsewhere
            for (std::size_t i = 0; i < stencil.count; ++i) {
                parent_moves = parent_moves || moves[stencil.parent[i]];
            }
            const bool is_mean = ((split.constrained | split.crossing) >> n & 1U) != 0;
            moves[at] = is_mean ? parent_moves : (*changed_)({&positions_[at], 1});
            if (!moves[at] && !parent_moves) continue;
            State& state = *dirty_->state_.insert(keys[at], {}).first;
            state.moved = state.moved || (is_mean && moves[at]);
        }
    }

    const Walk<Real>* walk_;
    const ChangedPlaces* changed_;
    bool refined_;  // the grid may have changed
    DirtyNodes* dirty_;
    NodeMaxima<std::uint8_t> splits_{0, 0};  // 1 at dirty nodes
    std::array<std::size_t, max_corners + max_new_nodes> nodes_{};
    SplitPositions positions_;
};

template <class Real>
DirtyNodes::DirtyNodes(const Walk<Real>& walk, const ChangedPlaces& changed, bool refined) {
    for (bool more = true; more;) {
        const std::size_t before = state_.size();
        Marker<Real> marker(walk, changed, refined, *this);
        walk.run(marker);
        marker.saturate();
        more = state_.size() > before;
    }
}

namespace {

/// Tells sweeps of splits and leaves, and of the entries of their clean nodes.
class DirtySweeps {
public:
    DirtySweeps(const DirtyNodes& dirty, const detail::IndicatorEntries& entries, Sweeps& sweeps)
        : dirty_{&dirty}, entries_{&entries}, sweeps_{&sweeps} {}

    template <class Offset>
    void split(const PrerollSplit& s, Offset&& offset) {
        raise_clean(s.keys);
        const auto corners = static_cast<std::size_t>(s.rule->corner_count());
        sweeps_->split(s, [&](std::size_t n) {
            return dirty_->contains(s.keys[corners + n]) ? offset(n) : 0.0F;
        });
    }
    void leaf(std::span<const NodeKey> corners, float error) {
        raise_clean(corners);
        sweeps_->leaf(corners, error);
    }
    void deviation(const Deviation&) {}  // those are made anew

private:
    void raise_clean(std::span<const NodeKey> nodes) {
        for (const NodeKey node : nodes) {
            if (!dirty_->contains(node)) sweeps_->raise(node, entries_->at(node));
        }
    }

    const DirtyNodes* dirty_;
    const detail::IndicatorEntries* entries_;
    Sweeps* sweeps_;
};

}  // namespace

template <class Real>
detail::PrerollFacts sweep_dirty(const Walk<Real>& walk, const DirtyNodes& dirty,
                                 const detail::IndicatorEntries& entries,
                                 const LeafErrors& leaf_errors, const Spread& spread,
                                 const std::function<void(NodeKey, detail::IndicatorEntry)>& put) {
    Sweeps sweeps(0, leaf_errors ? MadeOf::leaf_errors : MadeOf::offsets, spread);
    DirtySweeps receiver(dirty, entries, sweeps);
    const PrerollRequest request{.leaf_errors = &leaf_errors, .measures = spread.slope > 0};
    PrerollVisitor<Real, DirtySweeps> visitor(walk, request, receiver);
    const ElementTest<Real> has_dirty_corner = [&](const ElementView<Real>& view, const Split&) {
        std::array<NodeKey, max_corners> keys;
        walk.corners(view, keys.data(), nullptr);
        return dirty.any(std::span<const NodeKey>(keys).first(view.corner_count()));
    };
    visitor.restrict_to(has_dirty_corner);
    walk.run(visitor);
    sweeps.saturate();
    sweeps.for_each([&](NodeKey node, const detail::IndicatorEntry& entry) {
        if (dirty.contains(node)) put(node, entry);
    });
    detail::PrerollFacts facts = visitor.facts();
    facts.one_level_a_node = sweeps.one_level_a_node();
    return facts;
}

template DirtyNodes::DirtyNodes(const Walk<float>&, const ChangedPlaces&, bool);
template DirtyNodes::DirtyNodes(const Walk<double>&, const ChangedPlaces&, bool);
template detail::PrerollFacts sweep_dirty(
    const Walk<float>&, const DirtyNodes&, const detail::IndicatorEntries&, const LeafErrors&,
    const Spread&, const std::function<void(NodeKey, detail::IndicatorEntry)>&);
template detail::PrerollFacts sweep_dirty(
    const Walk<double>&, const DirtyNodes&, const detail::IndicatorEntries&, const LeafErrors&,
    const Spread&, const std::function<void(NodeKey, detail::IndicatorEntry)>&);

}  // namespace nestgrid::engine
