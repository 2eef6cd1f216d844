// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points on their way down through boxes, all of them in one walk: where children are no parts of
// the map of their father, or lie where the grid puts them.
//
// Invariant: the group of an element that the walk is at holds all points that lie in elements
// below it. Its box, widened by the reach of what is below, contains them.
// Where nodes that hang are interpolated, an element that is drawn differs from the one whose
// corners lie where the grid has them. A point that lies in the latter alone, at a curved boundary
// for instance, has its reference coordinates there, and takes the function of the element that is
// drawn, continued to the point.
#pragma once

#include <deque>
#include <vector>

#include <probes/coarse_search.hpp>
#include <probes/found_points.hpp>
#include <probes/reach.hpp>
#include <walk/criterion_question.hpp>

namespace nestgrid::engine {

template <class Real>
class BoxDescent final : public Visitor<Real> {
public:
    /// \param walk must carry positions
    BoxDescent(const Walk<Real>& walk, const Criterion& criterion, std::span<const Point> points,
               const Reach& reach, FoundPoints<Real>& found)
        : walk_{&walk}, criterion_{&criterion}, points_{points}, reach_{&reach}, found_{&found} {}

    /// Takes points down.
    /// \param which their numbers
    void run(std::span<const std::uint32_t> which);

    Decision inspect(const ElementView<Real>& view, const Split& split) override;
    void extract(const ElementView<Real>& view) override;
    NodeMask children(const ElementView<Real>& view) override;

private:
    using View = ElementView<Real>;
    using Group = std::vector<std::uint32_t>;

    Group& group_on(int level);
    void arrive(const View& view);

    const Walk<Real>* walk_;
    const Criterion* criterion_;
    std::span<const Point> points_;
    const Reach* reach_;
    FoundPoints<Real>* found_;
    CriterionQuestion question_;
    std::vector<Candidate> coarse_;  // by element
    std::deque<Group> groups_;       // of the element at hand and those above, by level
};

}  // namespace nestgrid::engine
