// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <gtest/gtest.h>

#include <nestgrid/error.hpp>

namespace nestgrid_test {

/// The sentence with which something is refused; empty where it is not.
template <class Error = nestgrid::InvalidInput, class Function>
std::string refusal(Function&& function) {
    try {
        function();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

/// Something is refused with a sentence that has this part.
template <class Function>
void expect_refused(Function&& function, const std::string& part) {
    const std::string sentence = refusal(function);
    EXPECT_NE(sentence.find(part), std::string::npos)
        << "'" << sentence << "', not '" << part << "'";
}

}  // namespace nestgrid_test
