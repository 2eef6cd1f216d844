// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The processes that each have a part of a distributed grid, as the library sees them: without MPI.
//
// All functions but rank() and size() are collective: each rank calls them in the same order, by
// one thread. They throw where another rank has ended or cannot be reached; the library lets that
// through. A program's own messages must not be mistaken for these: over MPI, by a communicator of
// their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nestgrid {

/// The processes of a distributed grid, of which this is one.
class Ranks {
public:
    using Bytes = std::vector<std::byte>;
    /// Bytes for a rank or from one.
    struct Message {
        int rank;
        Bytes bytes;
    };
    enum class Reduction : std::uint8_t { max, min, sum };

    Ranks() = default;
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;
    virtual ~Ranks() = default;

    virtual int rank() const = 0;  ///< of this process, 0 to size() - 1
    virtual int size() const = 0;
    /// Sends messages, at most one to each rank, this one among them; most ranks get none.
    /// \return those received, in the order of their senders
    virtual std::vector<Message> exchange(std::vector<Message> to) = 0;
    /// \return what each rank gave, in the order of ranks
    virtual std::vector<Bytes> gather(Bytes own) = 0;
    /// Replaces each number by its greatest, least or sum over all ranks, which give equally many.
    virtual void reduce(std::span<std::uint64_t> numbers, Reduction how) = 0;
};

}  // namespace nestgrid
