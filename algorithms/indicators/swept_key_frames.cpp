// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/swept_key_frames.hpp>

#include <cmath>

#include <nestgrid/error.hpp>

namespace nestgrid {

SweptKeyFrames::SweptKeyFrames(std::vector<const SweptIndicator*> frames,
                               std::span<const float> weights)
    : frames_{std::move(frames)} {
    if (frames_.empty()) throw InvalidInput("there are no frames to interpolate between");
    set_weights(weights);
}

void SweptKeyFrames::set_weights(std::span<const float> weights) {
    detail::require_weights(frames_.size(), weights);
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

}  // namespace nestgrid
