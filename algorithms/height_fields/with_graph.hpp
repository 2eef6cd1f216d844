// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Makes what a triangulation borrows, once its input is known to be sound.
#pragma once

#include <cmath>
#include <optional>

#include <drawing/requirements.hpp>
#include <height_fields/triangulation.hpp>
#include <nestgrid/error.hpp>
#include <projection/made_for_ranks.hpp>

namespace nestgrid::engine {

/// \throw InvalidInput, GridError as shading() and height_field() say
template <class Real>
void require_drawable(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                      const Bounds& bounds, const ShadingOptions& options) {
    hierarchy.facts().require_dimension(2);
    if (!std::isfinite(scale))
        throw InvalidInput("the scale of the heights is not a finite number");
    if (!(options.flatness >= 0)) throw InvalidInput("the flatness is negative or not a number");
    if (hierarchy.facts().shared != nullptr) {
        require_same_state(hierarchy);
        require_drawn_on_ranks(criterion, bounds, {}, false);
    }
    require_sound(hierarchy, criterion, bounds);
}

/// Calls draw(graph) with what a triangulation borrows.
/// \param elements whether to keep the elements
/// \throw InvalidInput, GridError as require_drawable()
template <class Real, class Draw>
auto with_graph(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                const Bounds& bounds, const ShadingOptions& options, bool elements, Draw&& draw) {
    std::optional<Walk<Real>> walk;
    const auto asked = [&] {
        return "triangles of height " + all_digits(scale) + ", flatness " +
               all_digits(options.flatness) + ", " + name_of(criterion);
    };
    together(hierarchy.facts().shared, asked, [&] {
        require_drawable(hierarchy, scale, criterion, bounds, options);
        walk.emplace(hierarchy, Triangulation<Real>::needs, bounds.hanging());
    });
    return draw(Graph<Real>{&*walk,
                            &criterion,
                            &bounds,
                            {scale, options.flatness},
                            elements,
                            may_stop_apart(hierarchy, criterion, bounds)});
}

}  // namespace nestgrid::engine
