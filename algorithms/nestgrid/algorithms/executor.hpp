// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What runs the tasks of an algorithm. Any type with two members will do:
//     std::size_t concurrency() const
//         how many tasks it may run at a time; with 1 none are made
//     void run(std::size_t count, Work&& work, Consume&& consume) const
//         calls work(i) once for every i < count, several at a time and in any order, and
//         consume(i, std::move(result)) once for each, in the order of i and one at a time, beside
//         the others. Results can be moved, and need not be copied.
//         Where one of them throws, no further ones are begun, and the exception is passed on when
//         all have ended.
// A grid and a field that are walked by several threads must allow it: their const operations must
// not change anything but the context of the task (operations.hpp).
#pragma once

#include <concepts>
#include <cstddef>
#include <utility>

namespace nestgrid {

template <class E>
concept Executor = requires(const E& executor) {
    { executor.concurrency() } -> std::convertible_to<std::size_t>;
    executor.run(
        std::size_t{}, [](std::size_t i) { return i; }, [](std::size_t, std::size_t) {});
};

/// The calling thread alone.
struct SequentialExecutor {
    static constexpr std::size_t concurrency() { return 1; }

    template <class Work, class Consume>
    void run(std::size_t count, Work&& work, Consume&& consume) const {
        for (std::size_t i = 0; i < count; ++i) consume(i, work(i));
    }
};

}  // namespace nestgrid
