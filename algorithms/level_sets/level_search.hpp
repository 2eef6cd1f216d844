// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which elements a walk enters to find level sets, and at which it stops.
#pragma once

#include <limits>
#include <span>

#include <contours/level.hpp>
#include <drawing/requirements.hpp>
#include <indicators/packed_entries.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <patches/patch_glance.hpp>
#include <walk/criterion_question.hpp>

namespace nestgrid::engine {

/// Decides about elements by levels, criterion and bounds, all of which it borrows.
/// Immutable: the tasks of a traversal share one.
template <class Real>
class LevelSearch {
public:
    using View = ElementView<Real>;

    /// A decision about an element, and how far the data may leave the range of their corner values
    /// in it.
    struct Sight {
        Decision decision;
        Real bound;
    };

    /// The least and the greatest value of data.
    class DataRange {
    public:
        explicit DataRange(const Bounds& bounds)
            : least_{bounds.least()}, greatest_{bounds.greatest()} {}
        double least() const { return least_; }
        double greatest() const { return greatest_; }

    private:
        double least_;
        double greatest_;
    };

    LevelSearch(const Walk<Real>& walk, std::span<const Level<Real>> levels,
                const Criterion& criterion, const Bounds& bounds);

    std::span<const Level<Real>> levels() const { return levels_; }
    /// Whether a level is that of a function of position.
    bool is_slice(const Level<Real>& level) const { return level.component < functions_; }
    const Bounds& bounds() const { return *bounds_; }
    /// Of component 0 of all data, as bounds() tell it.
    const DataRange& data_range() const { return range_; }
    /// What the criterion promises of a level (Criterion::surface_error); nothing of a slice.
    double surface_error(const Level<Real>& level) const {
        constexpr double nothing = std::numeric_limits<double>::infinity();
        return is_slice(level) ? nothing : criterion_->surface_error({&level.value, 1});
    }
    /// Whether elements may stop without conforming to their neighbours.
    bool may_stop_apart() const {
        return engine::may_stop_apart(walk_->hierarchy(), *criterion_, *bounds_);
    }

    /// Whether the walk in patches may ask: whether the criterion looks at keys and levels alone,
    /// and answers yes or no.
    bool fits_patches() const { return asks_for_masks_; }

    /// Decides about an element and its split.
    /// \param caps whether the element is of interest also where it is wholly inside
    Sight look(const View& view, const Split& split, bool caps, CriterionQuestion& question) const;
    /// The leaves to be extracted: those with corners on both sides of a level. To be inspected:
    /// those with a face that may lie in a slice.
    /// \param values of the father's split, corners first
    /// \param which the children that are leaves, one bit each
    Leaves cut_leaves(const Rule& rule, const Real* values, NodeMask which) const;
    /// The corners of an element that are inside a level, one bit each.
    NESTGRID_INLINE unsigned inside(const Real* value, std::size_t corners,
                                    const Level<Real>& level) const;
    /// |U - P_S U| at a node at which S holds is at most this.
    double offset_bound(NodeKey node) const {
        return own_bounds_ != nullptr ? own_bounds_->offset_bound(node)
                                      : bounds_->offset_bound(node);
    }

    // Questions of the walk in patches, where component 0 is that of all levels: the field's, or an
    // affine function's.
    struct Glance {
        Visit visit;
        Real bound;
    };
    /// Decides about a simplex whose one new node is `node`.
    Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level, bool outside) const;
    bool glance_at_leaf(Real lo, Real hi) const { return of_interest(lo, hi, Real(0), 0, false); }
    /// Decides about eight simplices at once, without a branch.
    template <std::size_t around>
    PackedGlance<Real, around> glance(const PackedElements<Real, around>& e) const;
    /// Fetches the entries of nodes into the cache.
    NESTGRID_INLINE void prefetch(const NodeKey* nodes, std::size_t rows) const {
        if (entries_ == nullptr) return;
        for (std::size_t row = 0; row < rows; ++row) {
            engine::prefetch(*entries_, std::span<const NodeKey>(nodes + row * most_patches, pack));
        }
    }

private:
    struct Range {
        Real lo;
        Real hi;
    };

    Range plain_range_of(const View& view) const;
    NodeMask low_nodes(std::span<const NodeKey> nodes) const;
    Sight look_plainly(const View& view, const Split& split) const;
    Sight look_anyhow(const View& view, const Split& split, bool caps,
                      CriterionQuestion& question) const;
    Range range_of(const View& view, std::size_t component) const;
    bool looks_at(const View& view, const Split& split, std::size_t component, Real bound,
                  bool caps) const;
    std::size_t corners_at_zero(const View& view, std::size_t component) const;
    bool looks_at_function(const View& view, const Split& split, std::size_t component,
                           bool caps) const;
    bool of_interest(Real lo, Real hi, Real bound, std::size_t component, bool also_below) const;
    Real bound_of(const Rule& rule, std::span<const NodeKey> nodes) const;
    NodeMask holds(const NewNodes& nodes) const;
    NodeMask cut_children(const Rule& rule, const Real* values, const Level<Real>& level) const;

    std::span<const Level<Real>> levels_;
    const Walk<Real>* walk_;
    std::size_t components_;
    std::size_t functions_;  // the first components are functions of position
    const Criterion* criterion_;
    const Bounds* bounds_;
    DataRange range_;
    const HierarchicalIndicator* own_bounds_;   // bounds_ where it has this type, else null
    const detail::IndicatorEntries* entries_;   // entries of own_bounds_, or null
    const Threshold* own_threshold_ = nullptr;  // criterion_ where it is one of own_bounds_
    Pack<float> packed_threshold_{};
    std::size_t last_component_ = 0;
    bool saturated_;
    bool asks_for_masks_;
    bool never_stops_;  // S holds nowhere
    // One level of the only component, and own_threshold_ is the criterion.
    bool looks_plainly_ = false;
    std::uint16_t most_ = 0;  // the threshold as bfloat16, where looks_plainly_
};

template <class Real>
NESTGRID_INLINE unsigned LevelSearch<Real>::inside(const Real* value, std::size_t corners,
                                                   const Level<Real>& level) const {
    unsigned bits = 0;
    if (components_ == 1 && corners == max_corners) {
        for (std::size_t i = 0; i < max_corners; ++i) {
            bits |= unsigned{value[i] >= level.least_inside} << i;
        }
        return bits;
    }
    value += level.component;
    for (std::size_t i = 0; i < corners; ++i) {
        bits |= unsigned{value[i * components_] >= level.least_inside} << i;
    }
    return bits;
}

template <class Real>
template <std::size_t around>
NESTGRID_INLINE PackedGlance<Real, around> LevelSearch<Real>::glance(
    const PackedElements<Real, around>& e) const {
    using Reals = Pack<Real>;
    using Mask = typename Reals::Mask;
    PackedGlance<Real, around> result;
    Mask holds;
    if (own_threshold_ != nullptr) {
        const PackedEntries known = engine::look_up(*entries_, e.node);
        const auto stops = at_most(known.stop(), packed_threshold_);
        if constexpr (std::is_same_v<Real, float>) {
            result.bound = known.bound();
            holds = stops;
        } else {
            const auto bounds = known.bound().numbers();
            const auto all = stops.numbers();
            result.bound = Reals::make(
                [&](auto i) NESTGRID_INLINE_LAMBDA { return static_cast<Real>(bounds[i]); });
            holds = Mask::make([&](auto i) NESTGRID_INLINE_LAMBDA {
                return all[i] != 0 ? ~MaskOf<Real>{0} : MaskOf<Real>{0};
            });
        }
    } else if (never_stops_ && functions_ > 0) {
        result.bound = Reals::all(0);
        holds = Mask::all(0);
    } else {
        const auto key = [&](auto i) NESTGRID_INLINE_LAMBDA {
            return std::span<const NodeKey>(e.node + i, 1);
        };
        result.bound =
            Reals::make([&](auto i) NESTGRID_INLINE_LAMBDA { return bound_of(e.rule, key(i)); });
        holds = Mask::make([&](auto i) NESTGRID_INLINE_LAMBDA {
            const NodeMask mask = this->holds({e.rule, key(i), e.level + 1, 0});
            return mask != 0 ? ~MaskOf<Real>{0} : MaskOf<Real>{0};
        });
    }
    // Where a function of position is drawn, it does not leave the range of its corner values.
    const Reals beyond = functions_ > 0 ? Reals::all(0) : result.bound;
    unrolled<around>([&](auto i) NESTGRID_INLINE_LAMBDA {
        const Reals& lo = e.range[i].first;
        const Reals& hi = e.range[i].second;
        const auto passes = [&](const Level<Real>& level) NESTGRID_INLINE_LAMBDA {
            return at_most(
                max(Reals::all(level.least_inside) - hi, lo - Reals::all(level.greatest_outside)),
                beyond);
        };
        Mask interest = passes(levels_[0]);
        for (const Level<Real>& level : levels_.subspan(1)) interest = interest | passes(level);
        result.descend[i] = without(interest, holds);
        result.stop[i] = interest & holds;
    });
    return result;
}

}  // namespace nestgrid::engine
