// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <utility>

#include <nestgrid/algorithms/executor.hpp>

/// An executor that tells how far its tasks are. Results have the bits of the executor inside.
class TellingExecutor final : public nestgrid::Executor {
public:
    /// \param inner borrowed
    /// \param tell told the share of the tasks of a run that are done, from 0 to 1; what it throws
    ///        ends the run; may be empty
    TellingExecutor(const nestgrid::Executor& inner, std::function<void(double share)> tell)
        : inner_{&inner}, tell_{std::move(tell)} {}

    std::size_t concurrency() const override { return inner_->concurrency(); }
    void run(std::size_t count, const std::function<void(std::size_t)>& work,
             const std::function<void(std::size_t)>& consume) const override {
        inner_->run(count, work, [&](std::size_t i) {
            consume(i);
            if (tell_) tell_(static_cast<double>(i + 1) / static_cast<double>(count));
        });
    }

private:
    const nestgrid::Executor* inner_;
    std::function<void(double share)> tell_;
};
