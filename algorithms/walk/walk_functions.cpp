// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The functions of position that a walk carries, at the new nodes of a split.
#include <nestgrid/detail/interpolate.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// Puts the functions of position at the new nodes into the frame, in the order of the rule: an
/// earlier node may be a parent of a later one. Requires the positions of the nodes there, where
/// the walk carries them.
template <class Real>
void Walk<Real>::put_functions(const View& view, const Split& split, NodeMask mean,
                               Frame<Real>& frame) const {
    const Rule& rule = *split.rule;
    const std::size_t corners = view.corner_count();
    const NodeMask fixed = fixed_ == nullptr ? 0 : fixed_->mask(split.keys);
    const NodeMask interpolated = functions_->affine() ? rule.all() : mean;
    SplitPositions own;
    std::span<const Point> x;
    if (carries_positions_) {
        x = std::span(frame.position).subspan(corners);
    } else if ((interpolated | fixed) != rule.all()) {
        x = split_positions(view, split, own).subspan(corners);
    }
    Real* const value = frame.value.data();
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        Real* const at = value + (corners + n) * components_;
        if ((fixed >> n & 1U) != 0) {
            fixed_->put_functions(split.keys[n], at);
            continue;
        }
        for (std::size_t c = 0; c < functions_->count(); ++c) {
            if ((mean >> n & 1U) != 0 || functions_->affine(c)) {
                const Real between = detail::interpolate(rule.new_nodes[n], value + c, components_);
                at[c] = static_cast<Real>(functions_->rounded(c, static_cast<double>(between)));
            } else {
                at[c] = functions_->template at<Real>(c, x[n]);
            }
        }
    }
}

template void Walk<float>::put_functions(const View&, const Split&, NodeMask, Frame<float>&) const;
template void Walk<double>::put_functions(const View&, const Split&, NodeMask,
                                          Frame<double>&) const;

}  // namespace nestgrid::engine
