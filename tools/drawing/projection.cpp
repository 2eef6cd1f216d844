// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/projection.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

#include <nestgrid/error.hpp>

#include "options/command_line.hpp"

using nestgrid::IndicatorKind;
using nestgrid::InvalidInput;
using nestgrid::ThresholdUnit;

namespace {

/// The indicators that fields in files can use: no file holds a curved grid.
std::vector<const IndicatorKind*> offered(bool of_isosurface) {
    std::vector<const IndicatorKind*> kinds;
    for (const IndicatorKind& kind : nestgrid::indicators()) {
        if (!kind.needs && (of_isosurface || !kind.of_level_sets)) kinds.push_back(&kind);
    }
    return kinds;
}

}  // namespace

double ThresholdText::in_units(const IndicatorKind& indicator, double range) const {
    if (!percent) return number;
    if (indicator.unit == ThresholdUnit::data) return number / 100 * range;
    throw InvalidInput(indicator.unit == ThresholdUnit::length
                           ? "a distance is a length, not a percentage"
                           : "thresholds of the " + std::string(indicator.name) +
                                 " indicator are no percentages: they have no units of the data");
}

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

void add_projection_options(CLI::App& command, nestgrid::Projection& projection,
                            bool of_isosurface) {
    std::vector<std::string> names;
    std::string text = "what --threshold limits: ";
    for (const IndicatorKind* const kind : offered(of_isosurface)) {
        if (!names.empty()) text += "; ";
        text += std::string(kind->name) + ", " + std::string(kind->measures);
        names.emplace_back(kind->name);
    }
    command.add_option("--indicator", projection.indicator, text)
        ->type_name("NAME")
        ->group("Detail")
        ->check(one_of(names))
        ->capture_default_str();
    command
        .add_option("--blend", projection.blend,
                    "let nodes move from their mean to their value between the threshold and this "
                    "many times it, instead of jumping [1]")
        ->type_name("FACTOR")
        ->group("Detail");
}

void check(const nestgrid::Projection& projection) {
    if (projection.blend >= 1 && std::isfinite(projection.blend)) return;
    throw InvalidInput("--blend is not a finite number of at least 1");
}

void require_threshold(const CLI::App& command) {
    const std::string why = "needs a --threshold or a --max-triangles above which it draws";
    refuse_options(command, {"--indicator", "--box"}, why);
    const CLI::Option* const lens = command.get_option_no_throw("--lens");
    if (lens == nullptr || lens->count() == 0) refuse_options(command, {"--blend"}, why);
}
