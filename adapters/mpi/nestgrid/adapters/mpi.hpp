// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The ranks of a distributed grid (distributed.hpp) over MPI.
//
// Messages go through a communicator of their own. An exchange is sparse: nobody is told how many
// messages come; each rank receives until all have been received (Hoefler, Siebert, Lumsdaine
// 2010). One thread of each rank may call at a time, and the one that initialised MPI alone where
// MPI was not asked for more. Where a rank dies, MPI ends the job.
#pragma once

#include <algorithm>
#include <atomic>
#include <string>

#include <mpi.h>

#include <nestgrid/algorithms/ranks.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// The processes of a communicator.
class MpiRanks final : public Ranks {
public:
    /// Collective. \param communicator whose ranks are those of the grid; it is copied
    ///
    /// \throw InvalidInput where MPI was not initialised, or has been finalised; where this process
    ///        is in no communicator
    explicit MpiRanks(MPI_Comm communicator) {
        if (!is(MPI_Initialized))
            throw InvalidInput("MPI was not initialised: call MPI_Init first");
        require_usable();
        if (communicator == MPI_COMM_NULL) {
            throw InvalidInput(
                "the communicator is MPI_COMM_NULL: this process is none of its ranks");
        }
        MPI_Comm_dup(communicator, &communicator_);
        MPI_Comm_rank(communicator_, &rank_);
        MPI_Comm_size(communicator_, &size_);
    }
    ~MpiRanks() override {
        if (!is(MPI_Finalized)) MPI_Comm_free(&communicator_);
    }

    /// The copy of the communicator.
    MPI_Comm communicator() const { return communicator_; }
    int rank() const override { return rank_; }
    int size() const override { return size_; }

    // All throw InvalidInput, before anything is sent, where MPI has been finalised, does not allow
    // this thread, or another thread is in one of them.
    std::vector<Message> exchange(std::vector<Message> to) override {
        const Turn turn(*this);
        // In turn, so that a message of the next exchange is not taken for one of this.
        tag_ = 3 - tag_;
        std::vector<Bytes> from(static_cast<std::size_t>(size_));
        std::vector<MPI_Request> sent;
        for (Message& m : to) {
            if (m.rank != rank_) {
                send(m, sent);
            } else {
                from[static_cast<std::size_t>(rank_)] = std::move(m.bytes);
            }
        }
        receive(sent, from);
        std::vector<Message> messages;
        for (int r = 0; r < size_; ++r) {
            Bytes& bytes = from[static_cast<std::size_t>(r)];
            if (!bytes.empty()) messages.push_back({r, std::move(bytes)});
        }
        return messages;
    }

    std::vector<Bytes> gather(Bytes own) override {
        const Turn turn(*this);
        const auto ranks = static_cast<std::size_t>(size_);
        std::uint64_t bytes = own.size();
        std::vector<std::uint64_t> all(ranks);
        MPI_Allgather(&bytes, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, communicator_);
        std::vector<Bytes> result(ranks);
        // MPI counts by int, over all ranks.
        const auto part = static_cast<std::uint64_t>(most_ / size_);
        const std::uint64_t most = *std::max_element(all.begin(), all.end());
        for (std::uint64_t first = 0; first < most; first += part)
            gather(own, all, first, part, result);
        return result;
    }

    void reduce(std::span<std::uint64_t> numbers, Reduction how) override {
        const Turn turn(*this);
        const MPI_Op op = how == Reduction::max   ? MPI_MAX
                          : how == Reduction::min ? MPI_MIN
                                                  : MPI_SUM;
        while (!numbers.empty()) {
            const auto part = numbers.first(std::min<std::size_t>(numbers.size(), most_));
            MPI_Allreduce(MPI_IN_PLACE, part.data(), static_cast<int>(part.size()), MPI_UINT64_T,
                          op, communicator_);
            numbers = numbers.subspan(part.size());
        }
    }

private:
    /// Bytes of a message of MPI at most. Greater ones go in parts, which arrive in order.
    static constexpr int most_ = 1 << 30;

    static bool is(int (*asked)(int*)) {
        int flag = 0;
        asked(&flag);
        return flag != 0;
    }
    static void require_usable() {
        if (is(MPI_Finalized)) throw InvalidInput("MPI has been finalised");
        int allowed = MPI_THREAD_SINGLE;
        MPI_Query_thread(&allowed);
        if (allowed < MPI_THREAD_SERIALIZED && !is(MPI_Is_thread_main)) {
            throw InvalidInput(
                "MPI allows none but the thread that initialised it: call MPI_Init_thread with "
                "MPI_THREAD_SERIALIZED, or MpiRanks from that thread");
        }
    }

    /// Held by the one thread that may talk to other ranks; refuses a second one.
    class Turn {
    public:
        explicit Turn(MpiRanks& ranks) : taken_{&ranks.taken_} {
            require_usable();
            if (taken_->exchange(true)) {
                throw InvalidInput("two threads of rank " + std::to_string(ranks.rank_) +
                                   " use one MpiRanks at the same time: give each its own");
            }
        }
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;
        ~Turn() { taken_->store(false); }

    private:
        std::atomic<bool>* taken_;
    };

    void send(const Message& m, std::vector<MPI_Request>& sent) const {
        for (std::size_t first = 0; first < m.bytes.size(); first += most_) {
            const std::size_t count = std::min<std::size_t>(m.bytes.size() - first, most_);
            MPI_Issend(m.bytes.data() + first, static_cast<int>(count), MPI_BYTE, m.rank, tag_,
                       communicator_, &sent.emplace_back());
        }
    }

    /// Receives until all ranks have received all messages.
    void receive(std::vector<MPI_Request>& sent, std::vector<Bytes>& from) const {
        MPI_Request barrier = MPI_REQUEST_NULL;
        bool all_sent = false;
        for (int done = 0; done == 0;) {
            int there = 0;
            MPI_Status status;
            MPI_Iprobe(MPI_ANY_SOURCE, tag_, communicator_, &there, &status);
            if (there != 0) {
                receive(status, from[static_cast<std::size_t>(status.MPI_SOURCE)]);
            } else if (all_sent) {
                MPI_Test(&barrier, &done, MPI_STATUS_IGNORE);
            } else {
                int received = 0;
                MPI_Testall(static_cast<int>(sent.size()), sent.data(), &received,
                            MPI_STATUSES_IGNORE);
                all_sent = received != 0;
                if (all_sent) MPI_Ibarrier(communicator_, &barrier);
            }
        }
    }
    void receive(const MPI_Status& status, Bytes& from) const {
        int count = 0;
        MPI_Get_count(&status, MPI_BYTE, &count);
        const std::size_t before = from.size();
        from.resize(before + static_cast<std::size_t>(count));
        MPI_Recv(from.data() + before, count, MPI_BYTE, status.MPI_SOURCE, tag_, communicator_,
                 MPI_STATUS_IGNORE);
    }

    /// Gathers the bytes first ... first + part - 1 of each rank.
    void gather(const Bytes& own, const std::vector<std::uint64_t>& all, std::uint64_t first,
                std::uint64_t part, std::vector<Bytes>& result) const {
        std::vector<int> count;
        std::vector<int> at;
        int sum = 0;
        for (const std::uint64_t bytes : all) {
            const std::uint64_t left = bytes > first ? std::min(bytes - first, part) : 0;
            count.push_back(static_cast<int>(left));
            at.push_back(sum);
            sum += count.back();
        }
        Bytes in(static_cast<std::size_t>(sum));
        const int mine = count[static_cast<std::size_t>(rank_)];
        MPI_Allgatherv(mine == 0 ? nullptr : own.data() + first, mine, MPI_BYTE, in.data(),
                       count.data(), at.data(), MPI_BYTE, communicator_);
        for (std::size_t r = 0; r < result.size(); ++r) {
            const auto* const begin = in.data() + at[r];
            result[r].insert(result[r].end(), begin, begin + count[r]);
        }
    }

    MPI_Comm communicator_ = MPI_COMM_NULL;
    int rank_ = 0;
    int size_ = 1;
    int tag_ = 1;  // 1 or 2
    std::atomic<bool> taken_ = false;
};

}  // namespace nestgrid
