// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/leaf_choice.hpp>

#include <algorithm>
#include <bit>

namespace nestgrid::engine {

LeafChoice::LeafChoice(const BaseWalk& walk, const Chooses& chooses, Needs needs) : all_{!chooses} {
    std::size_t number = 0;
    walk.for_each([&](Task*, std::span<const BaseElement> way) {
        const BaseElement& e = way.back();
        if (e.member->rule != nullptr) return;
        if (!all_ && !chooses(number++, e)) return;
        number_.insert(e.path, static_cast<std::uint32_t>(number_.size()));
        if (!all_ && needs == Needs::records) mark_parts(way);
    });
    mark_corners();
}

/// Marks where the records of the last element on the way, a leaf, may lie.
void LeafChoice::mark_parts(std::span<const BaseElement> way) {
    for (std::size_t part = 0; part < way.back().shape->parts.size(); ++part) {
        look_around(way, part, [&](std::size_t level, std::size_t number) {
            const BaseElement& e = way[level];
            const ShapePart& around = e.shape->parts[number];
            if (!parts_.insert(part_keys(e.key, *e.shape)[number], none).second) return false;
            for (std::size_t i = 0; i < around.count; ++i) {
                corners_.push_back(e.key[around.corner[i]]);
            }
            return false;
        });
    }
}

void LeafChoice::mark_corners() {
    may_be_corner_.resize(std::bit_ceil(8 * corners_.size() + 1));
    for (const NodeKey key : corners_) {
        may_be_corner_[static_cast<std::size_t>(hash(key)) & (may_be_corner_.size() - 1)] = true;
    }
    corners_ = {};
}

bool LeafChoice::may_have_record(const BaseElement& leaf) const {
    if (parts_.size() == 0) return false;
    std::size_t count = 0;
    for (std::size_t k = 0; k < leaf.shape->corners; ++k) {
        const auto at = static_cast<std::size_t>(hash(leaf.key[k]));
        count += may_be_corner_[at & (may_be_corner_.size() - 1)] ? 1U : 0U;
    }
    return count >= 2;  // an edge has two
}

void LeafChoice::finish() {
    parts_ = {};
    may_be_corner_ = {};
}

}  // namespace nestgrid::engine
