// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a shape is made of: its parts, which are its edges and, in space, its faces; how its red
// rule halves them; and in which part a point lies. One table for each shape, derived from its
// topology.
#pragma once

#include <high_order/net.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid::engine {

/// Faces of a shape, one bit each.
using FaceMask = unsigned;
/// Corners of a shape, one bit each.
using CornerMask = unsigned;

/// An edge or a face.
struct ShapePart {
    Factors factors;
    std::uint8_t count = 0;                ///< of corners
    std::array<std::uint8_t, 4> corner{};  ///< in the order of a tensor product
    CornerMask corners = 0;
    std::uint8_t node = no_new_node;  ///< of the red rule, that halves it
};

inline constexpr std::size_t max_parts = 18;  ///< of a shape

struct ShapeParts {
    static constexpr int inside = -1;
    static constexpr int at_corner = -2;

    Shape shape = Shape::point;
    Factors factors;
    std::size_t dimension = 0;
    std::size_t corners = 0;
    bool is_box = false;
    const Rule* rule = nullptr;  ///< the red rule
    std::vector<ShapePart> parts;
    std::vector<Place> node;             ///< of the red rule, the corners first, in units of 1 / 2
    std::array<std::uint8_t, 3> axis{};  ///< the corner at the end of each axis from corner 0

    /// A corner of the reference element.
    Place reference_corner(std::size_t corner) const {
        const Place& twice = node[corner];
        return {twice[0] / 2, twice[1] / 2, twice[2] / 2};
    }
    /// The faces that a point lies in. \param at in units of 2^-level
    FaceMask faces_at(const Place& at, int level) const;
    /// Number of the part that all these faces, and no others, are around; or inside, or at_corner.
    int part_in(FaceMask faces) const { return part_in_[faces]; }

private:
    friend ShapeParts make_parts(Shape shape);
    struct Plane {
        std::array<int, 3> normal{};
        int offset = 0;
    };
    std::vector<Plane> planes_;
    std::array<std::int8_t, 1U << max_faces> part_in_{};
};

/// How many corners make the frame of a part: one, and its neighbours.
inline std::size_t frame_size(const ShapePart& part) { return part.count == 2 ? 2 : 3; }

/// \param shape of dimension 2 or 3
const ShapeParts& parts_of(Shape shape);

/// A part of a shape, or, behind all parts, a corner.
using PartOrCorner = std::size_t;

/// Where a child of a rule that divides red lies in its father.
struct InFather {
    Place origin{};  ///< of the child's coordinates, in units of 1 / 2, as the next one
    std::array<Place, 3> axis{};
    /// The part or corner of the father that each part and corner of the child lies in, or
    /// ShapeParts::inside.
    std::vector<std::int8_t> around;

    /// \param at in units of 2^-level of the child \return in units of 2^-(level + 1) of the father
    Place operator()(const Place& at, int level) const {
        Place x;
        for (std::size_t i = 0; i < 3; ++i) {
            x[i] = origin[i] * (std::int64_t{1} << level) + at[0] * axis[0][i] +
                   at[1] * axis[1][i] + at[2] * axis[2][i];
        }
        return x;
    }
};
/// Of all children of a rule that divides red.
std::vector<InFather> children_in_father(const Rule& rule);

/// Whether a rule makes the nodes of the red rule of its shape, and as many children of each shape,
/// in any order.
bool divides_red(const Rule& rule);
/// The new node of such a rule that halves a part, or no_new_node.
std::uint8_t node_halving(const Rule& rule, const ShapePart& part);

/// Coordinates t in the frame of a part: with its corner 0 at the origin, and the neighbours of
/// that at the ends of the axes.
struct PartFrame {
    Place origin{};
    std::array<std::array<std::int64_t, 3>, 2> row{};  ///< t = row (x - origin)
    Place operator()(const Place& at, int level) const;
};
/// \param corners 2 or 3 corners of a reference element
PartFrame frame_between(std::span<const Place> corners);

}  // namespace nestgrid::engine
