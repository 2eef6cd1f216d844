// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contacts are sought by geometry alone. A face is taken as the plane polygon (segment) through its
// corners; how far a quadrilateral departs from its plane is added to what may lie between the two.
#include <nestgrid/detail/coarse_boundary.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/container/static_vector.hpp>

#include "box_tree.hpp"

namespace nestgrid::detail {

namespace {

constexpr double tolerance = 1e-6;  // of the size of a face

/// A single face of a coarse element.
struct Face {
    std::size_t element = 0;
    std::uint8_t number = 0;
    std::size_t corners = 0;
    std::array<Point, 4> x{};  // in a loop
    Point middle{};
    Point side{};      // unit length: to where the element is, across the face
    double size = 0;   // the greatest distance of two corners
    double slack = 0;  // how far another face may be away and touch
};

/// A loop of a face that is cut at the sides of another one, in coordinates of its plane. The third
/// one is the height above the plane.
using Loop = boost::container::static_vector<Point, 16>;

Point unit(const Point& x) {
    const double length = norm(x);
    return length > 0 ? (1 / length) * x : x;
}

/// The area vector of a loop.
Point area(const Face& face) {
    const Point across = face.x[2] - face.x[0];
    return face.corners == 4 ? 0.5 * cross(across, face.x[3] - face.x[1])
                             : 0.5 * cross(face.x[1] - face.x[0], across);
}

Face make_face(std::size_t element, std::uint8_t number, const Coarse& coarse) {
    const Topology& t = topology(coarse.shape);
    const FaceTopology& f = t.face[number];
    Face face{element, number, f.corners};
    for (std::size_t k = 0; k < f.corners; ++k) {
        face.x[k] = coarse.corners[f.corner[k]];
        face.middle = face.middle + (1.0 / f.corners) * face.x[k];
        for (std::size_t l = 0; l < k; ++l) {
            face.size = std::max(face.size, norm(face.x[k] - face.x[l]));
        }
    }
    Point inwards{};
    for (std::size_t k = 0; k < t.corners; ++k) {
        inwards = inwards + (1.0 / t.corners) * (coarse.corners[k] - face.middle);
    }
    face.slack = tolerance * face.size;
    if (f.corners == 2) {
        const Point along = unit(face.x[1] - face.x[0]);
        face.side = unit(inwards - dot(inwards, along) * along);
    } else {
        const Point normal = unit(area(face));
        face.side = dot(normal, inwards) < 0 ? -1.0 * normal : normal;
        double departs = 0;
        for (std::size_t k = 0; k < f.corners; ++k) {
            departs = std::max(departs, std::abs(dot(normal, face.x[k] - face.middle)));
        }
        face.slack += departs;
    }
    return face;
}

/// Whether the corners of both faces are at the same places.
bool same_corners(const Face& a, const Face& b) {
    if (a.corners != b.corners) return false;
    const double near = tolerance * std::min(a.size, b.size);
    for (std::size_t k = 0; k < a.corners; ++k) {
        const auto is_there = [&](const Point& x) { return norm(x - a.x[k]) <= near; };
        if (std::find_if(b.x.begin(), b.x.begin() + b.corners, is_there) ==
            b.x.begin() + b.corners) {
            return false;
        }
    }
    return true;
}

/// The part of b's segment that lies on a's.
/// \return its middle, and whether there is one
std::pair<Point, bool> common_segment(const Face& a, const Face& b) {
    const Point along = unit(a.x[1] - a.x[0]);
    const Point across = b.x[1] - b.x[0];
    double from = 0, to = 1;  // of b, between the ends of a
    const double at = dot(along, b.x[0] - a.x[0]);
    const double slope = dot(along, across);
    if (!(std::abs(slope) > 0)) return {};
    const double first = (0 - at) / slope;
    const double second = (norm(a.x[1] - a.x[0]) - at) / slope;
    from = std::max(from, std::min(first, second));
    to = std::min(to, std::max(first, second));
    if (!((to - from) * b.size > 10 * tolerance * std::min(a.size, b.size))) return {};
    for (const double s : {from, to}) {
        const Point x = b.x[0] + s * across - a.x[0];
        if (norm(x - dot(x, along) * along) > a.slack + b.slack) return {};
    }
    return {b.x[0] + (from + to) / 2 * across, true};
}

/// The part of b's polygon that lies on a's.
/// \return the mean of its corners, and whether there is one
std::pair<Point, bool> common_polygon(const Face& a, const Face& b) {
    const Point u = unit(a.x[1] - a.x[0]);
    const Point n = unit(area(a));
    const Point v = cross(n, u);
    const auto in_plane = [&](const Point& x) {
        const Point y = x - a.middle;
        return Point{dot(y, u), dot(y, v), dot(y, n)};
    };
    Loop loop;
    for (std::size_t k = 0; k < b.corners; ++k) loop.push_back(in_plane(b.x[k]));
    for (std::size_t k = 0; k < a.corners && !loop.empty(); ++k) {
        const Point from = in_plane(a.x[k]);
        const Point side = in_plane(a.x[(k + 1) % a.corners]) - from;
        const auto left = [&](const Point& x) {
            return side[0] * (x[1] - from[1]) - side[1] * (x[0] - from[0]);
        };
        Loop cut;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Point& x = loop[i];
            const Point& y = loop[(i + 1) % loop.size()];
            const double s = left(x);
            const double t = left(y);
            if (s >= 0) cut.push_back(x);
            if ((s < 0) != (t < 0) && s != t) cut.push_back(x + s / (s - t) * (y - x));
        }
        loop = cut;
    }
    Point doubled{};
    Point middle{};
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point& x = loop[i];
        doubled = doubled + cross(x - loop[0], loop[(i + 1) % loop.size()] - loop[0]);
        middle = middle + 1.0 / static_cast<double>(loop.size()) * x;
        if (std::abs(x[2]) > a.slack + b.slack) return {};
    }
    const double least = std::min(norm(area(a)), norm(area(b)));
    if (loop.size() < 3 || !(std::abs(doubled[2]) / 2 > 100 * tolerance * least)) return {};
    return {a.middle + middle[0] * u + middle[1] * v + middle[2] * n, true};
}

/// Whether elements on the two faces may lie on different sides: two elements of a surface may also
/// meet at an angle.
bool face_each_other(const Face& a, const Face& b) {
    return dot(a.side, b.side) < (a.corners == 2 ? 0.9 : -0.9);
}

template <class Real>
std::vector<Face> find_faces(const Hierarchy<Real>& hierarchy,
                             std::span<const std::uint8_t> single) {
    const std::unique_ptr<Task> task = hierarchy.open();
    std::vector<Face> faces;
    Coarse coarse;
    Family family;
    for (std::size_t i = 0; i < single.size(); ++i) {
        if (single[i] == 0) continue;
        hierarchy.coarse(task.get(), i, coarse, family);
        for (std::uint8_t f = 0; f < topology(coarse.shape).faces; ++f) {
            if ((single[i] >> f & 1U) == 0) continue;
            const Face face = make_face(i, f, coarse);
            if (face.corners >= 2 && std::isfinite(face.size)) faces.push_back(face);
        }
    }
    return faces;
}

}  // namespace

std::string FaceContact::text() const {
    const auto name = [&](std::size_t side) {
        return "face " + std::to_string(face[side]) + " of coarse element " +
               std::to_string(element[side]);
    };
    return name(0) + " and " + name(1) + ", around " + text_of(place);
}

template <class Real>
std::vector<FaceContact> face_contacts(const Hierarchy<Real>& hierarchy,
                                       std::span<const std::uint8_t> faces) {
    const std::vector<Face> all = find_faces(hierarchy, faces);
    std::vector<BoxTree::Box> boxes;
    for (const Face& face : all) {
        boxes.push_back(BoxTree::around(std::span(face.x).first(face.corners), face.slack));
    }
    BoxTree tree(boxes);
    std::vector<FaceContact> contacts;
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (const std::size_t k : tree.near(boxes[i])) {
            const Face& a = all[i];
            const Face& b = all[k];
            if (k <= i || a.element == b.element || !face_each_other(a, b)) continue;
            const auto [place, touch] =
                a.corners == 2 ? common_segment(a, b) : common_polygon(a, b);
            if (!touch) continue;
            contacts.push_back(
                {{a.element, b.element}, {a.number, b.number}, place, same_corners(a, b)});
        }
    }
    return contacts;
}

template std::vector<FaceContact> face_contacts(const Hierarchy<float>&,
                                                std::span<const std::uint8_t>);
template std::vector<FaceContact> face_contacts(const Hierarchy<double>&,
                                                std::span<const std::uint8_t>);

}  // namespace nestgrid::detail
