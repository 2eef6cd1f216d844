// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How finely a field is drawn, as a value: what a user chooses, whatever is drawn of it.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/domains.hpp>

namespace nestgrid {

class Bounds;

/// A lens by the size of elements (lens.hpp), in units of length.
struct LensRequest {
    Distance distance;  ///< from the domain where elements are fine
    double finest = 0;  ///< size of elements in it
    double coarsest = std::numeric_limits<double>::infinity();  ///< far from it
    double slope = 0.5;  ///< by which sizes may grow with the distance
};

/// A part of space that is drawn more finely (region.hpp).
struct RegionRequest {
    Distance distance;     ///< from it, not positive inside (domains.hpp)
    double threshold = 0;  ///< inside, in the units of the indicator
};

/// S at a threshold from 0 to 3.4e38, which holds at more nodes the greater that is.
using CriterionAt = std::function<AnyCriterion(double threshold)>;

/// Which elements may stop.
struct Projection {
    /// In the units of the indicator. Nothing: 0, or with a lens infinity, so that the lens decides
    /// alone.
    std::optional<double> threshold{};
    /// The largest number of triangles, beside which there is no threshold; 0 asks for none.
    std::uint64_t max_triangles = 0;
    /// A name in indicators(); or "error", with which the threshold is the error that is kept: on
    /// level sets error_indicator(), else deviations.
    std::string indicator = "offset";
    /// Nodes move from their mean to their value between the threshold and this many times it
    /// (blended.hpp), at least 1.
    double blend = 1;
    std::optional<LensRequest> lens{};
    /// Not while nodes move, nor where edges are collapsed.
    std::optional<RegionRequest> region{};
    /// Whether edges are taken away as long as the threshold stays the error that is kept
    /// (collapse.hpp). Then max_triangles asks for the least such error, or distance.
    bool collapse = false;
    /// Whether the threshold is a distance, which an isosurface and that of all data keep there and
    /// back (isosurface_within.hpp), in units of length.
    bool keeps_distance = false;
    /// How far a slice along a curved function whose edges are collapsed may be from that of all
    /// data, there and back, in units of length; 0 keeps its place (collapse_colours.hpp).
    double slice_distance = 0;
    /// Triangles of slices, boundaries and shadings in the plane are split until colours follow
    /// P_S U within this, in the units of the data (refine_colours.hpp); 0 splits none. Beside
    /// neither collapses nor a number of triangles.
    double colour_tolerance = 0;
    /// How far points of curved cells may be from where they are drawn, in units of length, beside
    /// an error; 0: the same share of the diameter of the domain as the error is of the range of
    /// the data (high_order.hpp).
    double position_error = 0;
    /// A criterion in the place of the threshold, the indicator and all that belongs to them, with
    /// bounds for the search; both are set by under(). No preroll is made.
    std::shared_ptr<const Criterion> criterion{};
    /// The same for one that has a threshold: then threshold, max_triangles, colour_tolerance and
    /// all that collapses go with it.
    CriterionAt criterion_at{};
    const Bounds* bounds = nullptr;  ///< borrowed

    /// The threshold where none is searched for.
    double least_threshold() const {
        return threshold.value_or(lens ? std::numeric_limits<double>::infinity() : 0);
    }
    /// Whether under() has given it a criterion.
    bool has_criterion() const { return criterion != nullptr || criterion_at != nullptr; }
    /// Whether it can be kept without a preroll: everything is drawn.
    bool draws_everything() const {
        return !has_criterion() && indicator == "offset" && least_threshold() == 0 &&
               max_triangles == 0 && blend == 1 && !lens;
    }
    /// Whether it does so with a threshold that is given, so that no other one is asked for.
    bool asks_for_everything() const { return threshold.has_value() && draws_everything(); }
    /// Whether nothing chooses which elements stop but a threshold of offsets, or a number of
    /// triangles.
    bool asks_for_offsets() const {
        return indicator == "offset" && blend == 1 && !lens && !region && !collapse &&
               !keeps_distance && slice_distance == 0;
    }
    /// Whether the threshold is the error that is kept, in units of the data.
    bool asks_for_error() const {
        return indicator == "error" || indicator == "deviation" || indicator == "cut";
    }
    /// \param degree of the field; 1 where its grid is curved
    ///
    /// \throw InvalidInput where the field is asked for in another way than by an error alone
    void require_error_alone(int degree) const;
    /// How the sizes of elements are spread, which the lens is compared with.
    Spread sizes_spread() const { return {.factor = blend, .slope = lens->slope}; }
    /// \throw InvalidInput where a number is out of range, with its name
    void check() const;
};

/// The projection by a criterion.
/// \param bounds of the same grid and field, borrowed: a HierarchicalIndicator, or other Bounds
template <std::derived_from<Criterion> S>
Projection under(S criterion, const Bounds& bounds) {
    return {.criterion = std::make_shared<const S>(std::move(criterion)), .bounds = &bounds};
}
/// The projection within a threshold of an indicator that is bounds, too: a HierarchicalIndicator.
template <std::derived_from<Indicator> I>
    requires std::convertible_to<const I&, const Bounds&> Projection under(const I& indicator,
                                                                           double threshold) {
        return under(Threshold(&indicator, threshold), indicator);
    }
/// The projection by a criterion for each threshold, with the threshold or the number of triangles
/// of `how`, and what else goes with these.
/// \param criterion_at of a threshold: a Blended, a lens or fine_inside (region.hpp), say
/// \param bounds of the same grid and field, borrowed
template <std::convertible_to<CriterionAt> Make>
Projection under(Make criterion_at, const Bounds& bounds, Projection how) {
    how.criterion_at = std::move(criterion_at);
    how.bounds = &bounds;
    return how;
}
/// The same for thresholds of an indicator that is bounds, too.
template <std::derived_from<Indicator> I>
    requires std::convertible_to<const I&, const Bounds&> Projection under(const I& indicator,
                                                                           Projection how) {
        return under([&indicator](double threshold) { return Threshold(&indicator, threshold); },
                     indicator, std::move(how));
    }
/// The projection by a criterion of any class, which is borrowed.
inline Projection under(const Criterion& criterion, const Bounds& bounds) {
    return {.criterion = std::shared_ptr<const Criterion>(std::shared_ptr<void>(), &criterion),
            .bounds = &bounds};
}

}  // namespace nestgrid
