// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One call from Python: the threads it may use, and whether it is to end.
#pragma once

#include <atomic>
#include <memory>
#include <variant>

#include <nestgrid/hierarchy.hpp>
#include <threads/thread_executor.hpp>

#include "stoppable.hpp"

namespace nestgrid::python {

/// A hierarchy with values of either type, borrowed.
using AnyHierarchy = std::variant<const Hierarchy<float>*, const Hierarchy<double>*>;

/// Runs tasks on threads, and throws Stopped between them once the flag is set.
class StoppableExecutor final : public Executor {
public:
    /// \param threads as of ThreadExecutor
    StoppableExecutor(int threads, const std::atomic<bool>& stopped)
        : executor_(threads), stopped_{stopped} {}

    std::size_t concurrency() const override { return executor_.concurrency(); }
    void run(std::size_t count, const std::function<void(std::size_t)>& work,
             const std::function<void(std::size_t)>& consume) const override {
        executor_.run(count, work, [&](std::size_t i) {
            if (stopped_.load(std::memory_order_relaxed)) throw Stopped();
            consume(i);
        });
    }

private:
    engine::ThreadExecutor executor_;
    const std::atomic<bool>& stopped_;
};

/// Invariant: once stop() was called, every algorithm that asks a hierarchy given by with(), or
/// runs tasks of executor(), throws Stopped. Safe for several threads.
class Call {
public:
    /// \throw InvalidInput as ThreadExecutor
    explicit Call(int threads) : executor_(threads, stopped_) {}

    const Executor& executor() const { return executor_; }
    void stop() { stopped_.store(true, std::memory_order_relaxed); }
    bool stopped() const { return stopped_.load(std::memory_order_relaxed); }

    /// A hierarchy that borrows another one, and throws Stopped when this call is to end.
    template <class Real>
    std::unique_ptr<const Hierarchy<Real>> stoppable(const Hierarchy<Real>& hierarchy) const {
        return std::make_unique<const Stoppable<Real>>(hierarchy, stopped_);
    }
    /// Calls function(hierarchy) with the Hierarchy<float> or Hierarchy<double>, which throws
    /// Stopped when this call is to end.
    template <class Function>
    decltype(auto) with(const AnyHierarchy& any, const Function& function) const {
        return std::visit(
            [&]<class Real>(const Hierarchy<Real>* hierarchy) -> decltype(auto) {
                const Stoppable<Real> stoppable(*hierarchy, stopped_);
                return function(static_cast<const Hierarchy<Real>&>(stoppable));
            },
            any);
    }

private:
    std::atomic<bool> stopped_{false};
    StoppableExecutor executor_;
};

}  // namespace nestgrid::python
