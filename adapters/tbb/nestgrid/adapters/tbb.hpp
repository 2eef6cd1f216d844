// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Threads of oneTBB for the algorithms (nestgrid/algorithms/executor.hpp).
#pragma once

#include <algorithm>
#include <memory>

#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid {

/// Runs tasks on the threads of oneTBB.
class TbbExecutor final : public Executor {
public:
    /// \param threads how many to use, though no more than oneTBB would; 0: all of these
    explicit TbbExecutor(int threads = 0)
        : arena_{std::make_unique<tbb::task_arena>(
              threads > 0 ? std::min(threads, tbb::info::default_concurrency())
                          : tbb::info::default_concurrency())} {}

    std::size_t concurrency() const override {
        return static_cast<std::size_t>(arena_->max_concurrency());
    }

    void run(std::size_t count, const std::function<void(std::size_t)>& work,
             const std::function<void(std::size_t)>& consume) const override {
        std::size_t next = 0;
        const auto begin = [&](tbb::flow_control& flow) {
            if (next == count) {
                flow.stop();
                return std::size_t{0};
            }
            return next++;
        };
        const auto draw = [&](std::size_t i) {
            work(i);
            return i;
        };
        // More parts in flight than threads: one that takes long does not hold up the others.
        arena_->execute([&] {
            tbb::parallel_pipeline(
                4 * concurrency(),
                tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, begin) &
                    tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, draw) &
                    tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order,
                                                        consume));
        });
    }

private:
    std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace nestgrid
