// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rules found in a grid: for solvers that tell where children lie in their father, but not by which
// rule they were made.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <span>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

/// A child as it lies in the reference element of its father.
struct PlacedChild {
    Shape shape = Shape::point;
    std::array<Point, max_corners> corners{};
};

/// An axis of a reference element, or several, one bit each. The two axes of the triangle of a
/// prism belong together.
using Axes = std::uint8_t;
inline constexpr Axes axis_x = 1;
inline constexpr Axes axis_y = 2;
inline constexpr Axes axis_z = 4;
inline constexpr Axes all_axes = axis_x | axis_y | axis_z;

/// Along which axes the parents of a new node lie. By default its parents are corners of the
/// father: the centre of a face has four. Along one axis it has two, the nodes on both ends of the
/// line through it along that axis. Two elements that divide one face must divide it alike.
struct ParentAxes {
    std::array<Axes, max_faces> face;  ///< of nodes inside a face of the father, by its number
    Axes inside = all_axes;            ///< of nodes in no face

    ParentAxes() { face.fill(all_axes); }
    bool operator==(const ParentAxes&) const = default;
};

/// Nodes of a quadrilateral, a hexahedron or a prism that is divided in steps: along the axes
/// in the first step, then every child along those in the second one, and so on. A node in a face
/// is made by the last step that divides the face.
/// \throw InvalidInput where two steps divide along one axis
ParentAxes in_steps(Shape parent, std::initializer_list<Axes> steps);

/// Rules by how the children lie, each made and checked once. Add those of a whole grid in the
/// constructor of its adapter: find() is const, and rules keep their addresses.
class RuleTable {
public:
    /// The rule of an element of a shape with these children. New nodes are numbered as the corners
    /// of the children name them first, but after their parents; their weights are the shape
    /// functions of the father, along the axes on which their parents lie.
    /// \param axes other than the default ones for a quadrilateral, a hexahedron or a prism only
    /// \throw InvalidInput with the sentence of find_violation() where the children do not tile the
    ///        parent, or one that says which node has no parents along its axes
    const Rule& add(Shape parent, std::span<const PlacedChild> children,
                    const ParentAxes& axes = {});

    /// The same without adding: null where there is no such rule.
    const Rule* find(Shape parent, std::span<const PlacedChild> children,
                     const ParentAxes& axes = {}) const;

    std::size_t size() const { return rules_.size(); }

private:
    std::deque<Rule> rules_;
    KeyTable<std::uint64_t, const Rule*> by_children_;  // by a hash of how they lie
};

}  // namespace nestgrid
