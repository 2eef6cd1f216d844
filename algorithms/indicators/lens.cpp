// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/lens.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <indicators/float_weight.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

/// The part of the slope that is left for the rounding of distances.
constexpr double slack = 0x1p-10;

}  // namespace

Lens::Lens(const Indicator* indicator, Distance distance, const LensOptions& options)
    : indicator_{indicator},
      distance_{std::move(distance)},
      options_{options},
      slope_{indicator->spread().slope * (1 - slack)} {
    if (!(options.finest >= 0 && options.finest <= options.coarsest) ||
        !std::isfinite(options.finest)) {
        throw InvalidInput("a lens has thresholds 0 <= finest <= coarsest, not " +
                           std::to_string(options.finest) + " and " +
                           std::to_string(options.coarsest));
    }
    if (!(options.blend >= 1) || !std::isfinite(options.blend)) {
        throw InvalidInput("a lens blends by a factor of at least 1, not by " +
                           std::to_string(options.blend));
    }
    if (!distance_) throw InvalidInput("a lens has no distance from its domain");
}

double Lens::threshold(const Point& x) const {
    const double distance = std::max(distance_(x), 0.0);
    return std::min(options_.coarsest, options_.finest + slope_ * distance);
}

NodeMask Lens::holds(const NewNodes& nodes) const {
    NodeMask mask = 0;
    for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
        const double eta = indicator_->stop(nodes.keys[n]);
        const bool holds = eta <= options_.finest ||
                           (eta <= options_.coarsest && eta <= threshold(nodes.positions[n]));
        mask |= NodeMask{holds} << n;
    }
    return mask & ~nodes.outside;
}

void Lens::weights(const NewNodes& nodes, std::span<float> s) const {
    for (std::size_t n = 0; n < s.size(); ++n) {
        const bool outside = (nodes.outside >> n & 1U) != 0;
        s[n] = outside ? 0
                       : engine::float_weight(indicator_->stop(nodes.keys[n]),
                                              threshold(nodes.positions[n]), options_.blend);
    }
}

bool Lens::saturated() const {
    return indicator_->saturated() && indicator_->spread().factor >= options_.blend;
}

}  // namespace nestgrid
