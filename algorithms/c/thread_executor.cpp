// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "thread_executor.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace nestgrid {

namespace {

/// One run. Tasks are begun in order; the thread that ends the first one not consumed consumes it
/// and those behind it that have ended.
class Run {
public:
    using Function = std::function<void(std::size_t)>;

    /// \param ahead how many tasks may be begun before the first of them is consumed
    Run(std::size_t count, std::size_t ahead, const Function& work, const Function& consume)
        : ahead_{ahead}, done_(count, false), work_{&work}, consume_{&consume} {}

    /// What every thread does.
    void loop() {
        std::unique_lock lock(mutex_);
        for (;;) {
            room_.wait(lock, [&] { return ended() || begun_ < consumed_ + ahead_; });
            if (ended()) return;
            const std::size_t task = begun_++;
            call(lock, *work_, task);
            done_[task] = true;
            if (!consuming_) consume_all(lock);
        }
    }
    void rethrow() const {
        if (failed_) std::rethrow_exception(failed_);
    }

private:
    bool ended() const { return failed_ || begun_ == done_.size(); }

    void consume_all(std::unique_lock<std::mutex>& lock) {
        consuming_ = true;
        while (!failed_ && consumed_ < done_.size() && done_[consumed_]) {
            call(lock, *consume_, consumed_);
            ++consumed_;
            room_.notify_all();
        }
        consuming_ = false;
    }

    /// Calls a function without the lock.
    void call(std::unique_lock<std::mutex>& lock, const Function& function, std::size_t task) {
        std::exception_ptr thrown;
        lock.unlock();
        try {
            function(task);
        } catch (...) {
            thrown = std::current_exception();
        }
        lock.lock();
        if (thrown && !failed_) {
            failed_ = thrown;
            room_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable room_;
    std::size_t ahead_;
    std::vector<bool> done_;
    std::size_t begun_ = 0;
    std::size_t consumed_ = 0;
    bool consuming_ = false;
    std::exception_ptr failed_;
    const Function* work_;
    const Function* consume_;
};

}  // namespace

std::size_t ThreadExecutor::all_threads() {
    return std::max<std::size_t>(std::thread::hardware_concurrency(), 1);
}

void ThreadExecutor::run(std::size_t count, const std::function<void(std::size_t)>& work,
                         const std::function<void(std::size_t)>& consume) const {
    // More parts in flight than threads: one that takes long does not hold up the others.
    Run run(count, 4 * threads_, work, consume);
    std::vector<std::thread> others;
    others.reserve(threads_);
    try {
        while (others.size() + 1 < threads_) others.emplace_back([&run] { run.loop(); });
    } catch (const std::system_error&) {
        // The system gives no more threads.
    }
    run.loop();
    for (std::thread& thread : others) thread.join();
    run.rethrow();
}

}  // namespace nestgrid
