// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "explorer.hpp"

#include <chrono>
#include <cmath>
#include <cstdlib>

#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>
#include <nestgrid/error.hpp>

#include "drawing/telling_executor.hpp"
#include "frame_reply.hpp"
#include "surface_arrays.hpp"
#include "watched_work.hpp"

namespace nestgrid::view {

namespace {

using Clock = std::chrono::steady_clock;

/// A moving frame is drawn again where its triangles miss the goal by more than this part of it.
constexpr double tolerance = 0.05;

bool keeps_surface(const FrameRequest& request) {
    return request.error > 0 || request.distance > 0;
}

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void write_part(FrameReply& reply, const FramePart& part, const FrameRequest& request) {
    const Surface<3>& surface = part.drawn.surface;
    JsonText& text = reply.header;
    text.open('{').key("kind").string(part.kind);
    text.key("triangles").number(static_cast<double>(surface.simplices.size()));
    text.key("visited").number(static_cast<double>(part.drawn.counts.visited));
    text.key("error_bound").number(part.drawn.error_bound);
    write_mesh(reply, surface);
    if (part.kind == std::string_view("slice")) {
        write_values(reply, surface);
    } else if (request.normals == NormalType::int8) {
        write_short_normals(reply, surface.normals);
    } else if (request.normals == NormalType::float32) {
        write_normals(reply, surface.normals);
    }
    text.close('}');
    if (request.outlines) write_outlines(reply, surface);
}

}  // namespace

struct Explorer::Drawn {
    double threshold = 0;
    int draws = 0;
    std::vector<FramePart> parts;

    std::uint64_t triangles() const {
        std::uint64_t sum = 0;
        for (const FramePart& part : parts) sum += part.drawn.surface.simplices.size();
        return sum;
    }
};

Explorer::Explorer(ExploredField field, const Executor& executor)
    : field_{std::move(field)}, executor_{&executor} {
    const auto start = Clock::now();
    if (field_.frames.empty() || field_.frames.size() != field_.times.size()) {
        throw InvalidInput("a field to explore needs at least one frame, and a time for each");
    }
    for (const SharedHierarchy& frame : field_.frames) {
        std::visit(
            [&](const auto& hierarchy) {
                if (hierarchy->facts().dimension != 3) {
                    throw InvalidInput("only fields in space can be explored; this one has " +
                                       std::to_string(hierarchy->facts().dimension) +
                                       " dimensions");
                }
                offsets_.emplace_back(*hierarchy, LeafErrors{}, executor);
            },
            frame);
    }
    least_ = offsets_.front().least();
    greatest_ = offsets_.front().greatest();
    for (const HierarchicalIndicator& frame : offsets_) {
        least_ = std::min(least_, frame.least());
        greatest_ = std::max(greatest_, frame.greatest());
    }
    if (field_.range) {
        least_ = (*field_.range)[0];
        greatest_ = (*field_.range)[1];
    }
    usual_range_ = field_.usual_range.value_or(std::array{least_, greatest_});
    preroll_seconds_ = seconds_since(start);
}

std::string Explorer::info() const {
    const Histogram& h = field_.histogram;
    const bool counted = h.greatest > h.least;
    JsonText text;
    text.open('{').key("title").string(field_.title).key("name").string(field_.name);
    text.key("least").number(least_).key("greatest").number(greatest_);
    text.key("usual_range").numbers(usual_range_).key("box").open('[');
    for (const Point& corner : field_.box) text.numbers(corner);
    text.close(']').key("times").numbers(field_.times);
    text.key("isovalue").number(field_.isovalue.value_or((least_ + greatest_) / 2));
    text.key("histogram").open('{').key("least").number(h.least);
    text.key("greatest").number(h.greatest).key("counts");
    text.numbers(counted ? std::span<const double>(h.counts) : std::span<const double>{});
    text.close('}').key("length_unit").string(field_.length_unit);
    text.key("samples")
        .number(static_cast<double>(field_.samples))
        .key("nodes")
        .number(static_cast<double>(offsets_.front().node_count()));
    text.key("preroll_seconds").number(preroll_seconds_);
    return text.close('}').text();
}

const HierarchicalIndicator& Explorer::of_nodes(IndicatorName name, std::size_t frame,
                                                WatchedSteps& steps) {
    if (name != IndicatorName::deviation) return offsets_[frame];
    deviations_.resize(offsets_.size());
    std::optional<HierarchicalIndicator>& deviations = deviations_[frame];
    if (deviations) return *deviations;
    steps.begin("Measuring errors");
    steps.check();
    const TellingExecutor executor(*executor_, [&steps](double share) { steps.check(share); });
    deviations.emplace(std::visit(
        [&](const auto& hierarchy) {
            if (executor.concurrency() > 1) {
                return HierarchicalIndicator(*hierarchy, NodeError::deviation, executor);
            }
            return HierarchicalIndicator(WatchedHierarchy(*hierarchy, steps), NodeError::deviation);
        },
        field_.frames[frame]));
    return *deviations;
}

Moment Explorer::moment_at(const FrameRequest& request, WatchedSteps& steps) {
    const IndicatorName name =
        keeps_surface(request) ? IndicatorName::deviation : request.indicator;
    std::vector<float> weights{1};
    if (request.time && field_.frames.size() == 1 && *request.time != field_.times.front()) {
        throw InvalidInput("there is one frame, and the time asked for is not its time");
    }
    if (field_.frames.size() > 1) {
        weights = linear_weights(field_.times, request.time.value_or(field_.times.front()));
    }
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] != 1) continue;
        const HierarchicalIndicator& alone = of_nodes(name, i, steps);
        return {field_.frames[i], i, {}, std::move(weights), &alone};
    }
    std::vector<const HierarchicalIndicator*> frames;
    std::vector<float> of_frames;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0) continue;
        frames.push_back(&of_nodes(name, i, steps));
        of_frames.push_back(weights[i]);
    }
    KeyFrames between(std::move(frames), of_frames);
    return {field_.between(weights), 0, std::move(between), std::move(weights), nullptr};
}

FrameIndicators Explorer::indicators_for(const FrameRequest& request, const Moment& moment,
                                         WatchedSteps& steps) {
    FrameIndicators indicators;
    if (request.lens) indicators.size = &size_for(moment, request.lens->slope, steps);
    if (!keeps_surface(request)) {
        indicators.detail = &indicator_at(moment, request.indicator, steps);
        return indicators;
    }
    indicators.detail = &indicator_at(moment, IndicatorName::deviation, steps);
    if (!request.isovalue || (request.moving && request.error > 0)) return indicators;
    surface_errors_.begin(moment, *request.isovalue);
    const bool cuts =
        std::visit([](const auto& h) { return cuts_are_errors(h->facts()); }, moment.hierarchy);
    if (request.error > 0 && cuts && !request.plane) {
        indicators.detail = &surface_errors_.cuts(moment, *executor_, steps);
    }
    if (!request.collapse) indicators.slopes = &surface_errors_.slopes(moment, *executor_, steps);
    if (request.distance > 0) indicators.detail = indicators.slopes;
    return indicators;
}

const Indicator& Explorer::indicator_at(const Moment& moment, IndicatorName name,
                                        WatchedSteps& steps) {
    if (name == IndicatorName::offset || name == IndicatorName::deviation) {
        if (moment.between) return *moment.between;
        return *moment.alone;
    }
    if (!moment.between) return swept_of(name, moment.frame, steps);
    if (name == IndicatorName::visual) {
        throw InvalidInput(
            "between frames there is no visual indicator: take another one, or the time of a "
            "frame");
    }
    std::vector<const SweptIndicator*> frames;
    std::vector<float> weights;
    for (std::size_t i = 0; i < moment.weights.size(); ++i) {
        if (moment.weights[i] == 0) continue;
        frames.push_back(&swept_of(name, i, steps));
        weights.push_back(moment.weights[i]);
    }
    return swept_->between.emplace(std::move(frames), weights);
}

const SweptIndicator& Explorer::swept_of(IndicatorName name, std::size_t frame,
                                         WatchedSteps& steps) {
    if (!swept_ || swept_->name != name) {
        swept_.emplace(Swept{name, {}, {}});
        swept_->frames.resize(field_.frames.size());
    }
    std::optional<SweptIndicator>& swept = swept_->frames[frame];
    if (swept) return *swept;
    const double tau = 0x1p-20 * (usual_range_[1] - usual_range_[0]);
    steps.begin("Measuring what counts as detail");
    steps.check();
    swept.emplace(std::visit(
        [&](const auto& hierarchy) {
            const WatchedHierarchy watched(*hierarchy, steps);
            if (name == IndicatorName::visual) return visual_indicator(watched, {.tau = tau});
            if (name == IndicatorName::numerical) return numerical_indicator(watched);
            return wavelet_indicator(watched);
        },
        field_.frames[frame]));
    return *swept;
}

const SweptIndicator& Explorer::size_for(const Moment& moment, double slope, WatchedSteps& steps) {
    if (!size_ || size_->spread().slope != slope) {
        steps.begin("Measuring the sizes of elements");
        size_.emplace(std::visit(
            [&](const auto& hierarchy) {
                return mesh_size(WatchedHierarchy(*hierarchy, steps), Spread{.slope = slope});
            },
            moment.hierarchy));
    }
    return *size_;
}

double Explorer::greatest_threshold(IndicatorName indicator) const {
    if (indicator == IndicatorName::visual) return 2;
    const double range = usual_range_[1] - usual_range_[0];
    if (!(range > 0)) return 1;
    // A gradient changes by a few ranges over the height of an element, which is a part of its
    // diameter.
    return indicator == IndicatorName::numerical ? 16 * range : range;
}

Explorer::Drawn Explorer::draw_to_goal(const FrameRequest& request, const FrameDrawing& drawing) {
    const auto goal = static_cast<double>(request.triangles);
    const bool known = budget_ && budget_->indicator == request.indicator;
    if (!known) {
        const double greatest = greatest_threshold(request.indicator);
        budget_.emplace(Budget{request.indicator, FrameBudget(goal, greatest), false});
    }
    FrameBudget& thresholds = budget_->thresholds;
    thresholds.aim(goal);
    Drawn drawn;
    const auto draw_at = [&](double threshold) {
        drawn.threshold = threshold;
        drawn.parts = drawing.draw(threshold);
        ++drawn.draws;
    };
    const auto draw_exactly = [&] {
        draw_at(thresholds.settle([&](double threshold) {
            ++drawn.draws;
            return drawing.fits(threshold);
        }));
    };
    const auto misses = [&] {
        return std::abs(static_cast<double>(drawn.triangles()) / goal - 1) > tolerance;
    };
    if (!request.moving || !known) {
        draw_exactly();
        budget_->in_steps = false;
        return drawn;
    }
    for (int i = 0; i < 2; ++i) {
        draw_at(thresholds.threshold());
        thresholds.drawn(static_cast<double>(drawn.triangles()));
        // At its least and its greatest value the threshold stays.
        if (!misses() || thresholds.threshold() == drawn.threshold) return drawn;
    }
    if (budget_->in_steps) return drawn;
    draw_exactly();
    budget_->in_steps = misses();
    return drawn;
}

Explorer::Drawn Explorer::draw(const FrameRequest& request, const FrameDrawing& drawing) {
    if (request.triangles == 0) {
        // At most one of them is not 0.
        const double held = request.threshold + request.error + request.distance;
        return {held, 1, drawing.draw(held)};
    }
    const std::optional<Budget> before = budget_;
    try {
        return draw_to_goal(request, drawing);
    } catch (const FrameAbandoned&) {
        budget_ = before;
        throw;
    }
}

FrameRequest Explorer::at_last_detail(FrameRequest request) const {
    if (!request.moving || !(request.distance > 0) || triangles_of_distance_ == 0) return request;
    request.distance = 0;
    request.triangles = triangles_of_distance_;
    return request;
}

std::vector<std::byte> Explorer::frame(std::string_view text, const FrameWatch& watch) {
    const FrameRequest request = at_last_detail(parse_request(text));
    const auto start = Clock::now();
    WatchedSteps steps(watch);
    const Moment moment = moment_at(request, steps);
    const FrameIndicators indicators = indicators_for(request, moment, steps);
    const FrameDrawing drawing(request, moment, indicators, *executor_, steps);
    const Drawn drawn = draw(request, drawing);
    if (request.distance > 0) triangles_of_distance_ = drawn.triangles();
    ErrorBounds bounds;
    double visited = 0;
    double distance = std::numeric_limits<double>::quiet_NaN();
    for (const FramePart& part : drawn.parts) {
        bounds.add_bounds(part.drawn);
        if (std::isfinite(part.distance)) distance = part.distance;
        visited += static_cast<double>(part.drawn.counts.visited);
    }
    const double seconds = seconds_since(start);
    FrameReply reply;
    reply.header.open('{').key("threshold").number(drawn.threshold);
    reply.header.key("triangles").number(static_cast<double>(drawn.triangles()));
    reply.header.key("visited").number(visited).key("error_bound").number(bounds.error_bound);
    reply.header.key("bound_says_nothing").boolean(bounds.bound_says_nothing());
    reply.header.key("distance").number(distance);
    reply.header.key("seconds").number(seconds).key("draws").number(drawn.draws);
    reply.header.key("parts").open('[');
    for (const FramePart& part : drawn.parts) write_part(reply, part, request);
    reply.header.close(']').close('}');
    return reply.bytes();
}

}  // namespace nestgrid::view
