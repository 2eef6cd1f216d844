// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What runs the tasks of an algorithm.
//
// A grid and a field that are walked by several threads must allow it: their const operations must
// not change anything but the context of the task (optional.hpp).
#pragma once

#include <cstddef>
#include <functional>

namespace nestgrid {

/// Runs the tasks of an algorithm, on one thread or on several.
class Executor {
public:
    virtual ~Executor() = default;

    /// How many tasks run at a time; with 1 an algorithm makes none.
    virtual std::size_t concurrency() const = 0;

    /// Calls work(i) once for every i < count, several at a time and in any order, and consume(i)
    /// once for every i, in the order of i and one at a time, after work(i) and beside other calls
    /// of work. Where one of them throws, no further ones are begun, and the exception is passed on
    /// when all have ended.
    virtual void run(std::size_t count, const std::function<void(std::size_t)>& work,
                     const std::function<void(std::size_t)>& consume) const = 0;

protected:
    Executor() = default;
    Executor(const Executor&) = default;
    Executor& operator=(const Executor&) = default;
    Executor(Executor&&) noexcept = default;
    Executor& operator=(Executor&&) noexcept = default;
};

/// The calling thread alone.
class SequentialExecutor final : public Executor {
public:
    std::size_t concurrency() const override { return 1; }
    void run(std::size_t count, const std::function<void(std::size_t)>& work,
             const std::function<void(std::size_t)>& consume) const override {
        for (std::size_t i = 0; i < count; ++i) {
            work(i);
            consume(i);
        }
    }
};

}  // namespace nestgrid
