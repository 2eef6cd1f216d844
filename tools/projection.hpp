// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is compared with the thresholds of the command line.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

#include "lens_options.hpp"

/// A threshold as the user gave it: in units of the indicator, or in percent of the range of the
/// data.
struct ThresholdText {
    double number = 0;
    bool percent = false;

    /// \param range of the data
    double in_units(double range) const { return percent ? number / 100 * range : number; }
};

/// \throw nestgrid::InvalidInput unless the text is a number >= 0, with or without %
ThresholdText parse_threshold(const std::string& text);

/// Where there is none: with a lens, whatever the data are; else 0.
void set_default_threshold(std::vector<ThresholdText>& thresholds, bool with_lens);

/// An indicator, and the factor by which the projection blends.
struct ProjectionChoice {
    std::string indicator = "offset";
    double blend = 1;

    bool is_default() const { return indicator == "offset" && blend == 1; }
};
void add_projection_options(CLI::App& command, ProjectionChoice& choice);
/// \throw nestgrid::InvalidInput where the factor is out of range
void check(const ProjectionChoice& choice);

/// \throw nestgrid::InvalidInput where anything else than the offsets decides: between frames
void require_offsets_alone(const ProjectionChoice& choice, const std::optional<LensRequest>& lens);

/// The indicators of one field: that of offsets, which gives bounds, the chosen one, and the sizes
/// of elements for a lens.
class ChosenIndicator {
public:
    /// \throw nestgrid::InvalidInput where the choice makes no sense for the hierarchy
    template <class Real>
    ChosenIndicator(const nestgrid::Hierarchy<Real>& hierarchy, const ProjectionChoice& choice,
                    const std::optional<LensRequest>& lens, const nestgrid::Executor& executor);

    const nestgrid::HierarchicalIndicator& offsets() const { return offsets_; }
    const nestgrid::Indicator& chosen() const {
        if (swept_) return *swept_;
        return offsets_;
    }
    std::size_t memory_bytes() const {
        return offsets_.memory_bytes() + (swept_ ? swept_->memory_bytes() : 0) +
               (size_ ? size_->memory_bytes() : 0);
    }
    /// \throw nestgrid::InvalidInput for percent of an indicator that has no units of the data
    double threshold(const ThresholdText& text) const;
    /// Calls function(criterion_at) with the function that makes a criterion of a threshold.
    template <class Function>
    void with_criteria(Function&& function) const {
        const nestgrid::Indicator* const indicator = &chosen();
        if (choice_.blend == 1) {
            in_lens(function, [=](double t) { return nestgrid::Threshold(indicator, t); });
        } else {
            in_lens(function, [=, blend = choice_.blend](double t) {
                return nestgrid::Blended(indicator, t, blend);
            });
        }
    }

private:
    template <class Function, class CriterionAt>
    void in_lens(Function&& function, const CriterionAt& criterion_at) const {
        if (!lens_) {
            function(criterion_at);
            return;
        }
        const nestgrid::Lens lens = lens_->criterion(*size_);
        function([&](double t) { return criterion_at(t) && lens; });
    }

    ProjectionChoice choice_;
    std::optional<LensRequest> lens_;
    nestgrid::HierarchicalIndicator offsets_;
    std::optional<nestgrid::SweptIndicator> swept_;  // empty where offsets are chosen
    std::optional<nestgrid::SweptIndicator> size_;   // of elements; empty where there is no lens
};
