// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/blended.hpp>

#include <cmath>
#include <string>

#include <indicators/float_weight.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

double detail::blend_weight(double eta, double epsilon, double factor) {
    // A little less than factor * epsilon, which covers the rounding of sums (KeyFrames).
    const double end = factor * (1 - 0x1p-40) * epsilon;
    if (eta <= epsilon) return 1;
    if (!(eta < end)) return 0;
    return (end - eta) / (end - epsilon);
}

Blended::Blended(const Indicator* indicator, double epsilon, double factor)
    : indicator_{indicator}, epsilon_{epsilon}, factor_{factor} {
    if (!(factor >= 1) || !std::isfinite(factor)) {
        throw InvalidInput("a criterion blends by a factor of at least 1, not by " +
                           std::to_string(factor));
    }
}

NodeMask Blended::holds(const NewNodes& nodes) const {
    return indicator_->stops_at_most(nodes.rule, nodes.keys, epsilon_) & ~nodes.outside;
}

void Blended::weights(const NewNodes& nodes, std::span<float> s) const {
    for (std::size_t n = 0; n < s.size(); ++n) {
        const bool outside = (nodes.outside >> n & 1U) != 0;
        s[n] =
            outside ? 0 : engine::float_weight(indicator_->stop(nodes.keys[n]), epsilon_, factor_);
    }
}

bool Blended::saturated() const {
    return indicator_->saturated() && indicator_->spread().factor >= factor_;
}

}  // namespace nestgrid
