// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/collapse_colours.hpp>

#include <cmath>
#include <string>

#include <nestgrid/algorithms/normals.hpp>
#include <nestgrid/error.hpp>

#include <collapses/collapse_rounds.hpp>
#include <levels/draw.hpp>
#include <surfaces/require_simplices.hpp>

namespace nestgrid {

namespace {

constexpr double same_plane = 0.999;  // the least cosine of a turn: rounding of flat triangles

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
    if (!(options.shape >= 0 && options.shape < 1)) {
        throw InvalidInput("the least quality of a triangle is not between 0 and 1");
    }
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

/// The triangles of a surface in order, each judged by its colours.
/// \param take take(triangle, whether they keep their errors) is called in order
/// \return the greatest part of an error of those that do
template <class Take>
double judge_colours(const Surface<3>& surface, std::span<const double> errors,
                     const engine::FieldCheck& check, const Executor& executor, const Take& take) {
    constexpr std::size_t chunk = 4096;
    const std::size_t count = surface.simplices.size();
    const std::size_t tasks = (count + chunk - 1) / chunk;
    std::vector<double> colours(surface.attributes.size());
    for (std::size_t i = 0; i < colours.size(); ++i) {
        colours[i] = surface.attributes[i] / errors[i % errors.size()];
    }
    const auto of = [&](std::uint32_t v) {
        return std::span<const double>(colours).subspan(v * errors.size(), errors.size());
    };
    std::vector<std::uint8_t> keeps(count);
    std::vector<double> greatest(tasks, 0);
    executor.run(
        tasks,
        [&](std::size_t i) {
            for (std::size_t t = i * chunk; t < std::min(count, (i + 1) * chunk); ++t) {
                const auto& [a, b, c] = surface.simplices[t];
                const engine::FlatTriangle x(
                    {surface.vertices[a], surface.vertices[b], surface.vertices[c]});
                keeps[t] = check.keeps_colours(x, {of(a), of(b), of(c)}, greatest[i]) ? 1 : 0;
            }
        },
        [](std::size_t) {});
    for (std::size_t t = 0; t < count; ++t) take(t, keeps[t] != 0);
    double most = 0;
    for (const double part : greatest) most = std::max(most, part);
    return most;
}

}  // namespace

template <class Real>
Collapsed collapse_colours(Surface<3>& surface, const Hierarchy<Real>& hierarchy,
                           const Bounds& bounds, const ColourCollapseOptions& options,
                           const Executor& executor) {
    engine::require_same_epoch(hierarchy, bounds);
    require_colours(surface, static_cast<std::size_t>(hierarchy.facts().components), options);
    if (surface.simplices.empty()) return {};
    std::vector<double> errors = options.errors;
    errors.resize(surface.attributes.size() / surface.vertices.size(), errors[0]);
    lift(surface, -options.scale);
    const auto leaves = engine::NearLeaves::find_along(hierarchy, surface, errors, bounds);
    const engine::FieldCheck check(leaves, engine::FieldCheck::Drawn::colours);
    const auto box = engine::Box::around(surface.vertices);
    const engine::CollapseRules rules{.field = &check,
                                      .strong = nullptr,
                                      .distance = nullptr,
                                      .coloured = true,
                                      .middle = 0.5 * (box.low + box.high),
                                      .least_cosine = same_plane,
                                      .least_shape = options.shape};
    const bool normals = !surface.normals.empty();
    engine::CollapseRounds rounds(surface, rules, executor);
    rounds.keep_support(errors);
    judge_colours(surface, errors, check, executor, [&](std::size_t t, bool keeps) {
        if (!keeps) rounds.fasten(t);
    });
    Collapsed result = rounds.run();
    rounds.finish();
    const double most =
        judge_colours(surface, errors, check, executor,
                      [&](std::size_t, bool keeps) { result.exceeding += keeps ? 0U : 1U; });
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
