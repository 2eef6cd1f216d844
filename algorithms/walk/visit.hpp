// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace nestgrid::engine {

/// What to do with an element.
enum class Visit : std::uint8_t {
    skip,     ///< leaves out the element and all below it
    stop,     ///< extracts the element
    descend,  ///< enters the children
};

}  // namespace nestgrid::engine
