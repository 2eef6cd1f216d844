// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the domain ends, as the ids of the coarse nodes tell it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::detail {

/// Two faces of coarse elements that no id joins, and that overlap in more than an edge.
struct FaceContact {
    std::array<std::size_t, 2> element{};
    std::array<std::uint8_t, 2> face{};
    Point place{};         ///< in the middle of what both have in common
    bool is_slit = false;  ///< the corners of both are at the same places, under different ids

    /// As in "face 1 of coarse element 0 and face 2 of coarse element 5, around (0, 0, 1)".
    std::string text() const;
};

/// For each coarse element, one bit each, the faces that no other coarse element has with the same
/// ids.
/// \throw GridError where a coarse element has a shape of another dimension than the grid
template <class Real>
std::vector<std::uint8_t> single_faces(const Hierarchy<Real>& hierarchy);

/// All contacts between single faces, up to 1e-6 of their size.
/// \param faces the result of single_faces()
template <class Real>
std::vector<FaceContact> face_contacts(const Hierarchy<Real>& hierarchy,
                                       std::span<const std::uint8_t> faces);

/// For each coarse element, one bit each, the faces on the boundary of the domain: single faces
/// that touch no other one, or that are one side of a slit. Faces that touch others in a part are
/// none: what is drawn on both sides does not fit together there, and its edges are open.
///
/// \throw GridError as single_faces()
template <class Real>
std::vector<std::uint8_t> coarse_boundary(const Hierarchy<Real>& hierarchy);

}  // namespace nestgrid::detail
