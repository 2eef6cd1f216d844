// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/real_nodes.hpp>

#include <algorithm>

namespace nestgrid::engine {

RealNodes::HalvedPart::HalvedPart(const PartOfLeaf& part)
    : leaf{part.leaf},
      level{static_cast<std::uint8_t>(part.level)},
      count{static_cast<std::uint8_t>(part.count)} {
    for (std::size_t i = 0; i < part.count; ++i) {
        for (std::size_t d = 0; d < 3; ++d) {
            corner[i][d] = static_cast<std::int32_t>(part.corner[i][d]);
        }
    }
}

PartOfLeaf RealNodes::part_halved(const RealNode& node) const {
    const HalvedPart& half = parts_[node.halves];
    PartOfLeaf part{half.leaf, half.level, {}, half.count};
    for (std::size_t i = 0; i < half.corner.size(); ++i) {
        std::copy(half.corner[i].begin(), half.corner[i].end(), part.corner[i].begin());
    }
    return part;
}

double RealNodes::offset_bound(NodeKey key) const {
    const RealNode* const node = find(key);
    return node == nullptr ? 0 : static_cast<double>(node->off);
}

/// Virtual nodes are in no table: their elements bring their own bounds (Member::beyond).
double RealNodes::bound(const Rule&, std::span<const NodeKey> keys) const {
    float bound = 0;
    for (const NodeKey key : keys) {
        const RealNode* const node = find(key);
        if (node != nullptr) bound = std::max(bound, node->bound);
    }
    return static_cast<double>(bound);
}

std::size_t RealNodes::memory_bytes() const {
    return nodes_.capacity() * sizeof(RealNode) + parts_.capacity() * sizeof(HalvedPart) +
           values_.capacity() * sizeof(double) + number_.memory_bytes();
}

}  // namespace nestgrid::engine
