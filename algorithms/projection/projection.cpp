// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/projection.hpp>

#include <cmath>

#include <nestgrid/error.hpp>

namespace nestgrid {

void Projection::check() const {
    if (has_criterion() != (bounds != nullptr)) {
        throw InvalidInput("a projection by a criterion needs bounds, and no other one has them");
    }
    if (criterion != nullptr && (threshold || max_triangles > 0 || !asks_for_offsets())) {
        throw InvalidInput(
            "a projection by a criterion has no threshold, nor anything else that chooses one");
    }
    if (criterion_at != nullptr && (lens || region || blend != 1 || indicator != "offset")) {
        throw InvalidInput(
            "a projection by a criterion of one's own has no indicator, lens, region or blend");
    }
    if (!(blend >= 1) || !std::isfinite(blend)) {
        throw InvalidInput("blend is not a finite number of at least 1");
    }
    if (!(least_threshold() >= 0)) throw InvalidInput("the threshold is not a number >= 0");
    if (collapse && !threshold && max_triangles == 0) {
        throw InvalidInput(
            "edges are collapsed within a threshold or a number of triangles: neither is given");
    }
    if (collapse && lens) throw InvalidInput("edges are collapsed without a lens");
    if (collapse && region) throw InvalidInput("edges are collapsed without a region");
    if (region && !(region->threshold >= 0)) {
        throw InvalidInput("the threshold in the region is not a number >= 0");
    }
    if (region && blend != 1) {
        throw InvalidInput("a region has a threshold of its own: nodes do not move with it");
    }
    if (!(colour_tolerance >= 0) || !std::isfinite(colour_tolerance)) {
        throw InvalidInput("the tolerance of colours is not a finite number >= 0");
    }
    if (colour_tolerance > 0 && (collapse || max_triangles > 0)) {
        throw InvalidInput(
            "triangles are split until colours follow the data: neither with collapses nor within "
            "a number of triangles");
    }
    if (!(position_error >= 0) || !std::isfinite(position_error)) {
        throw InvalidInput("the error of positions is not a finite number >= 0");
    }
    if (keeps_distance && !threshold && !(collapse && max_triangles > 0)) {
        throw InvalidInput("a distance is to be kept, but there is no threshold that says which");
    }
    if (!(slice_distance >= 0) || !std::isfinite(slice_distance)) {
        throw InvalidInput("the distance of a slice is not a finite number >= 0");
    }
    if (slice_distance > 0 && !collapse) {
        throw InvalidInput("the distance of a slice is for one whose edges are collapsed");
    }
    if (lens && (!(lens->slope >= 0) || !std::isfinite(lens->slope))) {
        throw InvalidInput("the slope of the lens is not a finite number >= 0");
    }
}

void Projection::require_error_alone(int degree) const {
    std::string what;
    if (keeps_distance || indicator == "slope") {
        what = "by no distance yet";
    } else if (blend != 1) {
        what = "by no blend yet";
    } else if (!asks_for_error()) {
        what = "by no threshold of nodes yet";
    }
    if (what.empty()) return;
    throw InvalidInput((degree > 1 ? "the field has degree " + std::to_string(degree)
                                   : std::string("the grid has curved cells")) +
                       " and is drawn within an error, " + what);
}

}  // namespace nestgrid
