// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <discontinuous/element_section.hpp>

#include <algorithm>
#include <bit>

#include <contours/cut_fraction.hpp>
#include <nestgrid/detail/shape_functions.hpp>

namespace nestgrid::engine {

bool ElementSection::draw(const View& view, SurfaceBuilder<3>& builder) {
    cuts_.load(view, false);
    cuts_.set_level(level_);
    builder_ = &builder;
    drew_ = false;
    vertices_.clear();
    on_edge_.fill(none);
    on_corner_.fill(none);
    unsigned inside = 0;
    for (std::size_t k = 0; k < view.corner_count(); ++k) inside |= unsigned{u(k) >= 0} << k;
    if (std::popcount(inside) == static_cast<int>(view.corner_count())) {
        draw_faces();
    } else if (inside != 0) {
        draw_contour(inside);
    }
    return drew_;
}

/// The alternating faces whose corners inside are joined, one bit each.
unsigned ElementSection::joins(const ContourTable& table, unsigned inside) const {
    unsigned joins = 0;
    for (unsigned left = table.alternating(inside); left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        joins |= unsigned{cuts_.joined(view().topology().face[f])} << f;
    }
    return joins;
}

void ElementSection::draw_contour(unsigned inside) {
    const ContourTable& table = ContourTable::of(view().shape);
    const Contour& contour = table.at(inside, joins(table, inside));
    ContourFilling<ElementSection> filling(*this);
    if (view().shape == Shape::hexahedron && contour.loop_count > 1) {
        if (const auto tunnel = find_tunnel(contour, cuts_.u())) {
            return filling.fill(contour, *tunnel);
        }
    }
    filling.fill(contour);
}

/// Draws the faces on the boundary at whose corners the function is 0, seen from outside.
void ElementSection::draw_faces() {
    for (unsigned left = cuts_.walk().boundary(view()); left != 0; left &= left - 1) {
        const FaceTopology& face =
            view().topology().face[static_cast<std::size_t>(std::countr_zero(left))];
        const std::span corner(face.corner.data(), face.corners);
        if (!std::ranges::all_of(corner, [&](std::size_t k) { return u(k) == 0; })) continue;
        const auto at = [&](std::size_t i) { return corner_vertex(corner[i]); };
        triangle(at(0), at(1), at(2));
        if (face.corners == 4) triangle(at(2), at(3), at(0));
    }
}

auto ElementSection::add(const Point& x, const Point& reference) -> Number {
    vertices_.push_back({x, reference, none});
    return static_cast<Number>(vertices_.size() - 1);
}

auto ElementSection::corner_vertex(std::size_t corner) -> Number {
    Number& number = on_corner_[corner];
    if (number == none)
        number = add(cuts_.positions()[corner], view().topology().reference[corner]);
    return number;
}

auto ElementSection::vertex(std::uint8_t edge) -> Number {
    if (on_edge_[edge] != none) return on_edge_[edge];
    auto [low, high] = view().topology().edge[edge];
    if (u(low) > u(high)) std::swap(low, high);
    if (u(high) == 0) return on_edge_[edge] = corner_vertex(high);
    const double fraction = cut_fraction(0.0, u(low), u(high), 0.0, 1.0);
    const auto& reference = view().topology().reference;
    const auto& x = cuts_.positions();
    return on_edge_[edge] = add(x[low] + fraction * (x[high] - x[low]),
                                reference[low] + fraction * (reference[high] - reference[low]));
}

auto ElementSection::middle(std::span<const Number> of) -> Number {
    Point x{0, 0, 0};
    Point reference{0, 0, 0};
    const double weight = 1.0 / static_cast<double>(of.size());
    for (const Number v : of) {
        x = x + weight * vertices_[v].x;
        reference = reference + weight * vertices_[v].reference;
    }
    return add(x, reference);
}

auto ElementSection::inside(const Point& reference) -> Number {
    const auto weight = shape_functions(view().shape, reference);
    Point x{0, 0, 0};
    for (std::size_t k = 0; k < view().corner_count(); ++k)
        x = x + weight[k] * cuts_.positions()[k];
    return add(x, reference);
}

/// Adds the vertex to the surface, with the data there, unless it is in it.
auto ElementSection::surface_vertex(Vertex& vertex) -> Number {
    if (vertex.in_surface != none) return vertex.in_surface;
    vertex.in_surface = builder_->next_vertex();
    builder_->add_vertex(vertex.x, cuts_.attributes_at(vertex.reference));
    return vertex.in_surface;
}

void ElementSection::triangle(Number a, Number b, Number c) {
    if (a == b || b == c || c == a) return;
    if (view().orientation < 0) std::swap(a, b);
    if (!drew_) builder_->add_element(view().element(), view().shape, view().level);
    drew_ = true;
    builder_->add_simplex(
        {surface_vertex(vertices_[a]), surface_vertex(vertices_[b]), surface_vertex(vertices_[c])},
        {});
}

}  // namespace nestgrid::engine
