// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/frame_weights.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::detail {

/// Indicators of several frames, which are added up by the absolute values of their weights.
template <class Frame>
class WeightedFrames {
public:
    /// The weights are 0 at first. Borrows the frames.
    /// \throw InvalidInput where there is no frame
    explicit WeightedFrames(std::vector<const Frame*> frames) : frames_{std::move(frames)} {
        if (frames_.empty()) throw InvalidInput("there are no frames to interpolate between");
    }

    /// \throw InvalidInput where there is not one finite weight for each frame
    void set_weights(std::span<const float> weights) {
        require_weights(frames_.size(), weights);
        terms_.clear();
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            if (weights[i] != 0) {
                terms_.push_back({frames_[i], std::abs(static_cast<double>(weights[i]))});
            }
        }
        spread_ = terms_.empty() ? Spread{} : terms_.front().frame->spread();
        spread_.slope = 0;
        for (const auto& [frame, weight] : terms_) {
            spread_.factor = std::min(spread_.factor, frame->spread().factor);
            spread_.slope += weight * frame->spread().slope;
        }
    }

    /// Sum of weight * of(frame), a float or a number of its precision, in the order of the frames:
    /// each product is exact, and the sum has the same bits wherever it is asked for.
    template <class Of>
    double sum(const Of& of) const {
        double result = 0;
        for (const auto& [frame, weight] : terms_) result += weight * of(*frame);
        return result;
    }
    /// The least factor of the frames, and the sum of their slopes. Of frames whose weight is not
    /// 0.
    const Spread& spread() const { return spread_; }
    /// Whether all frames, also those whose weight is 0, are of the grid in the state of this
    /// epoch.
    bool made_for(std::uint64_t epoch) const {
        return std::ranges::all_of(frames_, [&](const Frame* f) { return f->made_for(epoch); });
    }
    /// How many weights are not 0.
    std::size_t term_count() const { return terms_.size(); }
    const std::vector<const Frame*>& frames() const { return frames_; }

private:
    struct Term {
        const Frame* frame;
        double weight;  ///< positive
    };

    std::vector<const Frame*> frames_;
    std::vector<Term> terms_;  // of frames whose weight is not 0
    Spread spread_;
};

}  // namespace nestgrid::detail
