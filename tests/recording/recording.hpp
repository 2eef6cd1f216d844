// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces as hashes of their bits, one line a case:
//     <case> <surface> <statistics> <triangles> | <part>=... | <run>=... | <count>=...
// The surface is all that is drawn and its error bound; statistics are counts. Behind the bars, of
// 32 bits, what helps to find a difference: the same by part of a surface, and by run of a case.
//
// All calls of the library that depend on an engine are in the functions at the end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>
#include <nestgrid/table.hpp>

#include "thread_executor.hpp"

namespace recording {

using namespace nestgrid;
using nestgrid_test::ThreadExecutor;

/// FNV-1a.
class Hash {
public:
    template <class T>
        requires(std::is_arithmetic_v<T> || std::is_enum_v<T>)
    void add(T number) {
        if constexpr (std::is_floating_point_v<T>) {
            if (number != number) number = std::numeric_limits<T>::infinity();  // any NaN
        }
        std::array<unsigned char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), &number, sizeof(T));
        for (const unsigned char b : bytes) value_ = (value_ ^ b) * 0x100000001b3ULL;
    }
    template <class T, std::size_t size>
    void add(const std::array<T, size>& all) {
        for (const T& one : all) add(one);
    }
    template <class T>
    void add(const std::vector<T>& all) {
        add(all.size());
        for (const T& one : all) add(one);
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

inline std::uint32_t folded(std::uint64_t value) {
    return static_cast<std::uint32_t>(value ^ value >> 32U);
}

inline std::string in_hex(std::uint64_t value, int digits) {
    std::array<char, 17> text;
    std::snprintf(text.data(), text.size(), "%0*llx", digits,
                  static_cast<unsigned long long>(value));
    return text.data();
}

class Case {
public:
    explicit Case(std::string name) : name_{std::move(name)} {}

    /// All of a surface, under the name of a run.
    /// \param grid whose keys name the elements
    template <class Grid, int dimension>
    void add(const std::string& run, const Grid& grid, const Isosurface<dimension>& result) {
        const auto& s = result.surface;
        Hash whole;
        const auto part = [&](const char* name, const auto& what) {
            whole.add(what);
            parts_[name].add(what);
        };
        part("1vertices", s.vertices);
        part("2simplices", s.simplices);
        part("3normals", s.normals);
        part("4attributes", s.attributes);
        part("5element_of", s.element_of);
        part("6reference", s.reference);
        part("7shapes", s.shape_of);
        part("8levels", s.level_of);
        part("9boundary", s.boundary);
        part("bound", result.error_bound);
        part("cancelled", result.cancelled);
        part("elements", s.elements.size());
        std::vector<std::uint64_t> names;
        name_elements(grid, s, names);
        part("elements", names);
        end_run(run, whole);
        triangles_ += s.simplices.size();
        count("calls", result.counts.calls);
        count("visited", result.counts.visited);
        count("extracted", result.counts.extracted);
    }
    /// Anything else that must stay the same.
    template <class T>
    void add_bits(const std::string& run, const T& what) {
        Hash whole;
        whole.add(what);
        end_run(run, whole);
    }
    void add_triangles(std::size_t n) { triangles_ += n; }
    void count(const std::string& name, std::uint64_t n) {
        statistics_.add(n);
        counts_[name] += n;
    }

    std::string line() const {
        std::ostringstream out;
        out << name_ << ' ' << in_hex(surface_.value(), 16) << ' '
            << in_hex(statistics_.value(), 16) << ' ' << triangles_ << " |";
        for (const auto& [name, hash] : parts_) {
            out << ' ' << name << '=' << in_hex(folded(hash.value()), 8);
        }
        out << " |";
        for (const auto& [name, hashes] : runs_) {
            Hash all;
            for (const std::uint32_t hash : hashes) all.add(hash);
            const std::uint64_t one = hashes.size() == 1 ? hashes[0] : folded(all.value());
            out << ' ' << name << '=' << in_hex(one, 8);
        }
        out << " |";
        for (const auto& [name, n] : counts_) out << ' ' << name << '=' << n;
        return out.str();
    }

private:
    void end_run(std::string run, const Hash& whole) {
        surface_.add(whole.value());
        for (char& c : run) {
            if (c == ' ') c = '_';
        }
        auto at = std::ranges::find(runs_, run, [](const auto& r) { return r.first; });
        if (at == runs_.end()) at = runs_.insert(at, {run, {}});
        at->second.push_back(folded(whole.value()));
    }
    template <class Grid, class Surface>
    static void name_elements(const Grid& grid, const Surface& s,
                              std::vector<std::uint64_t>& names) {
        using Element = ElementOf<Grid>;
        const std::span<const Element> elements = s.elements.template as<Element>();
        for (std::size_t i = 0; i < elements.size(); ++i) {
            const Element& e = elements[i];
            std::array<NodeKey, max_corners> keys;
            const std::span<NodeKey> out = std::span(keys).first(topology(s.shape_of[i]).corners);
            if constexpr (requires { grid.offers(Feature::own_keys); }) {
                if (!grid.offers(Feature::own_keys)) return;
            }
            if constexpr (requires { grid.corner_keys(e, out); }) {
                grid.corner_keys(e, out);
            } else if constexpr (requires(typename Grid::Context & c) {
                                     grid.corner_keys(e, out, c);
                                 }) {
                typename Grid::Context context = grid.make_context();
                grid.corner_keys(e, out, context);
            } else if constexpr (std::is_integral_v<Element>) {
                names.push_back(e);
                continue;
            } else {
                return;
            }
            for (const NodeKey key : out) names.push_back(static_cast<std::uint64_t>(key));
        }
    }

    std::string name_;
    Hash surface_;
    Hash statistics_;
    std::size_t triangles_ = 0;
    std::map<std::string, Hash> parts_;
    std::vector<std::pair<std::string, std::vector<std::uint32_t>>> runs_;  // by name
    std::map<std::string, std::uint64_t> counts_;
};

/// Lines of this program, in order.
inline std::vector<std::string> lines;

/// Runs function(Case&) as a case of this name.
template <class Function>
void record(const std::string& name, Function&& function) {
    Case c(name);
    std::string line;
    try {
        function(c);
        line = c.line();
    } catch (const std::exception& error) {
        line = name + " threw: " + error.what();
    }
    lines.push_back(line);
}

inline std::string name_of(const std::string& line) { return line.substr(0, line.find(' ')); }

/// The columns that are compared: the name, the surface, the statistics, and the triangles.
inline std::string columns_of(const std::string& line) {
    return line.substr(0, std::min(line.size(), line.find(" |")));
}

/// Prints the lines, or with the file of recorded ones, compares those of the same group: what is
/// in front of the first slash.
inline int finish(int count, char** arguments) {
    if (count < 2) {
        for (const std::string& line : lines) std::cout << line << '\n';
        return 0;
    }
    std::map<std::string, std::string> recorded;
    std::ifstream file(arguments[1]);
    if (!file) {
        std::cout << "cannot read " << arguments[1] << '\n';
        return 2;
    }
    for (std::string line; std::getline(file, line);) recorded[name_of(line)] = line;
    int wrong = 0;
    const auto group_of = [](const std::string& name) { return name.substr(0, name.find('/')); };
    std::map<std::string, bool> groups;
    for (const std::string& line : lines) {
        const std::string name = name_of(line);
        groups[group_of(name)] = true;
        const auto at = recorded.find(name);
        if (at == recorded.end()) {
            ++wrong;
            std::cout << "NOT RECORDED " << name << '\n';
            continue;
        }
        if (at->second != columns_of(line)) {
            ++wrong;
            std::cout << "DIFFERS " << at->second << "\n     is " << line << '\n';
        }
        recorded.erase(at);
    }
    for (const auto& [name, line] : recorded) {
        if (!groups.contains(group_of(name))) continue;
        ++wrong;
        std::cout << "MISSING " << name << '\n';
    }
    std::cout << lines.size() << " cases, " << wrong << " differ\n";
    return wrong == 0 ? 0 : 1;
}

// ------------------------------------------------------------------------- the library's functions

/// The table of a grid, which is borrowed.
template <int dim>
struct TabledGrid {
    using Element = nestgrid_element;
    static constexpr int dimension = dim;

    bool offers(Feature feature) const {
        const bool keys = table.corner_keys != nullptr && table.new_keys != nullptr;
        return keys && (feature == Feature::own_keys ||
                        (feature == Feature::dense_keys && table.node_count > 0));
    }
    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        void* context = table.make_context == nullptr ? nullptr : table.make_context(table.self);
        table.corner_keys(table.self, context, &e, out.size(), out.data());
        if (table.free_context != nullptr) table.free_context(table.self, context);
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const {
        table.new_keys(table.self, nullptr, &e, out.size(), out.data());
    }
    std::size_t node_count() const { return table.node_count; }

    nestgrid_grid table;
};
template <class Real>
struct TabledField {
    using value_type = Real;
    nestgrid_field table;
};

template <class Grid, class Field>
std::unique_ptr<const Hierarchy<typename Field::value_type>> hierarchy_of(const Grid& grid,
                                                                          const Field& field) {
    using Real = typename Field::value_type;
    if constexpr (requires { grid.table.coarse_count; }) {
        return open_table<Real>(grid.table, field.table);
    } else {
        return std::unique_ptr<const Hierarchy<Real>>(
            new nestgrid::detail::ErasedHierarchy<Grid, Field>(grid, field));
    }
}

template <class Grid, class Field, class E = SequentialExecutor>
HierarchicalIndicator prepare(const Grid& grid, const Field& field, const E& executor = {}) {
    return HierarchicalIndicator(*hierarchy_of(grid, field), {}, executor);
}

template <class Grid, class Field>
auto draw_alone(const Grid& grid, const Field& field, double isovalue,
                const IsosurfaceOptions& options) {
    return isosurface<Grid::dimension>(*hierarchy_of(grid, field), isovalue, options);
}

template <class Grid, class Field, class I, class E = SequentialExecutor>
auto draw(const Grid& grid, const Field& field, double isovalue, const I& indicator,
          const IsosurfaceOptions& options, const E& executor = {}) {
    const auto hierarchy = hierarchy_of(grid, field);
    if constexpr (std::is_same_v<I, HierarchicalIndicator>) {
        return isosurface<Grid::dimension>(*hierarchy, isovalue, indicator, options, executor);
    } else {
        return isosurface<Grid::dimension>(*hierarchy, isovalue,
                                           Threshold(&indicator, options.threshold), indicator,
                                           options, executor);
    }
}

template <class Grid, class Field>
auto series_of(const Grid& grid, const Field& field) {
    return std::make_unique<IsosurfaceSeries<Grid::dimension>>(hierarchy_of(grid, field));
}

template <class Grid, class Field, class S, class Indicator>
auto draw_with(const Grid& grid, const Field& field, double isovalue, const S& criterion,
               const Indicator& indicator, const IsosurfaceOptions& options) {
    return isosurface<Grid::dimension>(*hierarchy_of(grid, field), isovalue, criterion, indicator,
                                       options);
}

template <class I>
Threshold at_most(const I& indicator, double threshold) {
    return {&indicator, threshold};
}

template <class Grid, class Field, class Indicator>
auto draw_several(const Grid& grid, const Field& field, const std::vector<double>& isovalues,
                  double threshold, const Indicator& indicator, const IsosurfaceOptions& options) {
    return isosurfaces<Grid::dimension>(*hierarchy_of(grid, field),
                                        std::span<const double>(isovalues),
                                        at_most(indicator, threshold), indicator, options);
}

template <class Grid, class Field, class Indicator>
auto draw_band(const Grid& grid, const Field& field, double low, double high, double threshold,
               const Indicator& indicator, const IsosurfaceOptions& options) {
    return isoband<Grid::dimension>(*hierarchy_of(grid, field), low, high,
                                    at_most(indicator, threshold), indicator, options);
}

template <class Grid, class Field, class Indicator>
TriangleBudget budget(const Grid& grid, const Field& field, double isovalue,
                      const Indicator& indicator, std::uint64_t most,
                      const IsosurfaceOptions& options) {
    return find_threshold<Grid::dimension>(*hierarchy_of(grid, field), isovalue, indicator, most,
                                           options);
}

/// Into sinks of one's own.
template <class Grid, class Field, class Indicator, class Sink, class E = SequentialExecutor>
auto pour(const Grid& grid, const Field& field, const std::vector<double>& isovalues,
          std::vector<Sink> sinks, double threshold, const Indicator& indicator,
          const IsosurfaceOptions& options, const E& executor = {}) {
    return extract_isosurfaces<Grid::dimension>(
        *hierarchy_of(grid, field), std::span<const double>(isovalues), std::move(sinks),
        at_most(indicator, threshold), indicator, options, executor);
}

template <class Grid, class Field, class Indicator>
double volume(const Grid& grid, const Field& field, double low, double high,
              const Indicator& indicator, double threshold) {
    return volume_between(*hierarchy_of(grid, field), low, high, indicator, threshold);
}

// ------------------------------------------------------------------------------ pieces of cases

inline void add_budget(Case& c, const std::string& run, const TriangleBudget& b) {
    c.add_bits(run + ".threshold", b.threshold);
    c.add_bits(run + ".triangles", b.triangles);
    c.add_triangles(b.triangles);
    c.count("trials", static_cast<std::uint64_t>(b.trials));
    c.count("extracted", b.extracted);
}

/// Counts, area, volume, integrals.
template <int dimension>
void add_measures(Case& c, const std::string& run, const Surface<dimension>& surface) {
    if constexpr (dimension == 3) {
        const SurfaceReport r = surface_report(surface);
        c.add_bits(
            run + ".counts",
            std::vector<std::size_t>{r.vertices, r.edges, r.triangles, r.open_edges,
                                     r.boundary_edges, r.nonmanifold_edges, r.misoriented_edges,
                                     r.nonmanifold_vertices, r.degenerate_triangles, r.components});
        c.add_bits(run + ".area", std::vector<double>{r.area, r.volume});
        const SurfaceMeasurement m = measure_surface(surface);
        std::vector<double> all{m.total.area, m.total.volume};
        for (const SurfaceMeasures& part : m.components) {
            all.insert(all.end(), {part.area, part.volume, part.closed ? 1.0 : 0.0});
            all.insert(all.end(), part.integrals.begin(), part.integrals.end());
        }
        c.add_bits(run + ".measures", all);
        c.count("open_edges", r.open_edges);
    }
}

/// What the preroll found.
/// \param own whether the grid numbers its nodes densely
template <class Grid>
void add_preroll(Case& c, const std::string& run, const Grid& grid,
                 const HierarchicalIndicator& indicator) {
    std::vector<double> all{indicator.least(), indicator.greatest(), indicator.hanging_violation()};
    if constexpr (requires { grid.node_count(); }) {
        if (dense_key_count(grid) > 0) {
            for (std::size_t n = 0; n < indicator.node_count(); ++n) {
                all.push_back(indicator.stop(static_cast<NodeKey>(n)));
                all.push_back(indicator.bound(static_cast<NodeKey>(n)));
            }
        }
    }
    c.add_bits(run, all);
    c.count("nodes", indicator.node_count());
    c.count("finest", static_cast<std::uint64_t>(indicator.finest_level() + 1));
    c.count("conform", indicator.stops_conform() ? 1 : 0);
    c.count("hanging", indicator.hanging() == nullptr ? 0 : indicator.hanging()->size());
}

}  // namespace recording
