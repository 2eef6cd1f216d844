// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <nestgrid/geometry.hpp>

namespace nestgrid {

/// An indexed level set: triangles in three dimensions, segments in two.
/// Oriented: the normal (for segments, the right-hand side) points to where U is below the
/// isovalue, so the region U >= C has positive volume when the surface is closed.
template <int dimension, class Element>
struct Surface {
    using Simplex = std::array<std::uint32_t, static_cast<std::size_t>(dimension)>;
    using Ridge = std::array<std::uint32_t, static_cast<std::size_t>(dimension - 1)>;

    std::vector<Point> vertices;
    std::vector<Point> normals;  ///< unit length, one per vertex, where asked for
    std::vector<Simplex> simplices;
    std::vector<std::uint32_t> element_of;  ///< per simplex, an index into elements
    std::vector<Element> elements;          ///< the extracted elements, in order of the traversal
    std::vector<std::uint16_t> level_of;    ///< level of each of them
    std::vector<Ridge> boundary;            ///< edges (points) on the boundary of the domain

    std::size_t memory_bytes() const {
        const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
        return bytes(vertices) + bytes(normals) + bytes(simplices) + bytes(element_of) +
               bytes(elements) + bytes(level_of) + bytes(boundary);
    }
};

}  // namespace nestgrid
