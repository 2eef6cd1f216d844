// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/collapse.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include <nestgrid/algorithms/normals.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/error.hpp>

#include <collapses/collapse_rounds.hpp>
#include <collapses/judge_triangles.hpp>
#include <projection/by_criterion.hpp>
#include <surfaces/probed_colours.hpp>
#include <surfaces/require_simplices.hpp>

namespace nestgrid {

namespace {

void require(const CollapseOptions& options, double isovalue) {
    if (!std::isfinite(isovalue)) throw InvalidInput("the isovalue is not a finite number");
    if (!options.error && !options.nearness) {
        throw InvalidInput("a collapse keeps an error or a distance: neither is given");
    }
    if (options.error && !(*options.error > 0 && std::isfinite(*options.error))) {
        throw InvalidInput("the error of a collapse is not a positive number");
    }
    if (options.nearness) {
        options.nearness->require();
        engine::require_simplices(options.nearness->whole);
    }
    engine::require_limits(options.turn, options.shape);
}

/// The checks that are asked for.
class Checks {
public:
    template <class Real>
    Checks(const Hierarchy<Real>& hierarchy, double isovalue, const Bounds& bounds,
           const CollapseOptions& options)
        : nearness_{options.nearness} {
        if (nearness_) to_whole_.emplace(nearness_->whole);
        leaves_ = options.error
                      ? engine::NearLeaves::find(hierarchy, isovalue, *options.error, bounds)
                      : engine::NearLeaves::find_at_boundary(hierarchy, *to_whole_,
                                                             nearness_->distance, bounds);
        if (nearness_) distance_.emplace(*nearness_, *to_whole_, leaves_);
        if (!options.error) return;
        field_.emplace(leaves_);
        strong_.emplace(leaves_);
    }

    const engine::NearLeaves& leaves() const { return leaves_; }
    const engine::FieldCheck* field() const { return field_ ? &*field_ : nullptr; }
    const engine::StrongNodes* strong() const { return strong_ ? &*strong_ : nullptr; }
    const engine::DistanceCheck* distance() const { return distance_ ? &*distance_ : nullptr; }

private:
    std::optional<Nearness> nearness_;
    std::optional<engine::ClosestPoints> to_whole_;
    engine::NearLeaves leaves_;
    std::optional<engine::FieldCheck> field_;
    std::optional<engine::StrongNodes> strong_;
    std::optional<engine::DistanceCheck> distance_;
};

/// The triangles of a surface in order, each judged by the field and by the distance there.
/// \param take take(triangle, whether it keeps what is asked for) is called in order
/// \return the greatest |U - C| of those that do; infinite where no error is asked for
template <class Take>
double judge(const Surface<3>& surface, const Checks& checks, const Executor& executor,
             const Take& take) {
    const engine::FieldCheck* const field = checks.field();
    const engine::DistanceCheck* const distance = checks.distance();
    const auto make = [&] {
        auto search = distance != nullptr ? std::optional(distance->search()) : std::nullopt;
        return [&, search](std::size_t t, double& greatest) mutable {
            const engine::Triangle x = engine::triangle_of(surface, t);
            const bool near = !search || !search->far_point(x);
            return near && (field == nullptr || field->keeps(engine::FlatTriangle(x), greatest));
        };
    };
    const double most = engine::judge_triangles(surface.simplices.size(), executor, make, take);
    return field != nullptr ? most : std::numeric_limits<double>::infinity();
}

/// Gives a surface that has changed what it had by vertex.
template <class Real>
void renew(Surface<3>& surface, const Hierarchy<Real>& hierarchy, std::size_t attributes,
           bool normals) {
    surface.attributes.assign(attributes * surface.vertices.size(),
                              std::numeric_limits<double>::quiet_NaN());
    surface.normals.clear();
    if (attributes > 0) {
        const detail::ProbePoints data = [&](std::span<const Point> points) {
            return engine::probe(hierarchy, points);
        };
        engine::ProbedColours(surface, data).colour_from(0);
    }
    if (normals) settle_normals(surface);
    engine::forget_elements(surface);
}

}  // namespace

template <class Real>
Collapsed collapse(Surface<3>& surface, const Hierarchy<Real>& hierarchy, double isovalue,
                   const Bounds& bounds, const CollapseOptions& options, const Executor& executor) {
    require(options, isovalue);
    engine::require_simplices(surface);
    const Checks checks(hierarchy, isovalue, bounds, options);
    if (surface.simplices.empty()) {
        return {.missed = options.nearness ? options.nearness->whole.simplices.size() : 0};
    }
    const auto box = engine::Box::around(surface.vertices);
    const engine::CollapseRules rules{
        .field = checks.field(),
        .strong = checks.strong(),
        .distance = checks.distance(),
        .coloured = false,
        .middle = 0.5 * (box.low + box.high),
        .least_cosine = std::cos(options.turn * std::numbers::pi / 180),
        .least_shape = options.shape};
    const std::size_t attributes = surface.attributes.size() / surface.vertices.size();
    const bool normals = !surface.normals.empty();
    engine::CollapseRounds rounds(surface, rules, executor);
    rounds.keep_borders(checks.leaves());
    judge(surface, checks, executor, [&](std::size_t t, bool keeps) {
        if (!keeps) rounds.fasten(t);
    });
    std::size_t missed = 0;
    if (const auto* distance = checks.distance()) {
        missed = engine::give_parts(distance->whole(), surface, rounds.parts(), executor);
    }
    Collapsed result = rounds.run();
    rounds.finish();
    result.missed = missed;
    result.error = judge(surface, checks, executor,
                         [&](std::size_t, bool keeps) { result.exceeding += keeps ? 0U : 1U; });
    renew(surface, hierarchy, attributes, normals);
    return result;
}

template Collapsed collapse(Surface<3>&, const Hierarchy<float>&, double, const Bounds&,
                            const CollapseOptions&, const Executor&);
template Collapsed collapse(Surface<3>&, const Hierarchy<double>&, double, const Bounds&,
                            const CollapseOptions&, const Executor&);

}  // namespace nestgrid
