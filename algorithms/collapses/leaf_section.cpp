// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/leaf_section.hpp>

namespace nestgrid::engine {

namespace {

/// By how much, in reference coordinates, rounding may move a corner off a face.
constexpr double rounding = 1e-10;
/// By how much a triangle may leave the plane of a leaf of dimension 2.
constexpr double off_plane = 1e-6;

}  // namespace

/// Cuts off what is outside a face. \return whether anything was
bool LeafSection::clip(const Distances& g) {
    if (g[0] >= 0 && g[1] >= 0 && g[2] >= 0) return false;
    const Polygon& old = *corner_;
    const std::size_t count = count_;
    corner_ = corner_ == room_.data() ? &room_[1] : room_.data();
    count_ = 0;
    const auto distance = [&](const Corner& c) { return c[0] * g[0] + c[1] * g[1] + c[2] * g[2]; };
    bool cut = false;
    double here = distance(old[0]);
    for (std::size_t i = 0; i < count; ++i) {
        const Corner& a = old[i];
        const Corner& b = old[i + 1 < count ? i + 1 : 0];
        const double next = distance(b);
        if (here >= 0)
            (*corner_)[count_++] = a;
        else
            cut = true;
        if ((here >= 0) != (next >= 0)) {
            const double t = here / (here - next);
            (*corner_)[count_++] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
                                    a[2] + t * (b[2] - a[2])};
        }
        here = next;
    }
    return cut;
}

bool LeafSection::cut(const NearLeaf& leaf, const AffineLeaf& map, const Triangle& x) {
    count_ = 0;
    leaves_domain_ = false;
    part_ = 1;
    const std::size_t faces = topology(leaf.shape).faces;
    std::array<Distances, max_faces> from;
    for (std::size_t i = 0; i < 3; ++i) {
        reference_[i] = map.reference(x[i]);
        const auto distance = face_distances(leaf.shape, reference_[i]);
        for (std::size_t f = 0; f < faces; ++f) from[f][i] = distance[f];
    }
    if (topology(leaf.shape).dimension == 2) {
        for (const Point& s : reference_) {
            if (!(std::abs(s[2]) <= off_plane)) return false;
        }
    }
    for (std::size_t f = 0; f < faces; ++f) {
        const auto& [a, b, c] = from[f];
        if (a < rounding && b < rounding && c < rounding &&
            (a < -rounding || b < -rounding || c < -rounding)) {
            return false;
        }
    }
    for (std::size_t f = 0; f < faces; ++f) {
        bool in_face = true;
        for (double& g : from[f]) {
            if (std::abs(g) < rounding) g = 0;
            in_face = in_face && g == 0;
        }
        if (in_face && (leaf.boundary >> f & 1U) == 0) part_ = 0.5;
    }
    (*corner_)[0] = {1, 0, 0};
    (*corner_)[1] = {0, 1, 0};
    (*corner_)[2] = {0, 0, 1};
    count_ = 3;
    for (std::size_t f = 0; f < faces && count_ > 0; ++f) {
        if ((leaf.boundary >> f & 1U) == 0) clip(from[f]);
    }
    // Faces on the boundary come last: what they cut off is in no other leaf.
    for (std::size_t f = 0; leaf.boundary != 0 && f < faces && count_ > 0; ++f) {
        if ((leaf.boundary >> f & 1U) != 0 && clip(from[f])) leaves_domain_ = true;
    }
    return count_ > 0;
}

double LeafSection::area() const {
    if (count_ < 3) return 0;
    double twice = 0;
    const auto& [a0, a1, a2] = (*corner_)[0];
    for (std::size_t i = 2; i < count_; ++i) {
        const auto& [b0, b1, b2] = (*corner_)[i - 1];
        const auto& [c0, c1, c2] = (*corner_)[i];
        twice += (b0 - a0) * (c1 - a1) - (b1 - a1) * (c0 - a0);
    }
    return part_ * std::abs(twice);  // the triangle has the area 1 / 2 in these coordinates
}

}  // namespace nestgrid::engine
