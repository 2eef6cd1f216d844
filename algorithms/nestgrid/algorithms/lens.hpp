// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Magnifying glasses (paper, section 4.3): fine in a domain, coarser by the distance from it.
//
//     S(x) = (eta(x) <= T(x)),   T(x) = min(coarsest, finest + slope * distance(x)),
//
// where eta is any indicator that was spread by a slope: mesh_size() for a lens in units of length,
// the offsets of the data for one in units of the data. The slope of the lens is that of the
// indicator, less a part of 2^-10, which covers the rounding of distances.
//
// The paper spreads nothing, and derives a slope from the refinement rules instead. That slope
// exists on few grids, and even there S(corner) does not imply S(new node). Here
//     eta(y) <= eta(x) / factor - slope |x - y| <= T(x) / ... - slope |x - y| <= T(y)
// for every corner x and new node y of a split, because the distance has Lipschitz constant 1: S is
// saturated for any slope, any rules and any domain. The indicator knows nothing of the domain, so
// that a lens moves, and grows, without a new sweep.
#pragma once

#include <limits>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/domains.hpp>

namespace nestgrid {

/// Thresholds in the units of the indicator.
struct LensOptions {
    double finest = 0;  ///< in the domain; elements there are at most so large
    double coarsest = std::numeric_limits<double>::infinity();  ///< far from the domain
    /// S is a weight between 0 and 1 where T < eta < blend * T (blended.hpp): nodes move as the
    /// lens does, and do not jump. 1 blends nothing.
    double blend = 1;
};

/// S of a lens. The indicator must outlive the criterion.
class Lens final : public Criterion {
public:
    /// \param indicator whose spread has the slope of the lens, and a factor of at least `blend`;
    ///        with a lower factor the criterion is not saturated, and algorithms refuse it
    /// \param distance from the domain (domains.hpp)
    /// \throw InvalidInput where `finest` is negative or infinite, `coarsest` below it, `blend`
    ///        below 1 or infinite, one of them no number, or the distance an empty function
    Lens(const Indicator* indicator, Distance distance, const LensOptions& options = {});

    NodeMask holds(const NewNodes& nodes) const override;
    bool blends() const override { return options_.blend > 1; }
    void weights(const NewNodes& nodes, std::span<float> s) const override;
    bool wants_positions() const override { return true; }
    bool saturated() const override;
    bool made_for(std::uint64_t epoch) const override { return indicator_->made_for(epoch); }

    /// T at a point.
    double threshold(const Point& x) const;

private:
    const Indicator* indicator_;
    Distance distance_;
    LensOptions options_;
    double slope_;
};

}  // namespace nestgrid
