// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points on their way down in reference coordinates, all of them in one walk.
//
// Invariants, for an element that the walk is at:
//   - its group holds the points that may lie in it, with their reference coordinates;
//   - these are the inverse of the element's own map, handed down by the rule, because the map of a
//     child is a part of its father's.
// Each point is handed to the child that it is deepest in, so that rounding loses none. Points go
// no farther where maps are no parts of others.
// Memory: 32 bytes a level for each point that is in an element there together with others.
#pragma once

#include <deque>
#include <vector>

#include <probes/found_points.hpp>
#include <probes/handed_points.hpp>
#include <walk/criterion_question.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

template <class Real>
class Descent final : public Visitor<Real> {
public:
    Descent(const Walk<Real>& walk, const Criterion& criterion, FoundPoints<Real>& found)
        : walk_{&walk}, criterion_{&criterion}, found_{&found} {}

    /// Takes points down.
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

    const Walk<Real>* walk_;
    const Criterion* criterion_;
    FoundPoints<Real>* found_;
    CriterionQuestion question_;
    ChildMapTable maps_;
    std::deque<Level> levels_;
    Group coarse_;
    std::vector<PointInElement> handed_;  // by the element at hand, before it is sorted
};

}  // namespace nestgrid::engine
