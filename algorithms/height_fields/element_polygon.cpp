// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <height_fields/element_polygon.hpp>

#include <algorithm>

#include <contours/contour_filling.hpp>
#include <nestgrid/detail/mean.hpp>

namespace nestgrid::engine {

namespace {

/// The corners of an element counterclockwise, where it is not mirrored.
std::array<std::size_t, 4> loop_of(std::size_t corners) {
    return corners == 3 ? std::array<std::size_t, 4>{0, 1, 2, 0}
                        : std::array<std::size_t, 4>{0, 1, 3, 2};
}

}  // namespace

/// The corners of the loaded element counterclockwise.
template <class Real>
std::array<std::size_t, 4> ElementPolygon<Real>::loop() const {
    const std::size_t n = element_.view().corner_count();
    auto loop = loop_of(n);
    if (element_.view().orientation < 0) {
        std::reverse(loop.begin() + 1, loop.begin() + std::ptrdiff_t(n));
    }
    return loop;
}

template <class Real>
Polygon ElementPolygon<Real>::polygon() const {
    const View& view = element_.view();
    const std::size_t n = view.corner_count();
    Polygon polygon;
    polygon.shape = view.shape;
    polygon.level = static_cast<std::uint16_t>(view.level);
    polygon.sides = static_cast<std::uint8_t>(n);
    if (const unsigned boundary = element_.boundary(); boundary != 0) {
        const auto at = loop();
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t edge = edge_between(view.shape, at[i], at[(i + 1) % n]);
            polygon.boundary |= static_cast<std::uint8_t>((boundary >> edge & 1U) << i);
        }
    }
    if (n == 3) return polygon;
    const auto x = four_corners();
    const auto [one, other] = dividing_diagonals(x);
    polygon.centred = one && other && needs_centre();
    const std::size_t shorter =
        one != other ? (one ? 0U : 1U) : shorter_diagonal(x, at_corners(0), shape_);
    polygon.diagonal = static_cast<std::uint8_t>(shorter);
    return polygon;
}

template <class Real>
PolygonSides ElementPolygon<Real>::sides(Polygon& polygon) const {
    const auto at = loop();
    PolygonSides sides;
    for (std::size_t i = 0; i < polygon.sides; ++i) {
        polygon.key[i] = element_.keys()[at[i]];
        const std::size_t edge = edge_between(polygon.shape, at[i], at[(i + 1) % polygon.sides]);
        if (element_.view().closed.edge(edge) == nullptr) continue;
        polygon.within |= static_cast<std::uint8_t>(1U << i);
        const ElementSide side = element_.side(edge);
        sides[i] = {side.around, side.place};
        if (side.corner[0] != at[i]) std::swap(sides[i].place[0], sides[i].place[1]);
    }
    return sides;
}

template <class Real>
auto ElementPolygon<Real>::vertex(NodeKey key, const Point& x, std::span<const double> values,
                                  DrawnSurface<3>& surface) const -> Number {
    return surface.vertex_between({key, key}, [&] {
        return SurfaceCut{shape_.lifted(x, values[0]), {key, key}, 0, values};
    });
}

template <class Real>
void ElementPolygon<Real>::put_vertices(Polygon& polygon, DrawnSurface<3>& surface) {
    const auto at = loop();
    for (std::size_t i = 0; i < polygon.sides; ++i) {
        polygon.vertex[i] = vertex(element_.keys()[at[i]], element_.positions()[at[i]],
                                   element_.values(at[i]), surface);
    }
    if (polygon.centred) polygon.centre = add_centre(surface);
}

template <class Real>
void ElementPolygon<Real>::add_boundary(Number from, const std::vector<Number>& between,
                                        Number to) {
    for (const Number next : between) {
        surface_->builder().add_boundary({from, next});
        from = next;
    }
    surface_->builder().add_boundary({from, to});
}

template <class Real>
void ElementPolygon<Real>::draw(const Polygon& polygon, const Handle& element,
                                const NodesOnSides* nodes, DrawnSurface<3>& surface) {
    surface_ = &surface;
    surface.builder().add_element(element, polygon.shape, polygon.level);
    for (std::size_t i = 0; i < polygon.sides; ++i) {
        std::vector<Number>& chain = between_[i];
        chain.clear();
        if (nodes != nullptr) {
            for (const EdgeNode& node : nodes->inside(i)) {
                chain.push_back(vertex(node.key, node.x, nodes->nodes.values(node), surface));
            }
            const auto& place = nodes->sides[i].place;
            if (place[0] > place[1]) std::ranges::reverse(chain);
        }
        if ((polygon.boundary >> i & 1U) != 0) {
            add_boundary(polygon.vertex[i], chain, polygon.vertex[(i + 1) % polygon.sides]);
        }
    }
    add_triangles(polygon);
}

template <class Real>
void ElementPolygon<Real>::add_triangles(const Polygon& polygon) {
    ContourFilling<ElementPolygon> filling(*this);
    const auto& v = polygon.vertex;
    const auto& on = between_;
    if (polygon.sides == 3) return filling.add(v[0], v[1], v[2], on[0], on[1], on[2]);
    if (polygon.centred) {
        for (std::size_t i = 0; i < 4; ++i) {
            filling.add(v[i], v[(i + 1) % 4], polygon.centre, on[i]);
        }
        return;
    }
    const std::size_t a = polygon.diagonal;
    const std::size_t c = a + 2;
    const std::size_t d = (a + 3) % 4;
    filling.add(v[a], v[a + 1], v[c], on[a], on[a + 1]);
    filling.add(v[c], v[d], v[a], on[c], on[d]);
}

template <class Real>
bool ElementPolygon<Real>::needs_centre() const {
    for (std::size_t c = 0; c < at_centre_.size(); ++c) {
        if (twist(at_corners(c)) > shape_.flatness) return true;
    }
    return false;
}

/// Adds a vertex in the middle of a quadrilateral.
template <class Real>
auto ElementPolygon<Real>::add_centre(DrawnSurface<3>& surface) -> Number {
    const auto mean = [](const auto& at) { return face_mean(at(0U), at(1U), at(2U), at(3U)); };
    const auto& corners = element_.positions();
    Point x;
    for (std::size_t d = 0; d < 3; ++d) x[d] = mean([&](std::size_t k) { return corners[k][d]; });
    for (std::size_t c = 0; c < at_centre_.size(); ++c) {
        at_centre_[c] = mean([&](std::size_t k) { return element_.u(k, c); });
    }
    x = shape_.lifted(x, at_centre_[0]);
    return surface.add_unnamed(std::span(&x, 1), at_centre_);
}

template <class Real>
double ElementPolygon<Real>::chord(const Polygon& polygon, bool nested) const {
    if (polygon.sides != 4) return 0;
    return quadrilateral_chord(four_corners(), at_corners(0), nested, polygon.centred);
}

template class ElementPolygon<float>;
template class ElementPolygon<double>;

}  // namespace nestgrid::engine
