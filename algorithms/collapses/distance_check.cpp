// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/distance_check.hpp>

#include <algorithm>

#include <collapses/separated.hpp>

namespace nestgrid::engine {

DomainFaces::DomainFaces(const NearLeaves& leaves) {
    std::array<Point, max_corners> room;
    for (const NearLeaf& leaf : leaves.leaves()) {
        if (leaf.boundary == 0) continue;
        const auto x = leaves.corners(leaf, room);
        const Topology& t = topology(leaf.shape);
        for (std::size_t f = 0; f < t.faces; ++f) {
            if ((leaf.boundary >> f & 1U) == 0) continue;
            const FaceTopology& face = t.face[f];
            for (std::size_t i = 2; i < face.corners; ++i) {
                faces_.push_back({x[face.corner[0]], x[face.corner[i - 1]], x[face.corner[i]]});
                tree_.add(Box::around(faces_.back()));
            }
        }
    }
    tree_.finish();
}

bool DomainFaces::hold(const Tetrahedron& x) const {
    const Box around = Box::around(x);
    return tree_.for_each([&](const Box& box) { return box.meets(around); },
                          [&](std::size_t i) { return separated(x, faces_[i]); });
}

bool DistanceJudge::keeps(const Point& w, std::span<const Triangle> fan,
                          std::span<const std::vector<NearPart>* const> parts) {
    return search_.is_near(w) && keeps_back(fan, parts) &&
           std::none_of(fan.begin(), fan.end(),
                        [&](const Triangle& x) { return search_.far_point(x).has_value(); });
}

bool DistanceJudge::keeps_back(std::span<const Triangle> fan,
                               std::span<const std::vector<NearPart>* const> parts) {
    fan_size_ = fan.size();
    if (given_.size() < fan_size_) given_.resize(fan_size_);
    for (auto& list : given()) list.clear();
    const PartedSurface& whole = check_->whole();
    std::uint32_t last = 0;
    const auto find = [&](const Triangle& x) -> Owner {
        const auto is_owner = [&](std::uint32_t i) { return whole.is_near(x, fan[i]); };
        if (last < fan.size() && is_owner(last)) return {last};
        for (std::uint32_t i = 0; i < fan.size(); ++i) {
            if (is_owner(i)) return {last = i};
        }
        const Point middle = middle_of(x);
        return {Owner::none, std::any_of(fan.begin(), fan.end(), [&](const Triangle& t) {
                    return whole.is_near(middle, t);
                })};
    };
    const auto take = [&](std::uint32_t i, const NearPart& part) { given_[i].push_back(part); };
    for (const auto* list : parts) {
        for (const NearPart& part : *list) {
            if (!whole.give(part, find, take)) return false;
        }
    }
    return true;
}

}  // namespace nestgrid::engine
