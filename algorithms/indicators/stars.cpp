// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/stars.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include <indicators/offset.hpp>
#include <indicators/packed_entries.hpp>
#include <indicators/packed_round_up.hpp>
#include <indicators/rules_by_level.hpp>
#include <nestgrid/detail/mean.hpp>

namespace nestgrid::engine {

namespace {

/// The mean of the values at a number of parents, to the last bit that of the walk.
/// \tparam Number a Pack
/// \param at at(i) is the values at parent i
template <class Number, class At>
NESTGRID_INLINE Number mean_of_parents(std::size_t parents, const At& at) {
    if (parents == 2) return midpoint<Number>(at(0), at(1));
    if (parents == 4) return face_mean<Number>(at(0), at(1), at(2), at(3));
    return cell_mean(std::array<Number, 8>{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)});
}

/// Computes stop and bound of the nodes in rows, four at once, and the range of values.
template <class Real>
class StarRows {
public:
    StarRows(const Hierarchy<Real>& hierarchy, detail::IndicatorEntry* entries)
        : hierarchy_{&hierarchy},
          may_be_missing_{hierarchy.offers(Feature::hidden)},
          entries_{entries} {}

    void add(const StarRow& row) {
        for (std::size_t i = 0; i < row.count; i += run_) make_run(row, i);
        for (std::size_t i = row.count - row.outside; i < row.count; ++i) {
            entries_[row.first + i * row.stride].stop = detail::bfloat16_infinity;
        }
    }

    /// \throw InvalidInput where one of the values is not usable
    void add_values(detail::PrerollFacts& facts) const {
        constexpr Real limit = std::numeric_limits<Real>::max() / 8;
        for (const Real nan_or_zero : unusable_.numbers()) {
            if (nan_or_zero != 0) facts.add_value(static_cast<double>(nan_or_zero), limit);
        }
        if (least_.template number<0>() > greatest_.template number<0>()) return;  // no values
        for (const Real v : least_.numbers()) facts.add_value(static_cast<double>(v), limit);
        for (const Real v : greatest_.numbers()) facts.add_value(static_cast<double>(v), limit);
    }

private:
    static constexpr std::size_t run_ = 64;  // nodes whose values are fetched at once
    static constexpr std::size_t width_ = 4;
    using Run = std::array<Real, run_>;
    using Steps = std::array<std::size_t, width_>;
    using Reals = Pack<Real, width_>;
    using Floats = Pack<float, width_>;
    using Entries = Pack<std::uint32_t, width_>;

    void make_run(const StarRow& row, std::size_t first) {
        const std::size_t count = std::min(run_, row.count - first);
        const std::size_t node = row.first + first * row.stride;
        const auto fetch = [&](std::ptrdiff_t offset, Run& to) {
            hierarchy_->row_values(static_cast<NodeKey>(node + static_cast<std::size_t>(offset)),
                                   row.stride, std::span(to).first(count));
            for (std::size_t i = count; i % width_ != 0; ++i) to[i] = to[count - 1];
        };
        if (!row.gathers) {
            fetch(0, own_);
            for (std::size_t p = 0; p < row.parents.size(); ++p) fetch(row.parents[p], parent_[p]);
            if (may_be_missing_) leave_out_missing(count, row.parents.size());
        }
        // Where fewer than four nodes are left, computes the last one several times.
        Steps whole;
        Steps rest;
        for (std::size_t k = 0; k < width_; ++k) {
            whole[k] = k * row.stride;
            rest[k] = std::min(k, (count - 1) % width_) * row.stride;
        }
        for (std::size_t i = 0, at = node; i < count; i += width_, at += width_ * row.stride) {
            make(row, i, entries_ + at, i + width_ <= count ? whole : rest);
        }
    }

    /// Makes the offset of a node infinite where a parent has no value (NaN): what a walk has there
    /// is the mean of no data. Where the node has none itself, it is 0: nobody asks.
    void leave_out_missing(std::size_t count, std::size_t parents) {
        for (std::size_t i = 0; i < (count + width_ - 1) / width_ * width_; ++i) {
            const bool missing = std::isnan(own_[i]);
            if (!missing) add_range(Reals::all(own_[i]));
            bool beside = false;
            for (std::size_t p = 0; p < parents; ++p) {
                beside = beside || std::isnan(parent_[p][i]);
            }
            if (!missing && !beside) continue;
            own_[i] = missing ? 0 : std::numeric_limits<Real>::infinity();
            for (std::size_t p = 0; p < parents; ++p) parent_[p][i] = 0;
        }
    }

    /// Computes four entries.
    /// \param i number of the first node in the run
    /// \param to its entry
    /// \param step from this entry to each of the four
    NESTGRID_INLINE void make(const StarRow& row, std::size_t i, detail::IndicatorEntry* to,
                              const Steps& step) {
        Entries made = Entries::all(0);
        for (const std::ptrdiff_t offset : row.finer) {
            const detail::IndicatorEntry* const finer = to + offset;
            made = greater_halves(made, Entries::make([&](auto k) NESTGRID_INLINE_LAMBDA {
                                      return bits_of(finer[step[k]]);
                                  }));
        }
        if (!row.gathers && !may_be_missing_) add_range(Reals::load(own_.data() + i));
        if (!row.parents.empty()) {
            const Floats own = own_offsets(row.parents.size(), i);
            const auto finer = (made & Entries::all(0xFFFF0000U)).template as<float>();
            made = greater_halves(
                made, bfloat16_above(own) >> 16 | bfloat16_above(sum_above(own, finer)));
        }
        const auto bits = made.numbers();
        for (std::size_t k = 0; k < width_; ++k) to[step[k]] = entry_of(bits[k]);
    }

    NESTGRID_INLINE void add_range(const Reals& v) {
        least_ = min(least_, v);
        greatest_ = max(greatest_, v);
        unusable_ = unusable_ + v * Reals::all(0);
    }

    /// The greater upper and the greater lower halves of words. Requires halves below 2^15.
    NESTGRID_INLINE static Entries greater_halves(const Entries& a, const Entries& b) {
        using Halves [[gnu::vector_size(2 * width_ * sizeof(std::int16_t))]] = std::int16_t;
        const auto x = std::bit_cast<Halves>(a.numbers());
        const auto y = std::bit_cast<Halves>(b.numbers());
        const Halves greater = x < y ? y : x;
        return Entries::load(std::bit_cast<std::array<std::uint32_t, width_>>(greater).data());
    }

    NESTGRID_INLINE Floats own_offsets(std::size_t parents, std::size_t i) const {
        const Reals own = Reals::load(own_.data() + i);
        const auto mean =
            mean_of_parents<Reals>(parents, [&](std::size_t p) NESTGRID_INLINE_LAMBDA {
                return Reals::load(parent_[p].data() + i);
            });
        if constexpr (std::is_same_v<Real, float>) {
            return distance_above(own, mean);
        } else {
            return Floats::make([&](auto k) NESTGRID_INLINE_LAMBDA {
                return offset_above(own.template number<k>(), mean.template number<k>());
            });
        }
    }

    const Hierarchy<Real>* hierarchy_;
    bool may_be_missing_;
    detail::IndicatorEntry* entries_;
    Run own_;
    std::array<Run, 8> parent_;
    Reals least_ = Reals::all(std::numeric_limits<Real>::infinity());
    Reals greatest_ = Reals::all(-std::numeric_limits<Real>::infinity());
    Reals unusable_ = Reals::all(0);  // NaN where a value is infinite or not a number
};

/// Adds the rules of one element of each level, because all elements of a level are split alike.
template <class Real>
void add_splits(const Hierarchy<Real>& hierarchy, detail::PrerollFacts& facts) {
    for (const Rule* rule : rules_by_level(hierarchy)) {
        facts.largest_split = std::max(facts.largest_split, rule->new_nodes.size());
        facts.all_divided = facts.all_divided && rule->divides_all;
        facts.longest_chain = std::max(facts.longest_chain, rule->steps);
        ++facts.finest_level;
    }
}

}  // namespace

template <class Real>
detail::PrerollFacts sweep_stars(const Hierarchy<Real>& hierarchy,
                                 detail::IndicatorEntries& entries) {
    detail::PrerollFacts facts;
    add_splits(hierarchy, facts);
    // A node of no element is in no row, and its entry is 0. Where rows hold all nodes, no entry
    // needs to be set before.
    const std::size_t count = hierarchy.facts().node_count;
    entries.dense = hierarchy.facts().fills_rows
                        ? std::make_unique_for_overwrite<detail::IndicatorEntry[]>(count)
                        : std::make_unique<detail::IndicatorEntry[]>(count);
    StarRows<Real> rows(hierarchy, entries.dense.get());
    hierarchy.star_rows([&](const StarRow& row) { rows.add(row); });
    rows.add_values(facts);
    return facts;
}

template detail::PrerollFacts sweep_stars(const Hierarchy<float>&, detail::IndicatorEntries&);
template detail::PrerollFacts sweep_stars(const Hierarchy<double>&, detail::IndicatorEntries&);

}  // namespace nestgrid::engine
