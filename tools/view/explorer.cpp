// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "explorer.hpp"

#include <chrono>
#include <cmath>
#include <cstdlib>

#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/slice.hpp>
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

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

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

struct Part {
    const char* kind;
    Isosurface<3> drawn;
};

void write_part(FrameReply& reply, const Part& part, const FrameRequest& request) {
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

/// The field at the time of a request.
struct Explorer::Moment {
    SharedHierarchy hierarchy;
    std::size_t frame = 0;                         ///< where it is that of a frame
    std::optional<KeyFrames> between;              ///< where it is not
    std::vector<float> weights;                    ///< of the frames
    const HierarchicalIndicator* alone = nullptr;  ///< of offsets or deviations, at a frame

    const Bounds& bounds() const {
        if (between) return *between;
        return *alone;
    }
};

struct Explorer::Drawn {
    double threshold = 0;
    int draws = 0;
    std::vector<Part> parts;

    std::uint64_t triangles() const {
        std::uint64_t sum = 0;
        for (const Part& part : parts) sum += part.drawn.surface.simplices.size();
        return sum;
    }
};

/// What a request draws, at any threshold.
class Explorer::Drawing {
public:
    Drawing(const FrameRequest& request, const Moment& moment, const Indicator& indicator,
            const SweptIndicator* size, const Executor& executor, WatchedSteps& steps)
        : request_{request},
          moment_{moment},
          indicator_{&indicator},
          executor_(executor, [&steps](double share) { steps.check(share); }),
          steps_{steps} {
        if (request.lens) {
            const LensRequest& l = *request.lens;
            lens_.emplace(size, Ball{l.centre, l.radius},
                          LensOptions{.finest = l.finest, .coarsest = l.coarsest});
        }
        if (request.plane) plane_.emplace(request.plane->through, request.plane->normal);
    }

    std::vector<Part> draw(double threshold) const {
        steps_.begin("Drawing");
        std::vector<Part> parts;
        with_criterion(threshold, [&](const auto& hierarchy, const Criterion& criterion) {
            IsosurfaceOptions options = watched({.elements = request_.outlines});
            if (plane_) parts.push_back({"slice", draw_slice(hierarchy, criterion)});
            if (!request_.isovalue) return;
            const bool normals = request_.normals != NormalType::none;
            options.normals = normals && !request_.moving;
            // Linear cuts keep a deviation.
            const bool keeps = request_.indicator == IndicatorName::deviation;
            options.cuts = keeps ? Cuts::linear : Cuts::finest;
            parts.push_back({"isosurface", isosurface<3>(hierarchy, *request_.isovalue, criterion,
                                                         moment_.bounds(), options, executor_)});
            if (parts.back().drawn.cancelled) throw FrameAbandoned{};
            if (normals && request_.moving) {
                Surface<3>& surface = parts.back().drawn.surface;
                surface.normals = normals_from_triangles(surface);
            }
        });
        return parts;
    }

    /// Whether a threshold gives no more triangles than asked for.
    bool fits(double threshold) const {
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

private:
    template <class Function>
    void with_criterion(double threshold, const Function& function) const {
        const Threshold everywhere(indicator_, threshold);
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
    Slice draw_slice(const Hierarchy<Real>& hierarchy, const Criterion& criterion) const {
        Slice drawn = slice(hierarchy, *plane_, criterion, moment_.bounds(),
                            watched({.elements = request_.outlines}), executor_);
        if (drawn.cancelled) throw FrameAbandoned{};
        return drawn;
    }
    /// Options of an extraction that ends where nobody waits for it.
    IsosurfaceOptions watched(IsosurfaceOptions options) const {
        options.progress = [this](const TraversalCounts&) { return steps_.tell(); };
        return options;
    }
    template <class Real>
    bool counts_at_most(std::uint64_t most, const Hierarchy<Real>& hierarchy,
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

    const FrameRequest& request_;
    const Moment& moment_;
    const Indicator* indicator_;
    std::optional<Lens> lens_;
    std::optional<Plane> plane_;
    TellingExecutor executor_;
    WatchedSteps& steps_;
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

Explorer::Moment Explorer::moment_at(const FrameRequest& request, WatchedSteps& steps) {
    std::vector<float> weights{1};
    if (request.time && field_.frames.size() == 1 && *request.time != field_.times.front()) {
        throw InvalidInput("there is one frame, and the time asked for is not its time");
    }
    if (field_.frames.size() > 1) {
        weights = linear_weights(field_.times, request.time.value_or(field_.times.front()));
    }
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] != 1) continue;
        const HierarchicalIndicator& alone = of_nodes(request.indicator, i, steps);
        return {field_.frames[i], i, {}, std::move(weights), &alone};
    }
    std::vector<const HierarchicalIndicator*> frames;
    std::vector<float> of_frames;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0) continue;
        frames.push_back(&of_nodes(request.indicator, i, steps));
        of_frames.push_back(weights[i]);
    }
    KeyFrames between(std::move(frames), of_frames);
    return {field_.between(weights), 0, std::move(between), std::move(weights), nullptr};
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

Explorer::Drawn Explorer::draw_to_goal(const FrameRequest& request, const Drawing& drawing) {
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

Explorer::Drawn Explorer::draw(const FrameRequest& request, const Drawing& drawing) {
    if (request.triangles == 0) return {request.threshold, 1, drawing.draw(request.threshold)};
    const std::optional<Budget> before = budget_;
    try {
        return draw_to_goal(request, drawing);
    } catch (const FrameAbandoned&) {
        budget_ = before;
        throw;
    }
}

std::vector<std::byte> Explorer::frame(std::string_view text, const FrameWatch& watch) {
    const FrameRequest request = parse_request(text);
    const auto start = Clock::now();
    WatchedSteps steps(watch);
    const Moment moment = moment_at(request, steps);
    const Indicator& indicator = indicator_at(moment, request.indicator, steps);
    const SweptIndicator* const size =
        request.lens ? &size_for(moment, request.lens->slope, steps) : nullptr;
    const Drawing drawing(request, moment, indicator, size, *executor_, steps);
    const Drawn drawn = draw(request, drawing);
    ErrorBounds bounds;
    double visited = 0;
    for (const Part& part : drawn.parts) {
        bounds.add_bounds(part.drawn);
        visited += static_cast<double>(part.drawn.counts.visited);
    }
    const double seconds = seconds_since(start);
    FrameReply reply;
    reply.header.open('{').key("threshold").number(drawn.threshold);
    reply.header.key("triangles").number(static_cast<double>(drawn.triangles()));
    reply.header.key("visited").number(visited).key("error_bound").number(bounds.error_bound);
    reply.header.key("bound_says_nothing").boolean(bounds.bound_says_nothing());
    reply.header.key("seconds").number(seconds).key("draws").number(drawn.draws);
    reply.header.key("parts").open('[');
    for (const Part& part : drawn.parts) write_part(reply, part, request);
    reply.header.close(']').close('}');
    return reply.bytes();
}

}  // namespace nestgrid::view
