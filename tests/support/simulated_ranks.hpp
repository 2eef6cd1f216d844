// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Ranks as threads of one process, which meet at each collective function.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <nestgrid/algorithms/ranks.hpp>

namespace nestgrid_test {

using nestgrid::Ranks;

class SimulatedRanks {
public:
    /// What one rank, or all together, have sent.
    struct Traffic {
        std::uint64_t exchanges = 0;
        std::uint64_t messages = 0;  ///< to other ranks
        std::uint64_t bytes = 0;
        std::uint64_t gathered = 0;  ///< bytes
        std::uint64_t reduced = 0;   ///< numbers
    };

    /// Calls function(ranks) for each rank, in a thread of its own. Where the function of one rank
    /// has ended and another rank waits for it, the other one's collective function throws.
    /// \return the sentence with which each rank ended by an exception; empty where it did not
    static std::vector<std::string> run(int size, const std::function<void(Ranks&)>& function) {
        Meeting meeting(size);
        std::vector<std::string> ended(static_cast<std::size_t>(size));
        std::vector<std::thread> threads;
        for (int r = 0; r < size; ++r) {
            threads.emplace_back([&, r] {
                One one(meeting, r);
                try {
                    function(one);
                } catch (const std::exception& e) {
                    ended[static_cast<std::size_t>(r)] = e.what();
                }
                meeting.leave();
            });
        }
        for (std::thread& thread : threads) thread.join();
        return ended;
    }
    static const Traffic& traffic(const Ranks& ranks) {
        return dynamic_cast<const One&>(ranks).sent;
    }

private:
    using Bytes = Ranks::Bytes;

    /// Where ranks leave things for each other.
    struct Meeting {
        explicit Meeting(int size)
            : messages(static_cast<std::size_t>(size)),
              bytes(messages.size()),
              numbers(messages.size()),
              what(messages.size()),
              size_{size} {}

        /// Waits until all ranks are here. \throw std::runtime_error where one has ended
        void arrive() {
            std::unique_lock lock(mutex_);
            const std::uint64_t now = turn_;
            if (++arrived_ == size_) {
                arrived_ = 0;
                ++turn_;
                all_.notify_all();
                return;
            }
            all_.wait(lock, [&] { return turn_ != now || left_; });
            if (turn_ == now) throw std::runtime_error("another rank has ended");
        }
        void leave() {
            const std::scoped_lock lock(mutex_);
            left_ = true;
            all_.notify_all();
        }

        std::vector<std::vector<Ranks::Message>> messages;
        std::vector<Bytes> bytes;
        std::vector<std::vector<std::uint64_t>> numbers;
        std::vector<int> what;  // collective function that each rank is in

    private:
        int size_;
        int arrived_ = 0;
        std::uint64_t turn_ = 0;
        bool left_ = false;
        std::mutex mutex_;
        std::condition_variable all_;
    };

    class One final : public Ranks {
    public:
        One(Meeting& meeting, int rank) : meeting_{&meeting}, rank_{rank} {}

        int rank() const override { return rank_; }
        int size() const override { return static_cast<int>(meeting_->messages.size()); }

        std::vector<Message> exchange(std::vector<Message> to) override {
            ++sent.exchanges;
            for (const Message& m : to) {
                sent.messages += m.rank != rank_ ? 1 : 0;
                sent.bytes += m.rank != rank_ ? m.bytes.size() : 0;
            }
            meeting_->messages[here()] = std::move(to);
            meet(1);
            std::vector<Message> from;
            for (int r = 0; r < size(); ++r) {
                for (const Message& m : meeting_->messages[static_cast<std::size_t>(r)]) {
                    if (m.rank == rank_) from.push_back({r, m.bytes});
                }
            }
            meeting_->arrive();
            return from;
        }
        std::vector<Bytes> gather(Bytes own) override {
            sent.gathered += own.size();
            meeting_->bytes[here()] = std::move(own);
            meet(2);
            std::vector<Bytes> all = meeting_->bytes;
            meeting_->arrive();
            return all;
        }
        void reduce(std::span<std::uint64_t> numbers, Reduction how) override {
            sent.reduced += numbers.size();
            meeting_->numbers[here()].assign(numbers.begin(), numbers.end());
            meet(3);
            for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = reduced(i, how);
            meeting_->arrive();
        }

        Traffic sent;

    private:
        std::size_t here() const { return static_cast<std::size_t>(rank_); }
        /// Waits for the others. \throw std::logic_error where one is in another function
        void meet(int what) {
            meeting_->what[here()] = what;
            meeting_->arrive();
            const auto& all = meeting_->what;
            if (std::any_of(all.begin(), all.end(), [&](int other) { return other != what; })) {
                throw std::logic_error("ranks are in different collective functions");
            }
        }
        std::uint64_t reduced(std::size_t i, Reduction how) const {
            std::uint64_t result = meeting_->numbers[0].at(i);
            for (std::size_t r = 1; r < meeting_->numbers.size(); ++r) {
                const std::uint64_t next = meeting_->numbers[r].at(i);
                result = how == Reduction::sum   ? result + next
                         : how == Reduction::max ? std::max(result, next)
                                                 : std::min(result, next);
            }
            return result;
        }

        Meeting* meeting_;
        int rank_;
    };
};

/// Ranks that forget what others send in one step of a program: mutants of the library.
class ForgetfulRanks final : public Ranks {
public:
    enum class Step : std::uint8_t { none, share, values, preroll, draw };
    struct Omission {
        const char* what;
        Step step;
        int from;              ///< the first exchange, or gathering, of the step that is forgotten
        bool gathers;          ///< gatherings are forgotten, and no exchanges
        bool reduces = false;  ///< sums and maxima are forgotten, and nothing else
    };

    ForgetfulRanks(Ranks& inner, const Omission& omission) : inner_{&inner}, omission_{omission} {}

    /// To be called before each step of the program.
    void begin(Step step) {
        step_ = step;
        exchanges_ = gathers_ = reductions_ = 0;
    }
    int rank() const override { return inner_->rank(); }
    int size() const override { return inner_->size(); }
    std::vector<Message> exchange(std::vector<Message> to) override {
        auto from = inner_->exchange(std::move(to));
        if (forgets(false, exchanges_++)) {
            std::erase_if(from, [&](const Message& m) { return m.rank != rank(); });
        }
        return from;
    }
    std::vector<Bytes> gather(Bytes own) override {
        auto all = inner_->gather(std::move(own));
        if (forgets(true, gathers_++)) {
            for (Bytes& bytes : all) bytes.clear();
        }
        return all;
    }
    void reduce(std::span<std::uint64_t> numbers, Reduction how) override {
        const std::vector<std::uint64_t> own(numbers.begin(), numbers.end());
        inner_->reduce(numbers, how);
        if (how == Reduction::min) return;  // by which ranks agree that all go on
        const bool forgets = step_ == omission_.step && omission_.reduces;
        if (forgets && reductions_++ >= omission_.from) std::ranges::copy(own, numbers.begin());
    }

private:
    bool forgets(bool gathers, int number) const {
        return step_ == omission_.step && !omission_.reduces && gathers == omission_.gathers &&
               number >= omission_.from;
    }

    Ranks* inner_;
    Omission omission_;
    Step step_ = Step::none;
    int exchanges_ = 0;
    int gathers_ = 0;
    int reductions_ = 0;
};

}  // namespace nestgrid_test
