// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The threads of the library keep the contract of an executor.
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include <nestgrid/error.hpp>
#include <threads/thread_executor.hpp>

#include "executor_laws.hpp"

using nestgrid::engine::ThreadExecutor;

namespace {

TEST(ThreadExecutor, WorksOnceAndConsumesInOrderOnTheCallingThread) {
    for (const int threads : {1, 2, 3, 0}) {
        const ThreadExecutor executor(threads);
        const std::thread::id caller = std::this_thread::get_id();
        nestgrid_test::expect_parts_once_and_in_order(
            executor, [&] { EXPECT_EQ(std::this_thread::get_id(), caller); });
    }
}

TEST(ThreadExecutor, WorksOnSeveralPartsAtATime) {
    const ThreadExecutor executor(3);
    std::atomic<int> running{0};
    std::atomic<int> most{0};
    executor.run(
        30,
        [&](std::size_t) {
            const int now = ++running;
            int seen = most;
            while (seen < now && !most.compare_exchange_weak(seen, now)) {
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
            --running;
        },
        [](std::size_t) {});
    EXPECT_GE(most, 2);
    EXPECT_LE(most, 3);
}

TEST(ThreadExecutor, PassesExceptionsOnAndBeginsNothingAfter) {
    const auto nothing = [](std::size_t) {};
    for (const int threads : {1, 2}) {
        const ThreadExecutor executor(threads);
        std::atomic<std::size_t> last{0};
        const auto fail_at_7 = [&](std::size_t i) {
            last = std::max<std::size_t>(last, i);
            if (i == 7) throw std::runtime_error("seven");
        };
        EXPECT_THROW(executor.run(10000, fail_at_7, nothing), std::runtime_error);
        EXPECT_LT(last, 100U);
        EXPECT_THROW(executor.run(10000, nothing, fail_at_7), std::runtime_error);
        executor.run(0, fail_at_7, nothing);
    }
    EXPECT_THROW(ThreadExecutor(-1), nestgrid::InvalidInput);
}

}  // namespace
