// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "explorer.hpp"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/error.hpp>

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

void write_report(JsonText& text, const SurfaceReport& report) {
    text.key("area").number(report.area);
    text.key("volume").number(report.closed() ? report.volume
                                              : std::numeric_limits<double>::quiet_NaN());
    text.key("open_edges").number(static_cast<double>(report.open_edges));
}

void write_measured(JsonText& text, const MeasuredError& measured) {
    text.key("measured_error").number(measured.value.greatest);
    text.key("measured_distance").number(measured.distance.greatest);
    text.key("measured_back").number(measured.back.greatest);
}

void write_part(FrameReply& reply, const FramePart& part, const FrameRequest& request) {
    const bool in_light = !part.is("slice");
    const bool has_values = part.has_values();
    const bool has_creases =
        in_light && (request.cap || has_values) && request.normals != NormalType::none;
    const Surface<3> creased = has_creases ? with_creases(part.drawn.surface) : Surface<3>();
    const Surface<3>& surface = has_creases ? creased : part.drawn.surface;
    JsonText& text = reply.header;
    text.open('{').key("kind").string(part.kind);
    text.key("triangles").number(static_cast<double>(surface.simplices.size()));
    text.key("visited").number(static_cast<double>(part.drawn.counts.visited));
    text.key("error_bound").number(part.drawn.error_bound);
    if (part.is("isosurface")) text.key("isovalue").number(part.isovalue);
    if (part.measured) write_measured(text, *part.measured);
    if (!has_values && request.report) write_report(text, surface_report(part.drawn.surface));
    write_mesh(reply, surface);
    if (has_values) write_values(reply, surface);
    // The colours of a slice are those of the legend.
    const NormalType normals = in_light ? request.normals : NormalType::none;
    if (normals == NormalType::int8) write_short_normals(reply, surface.normals);
    if (normals == NormalType::float32) write_normals(reply, surface.normals);
    text.close('}');
    if (request.outlines) write_outlines(reply, part.drawn.surface);
    if (has_values && !request.lines.empty()) {
        write_isolines(reply, part.drawn.surface, request.lines);
    }
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
    if (field_.dimension() != 3) {
        throw InvalidInput("only fields in space can be explored; this one has " +
                           std::to_string(field_.dimension()) + " dimensions");
    }
    const auto& [least, greatest] = field_.frames.prepare({}, {.executor = executor});
    least_ = least;
    greatest_ = greatest;
    nodes_ = field_.frames[0]->node_count({.executor = executor});
    if (const auto polynomials = field_.frames[0]->high_order({.executor = executor})) {
        // Curved cells of degree 1 are drawn as polynomials, too.
        degree_ = std::max({2, polynomials->greatest_degree(), polynomials->geometry_degree()});
        curved_ = polynomials->geometry_degree() > 1;
        jump_ = polynomials->jump();
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
    text.close(']').key("indicators").open('[');
    for (const IndicatorKind* const kind : page_indicators()) {
        text.open('[').string(kind->name).string(kind->measures).close(']');
    }
    text.close(']').key("times").numbers(field_.times());
    text.key("isovalue").number(field_.isovalue.value_or((least_ + greatest_) / 2));
    text.key("histogram").open('{').key("least").number(h.least);
    text.key("greatest").number(h.greatest).key("counts");
    text.numbers(counted ? std::span<const double>(h.counts) : std::span<const double>{});
    text.close('}').key("length_unit").string(field_.length_unit);
    text.key("samples")
        .number(static_cast<double>(field_.samples))
        .key("nodes")
        .number(static_cast<double>(nodes_));
    text.key("degree").number(degree_).key("curved").boolean(curved_);
    text.key("jump").number(jump_);
    text.key("preroll_seconds").number(preroll_seconds_);
    return text.close('}').text();
}

Prerolls& Explorer::moment_at(const FrameRequest& request) {
    const std::vector<double>& times = field_.times();
    if (request.time && times.size() == 1 && *request.time != times.front()) {
        throw InvalidInput("there is one frame, and the time asked for is not its time");
    }
    std::vector<float> weights{1};
    if (times.size() > 1) weights = linear_weights(times, request.time.value_or(times.front()));
    if (moment_ == nullptr || weights != weights_) {
        moment_ = field_.frames.at(weights);
        weights_ = std::move(weights);
    }
    return *moment_;
}

FrameCriteria Explorer::criteria_for(const FrameRequest& request, Prerolls& moment,
                                     const Work& work, WatchedSteps& steps) const {
    if (request.position_error > 0 && !curved_) {
        throw InvalidInput("the elements are straight: leave out position_error");
    }
    if (degree_ > 1) return polynomials_for(request, moment, work, steps);
    const std::vector<double> isovalues = request.level_sets();
    Projection projection = request.projection(request.indicator);
    if (!keeps_surface(request)) {
        steps.begin("Measuring what counts as detail");
        Criteria detail(moment, projection, isovalues, work);
        return {detail, detail.shared_bounds()};
    }
    steps.begin("Measuring errors");
    FrameCriteria criteria{Criteria(moment, request.projection("deviation"), isovalues, work),
                           moment.choose("deviation", request.blend, {}, work).bounds};
    if (isovalues.empty() || (request.moving && request.error > 0)) return criteria;
    if (!request.collapse || request.distance > 0) {
        steps.begin("Measuring distances of the surface");
        criteria.slopes = moment.choose("slope", 1, isovalues, work).indicator;
    }
    if (request.cuts() && request.distance == 0) return criteria;
    steps.begin("Measuring errors of the surface");
    projection.indicator = request.distance > 0 ? "slope" : "error";
    criteria.detail = Criteria(moment, projection, isovalues, work);
    return criteria;
}

/// What polynomials are drawn with: within an error, whatever the threshold is called.
FrameCriteria Explorer::polynomials_for(const FrameRequest& request, Prerolls& moment,
                                        const Work& work, WatchedSteps& steps) {
    if (request.distance > 0 || request.collapse || request.blend != 1) {
        throw InvalidInput(
            "data of higher degree are drawn within an error or a number of triangles: without a "
            "distance, a collapse and a blend");
    }
    steps.begin("Looking at polynomials");
    FrameCriteria criteria;
    criteria.polynomials = moment.high_order(work);
    return criteria;
}

double Explorer::greatest_threshold(const IndicatorKind& indicator) const {
    if (indicator.unit == ThresholdUnit::none) return 2;
    const double range = usual_range_[1] - usual_range_[0];
    if (!(range > 0)) return 1;
    // A gradient changes by a few ranges over the height of an element, which is a part of its
    // diameter.
    return indicator.name == "numerical" ? 16 * range : range;
}

Explorer::Drawn Explorer::draw_to_goal(const FrameRequest& request, const FrameDrawing& drawing) {
    const auto goal = static_cast<double>(request.triangles);
    const bool known = budget_ && budget_->indicator == request.indicator;
    if (!known) {
        const double greatest = greatest_threshold(indicator_named(request.indicator));
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
    FrameRequest request = at_last_detail(parse_request(text));
    if (degree_ > 1 && request.lens && request.lens->finest == 0) {  // leaves have no finest level
        request.lens->finest = norm(field_.box[1] - field_.box[0]) / 400;
    }
    const auto start = Clock::now();
    WatchedSteps steps(watch);
    const WatchedWork work(*executor_, steps);
    Prerolls& moment = moment_at(request);
    const FrameCriteria criteria = criteria_for(request, moment, work.work(), steps);
    const FrameDrawing drawing(request, moment, criteria, work, steps);
    Drawn drawn = draw(request, drawing);
    const double seconds = seconds_since(start);
    drawing.measure(drawn.parts);
    if (request.distance > 0) triangles_of_distance_ = drawn.triangles();
    ErrorBounds bounds;
    double visited = 0;
    double position_bound = 0;
    double distance = std::numeric_limits<double>::quiet_NaN();
    for (const FramePart& part : drawn.parts) {
        bounds.add_bounds(part.drawn);
        position_bound = std::max(position_bound, part.drawn.position_bound);
        if (std::isfinite(part.distance)) distance = part.distance;
        visited += static_cast<double>(part.drawn.counts.visited);
    }
    FrameReply reply;
    reply.header.open('{').key("threshold").number(drawn.threshold);
    reply.header.key("triangles").number(static_cast<double>(drawn.triangles()));
    reply.header.key("visited").number(visited).key("error_bound").number(bounds.error_bound);
    reply.header.key("bound_says_nothing").boolean(bounds.bound_says_nothing());
    reply.header.key("position_bound").number(position_bound).key("distance").number(distance);
    reply.header.key("seconds").number(seconds).key("draws").number(drawn.draws);
    reply.header.key("parts").open('[');
    for (const FramePart& part : drawn.parts) write_part(reply, part, request);
    reply.header.close(']').close('}');
    return reply.bytes();
}

}  // namespace nestgrid::view
