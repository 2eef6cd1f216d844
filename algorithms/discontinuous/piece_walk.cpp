// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <discontinuous/piece_walk.hpp>

#include <algorithm>
#include <numeric>
#include <optional>

#include <drawing/differences.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

PieceWalk::PieceWalk(const Pieces& pieces)
    : Base(*pieces.walk, pieces.options->progress),
      pieces_{&pieces},
      corner_values_(*pieces.data),
      deviations_{pieces.threshold > 0 ? pieces.deviations : nullptr},
      values_(max_corners * pieces.walk->components()),
      range_{pieces.deviations},
      surface_{{part_, false, pieces.options->elements}, 0} {
    part_.surface.elements = pieces.walk->hierarchy().make_elements();
}

double PieceWalk::Range::least() const {
    return deviations == nullptr ? -std::numeric_limits<double>::infinity() : deviations->least();
}
double PieceWalk::Range::greatest() const {
    return deviations == nullptr ? std::numeric_limits<double>::infinity() : deviations->greatest();
}

void PieceWalk::count_only(std::uint64_t most) {
    Base::count_only(most);
    surface_.count_only();
}

void PieceWalk::report(DiscontinuousSurface& result) {
    result.counts = counts_;
    result.counts.extracted = surface_.report().extracted;
    result.range_bound = greatest_difference({range_.least(), range_.greatest()}, range_);
    result.error_bound = std::min(surface_.report().error_bound, result.range_bound);
    result.surface = std::move(part_.surface);
}

std::unique_ptr<PieceWalk::Base> PieceWalk::begin_part(std::unique_ptr<Base>) {
    std::unique_ptr<PieceWalk> part = pieces_->make(*pieces_);
    part->leads_ = &starts_;
    if (surface_.counts_only()) part->count_only(tally_.limit());
    return part;
}

void PieceWalk::add(Base& part) {
    const auto& drawn = static_cast<const PieceWalk&>(part);
    surface_.report().add(drawn.surface_.report());
    tally_.add(drawn.tally_);
    if (surface_.counts_only()) return;
    const Surface<3>& more = drawn.part_.surface;
    std::vector<std::uint32_t> numbers(more.vertices.size());
    std::iota(numbers.begin(), numbers.end(), surface_.add_unnamed(more.vertices, more.attributes));
    for (const auto& [from, to] : more.boundary) {
        surface_.builder().add_boundary({numbers[from], numbers[to]});
    }
    surface_.builder().add_part(more, numbers);
}

Decision PieceWalk::inspect(const View& view, const Split& split) {
    count(1, 0);
    if ((counts_.calls & 0xFFFFU) == 0) tell(0, 0);
    const bool interest = of_interest(view, split);
    counted_ = interest ? 1 : 0;
    count(0, counted_);
    deviation_ = 0;
    at_ = behind_ = next_;
    if (split.rule == nullptr) return {interest ? Visit::stop : Visit::skip};
    if (deviations_ == nullptr) return {interest ? Visit::descend : Visit::skip};
    const ElementDeviations::Entry& entry = deviations_->entries()[at_];
    deviation_ = static_cast<double>(entry.deviation);
    const bool stops = deviation_ <= pieces_->threshold;
    behind_ = at_ + entry.subtree;
    next_ = interest && !stops ? at_ + 1 : behind_;
    if (!interest) return {Visit::skip};
    return {stops ? Visit::stop : Visit::descend};
}

/// Above the frontier the leader has entered each element that a task is shown.
Decision PieceWalk::look(const View& /*view*/, const Split& /*split*/) { return {Visit::descend}; }

void PieceWalk::undo() {
    Base::undo();
    starts_.push_back(at_);
    next_ = behind_;
}

void PieceWalk::restart() {
    Base::restart();
    starts_.clear();
    next_ = 0;
}

void PieceWalk::begin_entry(std::size_t number) { next_ = (*leads_)[number]; }

void PieceWalk::extract(const View& view) {
    corner_values_.put(view.element(), view.member->rule, view.shape,
                       values_.data() + pieces_->in_front, walk_->components());
    View valued = view;
    valued.value = values_.data();
    const double residual = draw(valued, values_);
    if (surface_.counts_only()) {
        tally_.add(part_.surface.simplices.size());
        return surface_.forget_element();
    }
    surface_.report().extracted += 1;
    raise_error_bound(view, residual);
}

/// \param residual how far component 0, as it is drawn, is from what the corners interpolate
void PieceWalk::raise_error_bound(const View& view, double residual) {
    std::array<double, max_corners> u{};
    for (std::size_t k = 0; k < view.corner_count(); ++k) {
        u[k] = values_[k * walk_->components() + pieces_->in_front];
    }
    const Extent corners = Extent::of(std::span(u).first(view.corner_count()));
    surface_.report().raise_error_bound(
        std::min(deviation_ + residual, greatest_difference(corners, corners, deviation_, range_)));
}

void require_drawable(const DiscontinuousData& data, int dimension,
                      const DiscontinuousOptions& options) {
    data.grid().facts().require_dimension(dimension);
    if (!(options.threshold >= 0)) throw InvalidInput("the threshold is negative or not a number");
    if (!(options.flatness >= 0)) throw InvalidInput("the flatness is negative or not a number");
    if (options.threshold > 0 && options.max_triangles > 0) {
        throw InvalidInput("give a threshold or a number of triangles, not both");
    }
    if (options.deviations != nullptr && options.deviations->epoch() != data.grid().epoch()) {
        throw GridError("the grid has changed since the deviations of its elements were computed");
    }
}

DiscontinuousSurface draw_pieces(const WidenedHierarchy<float>& hierarchy,
                                 const DiscontinuousData& data, const DiscontinuousOptions& options,
                                 std::size_t in_front, const Executor& executor,
                                 std::function<std::unique_ptr<PieceWalk>(const Pieces&)> make) {
    std::optional<ElementDeviations> own;
    const ElementDeviations* deviations = options.deviations;
    const bool coarsens = options.threshold > 0 || options.max_triangles > 0;
    if (deviations == nullptr && coarsens) deviations = &own.emplace(data);
    const Walk<double> walk(hierarchy, PieceWalk::needs);
    Pieces pieces{&walk, &data, &options, in_front, deviations, options.threshold, std::move(make)};
    DiscontinuousSurface result;
    if (options.max_triangles > 0) {
        const auto count = [&](double threshold, std::uint64_t most) {
            pieces.threshold = threshold;
            return count_within<double>(*pieces.make(pieces), most, executor, nullptr);
        };
        result.search = least_threshold(count, deviations->greatest() - deviations->least(),
                                        options.max_triangles);
        pieces.threshold = result.search.threshold;
    }
    const std::unique_ptr<PieceWalk> drawing = pieces.make(pieces);
    result.cancelled = result.search.cancelled;
    if (!result.cancelled)
        result.cancelled = run_until_cancelled<double>(*drawing, executor, nullptr);
    drawing->report(result);
    return result;
}

}  // namespace nestgrid::engine
