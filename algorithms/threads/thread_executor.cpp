// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <threads/thread_executor.hpp>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <nestgrid/error.hpp>

namespace nestgrid::engine {

namespace {

/// The parts of one run(), which its threads share.
class Parts {
public:
    Parts(std::size_t count, std::size_t ahead, const std::function<void(std::size_t)>& work)
        : work_{work}, worked_(count), ahead_{ahead} {}

    /// Works on one part after the other until none is left or something has failed.
    void work_on_all() {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [&] { return may_begin() || ended(); });
            if (ended()) return;
            work_on_next(lock);
        }
    }

    /// Consumes all parts in their order, and works on others between.
    void consume_all(const std::function<void(std::size_t)>& consume) {
        std::unique_lock lock(mutex_);
        while (consumed_ < worked_.size() && !failure_) {
            if (worked_[consumed_] != 0) {
                without(lock, [&] { consume(consumed_); });
                ++consumed_;
                changed_.notify_all();
            } else if (may_begin()) {
                work_on_next(lock);
            } else {
                changed_.wait(lock);
            }
        }
    }

    /// \throw what a part has thrown first
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    bool may_begin() const { return begun_ < worked_.size() && begun_ < consumed_ + ahead_; }
    bool ended() const { return begun_ == worked_.size() || failure_; }

    void work_on_next(std::unique_lock<std::mutex>& lock) {
        const std::size_t i = begun_++;
        without(lock, [&] { work_(i); });
        worked_[i] = 1;
        changed_.notify_all();
    }

    template <class Function>
    void without(std::unique_lock<std::mutex>& lock, const Function& function) {
        std::exception_ptr failure;
        lock.unlock();
        try {
            function();
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        if (failure && !failure_) failure_ = failure;
    }

    const std::function<void(std::size_t)>& work_;
    std::vector<char> worked_;  // by part
    std::size_t ahead_;         // of the consumed parts: how many may be begun
    std::size_t begun_ = 0;
    std::size_t consumed_ = 0;
    std::exception_ptr failure_;
    std::mutex mutex_;
    std::condition_variable changed_;
};

std::size_t thread_count(int threads) {
    if (threads < 0) throw InvalidInput("threads is " + std::to_string(threads) + ", below 0");
    return threads > 0 ? static_cast<std::size_t>(threads) : ThreadExecutor::all_threads();
}

}  // namespace

std::size_t ThreadExecutor::all_threads() {
    return std::max(1U, std::thread::hardware_concurrency());
}

ThreadExecutor::ThreadExecutor(int threads) : threads_{thread_count(threads)} {}

void ThreadExecutor::run(std::size_t count, const std::function<void(std::size_t)>& work,
                         const std::function<void(std::size_t)>& consume) const {
    Parts parts(count, 4 * threads_, work);
    {
        std::vector<std::jthread> threads;
        const std::size_t others = std::min(threads_, std::max<std::size_t>(count, 1)) - 1;
        try {
            while (threads.size() < others) threads.emplace_back([&] { parts.work_on_all(); });
        } catch (const std::system_error&) {
            // The system gives no more threads.
        }
        parts.consume_all(consume);
    }
    parts.rethrow();
}

}  // namespace nestgrid::engine
