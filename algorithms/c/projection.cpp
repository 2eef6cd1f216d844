// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "projection.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>
#include <nestgrid/error.hpp>

#include <threads/thread_executor.hpp>

#include "prerolls.hpp"

namespace nestgrid {

namespace {

constexpr int most_threads = 1024;

void require_range(const nestgrid_options& options) {
    if (!(options.threshold >= 0)) throw InvalidInput("the threshold is negative or not a number");
    if (!(options.error >= 0)) throw InvalidInput("the error is negative or not a number");
    if (options.indicator < NESTGRID_OFFSET || options.indicator > NESTGRID_SLOPE) {
        throw InvalidInput("the indicator " + std::to_string(options.indicator) +
                           " does not exist");
    }
    if (options.threads < NESTGRID_ALL_THREADS || options.threads > most_threads) {
        throw InvalidInput(std::to_string(options.threads) + " threads are asked for, not -1 to " +
                           std::to_string(most_threads));
    }
    if (options.attribute_count > 0 && options.attributes == nullptr) {
        throw InvalidInput("there are attributes, but the list of their tables is NULL");
    }
}

void require_one_wish(const nestgrid_options& options) {
    if (options.error > 0 && options.threshold > 0) {
        throw InvalidInput("an error and a threshold are asked for: give one of them");
    }
    if (options.error > 0 && options.indicator != NESTGRID_OFFSET) {
        throw InvalidInput("an error is asked for, which has an indicator of its own");
    }
    if (options.max_triangles > 0 && (options.error > 0 || options.threshold > 0)) {
        throw InvalidInput(
            "a number of triangles is asked for beside an error or a threshold: give one of them");
    }
}

int thread_count(int threads) {
    if (threads != NESTGRID_ALL_THREADS) return std::max(threads, 1);
    return static_cast<int>(
        std::min<std::size_t>(engine::ThreadExecutor::all_threads(), most_threads));
}

bool is_simplex(int shape) { return shape == NESTGRID_TRIANGLE || shape == NESTGRID_TETRAHEDRON; }

template <class Real>
bool coarse_simplices(const Hierarchy<Real>& hierarchy) {
    const auto task = hierarchy.open();
    Coarse coarse;
    Family family;
    for (std::size_t i = 0; i < hierarchy.coarse_count(); ++i) {
        hierarchy.coarse(task.get(), i, coarse, family);
        if (!is_simplex(static_cast<int>(coarse.shape))) return false;
    }
    return true;
}

/// The indicator that is to be compared with the threshold.
template <class Real>
int indicator_for(const Asked& asked, const Hierarchy<Real>& hierarchy, bool level_sets) {
    if (asked.options().error == 0) return asked.options().indicator;
    return level_sets && asked.rules_of_simplices() && coarse_simplices(hierarchy)
               ? NESTGRID_CUT
               : NESTGRID_DEVIATION;
}

template <class Real>
SweptIndicator make_swept(int indicator, const Hierarchy<Real>& hierarchy, const Bounds& bounds,
                          std::span<const double> isovalues, const Executor& executor) {
    switch (indicator) {
        case NESTGRID_NUMERICAL:
            return numerical_indicator(hierarchy);
        case NESTGRID_WAVELET:
            return wavelet_indicator(hierarchy);
        case NESTGRID_VISUAL:
            return visual_indicator(hierarchy);
        case NESTGRID_GEOMETRY:
            if (hierarchy.offers(Feature::new_positions)) return geometry_indicator(hierarchy);
            throw InvalidInput("NESTGRID_GEOMETRY is for curved grids: on this one it is 0");
        default:
            break;
    }
    if (isovalues.empty()) {
        throw InvalidInput("NESTGRID_CUT and NESTGRID_SLOPE are for isosurfaces and isolines");
    }
    return indicator == NESTGRID_CUT ? cut_deviations(hierarchy, isovalues, bounds, {}, executor)
                                     : slope_deviations(hierarchy, isovalues, bounds, {}, executor);
}

}  // namespace

Asked::Asked(const nestgrid_options* given, const nestgrid_grid* grid, const nestgrid_field* field)
    : grid_{grid}, field_{field} {
    if (given != nullptr) {
        if (given->size < sizeof(given->size)) {
            throw InvalidInput("the size of the options says " + std::to_string(given->size) +
                               " bytes: set it to that of the struct");
        }
        std::memcpy(&options_, given, std::min(given->size, sizeof(options_)));
    }
    require_range(options_);
    require_one_wish(options_);
    const int threads = thread_count(options_.threads);
    if (threads == 1) {
        executor_ = std::make_unique<SequentialExecutor>();
    } else {
        executor_ = std::make_unique<engine::ThreadExecutor>(threads);
    }
}

bool Asked::rules_of_simplices() const {
    const std::span rules(grid_->rules, static_cast<std::size_t>(grid_->rule_count));
    return std::all_of(rules.begin(), rules.end(), [](const nestgrid_rule& rule) {
        const std::span children(rule.children, static_cast<std::size_t>(rule.child_count));
        return is_simplex(rule.shape) &&
               std::all_of(children.begin(), children.end(),
                           [](const nestgrid_child& child) { return is_simplex(child.shape); });
    });
}

nestgrid_prerolls* Asked::prerolls() const {
    if (options_.prerolls != nullptr) options_.prerolls->require_same(*grid_, *field_);
    return options_.prerolls;
}

IsosurfaceOptions Asked::how_to_draw() const {
    IsosurfaceOptions how{.cuts = options_.finest_cuts != 0 ? Cuts::finest : Cuts::linear,
                          .normals = options_.normals != 0,
                          .cap = options_.cap != 0,
                          .elements = options_.elements != 0 || options_.reference != 0,
                          .reference = options_.reference != 0,
                          .at_nodes = options_.at_nodes != 0};
    if (options_.progress != nullptr) {
        how.progress = [this](const TraversalCounts& counts) {
            return options_.progress(options_.progress_data, counts.visited, counts.extracted) == 0;
        };
    }
    return how;
}

template <class Real>
Projection::Projection(const Hierarchy<Real>& hierarchy, const Asked& asked,
                       std::span<const double> isovalues)
    : threshold_{asked.options().error > 0 ? asked.options().error : asked.options().threshold} {
    const int indicator = indicator_for(asked, hierarchy, !isovalues.empty());
    nestgrid_prerolls* const kept = asked.prerolls();
    const bool deviations = indicator == NESTGRID_DEVIATION;
    const auto make_bounds = [&] {
        const NodeError error = deviations ? NodeError::deviation : NodeError::offset;
        return std::make_shared<const HierarchicalIndicator>(hierarchy, error, asked.executor());
    };
    const int measured = deviations ? NESTGRID_DEVIATION : NESTGRID_OFFSET;
    bounds_ = kept == nullptr ? make_bounds() : kept->kept(kept->of_nodes, measured, make_bounds);
    if (indicator == measured) return;
    const auto make_own = [&] {
        return std::make_shared<const SweptIndicator>(
            make_swept(indicator, hierarchy, *bounds_, isovalues, asked.executor()));
    };
    const bool of_isovalues = indicator == NESTGRID_CUT || indicator == NESTGRID_SLOPE;
    swept_ =
        kept == nullptr || of_isovalues ? make_own() : kept->kept(kept->swept, indicator, make_own);
}
template Projection::Projection(const Hierarchy<float>&, const Asked&, std::span<const double>);
template Projection::Projection(const Hierarchy<double>&, const Asked&, std::span<const double>);

}  // namespace nestgrid
