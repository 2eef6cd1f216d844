// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Work that Ctrl-C ends, or a function that is called meanwhile.
//
// The work runs in a thread of its own without Python's lock, while the thread that called waits
// and lets Python handle signals. Where a handler raises, the work is told to end. Work that does
// not hear within a moment, such as a long loop over a surface, is left to end by itself, and its
// result is dropped.
// Consequence: the work must own all that it touches.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <type_traits>

#include <pybind11/pybind11.h>

#include "call.hpp"

namespace nestgrid::python {

/// \param stop tells the work to end
/// \throw what the work throws, or py::error_already_set where a signal handler, or what watches,
///        has raised
void run_apart(std::function<void()> work, const std::function<void()>& stop);

/// Calls work(call), to be called with Python's lock.
/// \param threads as ThreadExecutor
/// \return what it returns
/// \throw what it throws, or py::error_already_set where a signal handler has raised, such as
///        KeyboardInterrupt
template <class Work>
auto interruptible(int threads, Work work) {
    using Result = std::invoke_result_t<const Work&, const Call&>;
    struct Job {
        Call call;
        Work work;
        std::optional<Result> result;
    };
    const std::shared_ptr<Job> job(new Job{Call(threads), std::move(work), {}});
    run_apart([job] { job->result.emplace(job->work(job->call)); }, [job] { job->call.stop(); });
    return std::move(*job->result);
}

/// Calls function(), and look() now and then while this thread waits for work: where look() raises,
/// the work ends as it does where a signal handler has raised.
/// \return what function() returns
/// \throw what look() raises, or function()
pybind11::object watched(const pybind11::object& function, const pybind11::object& look);

/// A Python object that memory belongs to; it may be dropped by any thread.
std::shared_ptr<const void> keep(pybind11::object object);

/// Waits for work that was left to end by itself: to be called before Python ends.
void wait_for_abandoned_work();

}  // namespace nestgrid::python
