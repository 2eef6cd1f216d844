// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <walk/walk.hpp>

namespace nestgrid_test {

/// Walks a whole hierarchy and counts its leaves.
template <class Real>
std::size_t count_leaves(const nestgrid::engine::Walk<Real>& walk) {
    using View = nestgrid::engine::ElementView<Real>;
    struct Count final : nestgrid::engine::Visitor<Real> {
        std::size_t leaves = 0;
        nestgrid::engine::Decision inspect(const View&, const nestgrid::engine::Split&) override {
            return {};
        }
        void extract(const View&) override { ++leaves; }
    } count;
    walk.run(count);
    return count.leaves;
}

}  // namespace nestgrid_test
