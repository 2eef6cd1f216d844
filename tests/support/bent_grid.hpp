// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A grid with true positions of new nodes.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <nestgrid/rule.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// A grid whose new nodes lie beside the means of their parents.
template <class Base>
class Bent : public Base {
public:
    explicit Bent(const Base& grid) : Base(grid), straight_{grid.node_positions()} {}

    void new_positions(const typename Base::Element& e, NodeMask which, std::span<Point> out,
                       typename Base::Context& context) const {
        const auto nodes = this->new_nodes(e, context);
        for (std::size_t n = 0; n < out.size(); ++n) {
            const Point& x = straight_[nodes[n]];
            const double bend = 0.02 * std::sin(7 * x[0] + 5 * x[1] + 3 * x[2]);
            if ((which >> n & 1U) != 0) out[n] = x + bend * Point{1, -1, x[2] == 0 ? 0.0 : 1.0};
        }
    }

private:
    std::vector<Point> straight_;
};

}  // namespace nestgrid_test
