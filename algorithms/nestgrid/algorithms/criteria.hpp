// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The criteria that a projection stands for, one for each threshold.
#pragma once

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/prerolls.hpp>
#include <nestgrid/algorithms/region.hpp>

namespace nestgrid {

/// S of a projection of one field at any threshold, and what it is made of.
class Criteria {
public:
    /// Makes the indicators that the projection needs, or takes them from the prerolls. Where it
    /// asks for everything, Prerolls::finest().
    /// \param isovalues of the level sets that are drawn; empty where none are
    /// \throw InvalidInput as Projection::check() and Prerolls::choose()
    Criteria(const Prerolls& prerolls, Projection projection, std::span<const double> isovalues,
             const Work& work);

    /// S at a threshold, which holds at more nodes the greater it is. Must not outlive this object.
    /// \throw InvalidInput for a threshold above 0, where the projection asks for everything
    AnyCriterion at(double threshold) const;
    /// S at the threshold of the projection.
    AnyCriterion criterion() const { return at(projection_.least_threshold()); }

    const Projection& projection() const { return projection_; }
    /// The row of the indicator, also where the projection asks for an error.
    const IndicatorKind& kind() const { return *chosen_.kind; }
    /// Not where the projection asks for everything.
    const Indicator& indicator() const { return *chosen_.indicator; }
    const Bounds& bounds() const { return *chosen_.bounds; }
    const std::shared_ptr<const Bounds>& shared_bounds() const { return chosen_.bounds; }

private:
    Projection projection_;
    ChosenIndicator chosen_;
    std::shared_ptr<const SweptIndicator> sizes_;  // where there is a lens
    std::optional<Region> region_;
};

}  // namespace nestgrid
