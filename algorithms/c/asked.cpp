// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "asked.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include <nestgrid/error.hpp>

#include <ranks/agreement.hpp>
#include <threads/thread_executor.hpp>

#include "calls.hpp"
#include "prerolls.hpp"

namespace nestgrid {

namespace {

constexpr int most_threads = 1024;

/// Names of the indicators, from NESTGRID_OFFSET on.
constexpr std::array<const char*, 9> names{
    "offset", "deviation", "numerical", "wavelet", "visual", "geometry", "cut", "slope", "norm"};
static_assert(NESTGRID_NORM + 1 == names.size());

void require_range(const nestgrid_options& options) {
    if (!(options.threshold >= 0)) throw InvalidInput("the threshold is negative or not a number");
    if (!(options.error >= 0)) throw InvalidInput("the error is negative or not a number");
    if (!(options.position_error >= 0) || !std::isfinite(options.position_error)) {
        throw InvalidInput("the error of positions is negative or not a finite number");
    }
    if (options.indicator < NESTGRID_OFFSET || options.indicator > NESTGRID_NORM) {
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

/// The distance from the domain of a lens or a region that a C code describes.
/// \param name of it
/// \throw InvalidInput where its table is too small, or lacks the function
template <class Table>
Distance distance_of(const Table& given, const std::string& name) {
    if (given.size < sizeof(Table)) {
        throw InvalidInput("the table of the " + name + " is too small: its size says " +
                           std::to_string(given.size) + " bytes");
    }
    if (given.distance == nullptr) {
        throw InvalidInput("the table of the " + name + " lacks the function 'distance'");
    }
    return [given, name = "the operation 'distance' of the " + name](const Point& x) {
        double distance = 0;
        require_success(given.distance(given.self, x.data(), &distance), name.c_str());
        return distance;
    };
}

/// The lens that a C code describes.
/// \throw InvalidInput where its table is too small, or a number is out of range
LensRequest lens_of(const nestgrid_lens& given) {
    LensRequest lens{.distance = distance_of(given, "lens"), .finest = given.finest};
    if (!(given.finest >= 0) || !(given.coarsest >= 0)) {
        throw InvalidInput("a size of the lens is negative or not a number");
    }
    if (given.coarsest > 0) lens.coarsest = given.coarsest;
    if (given.slope != 0) lens.slope = given.slope;
    return lens;
}

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

/// The options as far as the caller's struct goes, the rest empty.
/// \param given may be NULL
/// \throw InvalidInput where it does not say how large it is
nestgrid_options complete(const nestgrid_options* given) {
    nestgrid_options options{};
    if (given == nullptr) return options;
    if (given->size < sizeof(given->size)) {
        throw InvalidInput("the size of the options says " + std::to_string(given->size) +
                           " bytes: set it to that of the struct");
    }
    std::memcpy(&options, given, std::min(given->size, sizeof(options)));
    return options;
}

}  // namespace

void tell_other_ranks(const nestgrid_options* given) {
    const engine::Outcome own = engine::Outcome::of_exception();
    const nestgrid_options options = complete(given);
    if (options.ranks == nullptr) return;
    RanksInC ranks(*options.ranks);
    engine::settle(ranks, "what it refuses", own);
}

Asked::Asked(const nestgrid_options* given, const nestgrid_grid* grid, const nestgrid_field* field)
    : options_{complete(given)}, grid_{grid}, field_{field} {
    require_range(options_);
    require_one_wish(options_);
    if (options_.lens != nullptr) lens_ = lens_of(*options_.lens);
    if (options_.region != nullptr) {
        region_ = {distance_of(*options_.region, "region"), options_.region->threshold};
    }
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

/// Tables do not say at once whether all elements are simplices, as error_indicator() wants it.
std::string Asked::indicator_for(const FieldOnGrid& field, bool level_sets) const {
    if (options_.error == 0) return names[static_cast<std::size_t>(options_.indicator)];
    const bool simplices = level_sets && rules_of_simplices() &&
                           field.visit([](const auto& each) { return coarse_simplices(each); });
    return simplices ? "cut" : "deviation";
}

Projection Asked::projection(const FieldOnGrid& field, bool level_sets) const {
    std::optional<double> threshold = options_.error > 0 ? options_.error : options_.threshold;
    if (*threshold == 0 && (options_.max_triangles > 0 || lens_)) threshold.reset();
    return {.threshold = threshold,
            .max_triangles = options_.max_triangles,
            .indicator = indicator_for(field, level_sets),
            .blend = options_.blend == 0 ? 1 : options_.blend,
            .lens = lens_,
            .region = region_,
            .collapse = options_.collapse != 0,
            .keeps_distance = options_.keep_distance != 0,
            .slice_distance = options_.slice_distance,
            .colour_tolerance = options_.colour_tolerance,
            .position_error = options_.position_error};
}

void Asked::require_one_process(const std::string& what) const {
    if (options_.ranks != nullptr) detail::refuse_on_ranks(what);
}

FieldOnGrid Asked::as_it_is_drawn(const FieldOnGrid& field) const {
    if (options_.ranks == nullptr) return field;
    if (!field.facts().offers(Feature::presence)) {
        throw InvalidInput(
            "the table of the grid lacks the function 'presence', which says which leaves this "
            "rank has");
    }
    talks_ = true;
    part_ = options_.prerolls == nullptr
                ? std::make_shared<const PartOnRanks>(*options_.ranks, *grid_, field)
                : options_.prerolls->part_of(*options_.ranks, *grid_, field);
    return part_->on_ranks(field);
}

Prerolls& Asked::kept_prerolls(const FieldOnGrid& field) const {
    return options_.prerolls->of(*grid_, *field_, field);
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

}  // namespace nestgrid
