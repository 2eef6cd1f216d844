// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The triangles of one two-dimensional element: a polygon whose sides carry the nodes that finer
// sides recorded on its edges. Which diagonal divides it does not depend on them, so that it may be
// drawn before or after they are known.
//
// Invariants: each part of a side belongs to one triangle, which runs along it; every other edge
// belongs to two triangles and joins no two vertices of one side. So no triangle is degenerate.
#pragma once

#include <array>
#include <vector>

#include <height_fields/element_sides.hpp>
#include <height_fields/polygon_asides.hpp>
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
    /// The polygon of the loaded element, without its sides and vertices.
    Polygon polygon() const;
    /// The sides of the polygon of the loaded element, which is told its keys and which sides are
    /// parts of larger edges.
    PolygonSides sides(Polygon& polygon) const;
    /// Sets the vertices of the polygon of the loaded element.
    void put_vertices(Polygon& polygon, DrawnSurface<3>& surface);
    /// Draws a polygon that has its vertices.
    /// \param element the handle of its element
    /// \param nodes on its sides, or null
    void draw(const Polygon& polygon, const Handle& element, const NodesOnSides* nodes,
              DrawnSurface<3>& surface);
    /// Draws the loaded element, on whose sides no nodes lie.
    void draw(Polygon& polygon, DrawnSurface<3>& surface) {
        put_vertices(polygon, surface);
        draw(polygon, element_.view().element(), nullptr, surface);
    }
    /// How far component 0, interpolated from the corners of the loaded element, and the triangles
    /// of its polygon differ.
    /// \param nested whether all leaves below the element have its shape
    double chord(const Polygon& polygon, bool nested) const;
    const std::array<NodeKey, max_corners>& keys() const { return element_.keys(); }
    /// Component 0 at a corner.
    double u(std::size_t corner) const { return element_.u(corner); }

    /// Adds a triangle; contours/contour_filling.hpp calls it.
    void triangle(Number a, Number b, Number c) { surface_->add_simplex({a, b, c}, {}); }

private:
    std::array<std::size_t, 4> loop() const;
    Number vertex(NodeKey key, const Point& x, std::span<const double> values,
                  DrawnSurface<3>& surface) const;
    void add_boundary(Number from, const std::vector<Number>& between, Number to);
    void add_triangles(const Polygon& polygon);
    QuadrilateralCorners four_corners() const {
        return std::span(element_.positions()).template first<4>();
    }
    std::array<double, 4> at_corners(std::size_t component) const {
        const auto u = [&](std::size_t corner) { return element_.u(corner, component); };
        return {u(0), u(1), u(2), u(3)};
    }
    bool needs_centre() const;
    Number add_centre(DrawnSurface<3>& surface);

    ElementSides<Real> element_;
    GraphShape shape_;
    DrawnSurface<3>* surface_ = nullptr;            // that is drawn into
    std::array<std::vector<Number>, 4> between_{};  // vertices on the sides, in their order
    std::vector<double> at_centre_;                 // a value for each component
};

}  // namespace nestgrid::engine
