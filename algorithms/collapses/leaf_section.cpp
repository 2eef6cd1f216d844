// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/leaf_section.hpp>

namespace nestgrid::engine {

namespace {

/// A face of a reference element: constant + factor . s is 0 on it and positive inside.
struct ReferenceFace {
    double constant;
    Point factor;
};

constexpr std::array<ReferenceFace, 4> tetrahedron_faces{
    {{1, {-1, -1, -1}}, {0, {1, 0, 0}}, {0, {0, 1, 0}}, {0, {0, 0, 1}}}};
constexpr std::array<ReferenceFace, 5> prism_faces{
    {{0, {0, 0, 1}}, {1, {0, 0, -1}}, {0, {0, 1, 0}}, {1, {-1, -1, 0}}, {0, {1, 0, 0}}}};
constexpr std::array<ReferenceFace, 6> hexahedron_faces{{{0, {1, 0, 0}},
                                                         {1, {-1, 0, 0}},
                                                         {0, {0, 1, 0}},
                                                         {1, {0, -1, 0}},
                                                         {0, {0, 0, 1}},
                                                         {1, {0, 0, -1}}}};

/// Numbered as in Topology.
std::span<const ReferenceFace> faces_of(Shape shape) {
    if (shape == Shape::tetrahedron) return tetrahedron_faces;
    if (shape == Shape::prism) return prism_faces;
    return hexahedron_faces;
}

/// By how much, in reference coordinates, rounding may move a corner off a face.
constexpr double rounding = 1e-10;

/// Cuts off what is outside a face.
/// \param g distance of the triangle's corners from the face
/// \return whether anything was cut off
bool clip(LeafSection& section, const std::array<double, 3>& g) {
    const auto old = section.corner;
    const std::size_t count = section.count;
    const auto at = [&](const LeafSection::Corner& c) {
        return c[0] * g[0] + c[1] * g[1] + c[2] * g[2];
    };
    section.count = 0;
    bool cut = false;
    for (std::size_t i = 0; i < count; ++i) {
        const LeafSection::Corner& a = old[i];
        const LeafSection::Corner& b = old[i + 1 < count ? i + 1 : 0];
        const double here = at(a);
        const double next = at(b);
        if (here >= 0)
            section.corner[section.count++] = a;
        else
            cut = true;
        if ((here >= 0) == (next >= 0)) continue;
        const double t = here / (here - next);
        section.corner[section.count++] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
                                           a[2] + t * (b[2] - a[2])};
    }
    return cut;
}

double area_of(const LeafSection& section) {
    double twice = 0;
    const auto& [a0, a1, a2] = section.corner[0];
    for (std::size_t i = 2; i < section.count; ++i) {
        const auto& [b0, b1, b2] = section.corner[i - 1];
        const auto& [c0, c1, c2] = section.corner[i];
        twice += (b0 - a0) * (c1 - a1) - (b1 - a1) * (c0 - a0);
    }
    return std::abs(twice);  // a triangle has the area 1 / 2 in these coordinates
}

}  // namespace

AffineLeaf::AffineLeaf(Shape shape, std::span<const Point> corners)
    : shape_{shape}, origin_{corners[0]} {
    const std::size_t up = shape == Shape::hexahedron ? 4 : 3;
    const Point a = corners[1] - origin_;
    const Point b = corners[2] - origin_;
    const Point c = corners[up] - origin_;
    row_ = {cross(b, c), cross(c, a), cross(a, b)};
    const double inverse = 1 / dot(a, row_[0]);
    for (Point& row : row_) row = inverse * row;
}

double AffineLeaf::from_face(std::size_t face, const Point& s) const {
    const ReferenceFace& f = faces_of(shape_)[face];
    return f.constant + dot(f.factor, s);
}

Point AffineLeaf::face_direction(std::size_t face) const {
    const auto& [x, y, z] = faces_of(shape_)[face].factor;
    return x * row_[0] + y * row_[1] + z * row_[2];
}

LeafSection cut_out(const AffineLeaf& leaf, Shape shape, unsigned boundary, const Triangle& x) {
    LeafSection section;
    for (std::size_t i = 0; i < 3; ++i) section.reference[i] = leaf.reference(x[i]);
    const std::size_t faces = faces_of(shape).size();
    std::array<std::array<double, 3>, max_faces> from{};
    double part = 1;
    for (std::size_t f = 0; f < faces; ++f) {
        int outside = 0;
        int on = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            double& g = from[f][i];
            g = leaf.from_face(f, section.reference[i]);
            if (std::abs(g) < rounding) g = 0;
            outside += g < 0 ? 1 : 0;
            on += g == 0 ? 1 : 0;
        }
        if (outside == 3 || (outside > 0 && outside + on == 3)) return section;
        if (on == 3 && (boundary >> f & 1U) == 0) part = 0.5;
    }
    section.corner[0] = {1, 0, 0};
    section.corner[1] = {0, 1, 0};
    section.corner[2] = {0, 0, 1};
    section.count = 3;
    // Faces on the boundary come last, so that what they cut off is in no other leaf.
    for (const unsigned last : {0U, 1U}) {
        for (std::size_t f = 0; f < faces && section.count > 0; ++f) {
            if ((boundary >> f & 1U) != last) continue;
            const auto& g = from[f];
            if (g[0] >= 0 && g[1] >= 0 && g[2] >= 0) continue;
            const bool cut = clip(section, g);
            section.leaves_domain = section.leaves_domain || (last == 1 && cut);
        }
    }
    if (section.count > 2) section.area = part * area_of(section);
    return section;
}

}  // namespace nestgrid::engine
