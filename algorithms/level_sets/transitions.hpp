// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Closed faces between elements that stop without conforming. The finer side records the segments
// that it draws on such a face, the coarser side adopts them (docs/closed_surfaces.md).
#pragma once

#include <contours/transition_contours.hpp>
#include <level_sets/asides.hpp>
#include <level_sets/element_contour.hpp>

namespace nestgrid::engine {

/// Records the segments that an element draws on its closed faces.
/// \param closed_faces those of its faces that the level cuts, one bit each
/// \param inside its corners inside the level, one bit each
/// \param vertices by edge, the numbers by which the record knows them
template <class Real>
void record_transitions(const ElementCuts<Real>& element, unsigned closed_faces, unsigned inside,
                        std::span<const std::uint32_t, max_edges> vertices,
                        TransitionContours& record);

/// Finds what finer sides recorded on the faces of an element that was put aside, and hands it to
/// the element's contour.
template <int dimension, class Real>
class TransitionAdoption {
public:
    using Aside = typename Asides<Real>::Aside;

    /// Borrows the contour of the element at hand.
    explicit TransitionAdoption(ElementContour<dimension, Real>& contour) : contour_{&contour} {}

    /// Finds the cut faces of an element on which a finer side recorded anything.
    /// \return whether there is such a face
    bool find(const TransitionContours& record, const Aside& aside);
    /// Gives the contour the chains that finer sides drew on the faces that find() found. Requires
    /// that contour.begin() was called.
    /// \return faces that join their corners inside the level, one bit each: as the finer side
    ///         does, else by the face's values
    unsigned choose(const Aside& aside);

private:
    using Number = std::uint32_t;
    enum class Found : std::uint8_t { nothing, apart, joined };

    Found adopt(const Aside& aside, std::size_t face, std::size_t side, unsigned signs);

    ElementContour<dimension, Real>* contour_;
    const TransitionContours* record_ = nullptr;
    unsigned faces_ = 0;                       // faces that find() found, one bit each
    std::array<Number, max_faces> on_face_{};  // number of the record on each of them
    std::vector<Number> between_;              // vertices of the chain adopted last
};

}  // namespace nestgrid::engine
