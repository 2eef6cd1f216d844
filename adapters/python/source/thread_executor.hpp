// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Threads of the standard library for the algorithms, so that the wheel needs no other package.
#pragma once

#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid::python {

/// The calling thread consumes all parts, and works itself where none is ready. Threads begin with
/// run() and end with it.
class ThreadExecutor final : public Executor {
public:
    /// \param threads how many to use, the calling one among them; 0: as many as the machine has
    /// \throw InvalidInput for a negative number
    explicit ThreadExecutor(int threads);

    std::size_t concurrency() const override { return threads_; }
    void run(std::size_t count, const std::function<void(std::size_t)>& work,
             const std::function<void(std::size_t)>& consume) const override;

private:
    std::size_t threads_;
};

}  // namespace nestgrid::python
