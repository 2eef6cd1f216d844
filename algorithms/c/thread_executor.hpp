// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Threads of the standard library, for callers who bring no executor of their own.
#pragma once

#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid {

/// Runs tasks on the calling thread and on others that live as long as one run.
class ThreadExecutor final : public Executor {
public:
    /// \param threads at least 1, the calling one among them. Fewer run where no more can be begun
    explicit ThreadExecutor(std::size_t threads) : threads_{threads} {}

    std::size_t concurrency() const override { return threads_; }
    void run(std::size_t count, const std::function<void(std::size_t)>& work,
             const std::function<void(std::size_t)>& consume) const override;

    /// How many threads the machine runs at a time; 1 where this is not known.
    static std::size_t all_threads();

private:
    std::size_t threads_;
};

}  // namespace nestgrid
