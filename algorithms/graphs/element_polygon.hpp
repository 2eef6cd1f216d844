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

#include <graphs/edge_nodes.hpp>
#include <graphs/quadrilateral.hpp>
#include <surfaces/level_surface.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

template <class Real>
class ElementPolygon {
public:
    using View = ElementView<Real>;
    using Number = std::uint32_t;

    ElementPolygon(const Walk<Real>& walk, const GraphShape& shape)
        : walk_{&walk}, shape_{shape}, components_{walk.components()}, values_(components_) {}

    /// Loads the corners of an element.
    void load(const View& view);
    /// Records the nodes that the loaded element has inside closed edges: of each of its edges the
    /// end with the greater place, because that is the other end of the next edge, too.
    void record(EdgeNodes& nodes);
    /// Draws the loaded element.
    /// \param nodes that finer sides recorded, or null
    void draw(const EdgeNodes* nodes, LevelSurface<3>& surface);
    /// How far component 0, interpolated from the corners, and the triangles drawn last differ.
    /// \param nested whether all leaves below the element have its shape
    double chord(bool nested) const;
    const std::array<NodeKey, max_corners>& keys() const { return key_; }

    /// Adds a triangle; contours/contour_filling.hpp calls it.
    void triangle(Number a, Number b, Number c) { surface_->add_simplex({a, b, c}, {}); }

private:
    /// An edge of the element between the ends of the maximal edge around it.
    struct Side {
        std::array<std::size_t, 2> corner;
        KeyPair around;
        bool whole;                     // the edge is the maximal one
        std::array<double, 2> place{};  // of the two corners, where it is not
    };

    Side side(std::size_t edge) const;
    std::span<const double> values(std::size_t corner);
    Number vertex(NodeKey key, const Point& x, std::span<const double> values);
    void take_nodes(const EdgeNodes& nodes, std::size_t from, std::size_t edge,
                    std::vector<Number>& chain);
    void add_boundary(Number from, const std::vector<Number>& between, Number to);
    void add_triangles(std::size_t sides);
    QuadrilateralCorners four_corners() const { return std::span(x_).template first<4>(); }
    double u(std::size_t corner, std::size_t component = 0) const {
        return static_cast<double>(view_->value[corner * components_ + component]);
    }
    std::array<double, 4> at_corners(std::size_t component) const {
        return {u(0, component), u(1, component), u(2, component), u(3, component)};
    }
    bool needs_centre() const;
    Number add_centre();

    const Walk<Real>* walk_;
    GraphShape shape_;
    std::size_t components_;
    const View* view_ = nullptr;
    LevelSurface<3>* surface_ = nullptr;
    std::array<NodeKey, max_corners> key_{};
    std::array<Point, max_corners> x_{};
    std::array<Number, 4> number_{};                // of the corners, around the polygon
    std::array<std::vector<Number>, 4> between_{};  // vertices on the sides, likewise
    std::vector<double> values_;
    bool centred_ = false;
};

}  // namespace nestgrid::engine
