// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Caps: the part of each face on the boundary of the domain, or beside hidden elements, that is
// inside a level.
//
// Such faces meet in edges, more than two of them where hidden elements touch in an edge alone, and
// some are finer than others. Each one records its nodes on closed edges, under the key of the
// maximal edge. All others adopt those between their own vertices.
#pragma once

#include <contours/transition_contours.hpp>
#include <level_sets/element_contour.hpp>

namespace nestgrid::engine {

/// Draws the caps of one element at a time.
template <int dimension, class Real>
class CapContour {
public:
    /// Borrows the element at hand and its contour.
    CapContour(const ElementCuts<Real>& cuts, ElementContour<dimension, Real>& contour)
        : cuts_{&cuts}, contour_{&contour} {}

    /// Records the nodes of the element's caps on closed edges.
    /// \param inside the corners inside the level, one bit each
    /// \param faces the faces to be capped, one bit each
    /// Where the record knows vertices by numbers, contour.begin() must have been called.
    void record(unsigned inside, unsigned faces, TransitionContours& record) const;
    /// What all caps recorded, or null, and the key of the maximal edge around each edge.
    struct Recorded {
        const TransitionContours* by_caps = nullptr;
        const NodeKey* edge_key = nullptr;
    };
    /// Draws the element's caps; contour.begin() must have been called.
    void draw(unsigned inside, unsigned faces, const Recorded& recorded);
    /// The key of the maximal edge around an edge of the element at hand.
    NodeKey edge_key(std::uint8_t edge) const;

private:
    using Number = std::uint32_t;
    struct Corner {  // corner `from` of the face, or the cut of the face's side `from`
        std::uint8_t from;
        bool cut;
    };
    struct Polygon {  // its sides run from each corner to the next
        std::size_t count = 0;
        std::array<Corner, 8> corner;
        std::array<std::uint8_t, 8> edge;  // the edge of the element under each side, or no_edge
    };

    template <class Function>
    void for_each_polygon(unsigned inside, unsigned faces, Function&& function) const;
    static Polygon polygon_from(Shape shape, const FaceTopology& face, unsigned signs,
                                const FaceContour& contour, unsigned& left);
    void record_side(const FaceTopology& face, const Polygon& polygon, std::size_t side,
                     TransitionContours& record) const;
    std::vector<Number> chain(const FaceTopology& face, const Polygon& polygon, std::size_t side,
                              const Recorded& recorded);
    void draw_segments(unsigned inside, unsigned faces);
    void draw_polygon(const FaceTopology& face, const Polygon& polygon, const Recorded& recorded);

    const ElementCuts<Real>* cuts_;
    ElementContour<dimension, Real>* contour_;
};

}  // namespace nestgrid::engine
