// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid_test {

/// Expects that an executor works once on each of many parts, and consumes them in their order,
/// each after the work on it. \param consuming called whenever a part is consumed
inline void expect_parts_once_and_in_order(
    const nestgrid::Executor& executor, const std::function<void()>& consuming = [] {}) {
    EXPECT_GE(executor.concurrency(), 1U);
    std::vector<std::atomic<int>> times(1000);
    std::vector<std::size_t> twice(times.size());
    std::vector<std::size_t> order;
    executor.run(
        times.size(),
        [&](std::size_t i) {
            ++times[i];
            twice[i] = 2 * i;
        },
        [&](std::size_t i) {
            EXPECT_EQ(twice[i], 2 * i);
            consuming();
            order.push_back(i);
        });
    ASSERT_EQ(order.size(), times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
        EXPECT_EQ(times[i], 1);
        EXPECT_EQ(order[i], i);
    }
}

}  // namespace nestgrid_test
