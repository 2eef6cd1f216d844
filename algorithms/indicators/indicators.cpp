// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/indicators.hpp>

#include <algorithm>
#include <array>

#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

using Input = IndicatorInput;

SweptIndicator make_visual(const FieldOnGrid& field, const Input& input) {
    const VisualOptions options{.tau = 0x1p-20 * input.range, .spread = input.spread};
    return visual_indicator(field, options);
}

SweptIndicator make_numerical(const FieldOnGrid& field, const Input& input) {
    return numerical_indicator(field, {.spread = input.spread});
}

SweptIndicator make_wavelet(const FieldOnGrid& field, const Input& input) {
    return wavelet_indicator(field, {.spread = input.spread});
}

SweptIndicator make_norm(const FieldOnGrid& field, const Input& input) {
    return norm_indicator(field, {.spread = input.spread});
}

SweptIndicator make_geometry(const FieldOnGrid& field, const Input& input) {
    return geometry_indicator(field, {.spread = input.spread});
}

SweptIndicator make_cut(const FieldOnGrid& field, const Input& input) {
    return cut_deviations(field, input.isovalues, *input.bounds, input.spread, input.executor);
}

SweptIndicator make_slope(const FieldOnGrid& field, const Input& input) {
    return slope_deviations(field, input.isovalues, *input.bounds, input.spread, input.executor);
}

const std::array<IndicatorKind, 9> all{{
    {.name = "offset",
     .measures = "|data - mean of parents| at nodes",
     .between_frames = true,
     .of_nodes = NodeError::offset},
    {.name = "deviation",
     .measures = "|data - what is drawn|",
     .between_frames = true,
     .of_nodes = NodeError::deviation},
    {.name = "visual",
     .measures = "folds of the surface, from 0 to 2",
     .unit = ThresholdUnit::none,
     .make = make_visual},
    {.name = "numerical",
     .measures = "jumps of the gradient times the size of elements",
     .between_frames = true,
     .make = make_numerical},
    {.name = "wavelet",
     .measures = "wavelet coefficients",
     .between_frames = true,
     .make = make_wavelet},
    {.name = "norm",
     .measures = "offsets of all components, by their Euclidean norm",
     .between_frames = true,
     .make = make_norm},
    {.name = "geometry",
     .measures = "|position - mean of parents| of curved grids",
     .unit = ThresholdUnit::length,
     .needs = Feature::new_positions,
     .needed_grids = "curved grids",
     .make = make_geometry},
    {.name = "cut",
     .measures = "the error of this isosurface",
     .of_level_sets = true,
     .make = make_cut},
    {.name = "slope",
     .measures = "the distance from this isosurface, estimated",
     .unit = ThresholdUnit::length,
     .of_level_sets = true,
     .make = make_slope},
}};

}  // namespace

void IndicatorKind::require(const HierarchyFacts& facts) const {
    if (!needs || facts.offers(*needs)) return;
    throw InvalidInput("the indicator " + std::string(name) + " is for " +
                       std::string(needed_grids) + ": on this one it is 0 everywhere");
}

const char* unit_name(ThresholdUnit unit) {
    switch (unit) {
        case ThresholdUnit::data:
            return "data";
        case ThresholdUnit::length:
            return "length";
        case ThresholdUnit::none:
            break;
    }
    return "none";
}

std::span<const IndicatorKind> indicators() { return all; }

const IndicatorKind& indicator_named(std::string_view name) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const IndicatorKind& kind) { return kind.name == name; });
    if (found != all.end()) return *found;
    throw InvalidInput("the indicator '" + std::string(name) + "' is none of " +
                       detail::indicator_names());
}

const IndicatorKind& error_indicator(const HierarchyFacts& facts, bool between_frames) {
    return indicator_named(between_frames || !detail::cuts_are_errors(facts) ? "deviation" : "cut");
}

std::string detail::indicator_names() {
    std::string text;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i > 0) text += i + 1 == all.size() ? " and " : ", ";
        text += all[i].name;
    }
    return text;
}

}  // namespace nestgrid
