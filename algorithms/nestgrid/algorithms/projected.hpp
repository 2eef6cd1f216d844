// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What was drawn under a projection, and what every function that draws one has in common:
//
//   - it takes a field as Prerolls, which a hierarchy converts to, or in most cases a grid and a
//     field on it;
//   - options say what is kept and how, the projection how finely;
//   - the result does not depend on the executor;
//   - where edges are collapsed, what is drawn first has a part of the threshold, so that the whole
//     of it is kept in the end;
//   - a field of higher degree is drawn within an error by virtual refinement (high_order.hpp), by
//     any other projection at the corners of its leaves;
//   - it throws InvalidInput as Projection::check() and Prerolls::choose() do, where the field has
//     another dimension, and for a criterion that is not saturated and does not insist; GridError
//     where the field has no value, or where the grid has changed since bounds were computed.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/least_threshold.hpp>
#include <nestgrid/algorithms/prerolls.hpp>
#include <nestgrid/algorithms/projection.hpp>
#include <nestgrid/algorithms/watch.hpp>

namespace nestgrid {

/// A drawing, and what its projection came to.
template <class Result>
struct Projected : Result {
    /// At which threshold; with how it was found, where the projection has a number of triangles.
    TriangleBudget search{};
    std::optional<Collapsed> collapsed{};  ///< where edges were collapsed
    /// Vertices that were too far at first, where a distance is kept.
    std::size_t far_points = 0;

    /// Why there are fewer triangles than were asked for, as a sentence; or empty.
    std::string budget_reason() const {
        return search.max_triangles > 0 ? search.reason() : std::string();
    }
};

}  // namespace nestgrid
