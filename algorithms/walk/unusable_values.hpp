// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Values that are no numbers are met where only the value is known. Where they are is found by
// another walk, when one was met.
#pragma once

#include <span>

#include <nestgrid/error.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// A value of the field is not a number, infinite, or too great.
class UnusableValue final : public InvalidInput {
public:
    using InvalidInput::InvalidInput;
};

/// \throw UnusableValue where one of the values is no number or infinite
void require_numbers(std::span<const double> values);

/// \param functions how many components come before those of the field
/// \throw InvalidInput that adds the place of the first value that is no number or infinite, in the
///        numbering of the grid, to the sentence; UnusableValue as it is where all are finite
template <class Real>
[[noreturn]] void refuse_with_place(const Hierarchy<Real>& hierarchy, std::size_t functions,
                                    const UnusableValue& refusal);

/// Calls a function, and gives what it throws for a value the place of that.
/// \param functions how many components come before those of the field
template <class Real, class Function>
auto with_places(const Hierarchy<Real>& hierarchy, Function&& function, std::size_t functions = 0) {
    try {
        return function();
    } catch (const UnusableValue& refusal) {
        refuse_with_place(hierarchy, functions, refusal);
    }
}

}  // namespace nestgrid::engine
