// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame_drawing.hpp"

#include <algorithm>
#include <limits>
#include <memory>

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/algorithms/slices.hpp>

#include "dropped_nodes.hpp"
#include "surface_arrays.hpp"

namespace nestgrid::view {

FrameDrawing::FrameDrawing(const FrameRequest& request, const Prerolls& moment,
                           const FrameCriteria& criteria, const WatchedWork& work,
                           WatchedSteps& steps)
    : request_{request},
      moment_{moment},
      criteria_{criteria},
      work_{work},
      executor_{work.executor()},
      steps_{steps} {
    if (request.plane) {
        const auto& [through, normal] = *request.plane;
        cuts_.push_back({"slice", std::make_shared<Plane>(through, normal)});
    }
    if (request.sphere) {
        const auto& [centre, radius] = *request.sphere;
        cuts_.push_back({"slice", std::make_shared<Sphere>(centre, radius)});
    }
    if (request.boundary) {
        cuts_.push_back({"boundary", std::make_shared<nestgrid::detail::Everywhere>(), true});
    }
}

/// Calls function(hierarchy, what stops there) for what is drawn at a threshold.
template <class Function>
auto FrameDrawing::with(double threshold, const Function& function) const {
    if (criteria_.polynomials == nullptr) {
        const AnyCriterion criterion = criteria_.detail->at(threshold);
        return moment_.field().visit([&](const auto& hierarchy) {
            return function(hierarchy, StoppedBy{criterion, *criteria_.bounds});
        });
    }
    const HighOrder& data = *criteria_.polynomials;
    const double positions = request_.position_error;
    VirtualOptions options{.tolerance = std::max(threshold, data.least_tolerance(positions)),
                           .lens = request_.lens,
                           .region = request_.region,
                           .position_tolerance = positions};
    options.values.emplace();
    for (const double isovalue : request_.isovalues) {
        options.values->push_back(
            {isovalue, request_.cap ? std::numeric_limits<double>::infinity() : isovalue});
    }
    if (request_.band) {
        for (const double end : *request_.band) options.values->push_back({end, end});
    }
    options.boundary = request_.boundary;
    for (const Cut& cut : cuts_) {
        if (!cut.cap) options.functions.push_back(cut.function.get());
    }
    const VirtualRefinement fine(data, options);
    const Hierarchy<double>& hierarchy = fine;
    return function(hierarchy, StoppedBy{fine.criterion(), fine.bounds()});
}

std::vector<FramePart> FrameDrawing::draw(double threshold) const {
    steps_.begin("Drawing");
    std::vector<FramePart> parts;
    if (!cuts_.empty()) {
        with(threshold, [&](const auto& hierarchy, const StoppedBy& by) {
            for (const Cut& cut : cuts_) {
                const bool less = request_.collapses() && request_.slice_distance > 0 && !cut.cap;
                parts.push_back(less ? draw_collapsed(cut) : draw_cut(cut, hierarchy, by));
                refine(parts.back(), threshold);
            }
        });
    }
    if (request_.band) {
        with(threshold, [&](const auto& hierarchy, const StoppedBy& by) {
            parts.push_back(draw_band(hierarchy, by));
        });
    }
    if (request_.isovalues.empty()) return parts;
    if (request_.keeps_distance()) {
        for (FramePart& part : draw_within_distance()) parts.push_back(std::move(part));
        return parts;
    }
    const double first = request_.collapses() ? collapse_start * threshold : threshold;
    with(first, [&](const auto& hierarchy, const StoppedBy& by) {
        for (FramePart& part : draw_isosurfaces(hierarchy, by)) {
            if (request_.collapses()) collapse_edges(part, hierarchy);
            parts.push_back(std::move(part));
        }
    });
    return parts;
}

bool FrameDrawing::fits(double threshold) const {
    steps_.begin("Searching for the detail that keeps within the triangles");
    bool waits = true;
    IsosurfaceOptions options{.cap = request_.cap};
    options.progress = [&](const TraversalCounts&) { return waits = steps_.tell(); };
    const bool fit = with(threshold, [&](const auto& hierarchy, const StoppedBy& by) {
        std::uint64_t most = request_.triangles;
        for (const Cut& cut : cuts_) {  // merged at nodes, it has fewer triangles than are counted
            const std::size_t used = draw_cut(cut, hierarchy, by).drawn.surface.simplices.size();
            if (used > most) return false;
            most -= used;
        }
        const std::vector<double> isovalues = request_.level_sets();
        if (isovalues.empty()) return true;
        return count_triangles(hierarchy, {{}, isovalues}, under(by.criterion, by.bounds), most,
                               options, {executor_})
            .has_value();
    });
    if (!waits) throw FrameAbandoned{};
    return fit;
}

template <class Real>
std::vector<FramePart> FrameDrawing::draw_isosurfaces(const Hierarchy<Real>& hierarchy,
                                                      const StoppedBy& by) const {
    const IsosurfaceOptions options = surface_options();
    const DroppedNodes dropped(by.criterion, criteria_.slopes.get());
    const Criterion& asked = criteria_.slopes == nullptr ? by.criterion : dropped;
    std::vector<Isosurface<3>> drawn = isosurfaces<3>(
        hierarchy, request_.isovalues, under(asked, by.bounds), options, {executor_});
    std::vector<FramePart> parts;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        if (drawn[i].cancelled) throw FrameAbandoned{};
        parts.push_back({"isosurface", std::move(drawn[i]), request_.isovalues[i]});
        FramePart& part = parts.back();
        if (criteria_.slopes != nullptr && !request_.collapses()) {
            part.distance = dropped.greatest();
        }
        add_normals(part);
    }
    return parts;
}

/// Isosurfaces, each of which keeps its distance from that of all data, there and back.
std::vector<FramePart> FrameDrawing::draw_within_distance() const {
    Projection projection = request_.projection("slope");
    projection.threshold = request_.distance;
    projection.keeps_distance = true;
    std::vector<FramePart> parts;
    for (const double isovalue : request_.isovalues) {
        parts.push_back(
            {"isosurface",
             isosurface<3>(moment_, isovalue, projection, surface_options(), work_.work()),
             isovalue, request_.distance});
        if (parts.back().drawn.cancelled) throw FrameAbandoned{};
    }
    return parts;
}

template <class Real>
FramePart FrameDrawing::draw_band(const Hierarchy<Real>& hierarchy, const StoppedBy& by) const {
    const auto& [low, high] = *request_.band;
    IsosurfaceOptions options = surface_options();
    options.cap = false;
    FramePart part{"band", isoband<3>(hierarchy, low, high, under(by.criterion, by.bounds), options,
                                      {executor_})};
    if (part.drawn.cancelled) throw FrameAbandoned{};
    add_normals(part);
    return part;
}

/// Where edges are cut, what is kept, and whether normals are those of gradients.
IsosurfaceOptions FrameDrawing::surface_options() const {
    IsosurfaceOptions options = watched(
        {.cap = request_.cap, .elements = request_.outlines, .at_nodes = request_.at_nodes});
    options.normals =
        request_.normals != NormalType::none && !request_.draws_quickly() && !request_.cap;
    // Linear cuts keep an error.
    const bool keeps =
        request_.error > 0 || request_.indicator == "deviation" || criteria_.polynomials != nullptr;
    options.cuts = request_.cut_edges.value_or(keeps ? Cuts::linear : Cuts::finest);
    return options;
}

/// Normals from triangles, where those of gradients were not asked for.
void FrameDrawing::add_normals(FramePart& part) const {
    const bool quickly = request_.draws_quickly();
    if (request_.normals == NormalType::none || !quickly || request_.cap) return;
    Surface<3>& surface = part.drawn.surface;
    surface.normals = normals_from_triangles(surface);
}

void FrameDrawing::measure(std::vector<FramePart>& parts) const {
    if (!request_.measure || request_.moving) return;
    constexpr std::size_t points = 50000;
    steps_.begin("Measuring the surface against that of all data");
    for (FramePart& part : parts) {
        if (!part.is("isosurface")) continue;
        part.measured =
            measure_error(moment_, part.drawn.surface, part.isovalue, points, work_.work());
    }
}

template <class Real>
void FrameDrawing::collapse_edges(FramePart& part, const Hierarchy<Real>& hierarchy) const {
    steps_.begin("Taking triangles away");
    Isosurface<3>& drawn = part.drawn;
    collapse(drawn.surface, hierarchy, part.isovalue, *criteria_.bounds, {.error = request_.error},
             executor_)
        .hand_to(drawn, drawn.surface_error);
}

template <class Real>
FramePart FrameDrawing::draw_cut(const Cut& cut, const Hierarchy<Real>& hierarchy,
                                 const StoppedBy& by) const {
    FramePart part{cut.kind,
                   slice(hierarchy, *cut.function, under(by.criterion, by.bounds),
                         watched({.cap = cut.cap, .elements = request_.outlines}), {executor_})};
    if (part.drawn.cancelled) throw FrameAbandoned{};
    return part;
}

/// A slice with fewer triangles of the same error, and nearly of the same place.
FramePart FrameDrawing::draw_collapsed(const Cut& cut) const {
    Projection projection = request_.projection("error");
    projection.threshold = request_.error;
    projection.collapse = true;
    if (!cut.function->affine()) projection.slice_distance = request_.slice_distance;
    FramePart part{cut.kind, slice(moment_, *cut.function, projection, watched({}), work_.work())};
    if (part.drawn.cancelled) throw FrameAbandoned{};
    return part;
}

/// Splits triangles of a settled slice or boundary until its colours follow the data.
void FrameDrawing::refine(FramePart& cut, double threshold) const {
    if (!(request_.colour_tolerance > 0) || request_.moving) return;
    steps_.begin("Refining colours");
    Surface<3>& surface = cut.drawn.surface;
    if (criteria_.polynomials != nullptr) {
        Projection projection = request_.projection("error");
        projection.threshold =
            std::max(threshold, criteria_.polynomials->least_tolerance(request_.position_error));
        projection.position_error = request_.position_error;
        refine_colours(surface, moment_, request_.colour_tolerance, projection, work_.work());
        return;
    }
    const AnyCriterion criterion = criteria_.detail->at(threshold);
    refine_colours(surface, moment_, request_.colour_tolerance, under(criterion, *criteria_.bounds),
                   work_.work());
}

/// Options of an extraction that ends where nobody waits for it.
IsosurfaceOptions FrameDrawing::watched(IsosurfaceOptions options) const {
    options.progress = [this](const TraversalCounts&) { return steps_.tell(); };
    return options;
}

}  // namespace nestgrid::view
