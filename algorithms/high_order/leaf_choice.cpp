// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/leaf_choice.hpp>

#include <algorithm>
#include <bit>

namespace nestgrid::engine {

void look_around(std::span<const BaseElement> way, std::span<const Place> points,
                 const LookAround& function) {
    std::vector<std::array<Place, 4>> seen(way.size());  // from each element on the way
    const std::size_t last = way.size() - 1;
    std::copy(points.begin(), points.end(), seen[last].begin());
    for (std::size_t j = last; j > 0; --j) {
        const BaseElement& father = way[j - 1];
        const Rule& rule = *father.member->rule;
        const Child& child = rule.children[way[j].number];
        for (std::size_t i = 0; i < points.size(); ++i) {
            seen[j - 1][i] =
                father.shape->in_father(rule, child, seen[j][i], static_cast<int>(last - j));
        }
    }
    for (std::size_t j = 0; j <= last; ++j) {
        const BaseElement& e = way[j];
        const int level = static_cast<int>(last - j);
        FaceMask faces = ~FaceMask{0};
        for (std::size_t i = 0; i < points.size(); ++i)
            faces &= e.shape->faces_at(seen[j][i], level);
        const int part = e.shape->part_in(faces);
        if (part < 0) continue;
        const auto at = std::span<const Place>(seen[j]).first(points.size());
        if (function(e, static_cast<std::size_t>(part), at, level)) return;
    }
}

LeafChoice::LeafChoice(const BaseWalk& walk, const Chooses& chooses, Needs needs) : all_{!chooses} {
    std::size_t number = 0;
    walk.for_each([&](Task*, std::span<const BaseElement> way) {
        const BaseElement& e = way.back();
        if (e.member->rule != nullptr) return;
        if (!all_ && !chooses(number++, e.path)) return;
        number_.insert(e.path, static_cast<std::uint32_t>(number_.size()));
        if (!all_ && needs == Needs::records) mark_parts(way);
    });
    mark_corners();
}

/// Marks where the records of the last element on the way, a leaf, may lie.
void LeafChoice::mark_parts(std::span<const BaseElement> way) {
    const ShapeParts& shape = *way.back().shape;
    for (const ShapePart& part : shape.parts) {
        std::array<Place, 3> frame;
        const std::size_t count = frame_size(part);
        for (std::size_t i = 0; i < count; ++i) frame[i] = shape.reference_corner(part.corner[i]);
        look_around(way, std::span<const Place>(frame).first(count),
                    [&](const BaseElement& e, std::size_t number, auto, int) {
                        const ShapePart& around = e.shape->parts[number];
                        if (!parts_.insert(part_key(e.key, around), none).second) return false;
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
