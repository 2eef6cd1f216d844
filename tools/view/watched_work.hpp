// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Work on a frame that is asked now and then whether somebody waits for it, and ended by
// FrameAbandoned where nobody does.
#pragma once

#include <thread>

#include <nestgrid/algorithms/watch.hpp>

#include "frame_watch.hpp"

namespace nestgrid::view {

class WatchedWork final : public Watch {
public:
    /// Borrows both. For the thread that makes it: others go on until it ends.
    WatchedWork(const Executor& executor, const WatchedSteps& steps)
        : executor_(executor, [&steps](double share) { steps.check(share); }), steps_{steps} {}

    Work work() const { return {.executor = executor_, .watch = this}; }
    const Executor& executor() const { return executor_; }
    void check() const override {
        constexpr unsigned often = 4096;
        if (std::this_thread::get_id() == owner_ && ++calls_ % often == 0) steps_.check();
    }

private:
    TellingExecutor executor_;
    const WatchedSteps& steps_;
    std::thread::id owner_ = std::this_thread::get_id();
    mutable unsigned calls_ = 0;  // by the owner
};

}  // namespace nestgrid::view
