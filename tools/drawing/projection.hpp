// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Thresholds, indicators and weights on the command line.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <nestgrid/algorithms/indicators.hpp>
#include <nestgrid/algorithms/projection.hpp>

/// A threshold as the user gave it: in units of the indicator, or in percent of the range of the
/// data.
struct ThresholdText {
    double number = 0;
    bool percent = false;

    /// \param range of the data
    /// \throw nestgrid::InvalidInput for percent of an indicator that has no units of the data
    double in_units(const nestgrid::IndicatorKind& indicator, double range) const;
};

/// \throw nestgrid::InvalidInput unless the text is a number >= 0, with or without %
ThresholdText parse_threshold(const std::string& text);
/// \param option that asks for the error, for the sentence
/// \throw nestgrid::InvalidInput unless the text is a number > 0, with or without %
void require_error(const std::string& text, const std::string& option);

/// Where there is none: with a lens, whatever the data are; else 0.
void set_default_threshold(std::vector<ThresholdText>& thresholds, bool with_lens);

/// Adds the options for an indicator and the factor by which the projection blends.
/// \param of_isosurface whether indicators of level sets can be chosen, too
void add_projection_options(CLI::App& command, nestgrid::Projection& projection,
                            bool of_isosurface);
/// \throw nestgrid::InvalidInput where the factor is out of range
void check(const nestgrid::Projection& projection);
/// For a command without thresholds and budgets.
/// \throw nestgrid::InvalidInput where an option is given that means nothing then
void require_threshold(const CLI::App& command);
