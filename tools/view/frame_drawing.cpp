// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame_drawing.hpp"

#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>

#include "dropped_nodes.hpp"
#include "surface_arrays.hpp"

namespace nestgrid::view {

namespace {

/// Ends an extraction that has more triangles than asked for.
struct TooMany {};

/// Counts triangles and throws TooMany beyond a limit.
class Counter final : public SimplexSink<3> {
public:
    explicit Counter(std::uint64_t most) : most_{most} {}
    void take(const Surface<3>& part) override {
        count_ += part.simplices.size();
        if (count_ > most_) throw TooMany{};
    }

private:
    std::uint64_t most_;
    std::uint64_t count_ = 0;
};

}  // namespace

FrameDrawing::FrameDrawing(const FrameRequest& request, const Moment& moment,
                           const FrameIndicators& indicators, const Executor& executor,
                           WatchedSteps& steps)
    : request_{request},
      moment_{moment},
      indicators_{indicators},
      executor_(executor, [&steps](double share) { steps.check(share); }),
      steps_{steps} {
    if (request.lens) {
        const LensRequest& l = *request.lens;
        lens_.emplace(indicators.size, Ball{l.centre, l.radius},
                      LensOptions{.finest = l.finest, .coarsest = l.coarsest});
    }
    if (request.plane) plane_.emplace(request.plane->through, request.plane->normal);
}

std::vector<FramePart> FrameDrawing::draw(double threshold) const {
    steps_.begin("Drawing");
    std::vector<FramePart> parts;
    if (plane_) {
        with_criterion(threshold, [&](const auto& hierarchy, const Criterion& criterion) {
            parts.push_back({"slice", draw_slice(hierarchy, criterion)});
        });
    }
    if (!request_.isovalue) return parts;
    const double first = request_.collapses() ? begun_with * threshold : threshold;
    with_criterion(first, [&](const auto& hierarchy, const Criterion& criterion) {
        parts.push_back(draw_isosurface(hierarchy, criterion));
        if (request_.collapses()) collapse_edges(parts.back(), hierarchy);
    });
    return parts;
}

bool FrameDrawing::fits(double threshold) const {
    steps_.begin("Searching for the detail that keeps within the triangles");
    bool result = true;
    with_criterion(threshold, [&](const auto& hierarchy, const Criterion& criterion) {
        std::uint64_t most = request_.triangles;
        if (plane_) {
            const std::size_t used = draw_slice(hierarchy, criterion).surface.simplices.size();
            result = used <= most;
            most -= std::min<std::uint64_t>(used, most);
        }
        if (result && request_.isovalue) result = counts_at_most(most, hierarchy, criterion);
    });
    return result;
}

template <class Function>
void FrameDrawing::with_criterion(double threshold, const Function& function) const {
    const Threshold everywhere(indicators_.detail, threshold);
    std::visit(
        [&](const auto& hierarchy) {
            if (lens_) {
                function(*hierarchy, everywhere && *lens_);
            } else {
                function(*hierarchy, everywhere);
            }
        },
        moment_.hierarchy);
}

template <class Real>
FramePart FrameDrawing::draw_isosurface(const Hierarchy<Real>& hierarchy,
                                        const Criterion& criterion) const {
    const bool normals = request_.normals != NormalType::none;
    const bool quickly = request_.moving || request_.collapses();
    IsosurfaceOptions options = watched({.elements = request_.outlines});
    options.normals = normals && !quickly;
    // Linear cuts keep an error.
    const bool keeps = request_.error > 0 || request_.indicator == IndicatorName::deviation;
    options.cuts = keeps ? Cuts::linear : Cuts::finest;
    const DroppedNodes dropped(criterion, indicators_.slopes);
    const Criterion& asked = indicators_.slopes == nullptr ? criterion : dropped;
    FramePart part{"isosurface", isosurface<3>(hierarchy, *request_.isovalue, asked,
                                               moment_.bounds(), options, executor_)};
    if (part.drawn.cancelled) throw FrameAbandoned{};
    if (indicators_.slopes != nullptr && !request_.collapses()) part.distance = dropped.greatest();
    if (normals && quickly) {
        Surface<3>& surface = part.drawn.surface;
        surface.normals = normals_from_triangles(surface);
    }
    return part;
}

template <class Real>
void FrameDrawing::collapse_edges(FramePart& part, const Hierarchy<Real>& hierarchy) const {
    steps_.begin("Taking triangles away");
    Isosurface<3>& drawn = part.drawn;
    collapse(drawn.surface, hierarchy, *request_.isovalue, moment_.bounds(),
             {.error = request_.error}, executor_)
        .hand_to(drawn, drawn.surface_error);
}

template <class Real>
Slice FrameDrawing::draw_slice(const Hierarchy<Real>& hierarchy, const Criterion& criterion) const {
    Slice drawn = slice(hierarchy, *plane_, criterion, moment_.bounds(),
                        watched({.elements = request_.outlines}), executor_);
    if (drawn.cancelled) throw FrameAbandoned{};
    return drawn;
}

/// Options of an extraction that ends where nobody waits for it.
IsosurfaceOptions FrameDrawing::watched(IsosurfaceOptions options) const {
    options.progress = [this](const TraversalCounts&) { return steps_.tell(); };
    return options;
}

template <class Real>
bool FrameDrawing::counts_at_most(std::uint64_t most, const Hierarchy<Real>& hierarchy,
                                  const Criterion& criterion) const {
    const double isovalue = *request_.isovalue;
    try {
        const auto counted = extract_isosurfaces<3>(
            hierarchy, std::span(&isovalue, 1), std::vector{Counter(most)}, criterion,
            moment_.bounds(), watched({.elements = false}), executor_);
        if (counted.front().cancelled) throw FrameAbandoned{};
    } catch (const TooMany&) {
        return false;
    }
    return true;
}

}  // namespace nestgrid::view
