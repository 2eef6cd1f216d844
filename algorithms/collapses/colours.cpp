// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/colours.hpp>

namespace nestgrid::engine {

Colours::Colours(std::span<const double> values)
    : value_(values.begin(), values.end()), sum_(values.size()) {}

/// Sum of (l_i - a)^2 = sum of l_i^2 - weight * mean^2 for the best a, the mean.
void Colours::take_off_means(double sign) {
    if (!(weight_ > 0)) return;
    for (const Sum& sum : sum_) {
        quadric_.add_plane(sum.slope, -sum.offset, -sign / weight_);
    }
}

void Colours::add_triangle(const Triangle& x, double area,
                           const std::array<std::span<const double>, 3>& corners) {
    take_off_means(-1);
    const FlatTriangle triangle(x);
    for (std::size_t c = 0; c < sum_.size(); ++c) {
        const Point slope = triangle.gradient({corners[0][c], corners[1][c], corners[2][c]});
        const double offset = corners[0][c] - dot(slope, x[0]);
        sum_[c].slope = sum_[c].slope + area * slope;
        sum_[c].offset += area * offset;
        quadric_.add_plane(slope, -offset, area);
    }
    weight_ += area;
    take_off_means(1);
}

void Colours::add(const Colours& other) {
    take_off_means(-1);
    Colours more = other;
    more.take_off_means(-1);
    for (std::size_t c = 0; c < sum_.size(); ++c) {
        sum_[c].slope = sum_[c].slope + more.sum_[c].slope;
        sum_[c].offset += more.sum_[c].offset;
    }
    quadric_.add(more.quadric_);
    weight_ += more.weight_;
    take_off_means(1);
}

ColourValues Colours::best_at(const Point& x) const {
    ColourValues best;
    for (std::size_t c = 0; c < sum_.size(); ++c) {
        best.push_back(weight_ > 0 ? best_at(x, sum_[c]) : value_[c]);
    }
    return best;
}

double Colours::excess(const Point& x, const ColourValues& values) const {
    if (!(weight_ > 0)) return 0;
    double excess = 0;
    for (std::size_t c = 0; c < sum_.size(); ++c) {
        const double off = values[c] - best_at(x, sum_[c]);
        excess += weight_ * off * off;
    }
    return excess;
}

}  // namespace nestgrid::engine
