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

/// Sentences about places where coarse elements touch in a point, and share no node there: a node
/// of one lies on a face or an edge of the other, or two edges cross. Not told are elements of
/// which faces are in contact, nodes that lie at one place, and what is hidden or masked. \param
/// faces the result of single_faces() \param contacts the result of face_contacts()
template <class Real>
std::vector<std::string> point_contacts(const Hierarchy<Real>& hierarchy,
                                        std::span<const std::uint8_t> faces,
                                        std::span<const FaceContact> contacts);

/// Sentences about pairs of coarse elements of which one contains the middle of the other, or a
/// point half-way between that and a corner, so that they overlap. Elements that overlap in less
/// may not be told, and those that are hidden, in part or wholly, or masked are not looked at.
/// Nothing is said of surfaces in space, which may cross themselves.
template <class Real>
std::vector<std::string> coarse_overlaps(const Hierarchy<Real>& hierarchy);

/// For each coarse element, one bit each, the faces on the boundary of the domain: single faces
/// that touch no other one, or that are one side of a slit. Faces that touch others in a part are
/// none: what is drawn on both sides does not fit together there, and its edges are open.
///
/// \throw GridError as single_faces()
template <class Real>
std::vector<std::uint8_t> coarse_boundary(const Hierarchy<Real>& hierarchy);

}  // namespace nestgrid::detail
