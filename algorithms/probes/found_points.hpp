// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The results of a probe: a point in several elements gets the value of the one it is deepest in,
// and of several such elements that of the first one.
#pragma once

#include <vector>

#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/ranks.hpp>
#include <ranks/walk_place.hpp>
#include <walk/element_view.hpp>

namespace nestgrid::engine {

template <class Real>
class FoundPoints {
public:
    /// Makes a result in which no point is found.
    FoundPoints(const Hierarchy<Real>& hierarchy, std::size_t points);

    /// Begins with the points of another element.
    void begin_element() { element_ = none; }
    /// Takes the value of the element at hand at a point.
    /// \param s the point in its reference element
    /// \param weight of the corners, in the value
    /// \param depth how deep the point lies in the element
    void offer(const ElementView<Real>& view, std::uint32_t point, const Point& s,
               std::span<const double> weight, double depth);

    /// Takes what other ranks have found, and tells them what this one has. Collective.
    void agree(Ranks& ranks);
    bool found(std::uint32_t point) const { return result_.found(point); }
    TraversalCounts& counts() { return result_.counts; }
    ProbeResult take() { return std::move(result_); }

private:
    std::span<double> values_at(std::uint32_t point) {
        return std::span(result_.values).subspan(point * result_.components, result_.components);
    }
    void take(Reader& in, std::vector<WalkPlace>& first);

    static constexpr std::uint32_t none = ProbeResult::no_element;

    ProbeResult result_;
    std::vector<double> depth_;     // of each point in its element
    const SharedNodes* shared_;     // null on one process
    std::vector<WalkPlace> place_;  // of each element, where there are ranks
    std::uint32_t element_ = none;
};

}  // namespace nestgrid::engine
