// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators other than offsets at a time between frames (paper, section 5.3), from one indicator
// of each frame and without a preroll of the time.
//
// With weights mu_i of the frames, as in key_frames.hpp, stop(t, x) = sum |mu_i| stop_i(x).
// Invariants:
//   - S = (stop <= epsilon) is saturated;
//   - stop(t, x) is not below the measure of U(t) = sum mu_i U_i at x, up to the rounding of U(t),
//     where the measure is a seminorm of the data: measure(a U + b V) <= |a| measure(U) + |b|
//     measure(V). numerical_indicator(), wavelet_indicator() and norms of offsets are, and so is a
//     measure of one's own that adds up or takes the greatest of absolute values of linear
//     functions of the data. visual_indicator(), whose normals depend on the data in another way,
//     is not: make it anew at each time. geometry_indicator() has no frames;
//   - frames that are equal give their own stop at every time, and where one weight is 1 and the
//     others are 0, stop is that of the frame.
// Bounds come from KeyFrames with the same weights.
// Memory: that of the frames, 2 bytes a node and frame. Cost: one look-up a node and frame whose
// weight is not 0; a new time costs O(frames).
#pragma once

#include <vector>

#include <nestgrid/algorithms/detail/weighted_frames.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

/// An indicator at any time between frames, without a new walk.
class SweptKeyFrames final : public Indicator {
public:
    /// \param frames of one measure and one hierarchy; borrowed
    /// \param weights one for each frame, finite; such as linear_weights()
    /// \throw InvalidInput where there is no frame, or not one finite weight for each
    SweptKeyFrames(std::vector<const SweptIndicator*> frames, std::span<const float> weights)
        : frames_{std::move(frames)} {
        set_weights(weights);
    }

    /// Goes to another time.
    /// \throw InvalidInput where there is not one finite weight for each frame
    void set_weights(std::span<const float> weights) { frames_.set_weights(weights); }

    double stop(NodeKey node) const override {
        return frames_.sum([node](const SweptIndicator& frame) { return frame.stop(node); });
    }
    /// The least factor of the frames, and the sum of their slopes, weighted like `stop`.
    Spread spread() const override { return frames_.spread(); }
    bool made_for(std::uint64_t epoch) const override { return frames_.made_for(epoch); }

private:
    detail::WeightedFrames<SweptIndicator> frames_;
};

}  // namespace nestgrid
