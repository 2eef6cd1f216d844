// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// For machines without threads, such as WebAssembly: the calling thread does everything.
#include <threads/thread_executor.hpp>

namespace nestgrid::engine {

std::size_t ThreadExecutor::all_threads() { return 1; }

ThreadExecutor::ThreadExecutor(int /*threads*/) : threads_{1} {}

void ThreadExecutor::run(std::size_t count, const std::function<void(std::size_t)>& work,
                         const std::function<void(std::size_t)>& consume) const {
    SequentialExecutor{}.run(count, work, consume);
}

}  // namespace nestgrid::engine
