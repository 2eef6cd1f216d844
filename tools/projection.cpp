// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "projection.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>
#include <nestgrid/error.hpp>

namespace {

using nestgrid::InvalidInput;

template <class Real>
std::optional<nestgrid::SweptIndicator> swept_indicator(
    const nestgrid::Hierarchy<Real>& hierarchy, const ProjectionChoice& choice,
    const nestgrid::HierarchicalIndicator& offsets) {
    const nestgrid::Spread spread{.factor = choice.blend};
    if (choice.indicator == "visual") {
        const double tau = 0x1p-20 * (offsets.greatest() - offsets.least());
        return visual_indicator(hierarchy, {.tau = tau, .spread = spread});
    }
    if (choice.indicator == "numerical") return numerical_indicator(hierarchy, {.spread = spread});
    if (choice.indicator == "wavelet") return wavelet_indicator(hierarchy, {.spread = spread});
    if (choice.indicator == "geometry") {
        if (!hierarchy.offers(nestgrid::Feature::new_positions)) {
            throw InvalidInput(
                "--indicator geometry is for curved grids: on this one it is 0 everywhere");
        }
        return geometry_indicator(hierarchy, {.spread = spread});
    }
    return std::nullopt;
}

}  // namespace

ThresholdText parse_threshold(const std::string& text) {
    char* end = nullptr;
    ThresholdText t{std::strtod(text.c_str(), &end), false};
    t.percent = *end == '%';
    if (end == text.c_str() || *(end + (t.percent ? 1 : 0)) != '\0' || !(t.number >= 0) ||
        !std::isfinite(t.number)) {
        throw InvalidInput("the threshold '" + text + "' is no number >= 0, with or without %");
    }
    return t;
}

void set_default_threshold(std::vector<ThresholdText>& thresholds, bool with_lens) {
    // All offsets are below infinity: what is drawn depends on the lens alone.
    const double any_offset = std::numeric_limits<double>::infinity();
    if (thresholds.empty()) thresholds.push_back({with_lens ? any_offset : 0, false});
}

void add_projection_options(CLI::App& command, ProjectionChoice& choice) {
    command
        .add_option("--indicator", choice.indicator,
                    "what --threshold limits: offset, |data - mean| in units of the data; visual, "
                    "folds, 2 sin(angle / 2), from 0 to 2; numerical, jumps of the gradient times "
                    "the diameter, in units of the data; wavelet, coefficients in units of the "
                    "data; geometry, |position - mean| on curved "
                    "grids, in units of length")
        ->check(CLI::IsMember({"offset", "visual", "numerical", "wavelet", "geometry"}))
        ->capture_default_str();
    command.add_option("--blend", choice.blend,
                       "at least 1: nodes move from their mean to their value as the indicator "
                       "grows from the threshold to this many times it; default: 1, they jump");
}

void check(const ProjectionChoice& choice) {
    if (choice.blend >= 1 && std::isfinite(choice.blend)) return;
    throw InvalidInput("--blend is not a finite number of at least 1");
}

void require_offsets_alone(const ProjectionChoice& choice, const std::optional<LensRequest>& lens) {
    if (choice.is_default() && !lens) return;
    throw InvalidInput("between frames thresholds are those of offsets: leave out " +
                       std::string(lens                ? "--lens"
                                   : choice.blend == 1 ? "--indicator"
                                                       : "--blend"));
}

template <class Real>
ChosenIndicator::ChosenIndicator(const nestgrid::Hierarchy<Real>& hierarchy,
                                 const ProjectionChoice& choice,
                                 const std::optional<LensRequest>& lens,
                                 const nestgrid::Executor& executor)
    : choice_{choice},
      lens_{lens},
      offsets_(hierarchy, nestgrid::LeafErrors{}, executor,
               {.factor = choice.indicator == "offset" ? choice.blend : 1}),
      swept_{swept_indicator(hierarchy, choice, offsets_)} {
    if (lens) size_.emplace(nestgrid::mesh_size(hierarchy, lens->spread));
}

template ChosenIndicator::ChosenIndicator(const nestgrid::Hierarchy<float>&,
                                          const ProjectionChoice&,
                                          const std::optional<LensRequest>&,
                                          const nestgrid::Executor&);
template ChosenIndicator::ChosenIndicator(const nestgrid::Hierarchy<double>&,
                                          const ProjectionChoice&,
                                          const std::optional<LensRequest>&,
                                          const nestgrid::Executor&);

double ChosenIndicator::threshold(const ThresholdText& text) const {
    if (text.percent && (choice_.indicator == "visual" || choice_.indicator == "geometry")) {
        throw InvalidInput("thresholds of the " + choice_.indicator +
                           " indicator are no percentages: they have no units of the data");
    }
    return text.in_units(offsets_.greatest() - offsets_.least());
}
