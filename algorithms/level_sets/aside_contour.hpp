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

    /// Finds or makes the vertices on all cut edges of the element at hand.
    /// \param plain its contour where it may be drawn plainly, or null; then the contour is begun
    /// \return their numbers in the surface, by edge
    Vertices find_vertices(DrawnSurface<dimension>& surface, const Contour* plain, unsigned inside);
    /// Records what the element at hand draws on its closed faces.
    /// \param capped the faces to be capped, one bit each
    /// \param vertices as find_vertices() returns them, where the record knows vertices by numbers
    void record(TransitionContours& record, unsigned inside, unsigned capped,
                const Vertices& vertices);
    /// Keeps what draw() needs of the element at hand.
    /// \param boundary the faces on the boundary of the domain, where the surface keeps its edges
    ///        there, one bit each
    void put_aside(const DrawnSurface<dimension>& surface, Transitions<Real>& transitions,
                   unsigned inside, unsigned capped, unsigned boundary, const Vertices& vertices);
    /// Draws the elements that were put aside, and the gaps between them and finer ones. Requires
    /// that the level is set, and that all elements have recorded.
    void draw(DrawnSurface<dimension>& surface, Transitions<Real>& transitions);

private:
    using Aside = typename Asides<Real>::Aside;
    using Names = std::array<KeyPair, max_edges>;

    AsideElement describe(unsigned inside, unsigned capped, unsigned boundary) const;
    void keep_vertices(Transitions<Real>& transitions, unsigned edges, bool counts_only,
                       const Vertices& vertices) const;
    void keep_face_keys(Asides<Real>& asides, unsigned faces) const;
    void draw(DrawnSurface<dimension>& surface, const Transitions<Real>& transitions,
              const Aside& aside);
    void draw_plainly(DrawnSurface<dimension>& surface, const Transitions<Real>& transitions,
                      const Aside& aside, const Contour& plain);
    void load(bool keeps_elements, const Asides<Real>& asides, const Aside& aside);
    Vertices make_vertices(DrawnSurface<dimension>& surface, const Asides<Real>& asides,
                           const Aside& aside) const;
    Names take_vertices(const Transitions<Real>& transitions, const Aside& aside);
    void fill_gaps(DrawnSurface<dimension>& surface, const TransitionContours& record);

    ElementCuts<Real>* cuts_;
    ElementContour<dimension, Real>* contour_;
    CapContour<dimension, Real>* cap_;
    SimplexTally* tally_;
    const IsosurfaceOptions* options_;
    TransitionAdoption<dimension, Real> adoption_;
    // The element that was put aside and is drawn.
    Member member_;
    View view_{};
};

}  // namespace nestgrid::engine
