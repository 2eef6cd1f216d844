// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <nestgrid/adapters/amrex_text.hpp>

namespace nestgrid::detail {

/// How the numbers of a plotfile are stored: IEEE floats or doubles with their bytes in some order.
struct AmrexNumberType {
    std::size_t bytes = 0;                       ///< of a number; 0 before any was read
    std::array<std::uint8_t, 8> significance{};  ///< of each byte in the file; 0 for the highest

    bool operator==(const AmrexNumberType&) const = default;

    /// Whether numbers of the file are those of this machine.
    bool is_native() const {
        for (std::size_t i = 0; i < bytes; ++i) {
            if (significance[i] != native(i)) return false;
        }
        return true;
    }
    /// \tparam Real of so many bytes
    template <class Real>
    Real read(const std::byte* from) const {
        std::array<std::byte, sizeof(Real)> all;
        for (std::size_t i = 0; i < all.size(); ++i) all[native(significance[i])] = from[i];
        return std::bit_cast<Real>(all);
    }

    /// Reads the bits of the parts of a number, and the order of its bytes:
    /// ((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1))) is a double whose lowest byte stands
    /// first.
    /// \throw IoError by the text where numbers are others than IEEE floats and doubles
    static AmrexNumberType read_from(AmrexText& text) {
        text.expect('(', "the type of numbers");
        const auto format = list(text, "the format of numbers");
        text.expect(',', "the type of numbers");
        const auto order = list(text, "the order of bytes");
        text.expect(')', "the type of numbers");
        const std::vector<std::int64_t> single{32, 8, 23, 0, 1, 9, 0, 127};
        const std::vector<std::int64_t> twofold{64, 11, 52, 0, 1, 12, 0, 1023};
        AmrexNumberType type{order.size(), {}};
        if (!(type.bytes == 8 && format == twofold) && !(type.bytes == 4 && format == single)) {
            text.fail("numbers are neither IEEE floats nor doubles");
        }
        for (std::size_t i = 0; i < type.bytes; ++i) {
            const auto at = order.begin() + static_cast<std::ptrdiff_t>(i);
            const bool is_byte = *at >= 1 && *at <= static_cast<std::int64_t>(type.bytes);
            if (!is_byte || std::find(order.begin(), at, *at) != at) {
                text.fail("the order of bytes is none of " + std::to_string(type.bytes) +
                          " bytes, each of which comes once");
            }
            type.significance[i] = static_cast<std::uint8_t>(*at - 1);
        }
        return type;
    }

private:
    /// The place in memory of the byte of a significance, and the significance of that in a place.
    std::size_t native(std::size_t i) const {
        return std::endian::native == std::endian::little ? bytes - 1 - i : i;
    }
    static std::vector<std::int64_t> list(AmrexText& text, const char* what) {
        std::vector<std::int64_t> numbers;
        text.expect('(', what);
        numbers.resize(static_cast<std::size_t>(text.integer(what, 0, 16)));
        text.expect(',', what);
        text.expect('(', what);
        for (std::int64_t& number : numbers) number = text.integer(what, 0, INT32_MAX);
        text.expect(')', what);
        text.expect(')', what);
        return numbers;
    }
};

}  // namespace nestgrid::detail
