// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/found_points.hpp>

#include <limits>

namespace nestgrid::engine {

template <class Real>
FoundPoints<Real>::FoundPoints(const Hierarchy<Real>& hierarchy, std::size_t points)
    : depth_(points, -std::numeric_limits<double>::infinity()) {
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

template class FoundPoints<float>;
template class FoundPoints<double>;

}  // namespace nestgrid::engine
