// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An executor of plain threads: what a program without any library for them would write, and all of
// it visible to the thread sanitizer.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace nestgrid_test {

class ThreadExecutor {
public:
    explicit ThreadExecutor(std::size_t threads) : threads_{threads} {}

    std::size_t concurrency() const { return threads_; }

    template <class Work, class Consume>
    void run(std::size_t count, Work&& work, Consume&& consume) const {
        using Result = std::decay_t<decltype(work(count))>;
        std::mutex mutex;
        std::vector<std::optional<Result>> done(count);
        std::size_t begun = 0;
        std::size_t consumed = 0;
        bool consuming = false;
        std::exception_ptr failed;
        const auto loop = [&] {
            std::unique_lock lock(mutex);
            while (begun < count && !failed) {
                const std::size_t i = begun++;
                lock.unlock();
                std::optional<Result> result;
                std::exception_ptr thrown;
                try {
                    result.emplace(work(i));
                } catch (...) {
                    thrown = std::current_exception();
                }
                lock.lock();
                if (thrown && !failed) failed = thrown;
                done[i] = std::move(result);
                while (!consuming && !failed && consumed < count && done[consumed]) {
                    consuming = true;
                    Result next = *std::move(done[consumed]);
                    done[consumed].reset();
                    lock.unlock();
                    try {
                        consume(consumed, std::move(next));
                    } catch (...) {
                        thrown = std::current_exception();
                    }
                    lock.lock();
                    if (thrown && !failed) failed = thrown;
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
