// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Criteria other than a threshold, and indicators other than the hierarchical one.
#pragma once

#include "options.hpp"

namespace recording {

inline const std::vector<NamedOptions>& criteria_options() {
    static const std::vector<NamedOptions> all{{"plain", {.normals = true, .reference = true}},
                                               {"capped", {.cap = true}}};
    return all;
}

template <class Grid, class Subjects, class Make>
void record_criterion(const std::string& name, const Grid& grid, const Subjects& subjects,
                      const Make& make) {
    for (const NamedOptions& named : criteria_options()) {
        record(name + "/" + named.name, [&](Case& c) {
            for (const auto& s : subjects) {
                const auto indicator = prepare(grid, s.field);
                c.add(s.name, grid,
                      draw_with(grid, s.field, s.isovalue, make(indicator, s.range), indicator,
                                named.options));
            }
        });
    }
}

/// Levels, and both of two; what holds at a deep level is saturated only where each node is made on
/// one level.
template <class Grid, class Subjects>
void record_levels(const std::string& name, const Grid& grid, const Subjects& subjects, int level) {
    record_criterion(name + "/deepest_level", grid, subjects,
                     [&](const auto&, double) { return DeepestLevel{level}; });
    record_criterion(name + "/level_and_threshold", grid, subjects,
                     [&](const auto& indicator, double range) {
                         return at_most(indicator, 0.2 * range) && DeepestLevel{level - 1};
                     });
    record_criterion(name + "/exact", grid, subjects, [](const auto&, double) { return Exact{}; });
}

/// Fine inside of a box or a ball; a budget beside it.
template <class Grid, class Subjects, class Inside>
void record_region(const std::string& name, const Grid& grid, const Subjects& subjects,
                   const Inside& inside) {
    const Region region(grid, inside);
    record_criterion(name + "/region", grid, subjects, [&](const auto& indicator, double range) {
        return fine_inside(region, indicator, 0.3 * range, 0.01 * range);
    });
    record(name + "/region/budget", [&](Case& c) {
        for (const auto& s : subjects) {
            const auto indicator = prepare(grid, s.field);
            const auto at = [&](double threshold) {
                return fine_inside(region, indicator, threshold, 0);
            };
            const std::size_t finest =
                draw_with(grid, s.field, s.isovalue, at(0), indicator, {}).surface.simplices.size();
            try {
                add_budget(
                    c, s.name,
                    find_threshold(grid, s.field, s.isovalue, at, indicator, 4 * finest / 5));
            } catch (const InvalidInput& too_few) {
                c.add_bits(s.name, std::strlen(too_few.what()));
            }
        }
    });
}

/// Bounds that hide a part, from a class of one's own.
struct OwnIndicator final : Indicator, Bounds {
    const HierarchicalIndicator* of;
    unsigned one_in;  ///< of the bounds is 0; 0: none
    OwnIndicator(const HierarchicalIndicator* i, unsigned n) : of{i}, one_in{n} {}

    double stop(NodeKey node) const override { return of->stop(node); }
    double offset_bound(NodeKey node) const override { return of->offset_bound(node); }
    double bound(const Rule&, std::span<const NodeKey> nodes) const override {
        if (nodes.empty()) return 0;
        double largest = 0;
        for (const NodeKey node : nodes) largest = std::max<double>(largest, of->bound(node));
        const auto key = static_cast<std::uint64_t>(nodes[0]);
        const bool hides = one_in != 0 && (key * 0x9e3779b97f4a7c15ULL >> 40U) % one_in == 0;
        return hides ? 0 : largest;
    }
    const HangingNodes* hanging() const override { return of->hanging(); }
    std::uint64_t epoch() const override { return of->epoch(); }
};

template <class Grid, class Subjects>
void record_own_indicator(const std::string& name, const Grid& grid, const Subjects& subjects) {
    for (const unsigned one_in : {0U, 8U}) {
        record(name + "/own_indicator/" + std::to_string(one_in), [&](Case& c) {
            for (const auto& s : subjects) {
                const auto indicator = prepare(grid, s.field);
                const OwnIndicator own{&indicator, one_in};
                for (const double threshold : {0.0, 0.03}) {
                    c.add(s.name, grid,
                          draw(grid, s.field, s.isovalue, own,
                               {.threshold = threshold * s.range, .normals = true}));
                }
            }
        });
    }
}

/// Errors of leaves in the place of offsets.
template <class Grid, class Subjects, class Error>
void record_leaf_errors(const std::string& name, const Grid& grid, const Subjects& subjects,
                        const Error& error) {
    record(name + "/leaf_errors", [&](Case& c) {
        for (const auto& s : subjects) {
            const HierarchicalIndicator indicator(grid, s.field, error);
            add_preroll(c, s.name, grid, indicator);
            const HierarchicalIndicator by_two(grid, s.field, error, ThreadExecutor(2));
            add_preroll(c, s.name, grid, by_two);
            for (const double threshold : {0.0, 0.3, 0.9}) {
                c.add(s.name, grid,
                      draw(grid, s.field, s.isovalue, indicator,
                           {.threshold = threshold, .reference = true}));
            }
        }
    });
}

}  // namespace recording
