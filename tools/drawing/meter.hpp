// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "drawing/memory.hpp"

/// Measures time, and memory of the heap, since it was made. Memory is right as long as no other
/// meter is made.
class Meter {
public:
    Meter() : bytes_{memory::current()} { memory::reset_peak(); }

    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    /// The greatest number of bytes so far, beyond those at the beginning.
    std::size_t peak_bytes() const { return memory::peak() - bytes_; }

private:
    std::size_t bytes_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};
