// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The leaves of a grid in which a field may be near an isovalue, kept for many questions.
//
// Where U is continuous, a connected set on which |U - C| <= e, and which begins in such a leaf,
// does not leave them but through the boundary of the domain: on a face to any other leaf
// |U - C| > e. Memory is that of the leaves through which the surface passes, and of those around
// it to a distance at which U differs from C by e.
//
// Leaves along a surface that is given keep several components, each in units of its own error.
#pragma once

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/hierarchy.hpp>

#include <distances/closest_points.hpp>

namespace nestgrid::engine {

/// A leaf as it is kept.
struct NearLeaf {
    std::uint32_t first;  ///< of its corners in the list of all leaves' corners
    Shape shape;
    bool affine;            ///< its map is affine and U on it a polynomial
    std::uint8_t boundary;  ///< faces on the boundary of the domain, one bit each
};

class NearLeaves {
public:
    /// Walks to the leaves in which |U - C| <= e somewhere, U being component 0.
    /// \param bounds of the same grid and field, for the search
    template <class Real>
    static NearLeaves find(const Hierarchy<Real>& hierarchy, double isovalue, double error,
                           const Bounds& bounds);

    /// Walks to the leaves at the boundary of the domain that come within a distance of a surface.
    /// \param bounds of the same grid
    template <class Real>
    static NearLeaves find_at_boundary(const Hierarchy<Real>& hierarchy,
                                       const ClosestPoints& surface, double distance,
                                       const Bounds& bounds);

    /// Walks to the leaves that a surface passes through or touches, in a hierarchy of dimension 2
    /// or 3. Values are those of the last components, in units of their errors; error() is 1.
    /// \param errors no more than the field has components
    /// \param reach how far from the surface leaves are wanted, too
    /// \param bounds of the same grid
    template <class Real>
    static NearLeaves find_along(const Hierarchy<Real>& hierarchy, const Surface<3>& surface,
                                 std::span<const double> errors, double reach,
                                 const Bounds& bounds);

    double error() const { return error_; }
    std::size_t components() const { return components_; }
    /// Whether leaves may be missing because they are hidden.
    bool may_hide() const { return may_hide_; }
    std::size_t node_count() const { return position_.size(); }
    const Point& position(std::uint32_t node) const { return position_[node]; }
    /// U - C, or a component in units of its error.
    double value(std::uint32_t node, std::size_t component = 0) const {
        return value_[node * components_ + component];
    }
    std::span<const NearLeaf> leaves() const { return leaves_; }
    std::span<const std::uint32_t> nodes(const NearLeaf& leaf) const {
        return std::span(nodes_).subspan(leaf.first, topology(leaf.shape).corners);
    }
    /// Positions of the corners. \param out takes them
    std::span<const Point> corners(const NearLeaf& leaf, std::array<Point, max_corners>& out) const;

    /// Calls function(leaf) for the leaves in boxes of which meets(box) is true, until it returns
    /// false. \return whether it never did
    template <class Meets, class Function>
    bool for_each(const Meets& meets, const Function& function) const {
        return tree_.for_each(meets, [&](std::size_t i) { return function(leaves_[i]); });
    }
    /// As for_each(), but meets(box, level, group) also gets the group in the tree of boxes.
    template <class Meets, class Function>
    bool for_each_in_groups(const Meets& meets, const Function& function) const {
        return tree_.for_each_in_groups(meets, [&](std::size_t i) { return function(leaves_[i]); });
    }
    std::size_t memory_bytes() const;

private:
    template <class Real>
    class Search;
    template <class Real, class Wants>
    static NearLeaves collect(const Hierarchy<Real>& hierarchy, double isovalue, std::size_t first,
                              std::span<const double> units, const Bounds& bounds,
                              const Wants& wants);

    double error_ = 0;
    std::size_t components_ = 1;
    bool may_hide_ = false;
    std::vector<Point> position_;
    std::vector<double> value_;
    std::vector<std::uint32_t> nodes_;
    std::vector<NearLeaf> leaves_;
    BoxTree tree_;
};

}  // namespace nestgrid::engine
