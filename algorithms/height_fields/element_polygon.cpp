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

template <class Real>
auto ElementPolygon<Real>::vertex(NodeKey key, const Point& x, std::span<const double> values)
    -> Number {
    return surface_->vertex_between({key, key}, [&] {
        return SurfaceCut{shape_.lifted(x, values[0]), {key, key}, 0, values};
    });
}

/// Makes vertices of the nodes strictly inside an edge.
/// \param from the corner at which the chain begins
template <class Real>
void ElementPolygon<Real>::take_nodes(const EdgeNodes& nodes, std::size_t from, std::size_t edge,
                                      std::vector<Number>& chain) {
    const ElementSide side = element_.side(edge);
    for (const EdgeNode& node : side.inside(nodes)) {
        chain.push_back(vertex(node.key, node.x, nodes.values(node)));
    }
    if (side.rises() != (side.corner[0] == from)) std::ranges::reverse(chain);
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
void ElementPolygon<Real>::draw(const EdgeNodes* nodes, DrawnSurface<3>& surface) {
    surface_ = &surface;
    const View& view = element_.view();
    const std::size_t n = view.corner_count();
    auto loop = loop_of(n);
    if (view.orientation < 0) std::reverse(loop.begin() + 1, loop.begin() + std::ptrdiff_t(n));
    surface.builder().add_element(view.element(), view.shape, view.level);
    const unsigned boundary = element_.boundary();
    for (std::size_t i = 0; i < n; ++i) {
        number_[i] = vertex(element_.keys()[loop[i]], element_.positions()[loop[i]],
                            element_.values(loop[i]));
    }
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t next = (i + 1) % n;
        const std::size_t edge = edge_between(view.shape, loop[i], loop[next]);
        between_[i].clear();
        if (nodes != nullptr) take_nodes(*nodes, loop[i], edge, between_[i]);
        if ((boundary >> edge & 1U) != 0) add_boundary(number_[i], between_[i], number_[next]);
    }
    add_triangles(n);
}

template <class Real>
void ElementPolygon<Real>::add_triangles(std::size_t sides) {
    ContourFilling<ElementPolygon> filling(*this);
    const auto& v = number_;
    const auto& on = between_;
    centred_ = false;
    if (sides == 3) return filling.add(v[0], v[1], v[2], on[0], on[1], on[2]);
    const auto x = four_corners();
    const auto [one, other] = dividing_diagonals(x);
    if (one && other && needs_centre()) {
        centred_ = true;
        const Number centre = add_centre();
        for (std::size_t i = 0; i < 4; ++i) filling.add(v[i], v[(i + 1) % 4], centre, on[i]);
        return;
    }
    const std::size_t a =
        one != other ? (one ? 0U : 1U) : shorter_diagonal(x, at_corners(0), shape_);
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
auto ElementPolygon<Real>::add_centre() -> Number {
    const auto mean = [](const auto& at) { return face_mean(at(0U), at(1U), at(2U), at(3U)); };
    const auto& corners = element_.positions();
    Point x;
    for (std::size_t d = 0; d < 3; ++d) x[d] = mean([&](std::size_t k) { return corners[k][d]; });
    for (std::size_t c = 0; c < at_centre_.size(); ++c) {
        at_centre_[c] = mean([&](std::size_t k) { return element_.u(k, c); });
    }
    x = shape_.lifted(x, at_centre_[0]);
    return surface_->add_unnamed(std::span(&x, 1), at_centre_);
}

template <class Real>
double ElementPolygon<Real>::chord(bool nested) const {
    if (element_.view().corner_count() != 4) return 0;
    return quadrilateral_chord(four_corners(), at_corners(0), nested, centred_);
}

template class ElementPolygon<float>;
template class ElementPolygon<double>;

}  // namespace nestgrid::engine
