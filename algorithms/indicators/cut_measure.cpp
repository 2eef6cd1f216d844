// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/cut_measure.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nestgrid::engine {

namespace {

/// 1 / slope; the greatest number where that is none.
double inverse(double slope) {
    constexpr double most = std::numeric_limits<double>::max();
    return slope > 1 / most ? 1 / slope : most;
}

}  // namespace

void CutMeasure::begin(std::size_t first, std::size_t last, double most) {
    if (greatest_.size() < last) {
        greatest_.resize(last);
        most_.resize(last);
        low_.resize(last);
        high_.resize(last);
        active_.resize(last);
        error_.resize(last);
        per_slope_.resize(last, 1);
        function_.resize(max_corners * last);
    }
    for (std::size_t i = first; i < last; ++i) {
        greatest_[i] = 0;
        most_[i] = most;
    }
}

double CutMeasure::greatest(std::size_t first, std::size_t last) const {
    double greatest = 0;
    for (std::size_t i = first; i < last; ++i) greatest = std::max(greatest, greatest_[i]);
    return greatest;
}

bool CutMeasure::look(const CutCorners& at, bool leaf, double bound) {
    find_ranges(at);
    bool any = false;
    for (const double isovalue : isovalues_) {
        const std::size_t active = find_active(at, isovalue, bound);
        if (active == 0) continue;
        any = true;
        if (leaf) measure(at, active, isovalue);
    }
    return any;
}

void CutMeasure::find_ranges(const CutCorners& at) {
    double* const low = low_.data();
    double* const high = high_.data();
    const double* const first = at.row[0];
    for (std::size_t i = 0; i < at.columns; ++i) low[i] = high[i] = first[i];
    for (std::size_t k = 1; k < at.count; ++k) {
        const double* const row = at.row[k];
        for (std::size_t i = 0; i < at.columns; ++i) {
            low[i] = row[i] < low[i] ? row[i] : low[i];
            high[i] = high[i] < row[i] ? row[i] : high[i];
        }
    }
}

/// Whether an error up to `limit` would count. What is left out must not depend on the order of
/// elements: estimates of distances do.
bool CutMeasure::is_active(std::size_t column, double limit) const {
    return distances_ || greatest_[column] < limit;
}

/// Lists the functions that may have a greater error below the element than is known.
std::size_t CutMeasure::find_active(const CutCorners& at, double isovalue, double bound) {
    const auto [least, most] = std::ranges::minmax(std::span(at.value).first(at.count));
    const double above = (most + bound) - isovalue;   // the data are inside by this at most
    const double below = isovalue - (least - bound);  // and outside by this
    const bool inside = below <= 0;
    const bool cut = !inside && above >= 0;
    std::size_t active = 0;
    for (std::size_t i = 0; i < at.columns; ++i) {
        const bool all_in = low_[i] >= isovalue;
        const bool all_out = high_[i] < isovalue;
        if (cut) {
            const double error = all_in ? below : all_out ? above : std::max(above, below);
            const double back = std::max(isovalue - low_[i], high_[i] - isovalue);
            active_[active] = i;
            active += is_active(i, std::max(error, back)) ? 1U : 0U;
            continue;
        }
        if (inside ? all_in : all_out) continue;
        const double error = inside ? above : below;
        if (distances_ && (all_in || all_out)) {
            estimate(at, i, error - bound);
            continue;
        }
        active_[active] = i;
        active += is_active(i, error) ? 1U : 0U;
    }
    return active;
}

/// The distance where data and function lie on different sides of the isovalue, as far as the data
/// at the corners tell.
void CutMeasure::estimate(const CutCorners& at, std::size_t column, double error) {
    if (greatest_[column] >= most_[column]) return;
    const AffineSlopes slopes(at.position, at.dimension);
    const double slope = slopes.slope([&](std::size_t k) { return at.value[k]; });
    greatest_[column] =
        std::max(greatest_[column], std::min(most_[column], error * inverse(slope)));
}

/// The slopes of the data and of the active functions in a leaf.
void CutMeasure::find_slopes(const CutCorners& at, std::size_t active) {
    const AffineSlopes slopes(at.position, at.dimension);
    data_per_slope_ = inverse(slopes.slope([&](std::size_t k) { return at.value[k]; }));
    for (std::size_t i = 0; i < active; ++i) {
        per_slope_[i] = inverse(slopes.slope([&](std::size_t k) { return at.row[k][active_[i]]; }));
    }
}

/// Raises the active functions to their errors in a leaf: at its corners and between each two.
void CutMeasure::measure(const CutCorners& at, std::size_t active, double isovalue) {
    if (distances_) find_slopes(at, active);
    double* const error = error_.data();
    const double* const per_slope = per_slope_.data();
    for (std::size_t i = 0; i < active; ++i) error[i] = 0;
    for (std::size_t k = 0; k < at.count; ++k) {
        double* const b = function_.data() + k * active;
        const double u1 = at.value[k] - isovalue;
        const double off = std::abs(u1) * data_per_slope_;
        for (std::size_t i = 0; i < active; ++i) {
            b[i] = at.row[k][active_[i]] - isovalue;
            const double here = (b[i] >= 0) != (u1 >= 0) ? off : 0.0;
            error[i] = error[i] < here ? here : error[i];
        }
        for (std::size_t j = 0; j < k; ++j) {
            const double* const a = function_.data() + j * active;
            const double u0 = at.value[j] - isovalue;
            const bool cut = (u0 >= 0) != (u1 >= 0);
            const double t = cut ? u0 / (u0 - u1) : 0;
            const double most_off = std::max(std::abs(u0), std::abs(u1));
            for (std::size_t i = 0; i < active; ++i) {
                const bool crosses = (a[i] >= 0) != (b[i] >= 0);
                const double w = a[i] / (crosses ? a[i] - b[i] : 1.0);
                const double drawn = std::min(std::abs(u0 + w * (u1 - u0)), most_off);
                const double back = std::min(std::abs(a[i] + t * (b[i] - a[i])),
                                             std::max(std::abs(a[i]), std::abs(b[i])));
                const double there = crosses ? drawn * data_per_slope_ : 0.0;
                const double here = cut ? back * per_slope[i] : 0.0;
                const double greater = there < here ? here : there;
                error[i] = error[i] < greater ? greater : error[i];
            }
        }
    }
    for (std::size_t i = 0; i < active; ++i) {
        double& greatest = greatest_[active_[i]];
        const double most = distances_ ? std::min(error[i], most_[active_[i]]) : error[i];
        greatest = std::max(greatest, most);
    }
}

}  // namespace nestgrid::engine
