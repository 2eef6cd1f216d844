// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// The box of some vectors. Its bits do not depend on their order.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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
    /// The distance of the two farthest corners; 0 for an empty box.
    double diagonal() const {
        if (low_[0] > high_[0]) return 0;
        Point side;
        for (std::size_t d = 0; d < 3; ++d) side[d] = double{high_[d]} - double{low_[d]};
        return norm(side);
    }

private:
    static constexpr float infinity_ = std::numeric_limits<float>::infinity();
    std::array<float, 3> low_{infinity_, infinity_, infinity_};
    std::array<float, 3> high_{-infinity_, -infinity_, -infinity_};
};

}  // namespace nestgrid::engine
