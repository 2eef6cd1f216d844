// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/leaf_ranges.hpp>

namespace nestgrid::engine {

LinearColour::LinearColour(const FlatTriangle& triangle, const std::array<double, 3>& at_corners)
    : at_first{at_corners[0]},
      slope{triangle.gradient(at_corners)},
      least{std::min({at_corners[0], at_corners[1], at_corners[2]})},
      greatest{std::max({at_corners[0], at_corners[1], at_corners[2]})} {}

LeafRanges::LeafRanges(const NearLeaves& leaves) : components_{leaves.components()} {
    std::vector<Range> below;
    for (const NearLeaf& leaf : leaves.leaves()) {
        for (std::size_t c = 0; c < components_; ++c) {
            Range range;
            for (const std::uint32_t node : leaves.nodes(leaf)) {
                range.least = std::min(range.least, leaves.value(node, c));
                range.greatest = std::max(range.greatest, leaves.value(node, c));
            }
            below.push_back(range);
        }
    }
    do {
        const std::size_t count = below.size() / components_;
        std::vector<Range> groups((count + BoxTree::fan - 1) / BoxTree::fan * components_);
        for (std::size_t i = 0; i < below.size(); ++i) {
            Range& range = groups[i / components_ / BoxTree::fan * components_ + i % components_];
            range.least = std::min(range.least, below[i].least);
            range.greatest = std::max(range.greatest, below[i].greatest);
        }
        levels_.push_back(groups);
        below = std::move(groups);
    } while (below.size() > BoxTree::fan * components_);
}

bool LeafRanges::keeps(std::size_t level, std::size_t group, const Box& box, const Point& first,
                       std::span<const LinearColour> colours) const {
    for (std::size_t c = 0; c < components_; ++c) {
        const LinearColour& colour = colours[c];
        double middle = colour.at_first;
        double reach = 0;
        for (std::size_t d = 0; d < 3; ++d) {
            middle += colour.slope[d] * (0.5 * (box.low[d] + box.high[d]) - first[d]);
            reach += std::abs(colour.slope[d]) * 0.5 * (box.high[d] - box.low[d]);
        }
        // A triangle without area has no slope that is a number, and no box keeps it.
        const double least = std::max(middle - reach, colour.least);
        const double greatest = std::min(middle + reach, colour.greatest);
        const Range& range = levels_[level][group * components_ + c];
        if (!(middle == middle && greatest - range.least <= 1 && range.greatest - least <= 1)) {
            return false;
        }
    }
    return true;
}

}  // namespace nestgrid::engine
