// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Budgets, series, probes, isolines, shadings and height fields of distributed grids: what ranks
// find out is what one rank finds out.
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/count_triangles.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>
#include <nestgrid/algorithms/probe_line.hpp>
#include <nestgrid/algorithms/shading.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include <level_sets/leaf_bounds.hpp>

#include "record_judge.hpp"

using namespace nestgrid_test;

namespace {

Record::Numbers numbers_of(const TriangleBudget& budget) {
    return {budget.threshold,
            static_cast<double>(budget.triangles),
            static_cast<double>(budget.trials),
            static_cast<double>(budget.extracted),
            budget.next_threshold,
            static_cast<double>(budget.next_triangles)};
}
template <class Result>
Record::Numbers numbers_of_drawn(const Result& result) {
    return {result.error_bound, result.range_bound, static_cast<double>(result.counts.calls),
            static_cast<double>(result.counts.visited),
            static_cast<double>(result.counts.extracted)};
}

/// Of what the pieces of all ranks are together.
template <class Grid, class Drawn>
Record::Numbers numbers_of_whole(const Grid& grid, const Drawn& drawn) {
    if constexpr (requires { grid.shared_nodes(); }) {
        const JoinedPiece joined = join_pieces(drawn, grid);
        return {static_cast<double>(joined.vertices), static_cast<double>(joined.simplices),
                static_cast<double>(joined.components), static_cast<double>(joined.open)};
    } else {
        const auto report = surface_report(drawn.surface);
        return {static_cast<double>(report.vertices), static_cast<double>(report.triangles),
                static_cast<double>(report.components), static_cast<double>(report.open_edges)};
    }
}

/// Surfaces within a number of simplices, those of a series, and counts.
struct DrawWithin {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        constexpr int dim = Grid::dimension;
        const HierarchicalIndicator indicator(grid, field, executor);
        for (const std::uint64_t most : {40, 200, 100000}) {
            const IsosurfaceOptions options{.cap = most == 200};
            try {
                const auto drawn =
                    isosurface(grid, field, 0.1, {.max_triangles = most}, options, {executor});
                record.put(numbers_of_drawn(drawn));
                record.put_surface(drawn.surface);
                record.put(numbers_of(isosurface<dim>(erase(grid, field), 0.1,
                                                      under(indicator, {.max_triangles = most}),
                                                      options, {executor})
                                          .search));
            } catch (const InvalidInput& e) {
                record.put({static_cast<double>(std::string(e.what()).size())});
            }
        }
        IsosurfaceSeries<dim> series(grid, field, executor);
        for (const double isovalue : {0.0, 0.3, -0.1}) {
            const auto& drawn =
                series.draw(isovalue, {.threshold = 0.1}, {.cap = isovalue > 0}, executor);
            record.put(numbers_of_drawn(drawn));
            record.put_surface(drawn.surface);
        }
        if constexpr (dim == 3) within_plane(grid, field, indicator, executor, record);
    }
    template <class Grid, class Field>
    static void within_plane(const Grid& grid, const Field& field,
                             const HierarchicalIndicator& indicator, const Executor& executor,
                             Record& record) {
        const Plane plane({0.4, 0.45, 0.3}, {1, 2, 0.3});
        const auto drawn = slice(grid, field, plane, {.max_triangles = 300}, {}, {executor});
        record.put(numbers_of_drawn(drawn));
        record.put_surface(drawn.surface);
        const auto everywhere = [&](double threshold) { return Threshold(&indicator, threshold); };
        record.put(
            numbers_of(slice(erase(grid, field), plane,
                             under(everywhere, indicator, {.max_triangles = 250}), {}, {executor})
                           .search));
    }
};

TEST(DistributedPrograms, BudgetsAndSeries) {
    compare_on<UnbalancedOctree>("budgets, unbalanced octrees", DrawWithin{}, 6);
    compare_on<RedGreenMixed3>("budgets, red-green mixed", DrawWithin{}, 3);
    compare_on<BisectionTetrahedra>("budgets, bisections", DrawWithin{}, 4);
    compare_on<UnbalancedQuadtree>("budgets, quadtrees", DrawWithin{}, 6);
}

/// Shadings and height fields, with budgets.
struct Shade {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        const HierarchicalIndicator indicator(grid, field, executor);
        const auto put = [&](const Shading& drawn) {
            record.put(numbers_of_drawn(drawn));
            record.put_surface(drawn.surface);
            record.put(numbers_of_whole(grid, drawn));
        };
        for (const double threshold : {0.0, 0.1, 0.5}) {
            put(shading(grid, field, under(indicator, threshold), {.flatness = threshold + 0.05},
                        {executor}));
            put(height_field(grid, field, 0.7, under(indicator, threshold), {}, {executor}));
        }
        put(shading(grid, field, {}, {}, {executor}));
        const HierarchicalIndicator spread(grid, field, Spread{.factor = 2}, executor);
        put(shading(grid, field, under(Blended(&spread, 0.1, 2), spread), {}, {executor}));
        const auto everywhere = [&](double threshold) { return Threshold(&indicator, threshold); };
        record.put(
            numbers_of(shading(erase(grid, field),
                               under(everywhere, indicator, {.max_triangles = 90}), {}, {executor})
                           .search));
    }
};

TEST(DistributedPrograms, ShadingsAndHeightFields) {
    compare_on<UnbalancedQuadtree>("shadings, quadtrees", Shade{}, 8);
    compare_on<BisectionTriangles>("shadings, bisections", Shade{}, 8);
    compare_on<RedGreenTriangles>("shadings, red-green", Shade{}, 8);
}

/// Bands, whose pieces have vertices of two isovalues between the same nodes.
struct DrawBands {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        const HierarchicalIndicator indicator(grid, field, executor);
        for (const double threshold : {0.0, 0.2}) {
            const auto drawn =
                isoband(grid, field, -0.05, 0.15, under(indicator, threshold), {}, {executor});
            record.put_surface(drawn.surface);
            record.put(numbers_of_whole(grid, drawn));
        }
    }
};

TEST(DistributedPrograms, Bands) {
    compare_on<UnbalancedOctree>("bands, unbalanced octrees", DrawBands{}, 6);
    compare_on<BisectionTetrahedra>("bands, bisections", DrawBands{}, 4);
}

/// Lines, each ring from its least point on.
struct DrawLines {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        const HierarchicalIndicator indicator(grid, field, executor);
        constexpr std::array values{-0.13, 0.07, 0.31};
        for (const double threshold : {0.0, 0.2}) {
            const Isolines drawn =
                isolines(grid, field, values, under(indicator, threshold), {}, {executor});
            record.put(numbers_of_drawn(drawn));
            std::vector<Record::Numbers> lines;
            for (std::size_t i = 0; i < drawn.lines.count(); ++i) {
                lines.push_back(line(drawn.lines, i));
            }
            record.put_part(std::move(lines));
        }
    }
    static Record::Numbers line(const Polylines& of, std::size_t i) {
        std::vector<std::array<double, 4>> points;
        for (const std::uint32_t v : of.line(i)) {
            const Point& x = of.vertices[v];
            points.push_back({x[0], x[1], x[2], of.attributes[v * of.attribute_count]});
        }
        if (of.closed(i)) {
            points.pop_back();
            std::ranges::rotate(points, std::ranges::min_element(points));
        }
        Record::Numbers all{of.value[i], of.closed(i) ? 1.0 : 0.0};
        for (const auto& point : points) all.insert(all.end(), point.begin(), point.end());
        return all;
    }
};

TEST(DistributedPrograms, IsolinesAreWholeLines) {
    compare_on<UnbalancedQuadtree>("isolines, quadtrees", DrawLines{}, 10);
    compare_on<BisectionTriangles>("isolines, bisections", DrawLines{}, 10);
    compare_on<RedGreenTriangles>("isolines, red-green", DrawLines{}, 10);
}

/// Values at points, many of them on faces and at nodes between ranks.
struct Probe {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        const HierarchicalIndicator indicator(grid, field, executor);
        std::mt19937 random(9);
        std::vector<Point> points;
        for (int i = 0; i < 300; ++i) {
            Point x{};
            for (std::size_t d = 0; d < Grid::dimension; ++d) {
                const auto steps = static_cast<double>(random() % 80);
                x[d] = i % 2 == 0 ? steps / 64 - 0.125 : static_cast<double>(random()) / 0x1p32;
            }
            points.push_back(x);
        }
        put(probe(grid, field, points), record);
        put(probe(grid, field, points, under(indicator, 0.2)), record);
        put(probe_line(grid, field, points[1], points[3], 17), record);
    }
    static void put(const ProbeResult& result, Record& record) {
        Record::Numbers values;
        std::vector<Record::Numbers> found;
        for (std::size_t i = 0; i < result.level.size(); ++i) {
            values.push_back(result.level[i]);
            values.insert(values.end(), result.reference[i].begin(), result.reference[i].end());
            for (std::size_t c = 0; c < result.components && result.found(i); ++c) {
                values.push_back(result.values[i * result.components + c]);
            }
            // One rank has the element around each point.
            if (result.element_of[i] == ProbeResult::no_element) continue;
            const auto shape = result.shape_of[result.element_of[i]];
            found.push_back({static_cast<double>(i), static_cast<double>(shape)});
        }
        values.push_back(static_cast<double>(result.counts.calls));
        values.push_back(static_cast<double>(result.counts.visited));
        values.push_back(static_cast<double>(result.counts.extracted));
        record.put(std::move(values));
        record.put_part(std::move(found));
    }
};

TEST(DistributedPrograms, ValuesAtPoints) {
    compare_on<UnbalancedOctree>("points, unbalanced octrees", Probe{}, 6);
    compare_on<Prisms>("points, prisms", Probe{}, 4);
    compare_on<RedGreenMixed3>("points, red-green mixed", Probe{}, 4);
    compare_on<UnbalancedQuadtree>("points, quadtrees", Probe{}, 8);
    compare_on<RedGreenTriangles>("points, red-green triangles", Probe{}, 8);
}

/// A field that throws once it is told to.
struct FragileField : CutField<2, double> {
    FragileField(const CutField<2, double>& field, const bool* does)
        : CutField<2, double>(field), fails{does} {}
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        if (*fails) throw std::runtime_error("the disk is gone");
        return CutField<2, double>::coarse_values(i, out);
    }
    const bool* fails;
};

/// A library that forgets what ranks tell: from one exchange on, or all gatherings.
template <class Family, class Program>
void expect_fails(const char* name, const Program& program, int exchange, bool gathers) {
    const Tally tally =
        compare_on<Family>(name, program, 6, {name, ForgetfulRanks::Step::draw, exchange, gathers});
    std::printf("%s forgotten: of %llu runs %llu differ, %llu end\n", name,
                static_cast<unsigned long long>(tally.drawn + tally.ended),
                static_cast<unsigned long long>(tally.other),
                static_cast<unsigned long long>(tally.ended));
    EXPECT_GT(tally.other + tally.ended, 0U) << name;
}

/// Draws at full resolution, so that a preroll is not what fails.
struct ShadeExactly {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        const engine::LeafBounds bounds(erase(grid, field));
        record.put_surface(shading(grid, field, under(Exact(), bounds), {}, {executor}).surface);
    }
};
struct ProbeLeaves {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor&, Record& record) const {
        std::vector<Point> points;
        for (int i = 0; i < 50; ++i) points.push_back({i / 50.0, 0.37, 0});
        Probe::put(probe(grid, field, points), record);
    }
};
struct LinesExactly {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        const engine::LeafBounds bounds(erase(grid, field));
        std::vector<Record::Numbers> lines;
        const Isolines drawn =
            isolines(grid, field, std::array{0.07}, under(Exact(), bounds), {}, {executor});
        for (std::size_t i = 0; i < drawn.lines.count(); ++i) {
            lines.push_back(DrawLines::line(drawn.lines, i));
        }
        record.put_part(std::move(lines));
    }
};

TEST(DistributedPrograms, MutantsFail) {
    expect_fails<UnbalancedQuadtree>("nodes on edges", ShadeExactly{}, 0, false);
    expect_fails<UnbalancedQuadtree>("answers at points", ProbeLeaves{}, 0, true);
    expect_fails<BisectionTriangles>("copies of ends of lines", LinesExactly{}, 0, false);
    expect_fails<BisectionTriangles>("parts of lines", LinesExactly{}, 0, true);
}

/// What ranks say where one of them has other arguments, or a field that throws.
template <class Ask>
void expect_end_together(const char* what, const std::string& sentence, const Ask& ask) {
    std::mt19937 random(5);
    auto grid = UnbalancedQuadtree::grids()[0];
    refine_at_random(grid, random, 3, 4, 3, 200);
    const Whole whole(grid);
    const std::vector<int> owner = whole.partition(4, Whole::Cut::in_runs, random);
    const std::vector<double> values = some_values(whole, 1);
    const auto ended = SimulatedRanks::run(4, [&](Ranks& ranks) {
        const Part part(whole, owner, ranks.rank());
        const CutGrid<2> mine(whole, &part, true);
        const Distributed on_ranks(mine, ranks);
        bool fails = false;
        const DistributedField field(on_ranks,
                                     FragileField(CutField<2, double>{&mine, &values}, &fails));
        const HierarchicalIndicator indicator(on_ranks, field);
        fails = ranks.rank() == 2;
        ask(on_ranks, field, indicator, fails);
    });
    for (const std::string& said : ended) {
        EXPECT_EQ(said, ended[0]) << what;
        EXPECT_NE(said.find(sentence), std::string::npos) << what << ": '" << said << "'";
    }
}

TEST(DistributedPrograms, RanksEndTogether) {
    constexpr const char* disk = "rank 2: the disk is gone";
    constexpr const char* same = "all ranks must ask for the same, but rank 0 asks for ";
    const std::vector<Point> points{{0.3, 0.4, 0}, {0.8, 0.1, 0}};
    expect_end_together("shading", disk,
                        [](auto& g, auto& f, auto& s, bool&) { shading(g, f, under(s, 0.1)); });
    expect_end_together("points", disk,
                        [&](auto& g, auto& f, auto&, bool&) { probe(g, f, points); });
    expect_end_together("budget", disk, [](auto& g, auto& f, auto&, bool&) {
        isosurface(g, f, 0.1, {.max_triangles = 30});
    });
    expect_end_together("isolines", disk, [](auto& g, auto& f, auto& s, bool&) {
        isolines(g, f, std::array{0.1}, under(s, 0));
    });
    const auto odd = [](bool& fails) { return std::exchange(fails, false) ? 1 : 0; };
    expect_end_together("scales", same, [&](auto& g, auto& f, auto& s, bool& fails) {
        height_field(g, f, 1.0 + odd(fails), under(s, 0));
    });
    expect_end_together("other points", same, [&](auto& g, auto& f, auto&, bool& fails) {
        probe(g, f, std::span(points).first(2U - static_cast<std::size_t>(odd(fails))));
    });
    expect_end_together("other budgets", same, [&](auto& g, auto& f, auto&, bool& fails) {
        const auto most = static_cast<std::uint64_t>(30 + odd(fails));
        isosurface(g, f, 0.1, {.max_triangles = most});
    });
    const auto not_a_number = [&](bool& fails, double isovalue) {
        return odd(fails) == 0 ? isovalue : std::nan("");
    };
    expect_end_together("band", "rank 2: ", [&](auto& g, auto& f, auto&, bool& fails) {
        isoband(g, f, not_a_number(fails, -0.1), 0.2, {.max_triangles = 90});
    });
    expect_end_together("upper end of a band",
                        "rank 2: ", [&](auto& g, auto& f, auto& s, bool& fails) {
                            isoband(g, f, -0.1, not_a_number(fails, 0.2), under(s, 0));
                        });
    expect_end_together("lines", "rank 2: the isovalue", [&](auto& g, auto& f, auto&, bool& fails) {
        isolines(g, f, std::array{0.2, not_a_number(fails, 0.1)}, {.max_triangles = 90});
    });
    expect_end_together("lines without end", "rank 2: the isovalue",
                        [&](auto& g, auto& f, auto& s, bool& fails) {
                            const double high = std::numeric_limits<double>::infinity();
                            isolines(g, f, std::array{odd(fails) == 0 ? 0.1 : high}, under(s, 0));
                        });
    expect_end_together("too few", "even the coarsest surface has more than 1 triangles",
                        [&](auto& g, auto& f, auto&, bool& fails) {
                            fails = false;
                            isosurface(g, f, 0.1, {.max_triangles = 1});
                        });
}

}  // namespace
