// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Keeps the frames of an interaction at one cost: while a slider is dragged, a camera or a lens
// moves, or time goes on.
//
// A search for the threshold of a triangle budget draws a frame several times. Neighbouring frames
// differ little, and their cost is about proportional to a power of the threshold, which two frames
// tell: the secant between them gives the threshold of the next one. So there is one draw a frame.
// The goal is a target, not a limit: where the picture changes suddenly, a few frames miss it. When
// the motion ends, settle() finds the exact threshold.
#pragma once

#include <functional>

namespace nestgrid {

/// The thresholds of a series of frames. Knows nothing of what is drawn: isosurfaces, slices and
/// height fields under any criterion that holds at more nodes the greater its threshold is.
class FrameBudget {
public:
    /// \param goal the cost of a frame that is aimed at, in any unit: triangles, bytes, seconds
    /// \param greatest threshold that makes a difference, such as greatest() - least() of a
    ///        HierarchicalIndicator; the first frame takes an eighth of it
    /// \throw InvalidInput where one of them is not a positive finite number
    FrameBudget(double goal, double greatest);

    /// For the next frame. 0 where detail of less than 2^-16 of the greatest threshold fits in.
    double threshold() const;
    double goal() const { return goal_; }
    /// Takes another goal from the next frame on.
    /// \throw InvalidInput where it is not a positive finite number
    void aim(double goal);

    /// Tells what the frame at threshold() cost. Moves the threshold by a factor between 1/2 and 2.
    /// \throw InvalidInput where the cost is negative or not a number
    void drawn(double cost);

    /// The least threshold of 8 significant bits at which a frame fits, searched from threshold()
    /// on; the greatest one where none fits. Later frames go on from it.
    /// \param fits draws or counts a frame at a threshold, and says whether it keeps within the
    ///        goal. Asked at most ten times where the last frame was within 3 % of the goal.
    double settle(const std::function<bool(double threshold)>& fits);
    /// Whether the threshold that settle() found last fits: false where none does, not even the
    /// greatest one.
    bool kept() const { return kept_; }

private:
    double goal_;
    double greatest_;
    double threshold_;  // between 2^-16 and 1 times the greatest
    /// Binary logarithms of the last threshold, and of its cost / goal.
    struct Frame {
        double threshold;
        double miss;
    };
    Frame last_;
    bool kept_ = true;
    double power_ = 1;  // the cost is about proportional to threshold^-power
};

}  // namespace nestgrid
