// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/criteria.hpp>

#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

Criteria::Criteria(const Prerolls& prerolls, Projection projection,
                   std::span<const double> isovalues, const Work& work)
    : projection_{std::move(projection)} {
    projection_.check();
    if (projection_.has_criterion()) {
        chosen_.bounds = {std::shared_ptr<void>(), projection_.bounds};
        return;
    }
    chosen_ = projection_.asks_for_everything()
                  ? prerolls.finest(work)
                  : prerolls.choose(projection_.indicator, projection_.blend, isovalues, work);
    if (projection_.lens) sizes_ = prerolls.sizes(projection_.sizes_spread(), work);
    if (projection_.region) {
        region_.emplace(work.on(prerolls.field()),
                        [this](const Point& x) { return projection_.region->distance(x) <= 0; });
    }
}

AnyCriterion Criteria::at(double threshold) const {
    if (projection_.criterion) return AnyCriterion(projection_.criterion);
    if (projection_.criterion_at) return projection_.criterion_at(threshold);
    const Indicator* const indicator = chosen_.indicator.get();
    if (indicator == nullptr) {
        if (threshold == 0) return Exact{};
        throw InvalidInput("a projection with a threshold of 0 has no criterion for another one");
    }
    const auto in_lens = [&](auto criterion) -> AnyCriterion {
        if (!projection_.lens) return criterion;
        const LensRequest& lens = *projection_.lens;
        return criterion &&
               Lens(sizes_.get(), lens.distance,
                    {.finest = lens.finest, .coarsest = lens.coarsest, .blend = projection_.blend});
    };
    if (region_) {
        return in_lens(fine_inside(*region_, *indicator, threshold, projection_.region->threshold));
    }
    if (projection_.blend == 1) return in_lens(Threshold(indicator, threshold));
    return in_lens(Blended(indicator, threshold, projection_.blend));
}

}  // namespace nestgrid
