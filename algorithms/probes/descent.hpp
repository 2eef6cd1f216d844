// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points on their way down, all of them in one walk.
//
// Invariants, for an element that the walk is at:
//   - its group holds the points that may lie in it, with their reference coordinates;
//   - these are the inverse of the element's own map: where the map of a child is a part of its
//     father's they are handed down by the rule, else found by Newton's method from there.
// The nested descent hands each point to the child that it is deepest in, so that rounding loses
// none, and goes no farther where maps are no parts of others. The wide descent hands a point to
// all children that it may lie in, and needs a walk that carries positions.
// Memory: 32 bytes a level for each point that is in an element there together with others.
#pragma once

#include <deque>
#include <vector>

#include <nestgrid/algorithms/probe.hpp>
#include <probes/handed_points.hpp>
#include <walk/criterion_question.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// By how much, in reference coordinates, the wide descent looks beyond the faces of an element:
/// what lies below may reach there. True positions may be farther from those of a coarse grid.
inline constexpr double wide_margin = 0.25;
inline constexpr double curved_margin = 1;

template <class Real>
class Descent final : public Visitor<Real> {
public:
    /// \param margin 0 for the nested descent; for the wide one, that of coarse elements
    Descent(const Walk<Real>& walk, const Criterion& criterion, std::span<const Point> points,
            double margin, ProbeResult& result);

    /// Takes points down. A point that reaches several elements gets the value of the one it is
    /// deepest in.
    /// \param found sorted by coarse element; its order changes
    void run(std::span<PointInElement> found);

    Decision inspect(const ElementView<Real>& view, const Split& split) override;
    void extract(const ElementView<Real>& view) override;
    NodeMask children(const ElementView<Real>& view) override;

private:
    using Group = std::span<PointInElement>;
    using View = ElementView<Real>;

    /// The element of one level that the walk is at, and what it hands to its children.
    struct Level {
        Group group;                      ///< the points of the element
        bool affine = false;              ///< its map is affine
        const ChildMaps* maps = nullptr;  ///< of its rule
        bool nested = false;              ///< the children's maps are parts of the element's
        HandedPoints handed;              ///< the points of the children
    };

    Level& at_level(int level);
    void arrive(const View& view);
    void refine(const View& view, Group& group);
    double margin(int level) const { return level == 0 ? margin_ : wide_margin; }

    const Walk<Real>* walk_;
    const Criterion* criterion_;
    std::span<const Point> points_;
    double margin_;
    bool curved_;
    ProbeResult* result_;
    CriterionQuestion question_;
    ChildMapTable maps_;
    std::deque<Level> levels_;
    Group coarse_;
    std::vector<PointInElement> handed_;  // by the element at hand, before it is sorted
    std::vector<double> distance_;        // of each point from the faces of its element
};

}  // namespace nestgrid::engine
