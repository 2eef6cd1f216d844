// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <graphs/element_polygon.hpp>

#include <algorithm>
#include <cmath>

#include <contours/contour_filling.hpp>
#include <nestgrid/detail/mean.hpp>

namespace nestgrid::engine {

namespace {

/// The corners of an element counterclockwise, where it is not mirrored.
std::array<std::size_t, 4> loop_of(std::size_t corners) {
    return corners == 3 ? std::array<std::size_t, 4>{0, 1, 2, 0}
                        : std::array<std::size_t, 4>{0, 1, 3, 2};
}

/// -1 where a is less than b, 1 where it is greater, 0 where they differ by rounding only.
int compare(double a, double b) {
    constexpr double rounding = 1e-12;
    if (std::abs(a - b) <= rounding * std::max(std::abs(a), std::abs(b))) return 0;
    return a < b ? -1 : 1;
}

double squared_distance(const Point& a, const Point& b) { return dot(b - a, b - a); }

}  // namespace

template <class Real>
void ElementPolygon<Real>::load(const View& view) {
    view_ = &view;
    walk_->corners(view, key_.data(), x_.data());
}

template <class Real>
auto ElementPolygon<Real>::side(std::size_t edge) const -> Side {
    const auto [a, b] = view_->topology().edge[edge];
    const MaximalEdge<Real>* const maximal = view_->closed.edge(edge);
    if (maximal == nullptr) return {{a, b}, {key_[a], key_[b]}, true};
    Side side{{a, b}, {maximal->key(0), maximal->key(1)}, false};
    auto [from, to] = walk_->positions(*maximal);
    if (maximal->key(0) != side.around.low) std::swap(from, to);
    for (std::size_t i = 0; i < 2; ++i) {
        side.place[i] = dot(x_[side.corner[i]] - from, to - from);
    }
    return side;
}

template <class Real>
std::span<const double> ElementPolygon<Real>::values(std::size_t corner) {
    for (std::size_t c = 0; c < components_; ++c) values_[c] = u(corner, c);
    return values_;
}

template <class Real>
void ElementPolygon<Real>::record(EdgeNodes& nodes) {
    for (std::size_t e = 0; e < view_->topology().edges; ++e) {
        if (view_->closed.edge(e) == nullptr) continue;
        const Side at = side(e);
        const std::size_t end = at.place[0] < at.place[1] ? 1 : 0;
        const std::size_t corner = at.corner[end];
        if (key_[corner] == at.around.low || key_[corner] == at.around.high) continue;
        nodes.add({at.around, at.place[end], key_[corner], x_[corner], 0}, values(corner));
    }
}

template <class Real>
Point ElementPolygon<Real>::lifted(Point x, double u) const {
    if (shape_.lift != 0) x[2] += shape_.lift * u;
    return x;
}

template <class Real>
auto ElementPolygon<Real>::vertex(NodeKey key, const Point& x, std::span<const double> values)
    -> Number {
    return surface_->vertex_between({key, key}, [&] {
        return SurfaceCut{lifted(x, values[0]), {key, key}, 0, values};
    });
}

/// Makes vertices of the nodes strictly inside an edge.
/// \param from the corner at which the chain begins
template <class Real>
void ElementPolygon<Real>::take_nodes(const EdgeNodes& nodes, std::size_t from, std::size_t edge,
                                      std::vector<Number>& chain) {
    const Side at = side(edge);
    const auto [least, greatest] = std::minmax(at.place[0], at.place[1]);
    for (const EdgeNode& node : nodes.on(at.around)) {
        if (!at.whole && !(least < node.place && node.place < greatest)) continue;
        chain.push_back(vertex(node.key, node.x, nodes.values(node)));
    }
    const bool first_is_low =
        at.whole ? key_[at.corner[0]] == at.around.low : at.place[0] < at.place[1];
    if (first_is_low != (at.corner[0] == from)) std::ranges::reverse(chain);
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
void ElementPolygon<Real>::draw(const EdgeNodes* nodes, LevelSurface<3>& surface) {
    surface_ = &surface;
    const std::size_t n = view_->corner_count();
    auto loop = loop_of(n);
    if (view_->orientation < 0) std::reverse(loop.begin() + 1, loop.begin() + std::ptrdiff_t(n));
    surface.builder().add_element(view_->element(), view_->shape, view_->level);
    const unsigned boundary = walk_->boundary(*view_);
    for (std::size_t i = 0; i < n; ++i) {
        number_[i] = vertex(key_[loop[i]], x_[loop[i]], values(loop[i]));
    }
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t next = (i + 1) % n;
        const std::size_t edge = edge_between(view_->shape, loop[i], loop[next]);
        between_[i].clear();
        if (nodes != nullptr) take_nodes(*nodes, loop[i], edge, between_[i]);
        if ((boundary >> edge & 1U) != 0) add_boundary(number_[i], between_[i], number_[next]);
    }
    add_triangles(n, loop);
}

template <class Real>
void ElementPolygon<Real>::add_triangles(std::size_t sides,
                                         const std::array<std::size_t, 4>& loop) {
    ContourFilling<ElementPolygon> filling(*this);
    const auto& v = number_;
    const auto& on = between_;
    centred_ = false;
    if (sides == 3) return filling.add(v[0], v[1], v[2], on[0], on[1], on[2]);
    const auto [one, other] = cuts(loop);
    if (one && other && needs_centre()) {
        centred_ = true;
        const Number centre = add_centre();
        for (std::size_t i = 0; i < 4; ++i) filling.add(v[i], v[(i + 1) % 4], centre, on[i]);
        return;
    }
    const std::size_t a = one != other ? (one ? 0U : 1U) : first_of_diagonal(loop);
    const std::size_t c = a + 2;
    const std::size_t d = (a + 3) % 4;
    filling.add(v[a], v[a + 1], v[c], on[a], on[a + 1]);
    filling.add(v[c], v[d], v[a], on[c], on[d]);
}

/// Whether each of the two diagonals, the first one from the first corner of the loop, divides the
/// quadrilateral into triangles that are turned the same way.
template <class Real>
std::array<bool, 2> ElementPolygon<Real>::cuts(const std::array<std::size_t, 4>& loop) const {
    const auto turn = [&](std::size_t i) {  // at the corner behind place i
        const Point& x = x_[loop[(i + 1) % 4]];
        return cross(x - x_[loop[i % 4]], x_[loop[(i + 2) % 4]] - x);
    };
    return {dot(turn(0), turn(2)) > 0, dot(turn(1), turn(3)) > 0};
}

/// The place in the loop at which the shorter diagonal begins, 0 or 1. Of two that are equally
/// long, it is the one whose ends have nearer values, or else the one with the corner that is least
/// in lexicographic order.
template <class Real>
std::size_t ElementPolygon<Real>::first_of_diagonal(const std::array<std::size_t, 4>& loop) const {
    const auto at = [&](std::size_t i) { return lifted(x_[loop[i]], u(loop[i])); };
    int order = compare(squared_distance(at(0), at(2)), squared_distance(at(1), at(3)));
    if (order == 0) {
        order = compare(std::abs(u(loop[0]) - u(loop[2])), std::abs(u(loop[1]) - u(loop[3])));
    }
    if (order != 0) return order < 0 ? 0 : 1;
    const auto least = std::ranges::min_element(loop, {}, [&](std::size_t k) { return x_[k]; });
    return static_cast<std::size_t>(least - loop.begin()) % 2;
}

/// How far a component, bilinear on the element, is from two triangles: where the corners are those
/// of a parallelogram, this is the greatest difference.
template <class Real>
double ElementPolygon<Real>::twist(std::size_t component) const {
    const auto at = [&](std::size_t corner) { return u(corner, component); };
    return std::abs((at(0) - at(1)) - (at(2) - at(3))) / 4;
}

template <class Real>
bool ElementPolygon<Real>::needs_centre() const {
    for (std::size_t c = 0; c < components_; ++c) {
        if (twist(c) > shape_.flatness) return true;
    }
    return false;
}

/// Adds a vertex in the middle of a quadrilateral.
template <class Real>
auto ElementPolygon<Real>::add_centre() -> Number {
    const auto mean = [](const auto& at) { return face_mean(at(0U), at(1U), at(2U), at(3U)); };
    Point x;
    for (std::size_t d = 0; d < 3; ++d) x[d] = mean([&](std::size_t k) { return x_[k][d]; });
    for (std::size_t c = 0; c < components_; ++c) {
        values_[c] = mean([&](std::size_t k) { return u(k, c); });
    }
    x = lifted(x, values_[0]);
    return surface_->add_unnamed(std::span(&x, 1), values_);
}

/// With the best affine function subtracted, |U| is at most some r at the corners, so also where it
/// is interpolated, whatever the shapes; the difference is at most 2 r. In a parallelogram that is
/// divided into quadrilaterals it is at most r = twist, and a quarter of that around a centre.
template <class Real>
double ElementPolygon<Real>::chord(bool nested) const {
    if (view_->corner_count() != 4) return 0;
    constexpr double rounding = 1e-12;
    const Point skew = (x_[0] - x_[1]) - (x_[2] - x_[3]);
    if (nested && norm(skew) <= rounding * norm(x_[3] - x_[0])) {
        return centred_ ? twist(0) / 4 : twist(0);
    }
    const std::array<double, 4> at{u(0), u(1), u(2), u(3)};
    return 2 * affine_residual(std::span(x_).template first<4>(), std::span<const double, 4>(at));
}

template class ElementPolygon<float>;
template class ElementPolygon<double>;

}  // namespace nestgrid::engine
