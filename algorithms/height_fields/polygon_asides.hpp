// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Polygons that a walk puts aside, because elements on finer levels may record nodes on their sides
// later.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <span>
#include <utility>

#include <height_fields/edge_nodes.hpp>
#include <nestgrid/detail/elements.hpp>

namespace nestgrid::engine {

/// What is drawn of a two-dimensional element, but for the nodes on its sides. Its corners are in
/// counterclockwise order, and side i runs from corner i to the next.
struct Polygon {
    std::array<NodeKey, 4> key{};           ///< of the corners
    std::array<std::uint32_t, 4> vertex{};  ///< their numbers in the surface
    std::uint32_t centre = 0;               ///< the vertex in the middle, where there is one
    std::uint16_t level = 0;                ///< of the element in the hierarchy
    Shape shape = Shape::triangle;
    std::uint8_t sides = 3;
    std::uint8_t diagonal = 0;  ///< a corner at which the diagonal of a quadrilateral ends
    std::uint8_t boundary = 0;  ///< sides on the boundary of the domain, one bit each
    std::uint8_t within = 0;    ///< sides that are parts of larger edges, one bit each
    bool centred = false;       ///< whether there is a vertex in the middle

    /// The number of triangles.
    /// \param nodes on all sides
    std::uint64_t triangles(std::uint64_t nodes) const {
        return nodes + (centred ? sides : sides - 2U);
    }
};

/// Where a side lies on the maximal edge around it.
struct PolygonSide {
    KeyPair around;               ///< the ends of the maximal edge
    std::array<double, 2> place;  ///< of the ends of the side; infinite where it is all of the edge
};

using PolygonSides = std::array<PolygonSide, 4>;

/// The nodes that finer sides recorded on the sides of a polygon.
struct NodesOnSides {
    const EdgeNodes& nodes;
    const PolygonSides& sides;

    /// Strictly inside a side, in the order of their places.
    std::span<const EdgeNode> inside(std::size_t side) const {
        return nodes.between(sides[side].around, sides[side].place);
    }
};

/// A list of polygons in the order in which a walk met their elements, 64 bytes each, and 32 more
/// for each side that is a part of a larger edge.
class PolygonAsides {
public:
    /// \param elements an empty list for elements of the grid
    explicit PolygonAsides(Elements elements) : elements_{std::move(elements)} {}

    /// \param sides read where they are parts of larger edges
    void add(const Polygon& polygon, const PolygonSides& sides) {
        polygons_.push_back(polygon);
        for (std::size_t i = 0; i < polygon.sides; ++i) {
            if ((polygon.within >> i & 1U) != 0) sides_.push_back(sides[i]);
        }
    }
    /// Adds a handle of the element of the polygon that was added last.
    void add_handle(const Handle& element) { elements_.append(element); }

    /// Adds the list of another task.
    /// \param numbers those that the vertices of the other task have in this one; none where they
    ///        have no numbers
    void append(const PolygonAsides& other, std::span<const std::uint32_t> numbers) {
        for (Polygon polygon : other.polygons_) {
            for (std::size_t i = 0; !numbers.empty() && i < polygon.sides; ++i) {
                polygon.vertex[i] = numbers[polygon.vertex[i]];
            }
            if (!numbers.empty() && polygon.centred) polygon.centre = numbers[polygon.centre];
            polygons_.push_back(polygon);
        }
        sides_.insert(sides_.end(), other.sides_.begin(), other.sides_.end());
        elements_.append(other.elements_);
    }

    /// Calls function(polygon, its sides, its number in the list) for all polygons.
    template <class Function>
    void for_each(Function&& function) const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        auto larger = sides_.begin();
        for (std::size_t number = 0; number < polygons_.size(); ++number) {
            const Polygon& polygon = polygons_[number];
            PolygonSides sides;
            for (std::size_t i = 0; i < polygon.sides; ++i) {
                if ((polygon.within >> i & 1U) != 0) {
                    sides[i] = *larger++;
                    continue;
                }
                const NodeKey from = polygon.key[i];
                const NodeKey to = polygon.key[(i + 1U) % polygon.sides];
                const double end = from < to ? infinity : -infinity;
                sides[i] = {{from, to}, {-end, end}};
            }
            function(polygon, sides, number);
        }
    }
    /// A handle of an element, valid until the list changes. Requires that handles were added.
    Handle handle(std::size_t number) const { return elements_.handle(number); }

    std::size_t memory_bytes() const {
        return polygons_.size() * sizeof(Polygon) + sides_.size() * sizeof(PolygonSide) +
               elements_.memory_bytes();
    }

private:
    std::deque<Polygon> polygons_;
    std::deque<PolygonSide> sides_;  // parts of larger edges, in the order of the polygons
    Elements elements_;              // where the surface keeps elements
};

}  // namespace nestgrid::engine
