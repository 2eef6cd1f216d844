// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The indicators of one isosurface at one moment (cut_indicator.hpp), kept until another one is
// asked for.
#pragma once

#include <optional>
#include <vector>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

#include "frame_drawing.hpp"

namespace nestgrid::view {

class SurfaceErrors {
public:
    /// Forgets the indicators of other surfaces.
    void begin(const Moment& moment, double isovalue);

    // Of the surface that begin() was told of.
    /// \throw FrameAbandoned where nobody waits for them
    const SweptIndicator& cuts(const Moment& moment, const Executor& executor, WatchedSteps& steps);
    const SweptIndicator& slopes(const Moment& moment, const Executor& executor,
                                 WatchedSteps& steps);

private:
    std::vector<float> weights_;  // of the frames
    double isovalue_ = 0;
    std::optional<SweptIndicator> cuts_;
    std::optional<SweptIndicator> slopes_;
};

}  // namespace nestgrid::view
