// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface_errors.hpp"

#include <span>

#include <nestgrid/algorithms/cut_indicator.hpp>

#include "watched_work.hpp"

namespace nestgrid::view {

namespace {

/// Calls measure(hierarchy, executor), which ends where nobody waits for the frame.
template <class Measure>
SweptIndicator watch_measure(const Moment& moment, const Executor& executor, WatchedSteps& steps,
                             const Measure& measure) {
    steps.check();
    const TellingExecutor telling(executor, [&steps](double share) { steps.check(share); });
    return std::visit(
        [&]<class Real>(const std::shared_ptr<const Hierarchy<Real>>& hierarchy) {
            if (telling.concurrency() > 1) return measure(*hierarchy, telling);
            const WatchedHierarchy<Real> watched(*hierarchy, steps);
            return measure(static_cast<const Hierarchy<Real>&>(watched), telling);
        },
        moment.hierarchy);
}

}  // namespace

void SurfaceErrors::begin(const Moment& moment, double isovalue) {
    if (isovalue == isovalue_ && moment.weights == weights_) return;
    weights_ = moment.weights;
    isovalue_ = isovalue;
    cuts_.reset();
    slopes_.reset();
}

const SweptIndicator& SurfaceErrors::cuts(const Moment& moment, const Executor& executor,
                                          WatchedSteps& steps) {
    if (cuts_) return *cuts_;
    steps.begin("Measuring errors of the surface");
    return cuts_.emplace(
        watch_measure(moment, executor, steps, [&](const auto& hierarchy, const Executor& on) {
            const std::span isovalues(&isovalue_, 1);
            return cut_deviations(hierarchy, isovalues, moment.bounds(), {}, on);
        }));
}

const SweptIndicator& SurfaceErrors::slopes(const Moment& moment, const Executor& executor,
                                            WatchedSteps& steps) {
    if (slopes_) return *slopes_;
    steps.begin("Measuring distances of the surface");
    return slopes_.emplace(
        watch_measure(moment, executor, steps, [&](const auto& hierarchy, const Executor& on) {
            const std::span isovalues(&isovalue_, 1);
            return slope_deviations(hierarchy, isovalues, moment.bounds(), {}, on);
        }));
}

}  // namespace nestgrid::view
