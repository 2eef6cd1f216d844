// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One call from Python: the threads it may use, and whether it is to end.
#pragma once

#include <atomic>

#include <nestgrid/algorithms/watch.hpp>
#include <threads/thread_executor.hpp>

namespace nestgrid::python {

/// Thrown out of an algorithm that is to end.
struct Stopped {};

/// Invariant: once stop() was called, every algorithm that does its work(), or asks a hierarchy
/// given by with(), throws Stopped. Safe for several threads.
class Call final : public Watch {
public:
    /// \throw InvalidInput as ThreadExecutor
    explicit Call(int threads)
        : threads_(threads), executor_(threads_, [this](double) { check(); }) {}

    const Executor& executor() const { return executor_; }
    Work work() const { return {executor_, this}; }
    void stop() { stopped_.store(true, std::memory_order_relaxed); }
    bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
    void check() const override {
        if (stopped()) throw Stopped();
    }

    /// Calls function(hierarchy) with the Hierarchy<float> or Hierarchy<double>, which throws
    /// Stopped when this call is to end.
    template <class Function>
    decltype(auto) with(const FieldOnGrid& field, const Function& function) const {
        return detail::watched(field, *this).visit(function);
    }

private:
    std::atomic<bool> stopped_{false};
    engine::ThreadExecutor threads_;
    TellingExecutor executor_;
};

}  // namespace nestgrid::python
