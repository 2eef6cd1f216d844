// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is compared with the thresholds of the command line.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/swept_key_frames.hpp>

#include "drawing/frame_field.hpp"
#include "options/lens_options.hpp"

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
/// \param option that asks for the error, for the sentence
/// \throw nestgrid::InvalidInput unless the text is a number > 0, with or without %
void require_error(const std::string& text, const std::string& option);

/// Where there is none: with a lens, whatever the data are; else 0.
void set_default_threshold(std::vector<ThresholdText>& thresholds, bool with_lens);

/// An indicator, and the factor by which the projection blends.
struct ProjectionChoice {
    std::string indicator = "offset";
    double blend = 1;
    double isovalue = 0;  ///< of the indicators "cut" and "slope", which are of one surface
};
/// \param of_isosurface whether indicators of one isosurface can be chosen, too
void add_projection_options(CLI::App& command, ProjectionChoice& choice, bool of_isosurface);
/// \throw nestgrid::InvalidInput where the factor is out of range
void check(const ProjectionChoice& choice);
/// For a command without thresholds and budgets.
/// \throw nestgrid::InvalidInput where an option is given that means nothing then
void require_threshold(const CLI::App& command);

/// The prerolls of the frames of a field.
class FramePrerolls {
public:
    /// Walks all frames.
    /// \param executor must outlive the prerolls
    FramePrerolls(const std::vector<SharedHierarchy>& frames, ProjectionChoice choice,
                  std::optional<LensRequest> lens, const nestgrid::Executor& executor);

    const ProjectionChoice& choice() const { return choice_; }
    const nestgrid::Executor& executor() const { return *executor_; }
    const std::optional<LensRequest>& lens() const { return lens_; }
    /// Of each frame, or its deviations where these are chosen; spread for blending where the
    /// choice compares thresholds with them.
    const std::vector<nestgrid::HierarchicalIndicator>& offsets() const { return offsets_; }
    /// The chosen indicator of each of several frames, where it is that of a time between them,
    /// too: the numerical and the wavelet one. Else empty.
    const std::vector<nestgrid::SweptIndicator>& swept() const { return swept_; }
    /// Of elements; null where there is no lens.
    const nestgrid::SweptIndicator* sizes() const { return sizes_ ? &*sizes_ : nullptr; }
    double least() const { return least_; }        ///< of all frames
    double greatest() const { return greatest_; }  ///< of all frames
    std::size_t memory_bytes() const;

private:
    ProjectionChoice choice_;
    std::optional<LensRequest> lens_;
    std::vector<nestgrid::HierarchicalIndicator> offsets_;
    std::vector<nestgrid::SweptIndicator> swept_;
    std::optional<nestgrid::SweptIndicator> sizes_;
    const nestgrid::Executor* executor_;
    double least_;
    double greatest_;
};

/// The indicators of a field at one moment: that of offsets or deviations, which gives bounds, the
/// chosen one, and the sizes of elements for a lens. The prerolls must outlive it.
class ChosenIndicator {
public:
    /// \param hierarchy the field at that moment; an indicator that the prerolls do not have is
    /// made
    ///        of it
    /// \param weights of the frames; empty where there is one frame
    /// \throw InvalidInput where the choice makes no sense for the hierarchy
    ChosenIndicator(const FramePrerolls& prerolls, const SharedHierarchy& hierarchy,
                    std::span<const float> weights);

    const nestgrid::Bounds& bounds() const;
    const nestgrid::Indicator& chosen() const;
    double least() const { return prerolls_->least(); }        ///< of all frames
    double greatest() const { return prerolls_->greatest(); }  ///< of all frames
    std::size_t memory_bytes() const {
        return prerolls_->memory_bytes() + (swept_ ? swept_->memory_bytes() : 0);
    }
    /// \throw nestgrid::InvalidInput for percent of an indicator that has no units of the data
    double threshold(const ThresholdText& text) const;
    /// Calls function(criterion_at) with the function that makes a criterion of a threshold.
    template <class Function>
    void with_criteria(Function&& function) const {
        const nestgrid::Indicator* const indicator = &chosen();
        const double blend = prerolls_->choice().blend;
        if (blend == 1) {
            in_lens(function, [=](double t) { return nestgrid::Threshold(indicator, t); });
        } else {
            in_lens(function, [=](double t) { return nestgrid::Blended(indicator, t, blend); });
        }
    }
    /// Calls function(offsets) with a nestgrid::HierarchicalIndicator or, between frames, with
    /// nestgrid::KeyFrames.
    template <class Function>
    auto with_offsets(Function&& function) const {
        return between_ ? function(*between_) : function(*alone_);
    }

private:
    template <class Function, class CriterionAt>
    void in_lens(Function&& function, const CriterionAt& criterion_at) const {
        if (!prerolls_->lens()) {
            function(criterion_at);
            return;
        }
        const nestgrid::Lens lens = prerolls_->lens()->criterion(*prerolls_->sizes());
        function([&](double t) { return criterion_at(t) && lens; });
    }

    const FramePrerolls* prerolls_;
    const nestgrid::HierarchicalIndicator* alone_ = nullptr;  // at a frame; else null
    std::optional<nestgrid::KeyFrames> between_;              // between frames
    std::optional<nestgrid::SweptKeyFrames> swept_between_;   // where the prerolls have swept()
    std::optional<nestgrid::SweptIndicator> swept_;           // else, unless offsets are chosen
};
