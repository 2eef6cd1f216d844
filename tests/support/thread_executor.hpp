// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An executor of plain threads: what a program without any library for them would write, and all of
// it visible to the thread sanitizer.
#pragma once

#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid_test {

class ThreadExecutor final : public nestgrid::Executor {
public:
    explicit ThreadExecutor(std::size_t threads) : threads_{threads} {}

    std::size_t concurrency() const override { return threads_; }

    void run(std::size_t count, const std::function<void(std::size_t)>& work,
             const std::function<void(std::size_t)>& consume) const override {
        std::mutex mutex;
        std::vector<bool> done(count, false);
        std::size_t begun = 0;
        std::size_t consumed = 0;
        bool consuming = false;
        std::exception_ptr failed;
        /// Calls a function without the lock.
        const auto call = [&](std::unique_lock<std::mutex>& lock, const auto& function,
                              std::size_t i) {
            std::exception_ptr thrown;
            lock.unlock();
            try {
                function(i);
            } catch (...) {
                thrown = std::current_exception();
            }
            lock.lock();
            if (thrown && !failed) failed = thrown;
        };
        const auto loop = [&] {
            std::unique_lock lock(mutex);
            while (begun < count && !failed) {
                const std::size_t i = begun++;
                call(lock, work, i);
                done[i] = true;
                while (!consuming && !failed && consumed < count && done[consumed]) {
                    consuming = true;
                    call(lock, consume, consumed);
                    ++consumed;
                    consuming = false;
                }
            }
        };
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < threads_; ++t) threads.emplace_back(loop);
        for (std::thread& thread : threads) thread.join();
        if (failed) std::rethrow_exception(failed);
    }

private:
    std::size_t threads_;
};

}  // namespace nestgrid_test
