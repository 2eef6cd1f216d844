// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A lens (lens.hpp) on leaves and the elements below them: an element, an edge or a face is fine
// where `share` times its diameter is at most T at each of its corners, T growing by `slope` with
// the distance from the domain.
//
// A half of a part has at most 3/4 of its diameter, and its corners lie within 3/4 of a diameter
// from those of the part. So with share >= 3 slope a half of what is fine is fine. Invariants:
//   - whether a part is fine is a function of its leaf, or its record, and its place alone;
//   - parts of what is fine are fine.
// Consequence: as for flatness by beta, elements around an edge or face agree.
#pragma once

#include <utility>

#include <high_order/leaf_records.hpp>
#include <nestgrid/algorithms/projection.hpp>

namespace nestgrid::engine {

/// The corners of all leaves in space.
class LeafCorners {
public:
    explicit LeafCorners(const BaseWalk& walk);

    /// A point of a leaf, whose edges are straight. \param leaf in the order of the walk
    /// \param at in units of 2^-level
    Point position(std::size_t leaf, const Place& at, int level) const;
    /// Positions of several points of a leaf, which are written into room.
    std::span<const Point> positions(std::size_t leaf, std::span<const Place> points, int level,
                                     std::array<Point, max_corners>& room) const;
    std::size_t memory_bytes() const { return leaves_.capacity() * sizeof(Leaf); }

private:
    struct Leaf {
        Shape shape = Shape::point;
        std::array<std::array<double, max_corners>, 3> net{};  // of each coordinate, of degree 1
    };
    std::vector<Leaf> leaves_;
};

/// Edges and faces of leaves, and elements below these, that are in or near a region.
class RegionParts {
public:
    /// Borrows the corners.
    RegionParts(RegionRequest region, const LeafCorners& corners)
        : region_{std::move(region)}, corners_{&corners} {}

    double tolerance() const { return region_.threshold; }
    /// Whether a part of a leaf is. Those around a part that is are, too.
    /// \param corners in units of 2^-level
    bool has(std::size_t leaf, std::span<const Place> corners, int level) const;
    bool has(const PartOfLeaf& part) const { return has(part.leaf, part.corners(), part.level); }
    /// Whether elements at a node of the hierarchy, their parts and all below may be. Where they
    /// are at a new node, they are at the corners. \param size as in RealNode
    bool may_have(double size, const Point& node) const {
        return region_.distance(node) <= (1 + 1.1 * share) * size;
    }

private:
    static constexpr double share = 3.125;  // of the diameter, as far as near is

    RegionRequest region_;
    const LeafCorners* corners_;
};

class LensSizes {
public:
    /// Borrows the corners.
    /// \throw InvalidInput where the sizes of the lens are not 0 < finest <= coarsest
    LensSizes(const LensRequest& lens, const LeafCorners& corners);

    /// Whether a part of a leaf with these corners is fine. \param leaf in the order of the walk
    /// \param corners in units of 2^-level
    bool is_fine(std::size_t leaf, std::span<const Place> corners, int level) const;
    bool is_fine(const PartOfLeaf& part) const {
        return is_fine(part.leaf, part.corners(), part.level);
    }
    /// Whether elements of the hierarchy may stop at a node. \param size as in RealNode
    bool may_stop(double size, const Point& node) const;

private:
    double greatest_size(const Point& x) const;

    LensRequest lens_;
    double share_;
    const LeafCorners* corners_;
};

}  // namespace nestgrid::engine
