// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/lens_sizes.hpp>

#include <algorithm>

#include <nestgrid/error.hpp>

namespace nestgrid::engine {

LeafCorners::LeafCorners(const BaseWalk& walk) {
    const auto add = [&](Task*, std::span<const BaseElement> way) {
        const BaseElement& e = way.back();
        if (e.member->rule != nullptr) return;
        Leaf& leaf = leaves_.emplace_back();
        leaf.shape = e.shape->shape;
        for (std::size_t k = 0; k < max_corners; ++k) {
            // The upper face of a pyramid's box is its apex.
            const std::size_t corner =
                leaf.shape == Shape::pyramid ? std::min<std::size_t>(k, 4) : k;
            if (corner >= e.shape->corners) break;
            const std::size_t at = net_corner(1, e.shape->factors, k);
            for (std::size_t d = 0; d < 3; ++d) leaf.net[d][at] = e.x[corner][d];
        }
    };
    walk.for_each(add, BaseWalk::Positions::yes);
}

std::span<const Point> LeafCorners::positions(std::size_t leaf, std::span<const Place> points,
                                              int level,
                                              std::array<Point, max_corners>& room) const {
    std::transform(points.begin(), points.end(), room.begin(),
                   [&](const Place& point) { return position(leaf, point, level); });
    return std::span(room).first(points.size());
}

Point LeafCorners::position(std::size_t leaf, const Place& at, int level) const {
    const Leaf& of = leaves_[leaf];
    Point local = point_at(at, level);
    if (of.shape == Shape::pyramid) local = collapsed(local);
    Point x;
    for (std::size_t d = 0; d < 3; ++d) {
        x[d] = net_value(of.net[d].data(), 1, parts_of(of.shape).factors, local);
    }
    return x;
}

bool RegionParts::has(std::size_t leaf, std::span<const Place> corners, int level) const {
    std::array<Point, max_corners> room;
    const auto x = corners_->positions(leaf, corners, level, room);
    const double near = share * diameter_of(x);
    return std::any_of(x.begin(), x.end(),
                       [&](const Point& at) { return region_.distance(at) <= near; });
}

LensSizes::LensSizes(const LensRequest& lens, const LeafCorners& corners)
    : lens_{lens}, share_{std::max(1.0, 3.125 * lens.slope)}, corners_{&corners} {
    if (lens.finest > 0 && lens.finest <= lens.coarsest) return;
    throw InvalidInput(
        "a lens on data of higher degree says how large elements are in it: 0 < finest <= "
        "coarsest");
}

double LensSizes::greatest_size(const Point& x) const {
    const double distance = std::max(lens_.distance(x), 0.0);
    return std::min(lens_.coarsest, lens_.finest + lens_.slope * distance);
}

bool LensSizes::is_fine(std::size_t leaf, std::span<const Place> corners, int level) const {
    std::array<Point, max_corners> room;
    const auto x = corners_->positions(leaf, corners, level, room);
    const double diameter = diameter_of(x);
    return std::all_of(x.begin(), x.end(),
                       [&](const Point& at) { return share_ * diameter <= greatest_size(at); });
}

/// What an element that stops has on its faces is smaller than it, and as near to the node, so that
/// with T at the node less by slope times the size of the element it is fine.
bool LensSizes::may_stop(double size, const Point& node) const {
    return (1.1 * share_ + lens_.slope) * size <= greatest_size(node);
}

}  // namespace nestgrid::engine
