// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/drawing.hpp"

#include <algorithm>

#include <nestgrid/algorithms/collapse_budget.hpp>
#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/error.hpp>

#include "drawing/meter.hpp"

namespace {

using nestgrid::AnyCriterion;
using nestgrid::Bounds;
using nestgrid::Criterion;
using nestgrid::InvalidInput;
using nestgrid::Isosurface;
using nestgrid::IsosurfaceOptions;
using nestgrid::TriangleBudget;

void check(const DrawingRequest& request, const SurfaceOptions& options,
           const nestgrid::HierarchyFacts& facts) {
    const bool in_space = request.function != nullptr || request.isovalue;
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

/// A criterion that another object keeps, as a value.
class Borrowed final : public Criterion {
public:
    explicit Borrowed(const Criterion& criterion) : criterion_{&criterion} {}
    nestgrid::NodeMask holds(const nestgrid::NewNodes& nodes) const override {
        return criterion_->holds(nodes);
    }
    bool saturated() const override { return criterion_->saturated(); }
    bool made_for(std::uint64_t epoch) const override { return criterion_->made_for(epoch); }

private:
    const Criterion* criterion_;
};

/// Draws the surfaces at one moment.
template <class Real>
class Drawing {
public:
    Drawing(const nestgrid::Hierarchy<Real>& hierarchy, const Moment& moment,
            const nestgrid::Executor& executor, const SurfaceOptions& options,
            const DrawingRequest& request, const Telling& tell)
        : hierarchy_{hierarchy},
          moment_{moment},
          executor_{executor},
          options_{options},
          request_{request},
          tell_{tell} {
        check(request, options, hierarchy.facts());
    }

    void draw_all(const std::function<void(Drawn&&)>& take) const {
        if (is_drawn_exactly(request_, options_)) {
            tell_({});
            take(reported(draw({}, [&](Drawn& d) { draw_exactly(d); })));
            return;
        }
        std::vector<ThresholdText> thresholds;
        for (const std::string& text : options_.thresholds) {
            thresholds.push_back(parse_threshold(text));
        }
        if (options_.budgets.empty()) {
            set_default_threshold(thresholds, request_.lens.has_value());
        }
        for (const std::int64_t budget : options_.budgets) {
            take(draw_at(find(static_cast<std::uint64_t>(budget))));
        }
        for (const ThresholdText& t : thresholds) {
            Drawn d;
            d.threshold = moment_.threshold(t);
            take(draw_at(std::move(d)));
        }
    }

    /// Draws the leaves of a field of higher degree as finely as they are halved.
    Drawn draw_within(const nestgrid::VirtualRefinement& fine, Drawn d) const {
        tell_({});
        return reported(draw(std::move(d), [&](Drawn& to) {
            draw_with(Borrowed(fine.criterion()), fine.bounds(), to.threshold, {}, to);
        }));
    }

private:
    const nestgrid::Criteria& criteria() const { return moment_.criteria(); }
    const nestgrid::Bounds& bounds() const { return criteria().bounds(); }
    bool in_plane() const { return hierarchy_.facts().dimension == 2; }

    AnyCriterion criterion_at(double threshold) const { return criteria().at(threshold); }
    /// The same as a function.
    auto criteria_at() const {
        return [this](double threshold) { return criterion_at(threshold); };
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

    /// The least threshold at which the surface keeps within a number of triangles, after collapses
    /// where there are any.
    Drawn find(std::uint64_t budget) const {
        tell_("searching the threshold");
        const Meter meter;
        Drawn d;
        const bool of_isosurface = request_.in_one_colour() || !request_.by.empty();
        d.search = of_isosurface ? find_isosurface(budget) : find_coloured(budget);
        d.search_seconds = meter.seconds();
        d.threshold = d.search.threshold;
        return d;
    }
    TriangleBudget find_isosurface(std::uint64_t budget) const {
        const double isovalue = *request_.isovalue;
        const IsosurfaceOptions options = isosurface_options(true);
        if (in_plane()) {
            return nestgrid::find_threshold<2>(hierarchy_, isovalue, criteria_at(), bounds(),
                                               budget, options, executor_);
        }
        if (request_.collapses && request_.keeps_distances) {
            return nestgrid::find_collapse_distance(hierarchy_, isovalue, whole(), criteria_at(),
                                                    bounds(), budget, options, executor_);
        }
        if (request_.collapses) {
            return nestgrid::find_collapse_error(hierarchy_, isovalue, criteria_at(), bounds(),
                                                 budget, options, executor_);
        }
        return nestgrid::find_threshold<3>(hierarchy_, isovalue, criteria_at(), bounds(), budget,
                                           options, executor_);
    }
    TriangleBudget find_coloured(std::uint64_t budget) const {
        if (request_.collapses) return find_collapsed_colours(budget);
        if (request_.function == nullptr) {
            return find_shading_threshold(hierarchy_, criteria_at(), bounds(), budget, {},
                                          executor_);
        }
        if (!request_.isovalue) {
            return find_threshold(hierarchy_, *request_.function, criteria_at(), bounds(), budget,
                                  IsosurfaceOptions{.cap = request_.cap}, executor_);
        }
        return nestgrid::least_threshold(
            [&](double threshold, std::uint64_t most) {
                return count_both(criterion_at(threshold), most);
            },
            bounds().greatest() - bounds().least(), budget);
    }
    TriangleBudget find_collapsed_colours(std::uint64_t budget) const {
        const nestgrid::TryCollapse within = [&](double error) {
            Drawn d;
            d.threshold = error;
            d = draw_first(std::move(d), {});
            const std::uint64_t drawn = d.result.surface.simplices.size();
            if (error > 0) collapse_one({}, d);
            return nestgrid::CollapseTrial{drawn, d.result.surface.simplices.size()};
        };
        return find_collapse_error(within, bounds().greatest() - bounds().least(), budget);
    }
    /// Counts the triangles of the slice and of the isosurface beside it.
    std::optional<std::uint64_t> count_both(const nestgrid::Criterion& criterion,
                                            std::uint64_t most) const {
        return count_triangles(hierarchy_, {{request_.function}, {*request_.isovalue}},
                               under(criterion, bounds()), most, {}, {executor_});
    }

    /// The isosurface of all data, where it is compared with.
    nestgrid::Surface<3> whole() const {
        if (!request_.measures && !request_.keeps_distances) return {};
        return nestgrid::isosurface<3>(
                   hierarchy_, *request_.isovalue, under(nestgrid::Exact{}, bounds()),
                   {.elements = false, .at_nodes = request_.at_nodes}, {executor_})
            .surface;
    }
    Drawn draw_at(Drawn d) const {
        tell_({});
        const nestgrid::Surface<3> whole = this->whole();
        d = draw_first(std::move(d), whole);
        if (request_.collapses && d.threshold > 0) collapse_one(whole, d);
        if (request_.measures) measure_one(whole, d);
        return reported(std::move(d));
    }
    /// Draws within the threshold, or, where edges are then collapsed within it, within a part.
    Drawn draw_first(Drawn d, const nestgrid::Surface<3>& whole) const {
        const bool collapses = request_.collapses && d.threshold > 0;
        const bool of_error = request_.isovalue && !request_.keeps_distances;
        const double part = of_error ? nestgrid::collapse_start : 0.5;
        const double first = collapses ? part * d.threshold : d.threshold;
        return draw(std::move(d), [&](Drawn& to) {
            if (!collapses || request_.slice_distance == 0) {
                return draw_with(criterion_at(first), bounds(), first, whole, to);
            }
            // Only a slice of all data is as near to its function as the grid allows.
            draw_exactly(to);
            refine(to.result.surface, first);
        });
    }
    template <class DrawInto>
    Drawn draw(Drawn d, const DrawInto& draw_into) const {
        d.time = moment_.time();
        const Meter meter;
        draw_into(d);
        d.seconds = meter.seconds();
        const std::size_t kept = d.result.surface.memory_bytes() + d.segments.memory_bytes() +
                                 d.isosurface.memory_bytes();
        d.peak_bytes = meter.peak_bytes() - std::min(meter.peak_bytes(), kept);
        return d;
    }
    static Drawn reported(Drawn d) {
        d.report = nestgrid::surface_report(d.result.surface);
        d.isosurface_report = nestgrid::surface_report(d.isosurface);
        if (d.segments.vertices.empty()) return d;
        d.report.vertices = d.segments.vertices.size();
        d.report.triangles = d.segments.simplices.size();
        return d;
    }

    void draw_exactly(Drawn& d) const {
        d.result = request_.function == nullptr
                       ? triangles(0, {})
                       : slice(hierarchy_, *request_.function, {},
                               {.cap = request_.cap, .elements = keeps_elements()}, {executor_});
        refine(d.result.surface, request_.colour_tolerance);
    }
    void draw_with(const AnyCriterion& criterion, const Bounds& bounds, double threshold,
                   const nestgrid::Surface<3>& whole, Drawn& d) const {
        if (request_.function == nullptr && request_.isovalue) {
            return draw_isosurface(criterion, bounds, threshold, whole, d);
        }
        const IsosurfaceOptions options{.cap = request_.cap, .elements = keeps_elements()};
        const nestgrid::Projection projection = under(criterion, bounds);
        if (request_.isovalue) {
            auto both = slices(hierarchy_, {{request_.function}, {*request_.isovalue}}, projection,
                               options, {executor_});
            d.result = std::move(both[0]);
            d.isosurface = std::move(both[1].surface);
        } else if (request_.function != nullptr) {
            d.result = slice(hierarchy_, *request_.function, projection, options, {executor_});
        } else {
            d.result = triangles(threshold, projection);
        }
        if (request_.collapses && request_.scale == 0) {
            refine(d.result.surface, threshold, projection);
        }
        refine(d.result.surface, request_.colour_tolerance, projection);
        if (!d.isosurface.attributes.empty()) {
            refine(d.isosurface, request_.colour_tolerance, projection);
        }
    }
    void draw_isosurface(const AnyCriterion& criterion, const Bounds& bounds, double threshold,
                         const nestgrid::Surface<3>& whole, Drawn& d) const {
        const double isovalue = *request_.isovalue;
        const IsosurfaceOptions options = isosurface_options(executor_.concurrency() == 1);
        if (in_plane()) {
            auto lines = nestgrid::isosurface<2>(hierarchy_, isovalue, under(criterion, bounds),
                                                 options, {executor_});
            d.segments = std::move(lines.surface);
            d.result = {lines, {}, lines.counts};
            d.result.surface_error = lines.surface_error;
            d.result.stack_bytes = lines.stack_bytes;
        } else if (request_.keeps_distances && threshold > 0) {
            auto within = nestgrid::isosurface_within(hierarchy_, isovalue, {whole, threshold},
                                                      criterion, bounds, options, executor_);
            d.far_points = within.points;
            d.result = std::move(within.isosurface);
        } else {
            d.result = nestgrid::isosurface<3>(hierarchy_, isovalue, under(criterion, bounds),
                                               options, {executor_});
        }
    }
    /// The grid of dimension 2.
    Isosurface<3> triangles(double threshold, const nestgrid::Projection& projection) const {
        nestgrid::ShadingOptions options;
        options.elements = keeps_elements();
        if (request_.collapses) options.flatness = threshold;
        nestgrid::Shading s =
            request_.scale == 0
                ? shading(hierarchy_, projection, options, {executor_})
                : height_field(hierarchy_, request_.scale, projection, options, {executor_});
        return {s, std::move(s.surface), s.counts};
    }
    /// Makes colours follow the data.
    /// \param projection that the surface was drawn with
    void refine(nestgrid::Surface<3>& surface, double tolerance,
                const nestgrid::Projection& projection = {}) const {
        if (tolerance > 0) refine_colours(surface, hierarchy_, tolerance, projection);
    }

    /// Takes edges away within the threshold.
    void collapse_one(const nestgrid::Surface<3>& whole, Drawn& d) const {
        tell_("collapsing");
        const Meter meter;
        nestgrid::Surface<3>& surface = d.result.surface;
        if (request_.isovalue) {
            nestgrid::CollapseOptions options;
            if (request_.keeps_distances) {
                options.nearness.emplace(nestgrid::Nearness{whole, d.threshold});
            } else {
                options.error = d.threshold;
            }
            d.collapsed = nestgrid::collapse(surface, hierarchy_, *request_.isovalue, bounds(),
                                             options, executor_);
        } else {
            nestgrid::ColourCollapseOptions options{.errors = {d.threshold},
                                                    .scale = request_.scale};
            nestgrid::Surface<3> slice;
            if (request_.slice_distance > 0) {
                slice = surface;
                options.nearness.emplace(nestgrid::Nearness{slice, request_.slice_distance});
            }
            d.collapsed =
                nestgrid::collapse_colours(surface, hierarchy_, bounds(), options, executor_);
        }
        d.collapse_seconds = meter.seconds();
        d.collapsed->hand_to(d.result, d.result.surface_error);
    }
    void measure_one(const nestgrid::Surface<3>& whole, Drawn& d) const {
        constexpr std::size_t points = 200000;
        tell_("measuring");
        const Meter meter;
        d.measured = nestgrid::measure_error(hierarchy_, d.result.surface, whole,
                                             *request_.isovalue, points, {executor_});
        d.measure_seconds = meter.seconds();
    }

    const nestgrid::Hierarchy<Real>& hierarchy_;
    const Moment& moment_;
    const nestgrid::Executor& executor_;
    const SurfaceOptions& options_;
    const DrawingRequest& request_;
    const Telling& tell_;
};

/// \throw nestgrid::InvalidInput where options ask for more than an error
void require_error_alone(const DrawingRequest& request, const SurfaceOptions& options, int degree) {
    nestgrid::Projection projection = options.projection;
    const bool is_asked = !options.thresholds.empty() || !options.budgets.empty();
    if (!is_asked && !request.lens) projection.indicator = "error";
    projection.max_triangles = options.budgets.empty() ? 0 : 1;
    projection.lens = request.lens;
    projection.collapse = request.collapses;
    projection.keeps_distance = request.keeps_distances;
    projection.require_error_alone(degree);
    if (request.box || request.measures || request.colour_tolerance > 0) {
        throw InvalidInput("--box, --measure and --colour-tolerance are for fields of degree 1");
    }
}

}  // namespace

bool is_drawn_exactly(const DrawingRequest& request, const SurfaceOptions& options) {
    return options.thresholds.empty() && options.budgets.empty() && !request.lens &&
           !request.isovalue;
}

void draw_moment(const Moment& moment, const nestgrid::Executor& executor,
                 const SurfaceOptions& options, const DrawingRequest& request, const Telling& tell,
                 const std::function<void(Drawn&&)>& take) {
    if (const std::shared_ptr<const nestgrid::HighOrder> data = moment.high_order()) {
        require_error_alone(request, options, data->greatest_degree());
        std::vector<Drawn> wanted(std::max<std::size_t>(1, options.thresholds.size()));
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            Drawn& d = wanted[i];
            d.by_default = options.thresholds.empty();
            d.threshold = d.by_default ? nestgrid::default_error(*data)
                                       : moment.error(parse_threshold(options.thresholds[i]));
            d.degree = data->greatest_degree();
            const nestgrid::VirtualRefinement fine(*data, {.tolerance = d.threshold});
            const Drawing<double> drawing(fine, moment, executor, options, request, tell);
            take(drawing.draw_within(fine, std::move(d)));
        }
        return;
    }
    moment.visit([&]<class Real>(const nestgrid::Hierarchy<Real>& hierarchy) {
        Drawing<Real>(hierarchy, moment, executor, options, request, tell).draw_all(take);
    });
}
