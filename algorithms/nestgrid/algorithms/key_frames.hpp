// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicator and bounds at a time between frames (paper, section 5.3), from one preroll of each
// frame and without a preroll of the time.
//
// U(t) = sum mu_i U_i is the field Between (between.hpp) with the same weights mu_i, and
//     stop(t, x) = sum |mu_i| stop_i(x),    bound(t, x) = sum |mu_i| bound_i(x).
// Invariants, up to the rounding of U(t), which bounds include:
//   - stop(t, x) is not below the offset of U(t) at x, also where weights are negative;
//   - S = (stop <= epsilon) is saturated, and U(t) within its bounds;
//   - frames that are equal give their own stop at every time: neither the greatest of |mu_i|
//   stop_i
//     nor their Euclidean norm does, and still data would change their grid between two frames;
//   - stop has the same bits wherever it is asked for: weights are float, so that each product is
//     exact in double, and sums are taken in the order of the frames;
//   - where one weight is 1 and the others are 0, everything is that of the frame, bit for bit.
// Consequence: looser than a preroll of U(t) by what cancels between frames.
// Memory: that of the prerolls, 4 bytes a node and frame. Cost: one look-up a node and frame whose
// weight is not 0; a new time costs O(frames).
#pragma once

#include <vector>

#include <nestgrid/algorithms/detail/weighted_frames.hpp>
#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid {

/// Indicator and bounds at any time between frames, without a new walk.
class KeyFrames final : public Indicator, public Bounds {
public:
    /// \param frames of one hierarchy; borrowed
    /// \param weights one for each frame, finite; such as linear_weights()
    /// \throw GridError where the frames do not belong to one hierarchy in one state
    /// \throw InvalidInput where there is no frame, and as set_weights()
    KeyFrames(std::vector<const HierarchicalIndicator*> frames, std::span<const float> weights);

    /// Goes to another time.
    /// \throw InvalidInput where there is not one finite weight for each frame, and where U(t)
    /// could
    ///        be beyond an eighth of the range of the type of its values
    void set_weights(std::span<const float> weights);

    double stop(NodeKey node) const override {
        return frames_.sum([node](const HierarchicalIndicator& frame) { return frame.stop(node); });
    }
    NodeMask stops_at_most(const Rule& rule, std::span<const NodeKey> nodes,
                           double epsilon) const override;
    /// The least factor of the frames, and the sum of their slopes, weighted like `stop`.
    Spread spread() const override { return frames_.spread(); }
    double bound(const Rule& rule, std::span<const NodeKey> nodes) const override;
    double offset_bound(NodeKey node) const override;

    const HangingNodes* hanging() const override { return first().hanging(); }
    bool made_for(std::uint64_t epoch) const override { return frames_.made_for(epoch); }
    bool stops_conform() const override { return first().stops_conform(); }
    int finest_level() const override { return first().finest_level(); }
    bool one_level_a_node() const override { return first().one_level_a_node(); }

    double least() const override { return least_; }        ///< no value of U(t) is less
    double greatest() const override { return greatest_; }  ///< no value of U(t) is greater
    /// What the rounding of values adds to bounds: of the order of 10^-5 of the greatest value
    /// where values are float, of 10^-14 where they are double, 0 where one frame counts alone.
    double rounding() const { return rounding_; }

private:
    const HierarchicalIndicator& first() const { return *frames_.frames().front(); }
    double with_rounding(double sum) const;
    void set_range(std::span<const float> weights);

    detail::WeightedFrames<HierarchicalIndicator> frames_;
    double least_ = 0;
    double greatest_ = 0;
    double rounding_ = 0;
};

}  // namespace nestgrid
