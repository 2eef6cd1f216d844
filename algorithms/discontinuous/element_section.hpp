// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <contours/contour_filling.hpp>
#include <level_sets/element_cuts.hpp>

namespace nestgrid::engine {

/// The section of one element by the zero of a function, which no other element shares vertices
/// with. The contour passes through corners at which the function is 0; triangles that such a
/// corner makes flat are left out.
class ElementSection {
public:
    using View = ElementView<double>;
    using Number = std::uint32_t;

    /// \param walk whose elements have the function for component 0, and the data behind it;
    ///        borrowed
    explicit ElementSection(const Walk<double>& walk) : cuts_(walk, 1) {}

    /// Draws the section of an element. Where the function is 0 on a face on the boundary of the
    /// domain, and positive inside, draws the face.
    /// \return whether anything was drawn
    bool draw(const View& view, SurfaceBuilder<3>& builder);

    // ContourFilling calls these.
    Number vertex(std::uint8_t edge);
    Number middle(std::span<const Number> of);
    Number inside(const Point& reference);
    Point position(Number number) const { return vertices_[number].x; }
    static bool chained() { return false; }
    static std::span<const Number> chain(std::uint8_t) { return {}; }
    void triangle(Number a, Number b, Number c);

private:
    struct Vertex {
        Point x;
        Point reference;
        Number in_surface;
    };
    static constexpr Number none = ~Number{0};

    const View& view() const { return cuts_.view(); }
    double u(std::size_t corner) const { return cuts_.u(corner); }
    unsigned joins(const ContourTable& table, unsigned inside) const;
    void draw_contour(unsigned inside);
    void draw_faces();
    Number corner_vertex(std::size_t corner);
    Number add(const Point& x, const Point& reference);
    Number surface_vertex(Vertex& vertex);

    Level<double> level_{0, 0, 0};  // vertices may lie at corners
    ElementCuts<double> cuts_;
    SurfaceBuilder<3>* builder_ = nullptr;
    bool drew_ = false;
    std::vector<Vertex> vertices_;
    std::array<Number, max_edges> on_edge_{};
    std::array<Number, max_corners> on_corner_{};
};

}  // namespace nestgrid::engine
