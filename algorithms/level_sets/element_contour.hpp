// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Turns the signs at the corners of an element into loops of cuts, and the loops into simplices.
// Invariant: the segments that an element draws on a face depend on the face alone, or are the
// chain that the finer side drew there (transitions.hpp).
#pragma once

#include <contours/contour_filling.hpp>
#include <contours/transition_contours.hpp>
#include <level_sets/element_cuts.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <surfaces/drawn_surface.hpp>
#include <surfaces/simplex_tally.hpp>

namespace nestgrid::engine {

/// Draws one element at a time. Vertices of the element have local numbers, in the order in which
/// they are asked for.
template <int dimension, class Real>
class ElementContour {
public:
    using Number = std::uint32_t;
    using Locals = std::array<Number, static_cast<std::size_t>(dimension)>;
    /// Vertices of the surface, by edge or by place in a loop.
    using Vertices = std::array<Number, max_edges>;

    /// All arguments are borrowed.
    ElementContour(ElementCuts<Real>& cuts, SimplexTally& tally, const IsosurfaceOptions& options)
        : cuts_{&cuts}, tally_{&tally}, options_{&options} {}

    /// The contour of an element that no finer side drew on, where it may be drawn by
    /// draw_plainly(): no signs on a face alternate and no loop is filled around its middle.
    /// \param inside the corners inside the level, one bit each
    const Contour* plain(Shape shape, unsigned inside) { return table(shape).plain(inside); }
    /// The table of a shape, made when the shape is first met.
    NESTGRID_INLINE const ContourTable& table(Shape shape) {
        const ContourTable*& table = table_[static_cast<std::size_t>(shape)];
        if (table == nullptr) table = &ContourTable::of(shape);
        return *table;
    }
    static std::size_t simplices_of(const Contour& plain);
    /// Draws a plain contour as draw() would, in the same order and to the last bit, but for
    /// references, which it leaves out.
    /// \param by_edge takes the vertices where these have names, or is null
    void draw_plainly(DrawnSurface<dimension>& surface, const Contour& contour, unsigned inside,
                      Vertices* by_edge = nullptr);
    /// Finds the vertices of a plain contour as draw_plainly() does, which requires that vertices
    /// have names.
    /// \return them by edge
    Vertices plain_vertices(DrawnSurface<dimension>& surface, const Contour& contour,
                            unsigned inside);
    /// Draws a plain contour between vertices that are known.
    /// \param v by edge
    /// \param boundary the element's faces on the boundary of the domain, one bit each
    void draw_between(DrawnSurface<dimension>& surface, const Contour& contour, const Vertices& v,
                      bool mirrored, unsigned boundary);

    /// Begins the element at hand.
    void begin(DrawnSurface<dimension>& surface) { begin(surface, cuts_->view().orientation < 0); }
    /// Begins the caps that a hidden element draws on elements beyond its faces.
    void begin_beyond(DrawnSurface<dimension>& surface) {
        begin(surface, cuts_->view().orientation > 0);
    }
    /// Whether anything of the element was drawn since begin().
    bool begun() const { return begun_; }
    /// Replaces the side of a loop that follows an edge by a chain of local vertices.
    void set_chain(std::uint8_t edge, std::vector<Number>& chain);
    /// Draws the contour of an element.
    /// \param joins faces whose inside corners are joined where signs alternate, one bit each
    /// \param boundary faces on the boundary of the domain, one bit each
    void draw(unsigned inside, unsigned joins, unsigned boundary);
    /// Those of some faces whose signs alternate that join their corners inside the level, by the
    /// values at these.
    unsigned own_joins(unsigned alternating) const;
    /// A simplex between local vertices, oriented as in an element that is not mirrored.
    void simplex(const Locals& corners);
    /// Fills a gap between elements by a fan around its middle.
    void fill_gap(DrawnSurface<dimension>& surface, const TransitionContours& record,
                  const TransitionContours::Gap& gap);

    // Local vertices, each new where the element does not have it yet (ContourFilling).
    Number vertex(std::uint8_t edge);
    Number node_vertex(std::size_t corner);
    /// A vertex that a finer side recorded on a face.
    Number adopted(const TransitionContours& record, Number recorded, const FaceTopology& face);
    /// The position of a recorded vertex.
    Point recorded_position(const TransitionContours& record, Number recorded) const {
        return record.by_names() ? record.cut(recorded).x : surface_->position(recorded);
    }
    /// Takes a vertex on an edge that was found before, or its cut, where the element was put aside
    /// and is loaded again.
    /// \param corners whether keys, positions and values at the corners are loaded
    void take_vertex(std::uint8_t edge, Number of_surface, bool corners);
    void take_cut(std::uint8_t edge, const SurfaceCut& cut, bool corners);
    /// The vertex of the surface that a local vertex is.
    Number of_surface(Number local) const { return local_[local]; }
    Number middle(std::span<const Number> of);
    Number inside(const Point& reference);
    Point position(Number local) const { return surface_->position(local_[local]); }
    bool chained() const { return chained_ != 0; }
    std::span<const Number> chain(std::uint8_t edge) const {
        if ((chained_ >> edge & 1U) == 0) return {};
        return chain_[edge];
    }
    void triangle(Number a, Number b, Number c) {
        if constexpr (dimension == 3) simplex({a, b, c});
    }

private:
    static constexpr Number none = DrawnSurface<dimension>::none;

    void begin(DrawnSurface<dimension>& surface, bool mirrored);
    Vertices find_vertices(const ContourLoop& loop, unsigned inside);
    Vertices make_vertices(const ContourLoop& loop, unsigned inside);
    void put_loop(const ContourLoop& loop, const Vertices& v, bool mirrored);
    void hand_over_loop(const ContourLoop& loop, unsigned inside, bool mirrored);
    template <class Position, class Put>
    void divide_loop(const ContourLoop& loop, bool mirrored, const Position& x, const Put& put);
    void put_boundary(const ContourLoop& loop, const Vertices& v, unsigned boundary);
    Point reference_on_edge(std::uint8_t edge) const;
    Point reference_on_face(const Point& x, const FaceTopology& face) const;
    /// Tells the surface that a vertex lies at a corner.
    void put_at_node(Number vertex, std::size_t corner);
    /// Whether vertices need their reference coordinates.
    bool wants_reference() const { return options_->reference || cuts_->attribute_count() > 0; }
    Number of_record(const TransitionContours& record, Number recorded);
    Number number_of(Number vertex, const Point& reference);

    ElementCuts<Real>* cuts_;
    SimplexTally* tally_;
    const IsosurfaceOptions* options_;

    std::array<const ContourTable*, shape_count> table_{};
    DrawnSurface<dimension>* surface_ = nullptr;
    bool begun_ = false;
    bool mirrored_ = false;
    std::vector<Number> local_;     // vertices of the surface, by local number
    std::vector<Point> reference_;  // reference coordinates of each, where wanted
    std::array<Number, max_edges> on_edge_{};
    std::array<Number, max_corners> on_corner_{};
    std::uint16_t chained_ = 0;  // edges with a chain behind them, one bit each
    std::array<std::vector<Number>, max_edges> chain_;
};

}  // namespace nestgrid::engine
