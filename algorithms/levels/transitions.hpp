// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Closed faces between elements that stop without conforming. The finer side records the segments
// that it draws on such a face, the coarser side adopts them (docs/closed_surfaces.md).
#pragma once

#include <contours/transition_contours.hpp>
#include <levels/element_contour.hpp>

namespace nestgrid::engine {

/// Records the segments that an element draws on its closed faces.
/// \param cut_faces its faces that the level cuts, one bit each
/// \param inside its corners inside the level, one bit each
template <class Real>
void record_transitions(const ElementCuts<Real>& element, unsigned cut_faces, unsigned inside,
                        TransitionContours& record);

/// Finds what finer sides recorded on the faces of an element, and hands it to the element's
/// contour.
template <int dimension, class Real>
class TransitionAdoption {
public:
    /// Borrows the element at hand and its contour.
    TransitionAdoption(const ElementCuts<Real>& cuts, ElementContour<dimension, Real>& contour)
        : cuts_{&cuts}, contour_{&contour} {}

    /// Finds the cut faces on which a finer side recorded anything.
    /// \param drawn_below what finer sides recorded, or null
    /// \return whether there is such a face
    bool find(const TransitionContours* drawn_below, unsigned cut_faces);
    /// Decides which faces join their corners inside the level, one bit each: as the finer side
    /// does, else by the face's values. Gives the contour the chains that finer sides drew.
    /// Requires that contour.begin() was called.
    /// \param alternating faces whose signs alternate, one bit each
    unsigned choose(unsigned inside, unsigned alternating);

private:
    using Number = std::uint32_t;
    enum class Found : std::uint8_t { nothing, apart, joined };

    Found adopt(std::size_t face, std::size_t side, unsigned signs);

    const ElementCuts<Real>* cuts_;
    ElementContour<dimension, Real>* contour_;
    const TransitionContours* drawn_below_ = nullptr;
    unsigned faces_ = 0;                       // faces that find() found, one bit each
    std::array<Number, max_faces> on_face_{};  // number of the record on each of them
    std::vector<Number> between_;              // vertices of the chain adopted last
};

}  // namespace nestgrid::engine
