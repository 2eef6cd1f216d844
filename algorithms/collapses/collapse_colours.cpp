// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/collapse_colours.hpp>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <nestgrid/algorithms/normals.hpp>
#include <nestgrid/error.hpp>

#include <collapses/collapse_rounds.hpp>
#include <collapses/judge_triangles.hpp>
#include <drawing/requirements.hpp>
#include <surfaces/require_simplices.hpp>

namespace nestgrid {

namespace {

constexpr double same_plane = 0.999;  // the least cosine of a turn: rounding of flat triangles

void require_nearness(const ColourCollapseOptions& options) {
    options.nearness->require();
    engine::require_simplices(options.nearness->whole);
    if (options.scale != 0) {
        throw InvalidInput(
            "a height field keeps its place: a distance and a scale exclude each other");
    }
}

/// \param components of the field
void require_colours(const Surface<3>& surface, std::size_t components,
                     const ColourCollapseOptions& options) {
    if (options.errors.empty()) throw InvalidInput("a collapse of colours has no error to keep");
    for (const double error : options.errors) {
        if (!(error > 0 && std::isfinite(error))) {
            throw InvalidInput("the error of a colour is not a positive number");
        }
    }
    if (!std::isfinite(options.scale)) throw InvalidInput("the scale is not a finite number");
    if (options.nearness) require_nearness(options);
    engine::require_limits(options.turn, options.shape);
    engine::require_simplices(surface);
    if (surface.vertices.empty()) return;
    const std::size_t count = surface.attributes.size() / surface.vertices.size();
    if (count == 0 || count * surface.vertices.size() != surface.attributes.size()) {
        throw InvalidInput("the surface has no attributes to keep");
    }
    if (count > components) {
        throw InvalidInput("the surface has " + std::to_string(count) +
                           " attributes, and the field only " + std::to_string(components) +
                           (components == 1 ? " component" : " components"));
    }
    if (options.errors.size() != 1 && options.errors.size() != count) {
        throw InvalidInput("the surface has " + std::to_string(count) + " attributes, and errors " +
                           "are given for " + std::to_string(options.errors.size()));
    }
}

/// Moves vertices along z by a factor times attribute 0.
void lift(Surface<3>& surface, double factor) {
    if (factor == 0 || surface.vertices.empty()) return;
    const std::size_t attributes = surface.attributes.size() / surface.vertices.size();
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        surface.vertices[v][2] += factor * surface.attributes[v * attributes];
    }
}

/// The checks of colours, and of a distance where one is kept.
class ColourChecks {
public:
    template <class Real>
    ColourChecks(const Surface<3>& surface, const Hierarchy<Real>& hierarchy,
                 std::span<const double> errors, const Bounds& bounds,
                 std::optional<Nearness> nearness)
        : nearness_{std::move(nearness)} {
        using Drawn = engine::FieldCheck::Drawn;
        const Surface<3>& along = nearness_ ? nearness_->whole : surface;
        leaves_ = engine::NearLeaves::find_along(hierarchy, along, errors,
                                                 nearness_ ? nearness_->distance : 0, bounds);
        field_.emplace(leaves_, nearness_ ? Drawn::moving_colours : Drawn::colours);
        if (!nearness_) return;
        to_whole_.emplace(nearness_->whole);
        distance_.emplace(*nearness_, *to_whole_, leaves_);
    }

    const engine::NearLeaves& leaves() const { return leaves_; }
    const engine::FieldCheck& field() const { return *field_; }
    const engine::DistanceCheck* distance() const { return distance_ ? &*distance_ : nullptr; }

private:
    std::optional<Nearness> nearness_;
    engine::NearLeaves leaves_;
    std::optional<engine::FieldCheck> field_;
    std::optional<engine::ClosestPoints> to_whole_;
    std::optional<engine::DistanceCheck> distance_;
};

/// The triangles of a surface in order, each judged by its colours and by the distance there.
/// \param take take(triangle, whether they keep what is asked for) is called in order
/// \return the greatest part of an error of those that do
template <class Take>
double judge_colours(const Surface<3>& surface, std::span<const double> errors,
                     const ColourChecks& checks, const Executor& executor, const Take& take) {
    std::vector<double> colours(surface.attributes.size());
    for (std::size_t i = 0; i < colours.size(); ++i) {
        colours[i] = surface.attributes[i] / errors[i % errors.size()];
    }
    const auto of = [&](std::uint32_t v) {
        return std::span<const double>(colours).subspan(v * errors.size(), errors.size());
    };
    const engine::DistanceCheck* const distance = checks.distance();
    const auto make = [&] {
        auto search = distance != nullptr ? std::optional(distance->search()) : std::nullopt;
        return [&, search](std::size_t t, double& greatest) mutable {
            const engine::Triangle x = engine::triangle_of(surface, t);
            if (search && search->far_point(x)) return false;
            const auto& [a, b, c] = surface.simplices[t];
            return checks.field().keeps_colours(engine::FlatTriangle(x), {of(a), of(b), of(c)},
                                                greatest);
        };
    };
    return engine::judge_triangles(surface.simplices.size(), executor, make, take);
}

/// Says how vertices may move: within a distance, or on the planes of the surface.
/// \return how many triangles of the surface of all data are farther from the beginning
std::size_t prepare(engine::CollapseRounds& rounds, const Surface<3>& surface,
                    const ColourChecks& checks, const ColourCollapseOptions& options,
                    const Executor& executor) {
    if (!options.nearness) {
        rounds.keep_support();
        return 0;
    }
    rounds.keep_borders(checks.leaves(), options.nearness->distance);
    return engine::give_parts(checks.distance()->whole(), surface, rounds.parts(), executor);
}

}  // namespace

template <class Real>
Collapsed collapse_colours(Surface<3>& surface, const Hierarchy<Real>& hierarchy,
                           const Bounds& bounds, const ColourCollapseOptions& options,
                           const Executor& executor) {
    engine::require_same_epoch(hierarchy, bounds);
    require_colours(surface, static_cast<std::size_t>(hierarchy.facts().components), options);
    if (options.nearness) hierarchy.facts().require_dimension(3);
    if (surface.simplices.empty()) {
        return {.missed = options.nearness ? options.nearness->whole.simplices.size() : 0};
    }
    std::vector<double> errors = options.errors;
    errors.resize(surface.attributes.size() / surface.vertices.size(), errors[0]);
    lift(surface, -options.scale);
    const ColourChecks checks(surface, hierarchy, errors, bounds, options.nearness);
    const auto box = engine::Box::around(surface.vertices);
    const engine::CollapseRules rules{
        .field = &checks.field(),
        .strong = nullptr,
        .distance = checks.distance(),
        .coloured = true,
        .middle = 0.5 * (box.low + box.high),
        .least_cosine =
            options.nearness ? std::cos(options.turn * std::numbers::pi / 180) : same_plane,
        .least_shape = options.shape};
    const bool normals = !surface.normals.empty();
    engine::CollapseRounds rounds(surface, rules, executor);
    rounds.keep_colours(errors);
    const std::size_t missed = prepare(rounds, surface, checks, options, executor);
    judge_colours(surface, errors, checks, executor, [&](std::size_t t, bool keeps) {
        if (!keeps) rounds.fasten(t);
    });
    Collapsed result = rounds.run();
    rounds.finish();
    const double most =
        judge_colours(surface, errors, checks, executor,
                      [&](std::size_t, bool keeps) { result.exceeding += keeps ? 0U : 1U; });
    result.missed = missed;
    result.error = most * errors[0];
    lift(surface, options.scale);
    engine::forget_elements(surface);
    surface.normals.clear();
    if (normals) settle_normals(surface);
    return result;
}

template Collapsed collapse_colours(Surface<3>&, const Hierarchy<float>&, const Bounds&,
                                    const ColourCollapseOptions&, const Executor&);
template Collapsed collapse_colours(Surface<3>&, const Hierarchy<double>&, const Bounds&,
                                    const ColourCollapseOptions&, const Executor&);

}  // namespace nestgrid
