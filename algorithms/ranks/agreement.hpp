// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// That all ranks go on, or all end with the same sentence.
//
// Invariants:
//   - whatever a rank does alone between two exchanges, together() does; so what one rank throws
//     there, all throw, and none waits for a message that never comes;
//   - before the first exchange of an algorithm, agree_on() compares what the ranks ask for.
// Consequence: ranks that call different algorithms, or one with different arguments, get a
// sentence with both.
#pragma once

#include <string>

#include <ranks/shared_nodes.hpp>

namespace nestgrid::engine {

/// How a rank ended a part that it did alone.
struct Outcome {
    enum class Kind : std::uint8_t { done, cancelled, invalid_input, grid_error, io_error, other };
    Kind kind = Kind::done;
    std::string sentence;  ///< where it failed

    /// Of the exception that is being handled.
    static Outcome of_exception();
};

/// Throws, on all ranks, what the least rank that failed throws, with its number before the
/// sentence; or Cancelled where some rank was cancelled. Collective.
void settle(Ranks& ranks, const Outcome& own);

/// Calls a function that does not talk to other ranks; all ranks end alike. Collective.
/// \param shared null where the grid is not distributed: nothing is done but the call
template <class Function>
void together(const SharedNodes* shared, Function&& function) {
    if (shared == nullptr) return function();
    Outcome own;
    try {
        function();
    } catch (...) {
        own = Outcome::of_exception();
    }
    settle(shared->ranks(), own);
}

/// Compares what the ranks ask for. Collective.
/// \param asked a sentence without an end: "an isosurface of 0.5"
/// \throw InvalidInput on all ranks, with the sentences of two that differ
void agree_on(Ranks& ranks, const std::string& asked);

/// A number as agree_on() needs it: with all digits.
std::string all_digits(double number);

/// Numbers that become the greatest of all ranks. They may be infinite, and must be numbers.
void take_greatest(Ranks& ranks, std::span<double*> numbers);

}  // namespace nestgrid::engine
