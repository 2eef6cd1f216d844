// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/projection.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>
#include <nestgrid/error.hpp>

#include "options/command_line.hpp"

namespace {

using nestgrid::InvalidInput;

/// The chosen indicator; nothing where offsets or deviations are chosen.
/// \param range of the data
template <class Real>
std::optional<nestgrid::SweptIndicator> swept_indicator(const nestgrid::Hierarchy<Real>& hierarchy,
                                                        const ProjectionChoice& choice,
                                                        double range) {
    const nestgrid::Spread spread{.factor = choice.blend};
    if (choice.indicator == "visual") {
        return visual_indicator(hierarchy, {.tau = 0x1p-20 * range, .spread = spread});
    }
    if (choice.indicator == "numerical") return numerical_indicator(hierarchy, {.spread = spread});
    if (choice.indicator == "wavelet") return wavelet_indicator(hierarchy, {.spread = spread});
    return std::nullopt;
}

/// The chosen indicator of one surface; nothing where another one is chosen.
template <class Real>
std::optional<nestgrid::SweptIndicator> surface_indicator(
    const nestgrid::Hierarchy<Real>& hierarchy, const ProjectionChoice& choice,
    const nestgrid::Bounds& bounds, const nestgrid::Executor& executor) {
    const nestgrid::Spread spread{.factor = choice.blend};
    const std::span<const double> isovalues(&choice.isovalue, 1);
    if (choice.indicator == "cut") {
        return cut_deviations(hierarchy, isovalues, bounds, spread, executor);
    }
    if (choice.indicator == "slope") {
        return slope_deviations(hierarchy, isovalues, bounds, spread, executor);
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

void require_error(const std::string& text, const std::string& option) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && number > 0 && std::isfinite(number)) {
        parse_threshold(text);
        return;
    }
    throw InvalidInput("the " + option + " '" + text +
                       "' is no number > 0: leave the option out to draw all detail");
}

void set_default_threshold(std::vector<ThresholdText>& thresholds, bool with_lens) {
    // All offsets are below infinity: what is drawn depends on the lens alone.
    const double any_offset = std::numeric_limits<double>::infinity();
    if (thresholds.empty()) thresholds.push_back({with_lens ? any_offset : 0, false});
}

void add_projection_options(CLI::App& command, ProjectionChoice& choice, bool of_isosurface) {
    std::vector<std::string> names{"offset", "deviation", "visual", "numerical", "wavelet"};
    if (of_isosurface) names.insert(names.end(), {"cut", "slope"});
    command
        .add_option("--indicator", choice.indicator,
                    "what --threshold limits: offset, |data - mean|; deviation, |data - what is "
                    "drawn|; visual, folds from 0 to 2; "
                    "numerical, jumps of the gradient; wavelet, coefficients" +
                        std::string(of_isosurface ? "; cut, the --error of this surface; slope, "
                                                    "the --distance: the nearest within "
                                                    "--max-triangles where data are noisy"
                                                  : ""))
        ->type_name("NAME")
        ->group("Detail")
        ->check(one_of(names))
        ->capture_default_str();
    command
        .add_option("--blend", choice.blend,
                    "let nodes move from their mean to their value between the threshold and this "
                    "many times it, instead of jumping [1]")
        ->type_name("FACTOR")
        ->group("Detail");
}

void check(const ProjectionChoice& choice) {
    if (choice.blend >= 1 && std::isfinite(choice.blend)) return;
    throw InvalidInput("--blend is not a finite number of at least 1");
}

void require_threshold(const CLI::App& command) {
    const std::string why = "needs a --threshold or a --max-triangles above which it draws";
    refuse_options(command, {"--indicator", "--box"}, why);
    const CLI::Option* const lens = command.get_option_no_throw("--lens");
    if (lens == nullptr || lens->count() == 0) refuse_options(command, {"--blend"}, why);
}

FramePrerolls::FramePrerolls(const std::vector<SharedHierarchy>& frames, ProjectionChoice choice,
                             std::optional<LensRequest> lens, const nestgrid::Executor& executor)
    : choice_{std::move(choice)},
      lens_{std::move(lens)},
      executor_{&executor},
      least_{std::numeric_limits<double>::infinity()},
      greatest_{-least_} {
    const bool deviations = choice_.indicator == "deviation";
    const nestgrid::NodeError error =
        deviations ? nestgrid::NodeError::deviation : nestgrid::NodeError::offset;
    const nestgrid::Spread spread{
        .factor = choice_.indicator == "offset" || deviations ? choice_.blend : 1};
    for (const SharedHierarchy& frame : frames) {
        std::visit(
            [&](const auto& hierarchy) {
                offsets_.emplace_back(*hierarchy, error, executor, spread);
            },
            frame);
        least_ = std::min(least_, offsets_.back().least());
        greatest_ = std::max(greatest_, offsets_.back().greatest());
    }
    if (frames.size() > 1 && (choice_.indicator == "numerical" || choice_.indicator == "wavelet")) {
        for (const SharedHierarchy& frame : frames) {
            std::visit(
                [&](const auto& hierarchy) {
                    swept_.push_back(*swept_indicator(*hierarchy, choice_, greatest_ - least_));
                },
                frame);
        }
    }
    if (!lens_) return;
    lens_->options.blend = lens_->spread.factor = choice_.blend;
    std::visit(
        [&](const auto& hierarchy) {
            sizes_.emplace(nestgrid::mesh_size(*hierarchy, lens_->spread));
        },
        frames.front());
}

std::size_t FramePrerolls::memory_bytes() const {
    std::size_t bytes = sizes_ ? sizes_->memory_bytes() : 0;
    for (const auto& frame : offsets_) bytes += frame.memory_bytes();
    for (const auto& frame : swept_) bytes += frame.memory_bytes();
    return bytes;
}

ChosenIndicator::ChosenIndicator(const FramePrerolls& prerolls, const SharedHierarchy& hierarchy,
                                 std::span<const float> weights)
    : prerolls_{&prerolls} {
    const auto& offsets = prerolls.offsets();
    if (offsets.size() == 1) {
        alone_ = &offsets.front();
    } else {
        std::vector<const nestgrid::HierarchicalIndicator*> frames;
        for (const auto& frame : offsets) frames.push_back(&frame);
        between_.emplace(std::move(frames), weights);
    }
    if (!prerolls.swept().empty()) {
        std::vector<const nestgrid::SweptIndicator*> frames;
        for (const auto& frame : prerolls.swept()) frames.push_back(&frame);
        swept_between_.emplace(std::move(frames), weights);
        return;
    }
    std::visit(
        [&](const auto& each) {
            swept_ = swept_indicator(*each, prerolls.choice(), greatest() - least());
            if (swept_) return;
            swept_ = surface_indicator(*each, prerolls.choice(), bounds(), prerolls.executor());
        },
        hierarchy);
}

const nestgrid::Bounds& ChosenIndicator::bounds() const {
    if (between_) return *between_;
    return *alone_;
}

const nestgrid::Indicator& ChosenIndicator::chosen() const {
    if (swept_between_) return *swept_between_;
    if (swept_) return *swept_;
    if (between_) return *between_;
    return *alone_;
}

double ChosenIndicator::threshold(const ThresholdText& text) const {
    const std::string& indicator = prerolls_->choice().indicator;
    if (text.percent && indicator == "slope") {
        throw InvalidInput("a distance is a length, not a percentage");
    }
    if (text.percent && indicator == "visual") {
        throw InvalidInput(
            "thresholds of the visual indicator are no percentages: they have no units of the "
            "data");
    }
    return text.in_units(greatest() - least());
}
