// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Draws elements beside which finer ones may stop: keeps what their contour needs while the walk is
// at them, and draws it when all finer ones have recorded their segments (docs/closed_surfaces.md).
#pragma once

#include <level_sets/cap_contour.hpp>
#include <level_sets/transitions.hpp>

namespace nestgrid::engine {

/// What elements record on closed faces for one level, and the elements that may adopt it.
template <class Real>
struct Transitions {
    TransitionContours record;
    Asides<Real> asides;
};

/// Records, puts aside and draws one element at a time.
template <int dimension, class Real>
class AsideContour {
public:
    using View = ElementView<Real>;
    using Vertices = typename ElementContour<dimension, Real>::Vertices;

    /// All arguments are borrowed: the element at hand, its contour and caps, and what counts them.
    AsideContour(ElementCuts<Real>& cuts, ElementContour<dimension, Real>& contour,
                 CapContour<dimension, Real>& cap, SimplexTally& tally,
                 const IsosurfaceOptions& options)
        : cuts_{&cuts},
          contour_{&contour},
          cap_{&cap},
          tally_{&tally},
          options_{&options},
          adoption_{contour} {}

    /// Begins the element at hand.
    /// \param inside its corners inside the level, one bit each
    /// \param capped the faces to be capped, one bit each
    /// \param put_aside whether put_aside() will be called
    void begin(unsigned inside, unsigned capped, bool put_aside);
    /// The vertices on cut edges of the element at hand, by edge: their numbers in the surface, or
    /// in the record where this knows vertices by names.
    Vertices& vertices() { return aside_.vertex; }
    /// Finds or makes the vertices on all cut edges of the element at hand.
    /// \param plain its contour where it may be drawn plainly, or null; then the contour is begun
    void find_vertices(DrawnSurface<dimension>& surface, const Contour* plain);
    /// Finds or makes the vertices that are recorded or kept, in a record that knows them by names.
    void find_vertices(TransitionContours& record);
    /// Records what the element at hand draws on its closed faces.
    void record(TransitionContours& record);
    /// Keeps what draw() needs of the element at hand.
    /// \param boundary the faces on the boundary of the domain, where the surface keeps its edges
    ///        there, one bit each
    void put_aside(const DrawnSurface<dimension>& surface, Transitions<Real>& transitions,
                   unsigned boundary);
    /// Draws the elements that were put aside, and the gaps between them and finer ones. Requires
    /// that the level is set, and that all elements have recorded.
    /// \param keeps_memory of what was put aside; else it is freed while that is drawn
    void draw(DrawnSurface<dimension>& surface, Transitions<Real>& transitions, bool keeps_memory);

private:
    using Aside = typename Asides<Real>::Aside;

    std::size_t expected(const Asides<Real>& asides) const;
    void describe(unsigned boundary);
    void find_face_keys();
    void draw(DrawnSurface<dimension>& surface, const Transitions<Real>& transitions,
              const Aside& aside);
    void draw_plainly(DrawnSurface<dimension>& surface, const Transitions<Real>& transitions,
                      const Aside& aside, const Contour& plain);
    void load(bool keeps_elements, const Asides<Real>& asides, const Aside& aside);
    Vertices make_vertices(DrawnSurface<dimension>& surface, const TransitionContours& record,
                           const Aside& aside);
    void take_vertices(const TransitionContours& record, const Aside& aside);
    void fill_gaps(DrawnSurface<dimension>& surface, const TransitionContours& record);

    ElementCuts<Real>* cuts_;
    ElementContour<dimension, Real>* contour_;
    CapContour<dimension, Real>* cap_;
    SimplexTally* tally_;
    const IsosurfaceOptions* options_;
    TransitionAdoption<dimension, Real> adoption_;
    // The element at hand, as it is put aside, and what it draws on closed faces.
    Aside aside_{};
    unsigned closed_faces_ = 0;  // cut faces on which it records, one bit each
    bool put_aside_ = false;
    // The element that was put aside and is drawn.
    Member member_;
    View view_{};
};

}  // namespace nestgrid::engine
