// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Threads of the standard library, for callers who bring no executor of their own: C codes and the
// Python package.
#pragma once

#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid::engine {

/// The calling thread consumes all parts, and works itself where none is ready. Threads begin with
/// run() and end with it. Fewer run where the system gives no more.
class ThreadExecutor final : public Executor {
public:
    /// \param threads how many to use, the calling one among them; 0: as many as the machine has
    /// \throw InvalidInput for a negative number
    explicit ThreadExecutor(int threads);

    /// How many threads the machine runs at a time; 1 where this is not known.
    static std::size_t all_threads();

    std::size_t concurrency() const override { return threads_; }
    void run(std::size_t count, const std::function<void(std::size_t)>& work,
             const std::function<void(std::size_t)>& consume) const override;

private:
    std::size_t threads_;
};

}  // namespace nestgrid::engine
