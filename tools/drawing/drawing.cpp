// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/drawing.hpp"

#include <algorithm>
#include <string_view>
#include <type_traits>
#include <utility>

#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/error.hpp>

#include "drawing/meter.hpp"

namespace {

using nestgrid::InvalidInput;
using nestgrid::IsosurfaceOptions;
using nestgrid::Prerolls;
using nestgrid::Projected;
using nestgrid::Projection;
using nestgrid::Work;

void check(const DrawingRequest& request, const SurfaceOptions& options,
           const nestgrid::HierarchyFacts& facts) {
    const bool in_space = request.function != nullptr || request.has_isovalue();
    if (!in_space && facts.dimension == 3) {
        throw InvalidInput(
            "the field is one in space: give a slice, for isolines, or use 'isosurface'");
    }
    if (!request.in_one_colour()) facts.require_dimension(in_space ? 3 : 2);
    if (request.colour_tolerance > 0 && !options.budgets.empty()) {
        throw InvalidInput("--max-triangles excludes --colour-tolerance");
    }
}

std::string millions(std::uint64_t count) {
    return std::to_string(count / 100000 / 10) + "." + std::to_string(count / 100000 % 10) +
           " million";
}

/// Within an error of polynomials that is still to be said.
Projection within_error(const Moment& moment, const SurfaceOptions& options,
                        const DrawingRequest& request) {
    return {.indicator = "error",
            .lens = request.lens,
            .region = moment.projection().region,
            .collapse = request.collapses,
            .slice_distance = request.slice_distance,
            .position_error = options.projection.position_error};
}

/// Tells the steps of a drawing, and measures them.
class Steps {
public:
    Steps(const Telling& tell, Drawn& drawn) : tell_{tell}, drawn_{drawn} {}

    void begin(std::string_view step) {
        end();
        step_ = step;
        meter_.emplace();
        tell_(step_ == drawing ? std::string() : step_);
    }
    void end() {
        if (!meter_) return;
        time() += meter_->seconds();
        if (step_ == drawing) drawn_.peak_bytes = std::max(drawn_.peak_bytes, meter_->peak_bytes());
        meter_.reset();
    }

private:
    static constexpr std::string_view drawing = "drawing";

    double& time() {
        if (step_ == "collapsing") return drawn_.collapse_seconds;
        if (step_ == "measuring") return drawn_.measure_seconds;
        return step_ == drawing ? drawn_.seconds : drawn_.search_seconds;
    }

    const Telling& tell_;
    Drawn& drawn_;
    std::string step_;
    std::optional<Meter> meter_;
};

/// Draws the surfaces at one moment.
class Drawing {
public:
    Drawing(const Moment& moment, const nestgrid::Executor& executor, const SurfaceOptions& options,
            const DrawingRequest& request, const Telling& tell)
        : moment_{moment}, executor_{executor}, options_{options}, request_{request}, tell_{tell} {
        check(request, options, prerolls().field().facts());
    }

    /// \return the surfaces of one walk
    std::vector<Drawn> draw(Projection projection, Drawn drawn) const {
        drawn.time = moment_.time();
        std::vector<Drawn> walk(std::max<std::size_t>(1, request_.isovalues.size()), drawn);
        Drawn& first = walk.front();
        Steps steps(tell_, first);
        const Work work{.executor = executor_,
                        .step = [&](const char* step) { steps.begin(step); }};
        projection.colour_tolerance = request_.colour_tolerance;
        if (request_.has_several_isovalues()) {
            draw_together(walk, projection, work);
        } else {
            draw_into(first, projection, work);
        }
        steps.end();
        std::size_t kept = 0;
        for (const Drawn& d : walk) {
            kept += d.result.surface.memory_bytes() + d.segments.memory_bytes() +
                    d.isosurface.memory_bytes();
        }
        first.peak_bytes -= std::min(first.peak_bytes, kept);
        for (std::size_t i = 0; i < walk.size(); ++i) {
            if (request_.measures) measure(walk[i], request_.isovalues[i]);
            report(walk[i]);
        }
        return walk;
    }

private:
    const Prerolls& prerolls() const { return moment_.prerolls(); }

    void draw_into(Drawn& drawn, const Projection& projection, const Work& work) const {
        if (request_.has_two_surfaces()) return draw_both(drawn, projection, work);
        if (request_.has_isovalue()) return draw_isosurface(drawn, projection, work);
        if (request_.function != nullptr) {
            return take(drawn, slice(prerolls(), *request_.function, of_slice(projection),
                                     {.cap = request_.cap, .elements = keeps_elements()}, work));
        }
        const nestgrid::ShadingOptions options{.elements = keeps_elements()};
        auto grid = request_.scale == 0
                        ? shading(prerolls(), projection, options, work)
                        : height_field(prerolls(), request_.scale, projection, options, work);
        take_facts(drawn, grid);
        drawn.result = {grid, std::move(grid.surface), grid.counts, grid.position_bound};
    }
    /// At threshold 0 a slice stops where one does beside an isosurface. Without a threshold it
    /// needs no preroll, and stops nowhere.
    Projection of_slice(const Projection& projection) const {
        if (!projection.asks_for_everything()) return projection;
        const nestgrid::Criteria& criteria = moment_.criteria();
        Projection at_zero = under(criteria.at(0), criteria.bounds());
        at_zero.colour_tolerance = projection.colour_tolerance;
        return at_zero;
    }
    template <int dimension>
    Projected<nestgrid::Isosurface<dimension>> level_set(const Projection& projection,
                                                         const IsosurfaceOptions& options,
                                                         const Work& work) const {
        const double isovalue = request_.isovalues.front();
        if (!request_.upper) {
            return nestgrid::isosurface<dimension>(prerolls(), isovalue, projection, options, work);
        }
        return nestgrid::isoband<dimension>(prerolls(), isovalue, *request_.upper, projection,
                                            options, work);
    }
    void draw_isosurface(Drawn& drawn, const Projection& projection, const Work& work) const {
        const bool searches = projection.max_triangles > 0;
        const auto options = isosurface_options(searches || executor_.concurrency() == 1);
        if (prerolls().field().dimension() == 3) {
            return take(drawn, level_set<3>(projection, options, work));
        }
        auto lines = level_set<2>(projection, options, work);
        take_facts(drawn, lines);
        take_lines(drawn, std::move(lines));
    }
    /// Several isosurfaces in one walk.
    void draw_together(std::vector<Drawn>& walk, const Projection& projection,
                       const Work& work) const {
        const auto options = isosurface_options(executor_.concurrency() == 1);
        const auto all = [&]<int dimension>(std::integral_constant<int, dimension>) {
            return isosurfaces<dimension>(prerolls(), request_.isovalues, projection, options,
                                          work);
        };
        if (prerolls().field().dimension() == 3) {
            auto surfaces = all(std::integral_constant<int, 3>{});
            for (std::size_t i = 0; i < walk.size(); ++i) walk[i].result = std::move(surfaces[i]);
        } else {
            auto lines = all(std::integral_constant<int, 2>{});
            for (std::size_t i = 0; i < walk.size(); ++i) take_lines(walk[i], std::move(lines[i]));
        }
        for (std::size_t i = 0; i < walk.size(); ++i) {
            walk[i].threshold = projection.least_threshold();
            walk[i].isovalue = request_.isovalues[i];
            walk[i].shares_walk = i > 0;
        }
    }
    /// The slice, and the isosurface beside it, in one walk.
    void draw_both(Drawn& drawn, Projection projection, const Work& work) const {
        const nestgrid::SliceRequest both{{request_.function}, request_.isovalues};
        const double tolerance = std::exchange(projection.colour_tolerance, 0);
        if (projection.max_triangles > 0) {
            work.begin("searching the threshold");
            drawn.search = find_both(both, projection.max_triangles, work);
            projection.threshold = drawn.search.threshold;
            projection.max_triangles = 0;
        }
        work.begin("drawing");
        drawn.threshold = projection.least_threshold();
        auto surfaces = slices(prerolls(), both, projection,
                               {.cap = request_.cap, .elements = keeps_elements()}, work);
        drawn.result = std::move(surfaces[0]);
        drawn.result.position_bound =
            std::max(drawn.result.position_bound, surfaces[1].position_bound);
        drawn.isosurface = std::move(surfaces[1].surface);
        if (tolerance == 0) return;
        refine_colours(drawn.result.surface, prerolls(), tolerance, projection, work);
        if (drawn.isosurface.attributes.empty()) return;
        refine_colours(drawn.isosurface, prerolls(), tolerance, projection, work);
    }
    nestgrid::TriangleBudget find_both(const nestgrid::SliceRequest& both,
                                       std::uint64_t max_triangles, const Work& work) const {
        const auto count = [&](const Projection& at, std::uint64_t most) {
            return count_triangles(prerolls(), both, at, most, {}, {work.executor});
        };
        if (const std::shared_ptr<const nestgrid::HighOrder> data = moment_.high_order()) {
            Projection within = within_error(moment_, options_, request_);
            return nestgrid::least_threshold(
                [&](double error, std::uint64_t most) {
                    within.threshold = error;
                    return count(within, most);
                },
                nestgrid::default_error(*data), max_triangles,
                data->least_tolerance(within.position_error));
        }
        const nestgrid::Criteria& criteria = moment_.criteria();
        const nestgrid::Bounds& bounds = criteria.bounds();
        return nestgrid::least_threshold(
            [&](double threshold, std::uint64_t most) {
                return count(under(criteria.at(threshold), bounds), most);
            },
            bounds.greatest() - bounds.least(), max_triangles);
    }

    template <class Result>
    static void take_facts(Drawn& drawn, const Projected<Result>& from) {
        drawn.search = from.search;
        drawn.threshold = from.search.threshold;
        drawn.collapsed = from.collapsed;
    }
    void take(Drawn& drawn, Projected<nestgrid::Isosurface<3>> from) const {
        take_facts(drawn, from);
        if (request_.keeps_distances && drawn.threshold > 0) drawn.far_points = from.far_points;
        drawn.result = std::move(from);
    }
    static void take_lines(Drawn& drawn, nestgrid::Isosurface<2> lines) {
        drawn.segments = std::move(lines.surface);
        drawn.result = {lines, {}, lines.counts, lines.position_bound};
        drawn.result.surface_error = lines.surface_error;
        drawn.result.stack_bytes = lines.stack_bytes;
    }
    void measure(Drawn& drawn, double isovalue) const {
        constexpr std::size_t points = 200000;
        Steps steps(tell_, drawn);
        steps.begin("measuring");
        drawn.measured =
            measure_error(prerolls(), drawn.result.surface, isovalue, points, {executor_});
        steps.end();
    }
    static void report(Drawn& d) {
        d.report = nestgrid::surface_report(d.result.surface);
        d.isosurface_report = nestgrid::surface_report(d.isosurface);
        if (d.segments.vertices.empty()) return;
        d.report.vertices = d.segments.vertices.size();
        d.report.triangles = d.segments.simplices.size();
    }

    /// Whether triangles are to tell their elements: to files, or to what changes them.
    bool keeps_elements() const {
        return options_.elements || request_.outlines || request_.collapses ||
               request_.keeps_distances || request_.measures || request_.colour_tolerance > 0;
    }
    /// \param counting whether elements are told, where no share of the work is known
    IsosurfaceOptions isosurface_options(bool counting) const {
        const std::string& indicator = options_.projection.indicator;
        const bool keeps_error = indicator == "deviation" || indicator == "cut";
        const bool finest =
            indicator == "slope" || (!options_.budgets.empty() && !request_.collapses &&
                                     !keeps_error && request_.by.empty());
        IsosurfaceOptions options{.cuts = request_.cuts.value_or(finest ? nestgrid::Cuts::finest
                                                                        : nestgrid::Cuts::linear),
                                  .normals = request_.normals,
                                  .cap = request_.cap,
                                  .elements = keeps_elements(),
                                  .at_nodes = request_.at_nodes};
        if (counting) {
            options.progress = [&](const nestgrid::TraversalCounts& counts) {
                tell_("looked at " + millions(counts.calls) + " elements");
                return true;
            };
        }
        return options;
    }

    const Moment& moment_;
    const nestgrid::Executor& executor_;
    const SurfaceOptions& options_;
    const DrawingRequest& request_;
    const Telling& tell_;
};

/// \throw nestgrid::InvalidInput where options ask for more than an error
void require_error_alone(const DrawingRequest& request, const SurfaceOptions& options, int degree) {
    nestgrid::Projection projection = options.projection;
    if (options.thresholds.empty() && projection.indicator == "offset") {
        projection.indicator = "error";
    }
    projection.lens = request.lens;
    projection.keeps_distance = request.keeps_distances;
    projection.require_error_alone(degree);
}

/// Draws a field of higher degree within each error, or each number of triangles.
void draw_polynomials(const nestgrid::HighOrder& data, const Moment& moment,
                      const SurfaceOptions& options, const DrawingRequest& request,
                      const Drawing& drawing, const TakeWalk& take) {
    const Projection within = within_error(moment, options, request);
    std::vector<Projection> asked;
    for (const std::int64_t budget : options.budgets) {
        asked.push_back(within);
        asked.back().max_triangles = static_cast<std::uint64_t>(budget);
    }
    for (const std::string& text : options.thresholds) {
        asked.push_back(within);
        asked.back().threshold = moment.error(parse_threshold(text));
    }
    const bool by_default = asked.empty() && !request.lens;
    if (asked.empty()) asked.push_back(within);
    if (by_default) asked.back().threshold = nestgrid::default_error(data);
    for (const Projection& projection : asked) {
        Drawn drawn;
        drawn.by_default = by_default;
        drawn.degree = data.greatest_degree();
        drawn.curved = data.geometry_degree() > 1;
        take(drawing.draw(projection, std::move(drawn)));
    }
}

}  // namespace

bool is_drawn_exactly(const DrawingRequest& request, const SurfaceOptions& options) {
    return options.thresholds.empty() && options.budgets.empty() && !request.lens &&
           !request.has_isovalue();
}

void draw_moment(const Moment& moment, const nestgrid::Executor& executor,
                 const SurfaceOptions& options, const DrawingRequest& request, const Telling& tell,
                 const TakeWalk& take) {
    const Drawing drawing(moment, executor, options, request, tell);
    const std::shared_ptr<const nestgrid::HighOrder> data = moment.high_order();
    const bool curved = data != nullptr && data->geometry_degree() > 1;
    if (options.projection.position_error > 0 && !curved) {
        throw InvalidInput(
            "--position-error is for curved cells, and all of this grid are straight");
    }
    if (data != nullptr) {
        require_error_alone(request, options, data->greatest_degree());
        return draw_polynomials(*data, moment, options, request, drawing, take);
    }
    if (is_drawn_exactly(request, options)) return take(drawing.draw({}, {}));
    moment.criteria();  // what they cost is that of the preroll
    Projection projection = moment.projection();
    projection.collapse = request.collapses;
    projection.keeps_distance = request.keeps_distances;
    projection.slice_distance = request.slice_distance;
    for (const std::int64_t budget : options.budgets) {
        projection.max_triangles = static_cast<std::uint64_t>(budget);
        take(drawing.draw(projection, {}));
    }
    projection.max_triangles = 0;
    std::vector<ThresholdText> thresholds;
    for (const std::string& text : options.thresholds) thresholds.push_back(parse_threshold(text));
    if (options.budgets.empty()) set_default_threshold(thresholds, request.lens.has_value());
    for (const ThresholdText& text : thresholds) {
        projection.threshold = moment.threshold(text);
        take(drawing.draw(projection, {}));
    }
}
