// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// The box of some vectors. Its bits do not depend on their order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

/// The least and the greatest of each coordinate of some vectors, as floats.
class VectorBox {
public:
    void add(const std::array<float, 3>& vector) {
        for (std::size_t d = 0; d < 3; ++d) {
            low_[d] = std::min(low_[d], vector[d]);
            high_[d] = std::max(high_[d], vector[d]);
        }
    }
    void add(const VectorBox& other) {
        for (std::size_t d = 0; d < 3; ++d) {
            low_[d] = std::min(low_[d], other.low_[d]);
            high_[d] = std::max(high_[d], other.high_[d]);
        }
    }
    /// Numbers without signs that are the greater the larger the box is.
    using Numbers = std::array<std::uint32_t, 6>;
    Numbers numbers() const {
        return {in_order(-low_[0]), in_order(-low_[1]), in_order(-low_[2]),
                in_order(high_[0]), in_order(high_[1]), in_order(high_[2])};
    }
    /// Adds a box by its numbers. \return whether this one grows
    bool raise(const Numbers& other) {
        const Numbers own = numbers();
        for (std::size_t d = 0; d < 3; ++d) {
            low_[d] = std::min(low_[d], -from_order(other[d]));
            high_[d] = std::max(high_[d], from_order(other[3 + d]));
        }
        return own != numbers();
    }
    /// The distance of the two farthest corners; 0 for an empty box.
    double diagonal() const {
        if (low_[0] > high_[0]) return 0;
        Point side;
        for (std::size_t d = 0; d < 3; ++d) side[d] = double{high_[d]} - double{low_[d]};
        return norm(side);
    }

private:
    static constexpr std::uint32_t sign_ = std::uint32_t{1} << 31U;
    static std::uint32_t in_order(float x) {
        const auto bits = std::bit_cast<std::uint32_t>(x);
        return (bits & sign_) != 0 ? ~bits : bits | sign_;
    }
    static float from_order(std::uint32_t bits) {
        return std::bit_cast<float>((bits & sign_) != 0 ? bits & ~sign_ : ~bits);
    }
    static constexpr float infinity_ = std::numeric_limits<float>::infinity();
    std::array<float, 3> low_{infinity_, infinity_, infinity_};
    std::array<float, 3> high_{-infinity_, -infinity_, -infinity_};
};

}  // namespace nestgrid::engine
