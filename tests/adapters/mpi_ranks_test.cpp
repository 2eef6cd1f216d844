// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// MpiRanks that threads use, or that are of another communicator than they should be. Run under
// mpirun with what MPI is asked for: "single", "serialized" or "multiple". Returns 1 where
// something is not refused as it should be.
#include <cstdio>
#include <string>
#include <thread>

#include <nestgrid/adapters/mpi_files.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

using namespace nestgrid;

namespace {

/// What is said of a call, or nothing.
template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const InvalidInput& e) {
        return e.what();
    }
    return {};
}

int expect(const std::string& said, const std::string& sentence) {
    if (said == sentence) return 0;
    std::printf("'%s' is said, not '%s'\n", said.c_str(), sentence.c_str());
    return 1;
}

/// What is said of a call by another thread.
template <class Call>
std::string refusal_in_thread(const Call& call) {
    std::string said;
    std::thread([&] { said = refusal(call); }).join();
    return said;
}

/// Each exchange, by itself.
int use(MpiRanks& ranks) {
    const auto all = static_cast<std::uint64_t>(ranks.size());
    std::uint64_t sum = 1;
    ranks.reduce(std::span(&sum, 1), Ranks::Reduction::sum);
    const auto from = ranks.exchange({{(ranks.rank() + 1) % ranks.size(), Ranks::Bytes(1)}});
    return sum == all && ranks.gather({}).size() == all && from.size() == 1 ? 0 : 1;
}

int refuse_other_communicators(MpiRanks& ranks) {
    int wrong = expect(refusal([] { const MpiRanks none(MPI_COMM_NULL); }),
                       "the communicator is MPI_COMM_NULL: this process is none of its ranks");
    JoinedPiece joined;
    joined.ranks = ranks.size();
    MpiRanks self(MPI_COMM_SELF);
    const auto write = [&] { write_vtp(self, Isosurface<3>(), joined, "of_other_ranks.vtp"); };
    const auto write_pieces = [&] {
        write_pvtp(self, Isosurface<3>(), joined, "of_other_ranks.pvtp");
    };
    const std::string sentence = "the pieces are those of " + std::to_string(ranks.size()) +
                                 " ranks, but the communicator that writes them has 1 processes";
    wrong += expect(refusal(write), sentence) + expect(refusal(write_pieces), sentence);
    return wrong;
}

/// MPI allows none but the thread that initialised it.
int refuse_other_threads(MpiRanks& ranks) {
    const std::string sentence =
        "MPI allows none but the thread that initialised it: call MPI_Init_thread with "
        "MPI_THREAD_SERIALIZED, or MpiRanks from that thread";
    return expect(refusal_in_thread([&] { ranks.gather({}); }), sentence) +
           expect(refusal_in_thread([&] { ranks.exchange({}); }), sentence) +
           expect(refusal_in_thread([&] { ranks.reduce({}, Ranks::Reduction::max); }), sentence) +
           expect(refusal_in_thread([] { const MpiRanks other(MPI_COMM_SELF); }), sentence) +
           use(ranks);
}

/// One thread after the other.
int allow_threads_in_turn(MpiRanks& ranks) {
    int wrong = 0;
    std::thread([&] { wrong = use(ranks); }).join();
    return wrong + use(ranks);
}

/// While a thread of the last rank waits for the others, another thread of that rank is refused;
/// the first gets what it waits for.
int refuse_two_threads_at_once(MpiRanks& ranks) {
    const int last = ranks.size() - 1;
    if (ranks.rank() != last) {
        MPI_Barrier(MPI_COMM_WORLD);
        return use(ranks);
    }
    int wrong = 0;
    std::thread first([&] {
        // Refused, too, where it comes while the other one is there.
        while (!refusal([&] { wrong = use(ranks); }).empty()) std::this_thread::yield();
    });
    // Talks to nobody, so that it ends where it is allowed.
    const auto reduce_nothing = [&] { ranks.reduce({}, Ranks::Reduction::max); };
    while (refusal(reduce_nothing).empty()) std::this_thread::yield();
    const std::string sentence = "two threads of rank " + std::to_string(last) +
                                 " use one MpiRanks at the same time: give each its own";
    const std::string gathers = refusal([&] { ranks.gather({}); });
    const std::string exchanges = refusal([&] { ranks.exchange({}); });
    const std::string reduces = refusal(reduce_nothing);
    MPI_Barrier(MPI_COMM_WORLD);
    first.join();
    return wrong + expect(gathers, sentence) + expect(exchanges, sentence) +
           expect(reduces, sentence);
}

int run(const std::string& threads) {
    MpiRanks ranks(MPI_COMM_WORLD);
    int wrong = use(ranks) + refuse_other_communicators(ranks);
    wrong += threads == "single" ? refuse_other_threads(ranks) : allow_threads_in_turn(ranks);
    if (threads == "multiple") wrong += refuse_two_threads_at_once(ranks);
    auto all = static_cast<std::uint64_t>(wrong);
    ranks.reduce(std::span(&all, 1), Ranks::Reduction::sum);
    return all == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string threads = argc > 1 ? argv[1] : "single";
    const int wanted = threads == "multiple"     ? MPI_THREAD_MULTIPLE
                       : threads == "serialized" ? MPI_THREAD_SERIALIZED
                                                 : MPI_THREAD_SINGLE;
    int allowed = 0;
    MPI_Init_thread(&argc, &argv, wanted, &allowed);
    int failed = 1;
    if (allowed < wanted || (threads == "single" && allowed >= MPI_THREAD_SERIALIZED)) {
        std::printf("MPI allows threads by %d, not %d\n", allowed, wanted);
    } else {
        failed = run(threads);
    }
    MPI_Finalize();
    return failed;
}
