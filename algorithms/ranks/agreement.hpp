// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// That all ranks go on, or all end with the same sentence.
//
// Invariants:
//   - whatever a rank does alone between two exchanges, together() does; so what one rank throws
//     there, all throw, and none waits for a message that never comes;
//   - together() compares what the ranks are at, and comes before each exchange.
// Consequence: ranks that call different algorithms, or one with different arguments, get a
// sentence with both.
#pragma once

#include <string>

#include <nestgrid/optional.hpp>
#include <ranks/shared_nodes.hpp>

namespace nestgrid::engine {

/// How a rank ended a part that it did alone.
struct Outcome {
    enum class Kind : std::uint8_t {
        done,
        over_limit,
        cancelled,
        invalid_input,
        grid_error,
        io_error,
        other
    };
    Kind kind = Kind::done;
    std::string sentence;  ///< where it failed

    /// Of the exception that is being handled.
    static Outcome of_exception();
};

/// Throws, on all ranks, what the least rank that failed throws, with its number before the
/// sentence; or that ranks ask for different things; or Cancelled where some rank was cancelled;
/// or OverLimit where some rank counted more than the limit.
/// Collective, one reduction.
/// \param asked what this rank is asked for, without an end: "an isosurface of 0.5"
///
/// \throw InvalidInput where ranks are asked for different things, with two of these
void settle(Ranks& ranks, const std::string& asked, const Outcome& own);

/// Calls a function that does not talk to other ranks; all ranks end alike. Collective.
/// \param shared null where the grid is not distributed: nothing is done but the call
/// \param asked asked() is as that of settle(), called after the function
template <class Asked, class Function>
void together(const SharedNodes* shared, const Asked& asked, Function&& function) {
    if (shared == nullptr) return function();
    Outcome own;
    std::string what = "what it refuses";
    try {
        function();
        what = asked();
    } catch (...) {
        own = Outcome::of_exception();
    }
    settle(shared->ranks(), what, own);
}
template <class Function>
void together(const SharedNodes* shared, const char* asked, Function&& function) {
    together(
        shared, [asked] { return std::string(asked); }, std::forward<Function>(function));
}

/// 1 for an element that this rank counts, else 0. Ranks that have parts of one element all visit
/// it; the one with its first leaf counts it.
template <class View>
std::uint64_t counted(const View& view) {
    return view.member->presence == Presence::partly ? 0 : 1;
}

/// Adds the numbers of all ranks up. Collective.
void take_sums(Ranks& ranks, std::span<std::uint64_t*> numbers);

/// A number as it is compared: with all digits.
std::string all_digits(double number);

/// Numbers that become the greatest of all ranks. They may be infinite, and must be numbers.
void take_greatest(Ranks& ranks, std::span<double*> numbers);

}  // namespace nestgrid::engine
