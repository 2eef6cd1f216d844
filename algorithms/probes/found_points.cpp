// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/found_points.hpp>

#include <limits>

#include <ranks/agreement.hpp>

namespace nestgrid::engine {

template <class Real>
FoundPoints<Real>::FoundPoints(const Hierarchy<Real>& hierarchy, std::size_t points)
    : depth_(points, -std::numeric_limits<double>::infinity()), shared_{hierarchy.facts().shared} {
    result_.components = static_cast<std::size_t>(hierarchy.facts().components);
    result_.values.assign(points * result_.components, std::numeric_limits<double>::quiet_NaN());
    result_.level.assign(points, -1);
    result_.element_of.assign(points, none);
    result_.reference.assign(points, Point{0, 0, 0});
    result_.elements = hierarchy.make_elements();
}

template <class Real>
void FoundPoints<Real>::offer(const ElementView<Real>& view, std::uint32_t point, const Point& s,
                              std::span<const double> weight, double depth) {
    if (!(depth > depth_[point])) return;
    if (element_ == none) {
        element_ = static_cast<std::uint32_t>(result_.elements.size());
        result_.elements.append(view.element());
        result_.shape_of.push_back(view.shape);
        if (shared_ != nullptr) place_.push_back(walk_place_of(view, *shared_));
    }
    depth_[point] = depth;
    result_.level[point] = view.level;
    result_.element_of[point] = element_;
    result_.reference[point] = s;
    const std::size_t components = result_.components;
    for (std::size_t c = 0; c < components; ++c) {
        double sum = 0;
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            sum += weight[k] * static_cast<double>(view.value[k * components + c]);
        }
        result_.values[point * components + c] = sum;
    }
}

template <class Real>
void FoundPoints<Real>::agree(Ranks& ranks) {
    Bytes own;
    for (std::uint32_t p = 0; p < depth_.size(); ++p) {
        if (result_.element_of[p] == none) continue;
        const WalkPlace& place = place_[result_.element_of[p]];
        put(own, p);
        put(own, depth_[p]);
        put(own, static_cast<std::uint32_t>(place.size()));
        for (const char digit : place) put(own, digit);
        put(own, result_.level[p]);
        put(own, result_.reference[p]);
        for (double& value : values_at(p)) put(own, value);
    }
    std::vector<WalkPlace> first(depth_.size());
    for (std::uint32_t p = 0; p < depth_.size(); ++p) {
        if (result_.element_of[p] != none) first[p] = place_[result_.element_of[p]];
    }
    Outbox box(ranks.size());
    box.to_all() = std::move(own);
    box.send_to_all(ranks, [&](int, Reader& in) {
        while (in.more()) take(in, first);
    });
}

/// Takes what another rank has found at a point, where that is deeper or comes first.
/// \param first where the element of each point is met
template <class Real>
void FoundPoints<Real>::take(Reader& in, std::vector<WalkPlace>& first) {
    const auto p = in.get<std::uint32_t>();
    const auto depth = in.get<double>();
    WalkPlace place(in.get<std::uint32_t>(), 0);
    for (char& digit : place) digit = in.get<char>();
    const auto level = in.get<int>();
    const auto reference = in.get<Point>();
    const bool wins = depth > depth_[p] || (depth == depth_[p] && place < first[p]);
    for (double& value : values_at(p)) {
        const auto told = in.get<double>();
        if (wins) value = told;
    }
    if (!wins) return;
    depth_[p] = depth;
    result_.level[p] = level;
    result_.reference[p] = reference;
    result_.element_of[p] = none;
    first[p] = std::move(place);
}

template class FoundPoints<float>;
template class FoundPoints<double>;

}  // namespace nestgrid::engine
