// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The triangles of one two-dimensional element: a polygon whose sides carry the nodes that finer
// sides recorded on its edges.
//
// Invariants: each part of a side belongs to one triangle, which runs along it; every other edge
// belongs to two triangles and joins no two vertices of one side. So no triangle is degenerate.
#pragma once

#include <array>
#include <vector>

#include <height_fields/element_sides.hpp>
#include <height_fields/quadrilateral.hpp>
#include <surfaces/drawn_surface.hpp>

namespace nestgrid::engine {

template <class Real>
class ElementPolygon {
public:
    using View = ElementView<Real>;
    using Number = std::uint32_t;

    ElementPolygon(const Walk<Real>& walk, const GraphShape& shape)
        : element_{walk}, shape_{shape}, at_centre_(walk.components()) {}

    /// Loads an element, which must outlive its use.
    void load(const View& view) { element_.load(view); }
    /// Records the nodes that the loaded element has inside closed edges.
    void record(EdgeNodes& nodes) { element_.record(nodes); }
    /// Draws the loaded element.
    /// \param nodes that finer sides recorded, or null
    void draw(const EdgeNodes* nodes, DrawnSurface<3>& surface);
    /// How far component 0, interpolated from the corners, and the triangles drawn last differ.
    /// \param nested whether all leaves below the element have its shape
    double chord(bool nested) const;
    const std::array<NodeKey, max_corners>& keys() const { return element_.keys(); }
    /// Component 0 at a corner.
    double u(std::size_t corner) const { return element_.u(corner); }

    /// Adds a triangle; contours/contour_filling.hpp calls it.
    void triangle(Number a, Number b, Number c) { surface_->add_simplex({a, b, c}, {}); }

private:
    Number vertex(NodeKey key, const Point& x, std::span<const double> values);
    void take_nodes(const EdgeNodes& nodes, std::size_t from, std::size_t edge,
                    std::vector<Number>& chain);
    void add_boundary(Number from, const std::vector<Number>& between, Number to);
    void add_triangles(std::size_t sides);
    QuadrilateralCorners four_corners() const {
        return std::span(element_.positions()).template first<4>();
    }
    std::array<double, 4> at_corners(std::size_t component) const {
        const auto u = [&](std::size_t corner) { return element_.u(corner, component); };
        return {u(0), u(1), u(2), u(3)};
    }
    bool needs_centre() const;
    Number add_centre();

    ElementSides<Real> element_;
    GraphShape shape_;
    DrawnSurface<3>* surface_ = nullptr;
    std::array<Number, 4> number_{};                // of the corners, around the polygon
    std::array<std::vector<Number>, 4> between_{};  // vertices on the sides, in that order
    std::vector<double> at_centre_;                 // a value for each component
    bool centred_ = false;
};

}  // namespace nestgrid::engine
