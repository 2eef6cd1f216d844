// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <contours/contour_filling.hpp>
#include <surfaces/surface_builder.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// The section of one element by the zero of a function, which no other element shares vertices
/// with. The contour passes through corners at which the function is 0; triangles that such a
/// corner makes flat are left out.
class ElementSection {
public:
    using View = ElementView<double>;
    using Number = std::uint32_t;

    /// \param components of the elements' values: the function, and the data behind it
    explicit ElementSection(std::size_t components)
        : components_{components}, attributes_(components - 1) {}

    /// Draws the section of an element.
    /// \param x of its corners
    /// \param boundary faces on the boundary of the domain: where the function is 0 on such a face
    ///        and positive inside, the face is drawn
    void draw(const View& view, std::span<const Point> x, unsigned boundary,
              SurfaceBuilder<3>& builder);
    /// Whether the last element was drawn.
    bool drew() const { return drew_; }

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

    double u(std::size_t corner) const { return view_->value[corner * components_]; }
    unsigned joins(const ContourTable& table, unsigned inside) const;
    void draw_contour(unsigned inside);
    void draw_faces(unsigned boundary);
    Number corner_vertex(std::size_t corner);
    Number add(const Point& x, const Point& reference);
    Number surface_vertex(Vertex& vertex);

    std::size_t components_;
    std::vector<double> attributes_;
    const View* view_ = nullptr;
    std::span<const Point> x_;
    SurfaceBuilder<3>* builder_ = nullptr;
    bool drew_ = false;
    std::vector<Vertex> vertices_;
    std::array<Number, max_edges> on_edge_{};
    std::array<Number, max_corners> on_corner_{};
};

}  // namespace nestgrid::engine
