// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How far what lies below elements reaches beyond the boxes of their corners.
//
// An element lies in the convex hull of its corners, because shape functions are not negative and
// add up to 1. Where eq. (1) holds for positions all nodes below lie in that hull, too, and nothing
// reaches beyond. Elsewhere a hierarchy may tell it with each element (InnerBounds::beyond_hull),
// or one walk under the criterion looks at all positions. What is kept is the greatest reach on
// each level below each coarse element: a point in an element lies within that reach of the box of
// every element above.
#pragma once

#include <optional>
#include <vector>

#include <nestgrid/algorithms/criterion.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

class Reach {
public:
    /// For grids on which no element reaches beyond its corners.
    Reach() = default;
    /// Walks the whole grid.
    /// \param walk must carry positions and what the criterion wants; what it places counts, too
    template <class Real>
    Reach(const Walk<Real>& walk, const Criterion& criterion);
    /// Of coarse elements alone, by what the hierarchy tells of them; nothing where it does not.
    template <class Real>
    static std::optional<Reach> told(const Hierarchy<Real>& hierarchy);

    /// The reach below an element, which is told with it or that of its level.
    template <class Real>
    double beyond(const ElementView<Real>& view) const {
        const float told = view.inner_bounds().beyond_hull;
        return told >= 0 ? static_cast<double>(told) : beyond(view.coarse, view.level);
    }
    /// The reach below the elements on a level below a coarse element.
    double beyond(std::size_t coarse, int level) const {
        if (first_.empty()) return 0;
        const std::size_t at = first_[coarse] + static_cast<std::size_t>(level);
        return at < first_[coarse + 1] ? of_level_[at] : 0;
    }

private:
    std::vector<std::size_t> first_;  // of each coarse element, in of_level_; empty: 0 everywhere
    std::vector<double> of_level_;
};

}  // namespace nestgrid::engine
