// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame is doing while it is drawn, and how it ends early.
#pragma once

#include <functional>
#include <limits>

namespace nestgrid::view {

struct FrameStep {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    const char* doing = "";  ///< for readers, without a full stop; empty where nothing is done
    double share = unknown;  ///< of this step that is done, from 0 to 1
};

/// Told now and then what a frame is doing, by one thread at a time. Returns whether somebody still
/// waits for the frame.
using FrameWatch = std::function<bool(const FrameStep&)>;

/// Thrown in the place of a frame for which nobody waits any more.
struct FrameAbandoned {};

/// Tells a FrameWatch of one step after the other.
class WatchedSteps {
public:
    /// \param watch borrowed; may be empty
    explicit WatchedSteps(const FrameWatch& watch) : watch_{&watch} {}

    void begin(const char* doing) { doing_ = doing; }
    /// \return whether somebody still waits for the frame
    bool tell(double share = FrameStep::unknown) const {
        return !*watch_ || (*watch_)(FrameStep{doing_, share});
    }
    /// \throw FrameAbandoned where nobody does
    void check(double share = FrameStep::unknown) const {
        if (!tell(share)) throw FrameAbandoned{};
    }

private:
    const FrameWatch* watch_;
    const char* doing_ = "";
};

}  // namespace nestgrid::view
