// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// What ranks tell each other, as bytes. All ranks have the same byte order.
#pragma once

#include <cstring>
#include <type_traits>
#include <utility>

#include <nestgrid/algorithms/ranks.hpp>

namespace nestgrid::engine {

using Bytes = Ranks::Bytes;

template <class T>
void put(Bytes& bytes, const T& what) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof(T));
    std::memcpy(bytes.data() + at, &what, sizeof(T));
}

/// Reads what put() wrote, in the same order.
class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_{bytes} {}
    bool more() const { return at_ < bytes_.size(); }
    template <class T>
    T get() {
        static_assert(std::is_trivially_copyable_v<T>);
        T what;
        std::memcpy(&what, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return what;
    }

private:
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

/// Bytes for some ranks, and for all.
class Outbox {
public:
    explicit Outbox(int size) : to_(static_cast<std::size_t>(size)) {}
    Bytes& to(int rank) { return to_[static_cast<std::size_t>(rank)]; }
    Bytes& to_all() { return all_; }

    /// Sends what is for some ranks, and calls take(rank, reader) for what others sent to this one.
    template <class Take>
    void send(Ranks& ranks, Take&& take) {
        std::vector<Ranks::Message> out;
        for (std::size_t r = 0; r < to_.size(); ++r) {
            if (!to_[r].empty()) out.push_back({static_cast<int>(r), std::move(to_[r])});
        }
        for (const Ranks::Message& message : ranks.exchange(std::move(out))) {
            Reader in(message.bytes);
            take(message.rank, in);
        }
    }
    /// Sends what is for all ranks, and calls take(rank, reader) for what the others sent.
    template <class Take>
    void send_to_all(Ranks& ranks, Take&& take) {
        const std::vector<Bytes> all = ranks.gather(std::move(all_));
        for (int r = 0; r < ranks.size(); ++r) {
            Reader in(all[static_cast<std::size_t>(r)]);
            if (r != ranks.rank() && in.more()) take(r, in);
        }
    }

private:
    std::vector<Bytes> to_;
    Bytes all_;
};

}  // namespace nestgrid::engine
