// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The cases that every family has: options, several isovalues, bands, budgets, a series, threads,
// measures, the preroll. All of them share one instantiation of the engine, and one by threads.
#pragma once

#include "recording.hpp"

namespace recording {

/// A field with a name, where to cut it, and its scale.
template <class Field>
struct Subject {
    std::string name;
    Field field;
    double isovalue;
    double range;
};

struct NamedOptions {
    const char* name;
    IsosurfaceOptions options;  ///< threshold for a range of 1
};

inline std::vector<NamedOptions> all_options() {
    return {{"zero", {}},
            {"small", {.threshold = 0.01, .normals = true, .reference = true}},
            {"capped", {.threshold = 0.08, .cap = true, .elements = false}},
            {"middle", {.threshold = 0.2}},
            {"large", {.threshold = 0.5, .normals = true, .cap = true, .reference = true}},
            {"verified", {.threshold = 0.03, .reference = true, .verify = true}}};
}

inline IsosurfaceOptions scaled(IsosurfaceOptions options, double range) {
    options.threshold *= range;
    return options;
}

/// \param which of the options' names, or all
template <class Grid, class Field>
void record_options(const std::string& name, const Grid& grid,
                    const std::vector<Subject<Field>>& subjects, const std::string& which = "") {
    for (const NamedOptions& named : all_options()) {
        if (!which.empty() && which.find(named.name) == std::string::npos) continue;
        record(name + "/" + named.name, [&](Case& c) {
            for (const auto& s : subjects) {
                const auto indicator = prepare(grid, s.field);
                c.add(s.name, grid,
                      draw(grid, s.field, s.isovalue, indicator, scaled(named.options, s.range)));
            }
        });
    }
}

template <class Grid, class Field>
void record_preroll(const std::string& name, const Grid& grid,
                    const std::vector<Subject<Field>>& subjects) {
    record(name + "/preroll", [&](Case& c) {
        for (const auto& s : subjects) add_preroll(c, s.name, grid, prepare(grid, s.field));
    });
}

/// Isovalues together, a band, budgets, a series, measures.
template <class Grid, class Field>
void record_uses(const std::string& name, const Grid& grid,
                 const std::vector<Subject<Field>>& subjects) {
    record(name + "/together", [&](Case& c) {
        for (const auto& s : subjects) {
            const auto indicator = prepare(grid, s.field);
            const std::vector<double> isovalues{s.isovalue - 0.1 * s.range, s.isovalue,
                                                s.isovalue + 0.05 * s.range};
            const auto all = draw_several(grid, s.field, isovalues, 0.02 * s.range, indicator,
                                          {.normals = true, .cap = true});
            for (const auto& one : all) c.add(s.name, grid, one);
        }
    });
    record(name + "/band", [&](Case& c) {
        for (const auto& s : subjects) {
            const auto indicator = prepare(grid, s.field);
            for (const double threshold : {0.0, 0.05 * s.range}) {
                c.add(s.name, grid,
                      draw_band(grid, s.field, s.isovalue - 0.03 * s.range,
                                s.isovalue + 0.06 * s.range, threshold, indicator,
                                {.normals = true, .reference = true}));
            }
        }
    });
    record(name + "/budget", [&](Case& c) {
        for (const auto& s : subjects) {
            const auto indicator = prepare(grid, s.field);
            for (const bool cap : {false, true}) {
                const std::size_t finest = draw(grid, s.field, s.isovalue, indicator, {.cap = cap})
                                               .surface.simplices.size();
                for (const std::size_t most : {2 * finest / 3, finest / 2, finest}) {
                    try {
                        add_budget(
                            c, s.name,
                            budget(grid, s.field, s.isovalue, indicator, most, {.cap = cap}));
                        c.add(s.name, grid,
                              draw_alone(grid, s.field, s.isovalue,
                                         {.max_triangles = most, .cap = cap}));
                    } catch (const InvalidInput& too_few) {
                        c.add_bits(s.name, std::strlen(too_few.what()));
                    }
                }
            }
        }
    });
    record(name + "/series", [&](Case& c) {
        for (const auto& s : subjects) {
            const auto series = series_of(grid, s.field);
            for (const auto& named : all_options()) {
                for (const double off : {0.0, 0.04, -0.07}) {
                    c.add(s.name, grid,
                          series->draw(s.isovalue + off * s.range, scaled(named.options, s.range)));
                }
            }
        }
    });
    if (Grid::dimension == 2) return;
    record(name + "/measures", [&](Case& c) {
        for (const auto& s : subjects) {
            const auto indicator = prepare(grid, s.field);
            for (const bool cap : {false, true}) {
                add_measures(c, s.name,
                             draw(grid, s.field, s.isovalue, indicator,
                                  {.threshold = 0.02 * s.range, .cap = cap})
                                 .surface);
            }
        }
    });
}

/// By the test's threads, beside the calling one: runs of one subject have one hash.
template <class Grid, class Field>
void record_threads(const std::string& name, const Grid& grid,
                    const std::vector<Subject<Field>>& subjects) {
    record(name + "/threads", [&](Case& c) {
        for (const auto& s : subjects) {
            const auto options = scaled(
                {.threshold = 0.01, .normals = true, .cap = true, .reference = true}, s.range);
            c.add(s.name + ".serial", grid,
                  draw(grid, s.field, s.isovalue, prepare(grid, s.field), options));
            for (const std::size_t threads : {1U, 2U, 4U}) {
                const ThreadExecutor executor(threads);
                const auto indicator = prepare(grid, s.field, executor);
                c.add(s.name + "." + std::to_string(threads), grid,
                      draw(grid, s.field, s.isovalue, indicator, options, executor));
            }
        }
    });
}

template <class Grid, class Field>
void record_all(const std::string& name, const Grid& grid,
                const std::vector<Subject<Field>>& subjects) {
    record_preroll(name, grid, subjects);
    record_options(name, grid, subjects);
    record_uses(name, grid, subjects);
    record_threads(name, grid, subjects);
}

}  // namespace recording
