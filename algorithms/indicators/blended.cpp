// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/blended.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <nestgrid/error.hpp>

namespace nestgrid {

double blend_weight(double eta, double epsilon, double factor) {
    if (eta <= epsilon) return 1;
    if (!(eta < factor * epsilon)) return 0;
    return (factor * epsilon - eta) / ((factor - 1) * epsilon);
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
    constexpr float below_one = 1 - 0x1p-24F;  // the greatest float below 1
    const NodeMask whole = holds(nodes);
    for (std::size_t n = 0; n < s.size(); ++n) {
        if ((whole >> n & 1U) != 0) {
            s[n] = 1;
        } else if ((nodes.outside >> n & 1U) != 0) {
            s[n] = 0;
        } else {
            const double weight = blend_weight(indicator_->stop(nodes.keys[n]), epsilon_, factor_);
            s[n] = std::min(static_cast<float>(weight), below_one);
        }
    }
}

bool Blended::saturated() const {
    return indicator_->saturated() && indicator_->spread().factor >= factor_;
}

}  // namespace nestgrid
