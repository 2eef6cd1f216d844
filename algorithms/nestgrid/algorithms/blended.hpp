// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Continuous level of detail (paper, section 6): S has values between 0 and 1,
//     P_S U(x) = S(x) * interpolant + (1 - S(x)) * U(x),
// so that a node moves as epsilon changes and does not jump.
//
// S is 1 where eta <= epsilon, 0 where eta >= factor * epsilon, and linear in eta between. Elements
// stop where S is 1 at all new nodes ("max S = 1" in the paper would stop where one is).
// Consequences, with an indicator that spreads by the same factor:
//   - the corners of a split element have their true values, as under a Threshold;
//   - a node is off by at most epsilon where factor <= 2, else by factor^2 epsilon / (4 (factor -
//   1));
//   - where eta is not below the offsets of the data, P_S U at a node moves by at most
//     factor^2 / (factor - 1) times a change of epsilon: least for 2, where it is 4.
// Surfaces on simplices move continuously. On other shapes P_S U does, too, but when an element
// stops, its flat triangles replace those of its children: a step of at most its affine_residual.
#pragma once

#include <nestgrid/algorithms/criterion.hpp>

namespace nestgrid {

namespace detail {

/// 1 where eta <= epsilon, 0 where eta >= factor * epsilon, linear between.
/// \param factor at least 1
double blend_weight(double eta, double epsilon, double factor);

}  // namespace detail

/// S(x) = blend_weight(eta(x), epsilon, factor). With factor 1 it is Threshold. The indicator must
/// outlive the criterion.
class Blended final : public Criterion {
public:
    /// \param factor at most that of the indicator's Spread; else the criterion is not saturated,
    ///        and algorithms refuse it
    /// \throw InvalidInput where the factor is below 1 or not finite
    Blended(const Indicator* indicator, double epsilon, double factor);

    NodeMask holds(const NewNodes& nodes) const override;
    bool blends() const override { return factor_ > 1; }
    void weights(const NewNodes& nodes, std::span<float> s) const override;
    bool saturated() const override;
    bool made_for(std::uint64_t epoch) const override { return indicator_->made_for(epoch); }
    double surface_error(std::span<const double> isovalues) const override {
        return indicator_->surface_error(isovalues, factor_ * epsilon_);
    }

private:
    const Indicator* indicator_;
    double epsilon_;
    double factor_;
};

}  // namespace nestgrid
