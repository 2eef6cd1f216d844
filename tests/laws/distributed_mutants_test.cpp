// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Budgets, series, updates and key frames of a library in which ranks forget what others tell in
// one step: the laws of distributed grids must notice each of them.
#include <array>
#include <cstdio>
#include <functional>

#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>
#include <nestgrid/algorithms/key_frames.hpp>

#include "record_judge.hpp"

using namespace nestgrid_test;

namespace {

using Step = ForgetfulRanks::Step;

/// Begins a step of the program on ranks; on one process it does nothing.
template <class Grid>
void begin(const Grid& grid, Step step) {
    if constexpr (requires { grid.shared_nodes(); }) {
        dynamic_cast<ForgetfulRanks&>(grid.shared_nodes()->ranks()).begin(step);
    }
}

template <class Result>
void put(const Result& drawn, Record& record) {
    record.put({drawn.error_bound, drawn.range_bound, static_cast<double>(drawn.counts.calls),
                static_cast<double>(drawn.counts.visited),
                static_cast<double>(drawn.counts.extracted)});
    record.put_surface(drawn.surface);
}

/// The least threshold of a number of triangles, and what is drawn within that.
struct Budget {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        const HierarchicalIndicator indicator(grid, field, executor);
        begin(grid, Step::draw);
        for (const std::uint64_t most : {150, 600}) {
            try {
                const auto found =
                    isosurface<3>(erase(grid, field), 0.1,
                                  under(indicator, {.max_triangles = most}), {}, {executor})
                        .search;
                record.put({found.threshold, static_cast<double>(found.triangles),
                            static_cast<double>(found.extracted)});
                put(isosurface(grid, field, 0.1, under(indicator, found.threshold), {}, {executor}),
                    record);
            } catch (const InvalidInput& e) {
                record.put({static_cast<double>(std::string(e.what()).size())});
            }
        }
    }
};

/// Several isovalues in one object, after the first of which a step begins.
struct Series {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        IsosurfaceSeries<3> series(grid, field, executor);
        put(series.draw(0.2, {.threshold = 0.2}, {}, executor), record);
        begin(grid, Step::draw);
        put(series.draw(0.1, {.threshold = 0.2}, {}, executor), record);
    }
};

/// The same values, halved: those of another time.
template <class Field>
struct Halved : Field {
    explicit Halved(const Field& field) : Field(field) {}
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return halved(Field::coarse_values(i, out), out);
    }
    template <class Element>
    NodeMask new_values(const Element& e, NodeMask which, std::span<double> out) const {
        return halved(Field::new_values(e, which, out), out);
    }

private:
    static NodeMask halved(NodeMask missing, std::span<double> out) {
        for (double& value : out) value = value < 0.2 ? value / 2 : value - 0.05;
        return missing;
    }
};

/// Calls draw(field) with the values of another time, fetched in a step of its own.
template <class Grid, class Field, class Draw>
void with_field(const Grid& grid, const Field& field, const Draw& draw) {
    begin(grid, Step::values);
    if constexpr (requires { grid.shared_nodes(); }) {
        draw(DistributedField(grid, field));
    } else {
        draw(field);
    }
}

struct Update {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        HierarchicalIndicator offsets(grid, field, executor);
        constexpr double far = 1e3;
        const CutField<3, double>& now = field;
        with_field(grid, Halved(now), [&](const auto& changed) {
            begin(grid, Step::preroll);
            offsets.update(grid, changed, ChangedBox{{-far, -far, -far}, {far, far, far}});
            record.put({offsets.least(), offsets.greatest()});
            begin(grid, Step::draw);
            put(isosurface(grid, changed, 0.1, under(offsets, 0.2), {}, {executor}), record);
        });
    }
};

/// Half of the values of two times.
template <class Field>
struct Mean {
    using value_type = double;
    static constexpr int components = Field::components;
    using Later = Halved<Field>;

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return mean(out, [&](const auto& f, std::span<double> o) { return f.coarse_values(i, o); });
    }
    template <class Element>
    NodeMask new_values(const Element& e, NodeMask which, std::span<double> out) const {
        return mean(out,
                    [&](const auto& f, std::span<double> o) { return f.new_values(e, which, o); });
    }

    Field first;
    Later second{first};

private:
    template <class Ask>
    NodeMask mean(std::span<double> out, const Ask& ask) const {
        std::vector<double> other(out.size());
        const NodeMask missing = ask(first, out) | ask(second, std::span(other));
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = 0.5 * out[i] + 0.5 * other[i];
        return missing;
    }
};

struct Frames {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        const CutField<3, double>& now = field;
        const HierarchicalIndicator first(grid, field, executor);
        with_field(grid, Halved(now), [&](const auto& later) {
            begin(grid, Step::preroll);
            const HierarchicalIndicator second(grid, later, executor);
            constexpr std::array weights{0.5F, 0.5F};
            const KeyFrames frames({&first, &second}, weights);
            with_field(grid, Mean<CutField<3, double>>{now}, [&](const auto& between) {
                begin(grid, Step::draw);
                put(isosurface(grid, between, 0.1, under(frames, 0.1), {}, {executor}), record);
            });
        });
    }
};

/// Compares a program without one step of it.
template <class Family, class Program>
void expect_fails(const char* program, const ForgetfulRanks::Omission& omission) {
    const Tally tally = compare_on<Family>(program, Program{}, 6, omission);
    std::printf("%s, %s: of %llu runs %llu differ, %llu end\n", program, omission.what,
                static_cast<unsigned long long>(tally.drawn + tally.ended),
                static_cast<unsigned long long>(tally.other),
                static_cast<unsigned long long>(tally.ended));
    EXPECT_GT(tally.other + tally.ended, 0U) << program << ", " << omission.what;
}

constexpr ForgetfulRanks::Omission nothing{"nothing", Step::none, 0, false};
constexpr ForgetfulRanks::Omission values{"values not told", Step::values, 0, false};
constexpr ForgetfulRanks::Omission maxima{"maxima not told", Step::preroll, 0, false};
constexpr ForgetfulRanks::Omission facts{"ranges not agreed on", Step::preroll, 0, false, true};
constexpr ForgetfulRanks::Omission contours{"contours not told", Step::draw, 0, false};
constexpr ForgetfulRanks::Omission sums{"sums not taken", Step::draw, 0, false, true};

template <class Family>
void expect_noticed(bool hangs) {
    compare_on<Family>("budgets", Budget{}, 6, nothing);
    compare_on<Family>("series", Series{}, 6, nothing);
    compare_on<Family>("updates", Update{}, 6, nothing);
    compare_on<Family>("key frames", Frames{}, 6, nothing);
    expect_fails<Family, Budget>("budgets", sums);
    expect_fails<Family, Series>("series", sums);
    for (const auto& omission : {values, maxima, facts, sums}) {
        expect_fails<Family, Update>("updates", omission);
        expect_fails<Family, Frames>("key frames", omission);
    }
    if (!hangs) return;  // elements that conform have no contours to tell
    expect_fails<Family, Budget>("budgets", contours);
    expect_fails<Family, Series>("series", contours);
    expect_fails<Family, Update>("updates", contours);
    expect_fails<Family, Frames>("key frames", contours);
}

TEST(DistributedMutants, FailTheLawsOnOctrees) { expect_noticed<UnbalancedOctree>(true); }
TEST(DistributedMutants, FailTheLawsOnBisections) { expect_noticed<BisectionTetrahedra>(false); }

}  // namespace
