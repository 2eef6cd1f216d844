// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <drawing/requirements.hpp>

#include <nestgrid/error.hpp>
#include <ranks/shared_nodes.hpp>

namespace nestgrid::engine {

namespace {

[[noreturn]] void refuse_changed() {
    throw GridError("the grid has changed since its indicator was computed");
}

/// \throw InvalidInput as require_sound()
void require_saturated(const Criterion& criterion, const Bounds& bounds, bool decodes) {
    if (criterion.insists() && decodes) {
        throw InvalidInput(
            "the criterion is not saturated, and values of this field are decoded from those at "
            "corners, which are not exact then");
    }
    if (criterion.insists()) return;
    if (!criterion.saturated()) {
        throw InvalidInput(
            "the criterion is not saturated, so that the surface may have open edges and no bound "
            "holds: saturate it, or insist with Unsaturated{criterion}");
    }
    if (criterion.needs_one_level_a_node() && !bounds.one_level_a_node()) {
        throw InvalidInput(
            "the criterion depends on the level on which a node is created, and the grid creates "
            "some nodes on several levels: use NodeLevels (node_levels.hpp)");
    }
}

}  // namespace

template <class Real>
void require_same_epoch(const Hierarchy<Real>& hierarchy, const Bounds& bounds) {
    if (!bounds.made_for(hierarchy.epoch())) refuse_changed();
}

template <class Real>
void require_sound(const Hierarchy<Real>& hierarchy, const Criterion& criterion,
                   const Bounds& bounds) {
    require_same_epoch(hierarchy, bounds);
    if (!criterion.made_for(hierarchy.epoch())) refuse_changed();
    require_saturated(criterion, bounds, hierarchy.facts().decodes);
}

template <class Real>
bool may_stop_apart(const Hierarchy<Real>& hierarchy, const Criterion& criterion,
                    const Bounds& bounds) {
    if (hierarchy.offers(Feature::constrained) || bounds.hanging() != nullptr) return true;
    if (const SharedNodes* shared = hierarchy.facts().shared; shared != nullptr) {
        if (shared->any_hangs()) return true;
    }
    if (criterion.never_holds()) return false;
    const Threshold* const threshold = criterion.as_threshold();
    if (threshold != nullptr && threshold->epsilon() < threshold->indicator()->least_stop()) {
        return false;
    }
    return hierarchy.offers(Feature::hidden) || !bounds.stops_conform();
}

#define NESTGRID_INSTANTIATE(Real)                                                        \
    template void require_same_epoch(const Hierarchy<Real>&, const Bounds&);              \
    template void require_sound(const Hierarchy<Real>&, const Criterion&, const Bounds&); \
    template bool may_stop_apart(const Hierarchy<Real>&, const Criterion&, const Bounds&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::engine
