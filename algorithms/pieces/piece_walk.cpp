// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <pieces/piece_walk.hpp>

#include <algorithm>

#include <levels/error_bound.hpp>
#include <nestgrid/error.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::engine {

PieceWalk::PieceWalk(const Walk<double>& walk, const DiscontinuousData& data,
                     const ElementDeviations* deviations, const DiscontinuousOptions& options,
                     std::size_t in_front)
    : walk_{&walk},
      corner_values_(data),
      deviations_{options.threshold > 0 ? deviations : nullptr},
      options_{&options},
      in_front_{in_front},
      values_(max_corners * walk.components()),
      range_{deviations} {}

double PieceWalk::Range::least() const {
    return deviations == nullptr ? -std::numeric_limits<double>::infinity() : deviations->least();
}
double PieceWalk::Range::greatest() const {
    return deviations == nullptr ? std::numeric_limits<double>::infinity() : deviations->greatest();
}

void PieceWalk::run(DiscontinuousSurface& result) {
    try {
        walk_->run(*this);
    } catch (const Cancelled&) {
        result.cancelled = true;
    }
    result.counts = counts_;
    result.range_bound = greatest_difference({range_.least(), range_.greatest()}, range_);
    result.error_bound = std::min(error_bound_, result.range_bound);
}

/// \throw Cancelled where progress says so
void PieceWalk::count() {
    ++counts_.calls;
    if ((counts_.calls & 0xFFFFU) != 0 || !options_->progress) return;
    if (!options_->progress(counts_)) throw Cancelled{};
}

Decision PieceWalk::inspect(const View& view, const Split& split) {
    count();
    const bool interest = of_interest(view, split);
    counts_.visited += interest ? 1 : 0;
    deviation_ = 0;
    if (split.rule == nullptr) return {interest ? Visit::stop : Visit::skip};
    if (deviations_ == nullptr) return {interest ? Visit::descend : Visit::skip};
    const ElementDeviations::Entry& entry = deviations_->entries()[next_];
    deviation_ = static_cast<double>(entry.deviation);
    const bool stops = deviation_ <= options_->threshold;
    next_ += interest && !stops ? 1 : entry.subtree;
    if (!interest) return {Visit::skip};
    return {stops ? Visit::stop : Visit::descend};
}

void PieceWalk::extract(const View& view) {
    ++counts_.extracted;
    corner_values_.put(view.element(), view.member->rule, view.shape, values_.data() + in_front_,
                       walk_->components());
    View valued = view;
    valued.value = values_.data();
    raise_error_bound(view, draw(valued, values_));
}

/// \param residual how far component 0, as it is drawn, is from what the corners interpolate
void PieceWalk::raise_error_bound(const View& view, double residual) {
    std::array<double, max_corners> u{};
    for (std::size_t k = 0; k < view.corner_count(); ++k) {
        u[k] = values_[k * walk_->components() + in_front_];
    }
    const Extent corners = Extent::of(std::span(u).first(view.corner_count()));
    error_bound_ = std::max(
        error_bound_,
        std::min(deviation_ + residual, greatest_difference(corners, corners, deviation_, range_)));
}

void require_drawable(const DiscontinuousData& data, int dimension,
                      const DiscontinuousOptions& options) {
    data.grid().facts().require_dimension(dimension);
    if (!(options.threshold >= 0)) throw InvalidInput("the threshold is negative or not a number");
    if (!(options.flatness >= 0)) throw InvalidInput("the flatness is negative or not a number");
    if (options.deviations != nullptr && options.deviations->epoch() != data.grid().epoch()) {
        throw GridError("the grid has changed since the deviations of its elements were computed");
    }
}

}  // namespace nestgrid::engine
