// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Streams, soups and an indexed sink of one's own.
#pragma once

#include "options.hpp"

namespace recording {

/// Keeps what it is told, in the order of each kind.
template <int dimension>
class OwnSink final : public MeshSink<dimension> {
public:
    struct Told {
        std::vector<Point> x;
        std::vector<double> attributes;
        std::vector<typename Surface<dimension>::Simplex> simplices;
        std::vector<Point> reference;
        std::vector<typename Surface<dimension>::Ridge> boundary;
        std::vector<Point> normals;
        std::vector<int> elements;  ///< shape, level, simplices so far
    };
    explicit OwnSink(Told& told) : told_{&told} {}

    void take(const Surface<dimension>& part) override {
        const auto append = [](auto& to, const auto& from) {
            to.insert(to.end(), from.begin(), from.end());
        };
        append(told_->x, part.vertices);
        append(told_->attributes, part.attributes);
        std::size_t known = 0;
        for (std::size_t t = 0; t < part.simplices.size(); ++t) {
            if (part.element_of[t] == known) {
                told_->elements.insert(
                    told_->elements.end(),
                    {static_cast<int>(part.shape_of[known]), static_cast<int>(part.level_of[known]),
                     static_cast<int>(told_->simplices.size())});
                ++known;
            }
            told_->simplices.push_back(part.simplices[t]);
        }
        append(told_->reference, part.reference);
        append(told_->boundary, part.boundary);
    }
    Point position(std::uint32_t vertex) const override { return told_->x[vertex]; }
    bool keeps_elements() const override { return true; }
    void set_normals(std::span<const Point> normals) override {
        told_->normals.assign(normals.begin(), normals.end());
    }

private:
    Told* told_;
};

template <class Reports>
void add_reports(Case& c, const Reports& reports) {
    for (const auto& report : reports) {
        c.add_bits("bound", report.error_bound);
        c.count("visited", report.counts.visited);
        c.count("extracted", report.counts.extracted);
    }
}

/// function(case, subject, isovalues, threshold, indicator, options), capped and not.
template <class Grid, class Field, class Function>
void record_sink(const std::string& name, const Grid& grid,
                 const std::vector<Subject<Field>>& subjects, const Function& function) {
    record(name, [&](Case& c) {
        for (const Subject<Field>& s : subjects) {
            const HierarchicalIndicator indicator = prepare(grid, s.field);
            const std::vector<double> isovalues{s.isovalue, s.isovalue + 0.05 * s.range};
            for (const bool cap : {false, true}) {
                for (const double threshold : {0.0, 0.02 * s.range}) {
                    IsosurfaceOptions options;
                    options.cap = cap;
                    function(c, s, isovalues, threshold, indicator, options);
                }
            }
        }
    });
}

template <class Real, class Grid, class Field, class E>
void add_soup(Case& c, const std::string& run, const Grid& grid, const Subject<Field>& s,
              const std::vector<double>& isovalues, double threshold,
              const HierarchicalIndicator& indicator, const IsosurfaceOptions& options,
              const E& executor) {
    using Soup = SimplexSoup<Grid::dimension, Real>;
    std::vector<std::vector<typename Soup::Simplex>> all(isovalues.size());
    std::vector<Soup> sinks;
    for (auto& one : all) sinks.emplace_back(one);
    add_reports(c, pour(grid, s.field, isovalues, std::move(sinks), threshold, indicator, options,
                        executor));
    c.add_bits(run, all);
    c.add_triangles(all[0].size() + all[1].size());
}

template <int dim>
struct Keep {
    using Simplex = std::array<Point, static_cast<std::size_t>(dim)>;
    std::vector<Simplex>* to;
    void operator()(const Simplex& x) const { to->push_back(x); }
};

template <class Grid, class Field>
void record_sinks(const std::string& name, const Grid& grid,
                  const std::vector<Subject<Field>>& subjects) {
    using Values = std::vector<double>;
    using Indicator = HierarchicalIndicator;
    using Options = IsosurfaceOptions;
    record_sink(name + "/stream", grid, subjects,
                [&](Case& c, const Subject<Field>& s, const Values& isovalues, double threshold,
                    const Indicator& indicator, const Options& options) {
                    using Function = Keep<Grid::dimension>;
                    std::vector<std::vector<typename Function::Simplex>> all(isovalues.size());
                    std::vector<SimplexStream<Grid::dimension>> sinks;
                    for (auto& one : all) sinks.emplace_back(Function{&one});
                    add_reports(c, pour(grid, s.field, isovalues, std::move(sinks), threshold,
                                        indicator, options));
                    c.add_bits(s.name, all);
                    c.add_triangles(all[0].size() + all[1].size());
                });
    record_sink(name + "/soup", grid, subjects,
                [&](Case& c, const Subject<Field>& s, const Values& isovalues, double threshold,
                    const Indicator& indicator, const Options& options) {
                    add_soup<double>(c, s.name, grid, s, isovalues, threshold, indicator, options,
                                     SequentialExecutor{});
                    add_soup<double>(c, s.name + ".3", grid, s, isovalues, threshold, indicator,
                                     options, ThreadExecutor(3));
                });
    record_sink(name + "/soup_of_floats", grid, subjects,
                [&](Case& c, const Subject<Field>& s, const Values& isovalues, double threshold,
                    const Indicator& indicator, const Options& options) {
                    add_soup<float>(c, s.name, grid, s, isovalues, threshold, indicator, options,
                                    SequentialExecutor{});
                });
    record_sink(name + "/own", grid, subjects,
                [&](Case& c, const Subject<Field>& s, const Values& isovalues, double threshold,
                    const Indicator& indicator, Options options) {
                    options.normals = options.reference = true;
                    using Sink = OwnSink<Grid::dimension>;
                    std::vector<typename Sink::Told> all(isovalues.size());
                    std::vector<Sink> sinks;
                    for (auto& one : all) sinks.emplace_back(one);
                    add_reports(c, pour(grid, s.field, isovalues, std::move(sinks), threshold,
                                        indicator, options));
                    for (const auto& one : all) {
                        c.add_bits(s.name + ".x", one.x);
                        c.add_bits(s.name + ".simplices", one.simplices);
                        c.add_bits(s.name + ".reference", one.reference);
                        c.add_bits(s.name + ".boundary", one.boundary);
                        c.add_bits(s.name + ".normals", one.normals);
                        c.add_bits(s.name + ".elements", one.elements);
                        c.add_triangles(one.simplices.size());
                    }
                });
    if constexpr (Grid::dimension == 3) {
        record(name + "/volumes", [&](Case& c) {
            for (const Subject<Field>& s : subjects) {
                const Indicator indicator = prepare(grid, s.field);
                for (const double threshold : {0.0, 0.02, 0.3}) {
                    c.add_bits(s.name,
                               volume(grid, s.field, s.isovalue - 0.05 * s.range,
                                      s.isovalue + 0.1 * s.range, indicator, threshold * s.range));
                }
            }
        });
    }
}

}  // namespace recording
