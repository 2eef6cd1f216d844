// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the dual graph of a coarse grid tells (elements are vertices, inner faces are edges):
// connected components, consistent orientation, an order of the elements for locality, colours of
// the nodes.
#pragma once

#include <array>
#include <functional>

#include <nestgrid/adapters/coarse.hpp>

namespace nestgrid {

/// A face of a coarse element.
struct CoarseFace {
    std::array<std::uint32_t, 4> nodes{};  ///< sorted; the last one 0xFFFFFFFF where there are less
    std::uint32_t element = 0;
    std::uint8_t face = 0;
    bool odd = false;  ///< the loop of the face runs against the order of `nodes`
};

namespace detail {

/// All faces, those of equal nodes next to each other.
std::vector<CoarseFace> sorted_faces(const CoarseGrid& grid);

/// Calls function(a, b) for the two sides of every inner face.
/// \throw InvalidInput where more than two elements share a face
void for_each_inner_face(const CoarseGrid& grid,
                         const std::function<void(const CoarseFace&, const CoarseFace&)>& function);

}  // namespace detail

/// Number of the connected component of every element (through faces), and how many there are.
/// \throw InvalidInput where more than two elements share a face
std::pair<std::vector<int>, int> components(const CoarseGrid& grid);

/// The mirror image of an element's corners.
void mirror(Shape shape, std::span<std::uint32_t> corners);

/// Makes the orientation consistent: afterwards neighbours run through their common face in
/// opposite senses. The first element of each component keeps its own.
/// \return number of elements turned
/// \throw InvalidInput for a surface that cannot be oriented, such as a Moebius strip, or where
///        more than two elements share a face
std::size_t orient(CoarseGrid& grid);

/// Order of the elements after Cuthill and McKee, reversed: neighbours become near in memory.
/// order[i] is the element to stand at place i.
/// \throw InvalidInput where more than two elements share a face
std::vector<std::uint32_t> reverse_cuthill_mckee(const CoarseGrid& grid);

/// The same grid with its elements in another order.
CoarseGrid reordered(const CoarseGrid& grid, std::span<const std::uint32_t> order);

/// A colour for every node such that no two nodes of an element have the same; greedy.
std::vector<std::uint32_t> node_colours(const CoarseGrid& grid);

/// Whether there is an order of the nodes in which the corners of every element ascend.
bool has_common_order(const CoarseGrid& grid);

}  // namespace nestgrid
