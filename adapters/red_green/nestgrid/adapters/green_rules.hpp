// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Green rules: how an element is closed whose edges and faces are partly refined by neighbours.
//
// Invariant: the subdivision of a face is a function of the state of its edges and of its centre,
// and of the places of its nodes where it has a choice: the shorter diagonal.
// Consequence: both sides of a face agree, and the grid conforms.
// Hexahedra are closed by cones over their subdivided faces to a new node in the centre (pyramids
// and tetrahedra), or, where the state is constant along a direction, by prisms and hexahedra.
#pragma once

#include <memory>

#include <nestgrid/error.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

/// The state of an element at the time of its closure.
struct GreenState {
    Shape shape = Shape::point;
    std::uint32_t edges = 0;  ///< split ones, one bit each, in the order of the topology
    std::uint32_t faces = 0;  ///< quadrilateral faces with a node in the centre
    /// Tetrahedra with two split edges that meet: the diagonal of the quadrilateral on their face
    /// starts at the end of the second edge instead of the first.
    bool other_diagonal = false;

    static constexpr std::uint64_t green = 0x100;

    std::uint64_t descriptor() const {
        return green | static_cast<std::uint64_t>(shape) | std::uint64_t{edges} << 16U |
               std::uint64_t{faces} << 32U | std::uint64_t{other_diagonal} << 40U;
    }
    static GreenState from(std::uint64_t descriptor) {
        return {static_cast<Shape>(descriptor & 0xFU),
                static_cast<std::uint32_t>(descriptor >> 16U & 0xFFFU),
                static_cast<std::uint32_t>(descriptor >> 32U & 0x3FU),
                (descriptor >> 40U & 1U) != 0};
    }
};

/// The rule that closes an element in some state.
/// \throw InvalidInput where there is none: the element must be refined red
std::shared_ptr<const Rule> green_rule(const GreenState& state);

/// Whether a triangle or tetrahedron with these split edges has a green rule.
bool has_green_rule(Shape shape, std::uint32_t edges);

}  // namespace nestgrid
