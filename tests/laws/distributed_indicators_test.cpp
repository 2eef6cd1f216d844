// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators of distributed grids, updates of them and times between frames: what ranks draw under
// them is what one rank draws.
#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/node_levels.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/swept_key_frames.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>

#include <level_sets/leaf_bounds.hpp>

#include "record_judge.hpp"

using namespace nestgrid_test;

namespace {

template <class Result>
void put(const Result& drawn, Record& record) {
    record.put({drawn.error_bound, drawn.range_bound, drawn.surface_error,
                static_cast<double>(drawn.counts.calls), static_cast<double>(drawn.counts.visited),
                static_cast<double>(drawn.counts.extracted)});
    record.put_surface(drawn.surface);
}

struct DrawUnderIndicators {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        const HierarchicalIndicator offsets(grid, field, executor);
        const auto draw = [&](const Indicator& indicator, double epsilon) {
            put(isosurface(grid, field, 0.1, under(Threshold(&indicator, epsilon), offsets), {},
                           {executor}),
                record);
        };
        const SweptIndicator visual = visual_indicator({grid, field});
        const SweptIndicator rough =
            visual_indicator({grid, field}, {.tau = 0.3, .spread = {.factor = 2, .slope = 0.5}});
        const SweptIndicator numerical = numerical_indicator({grid, field});
        for (const double epsilon : {0.1, 0.5, 1.2}) {
            draw(visual, epsilon);
            draw(rough, epsilon);
            draw(numerical, epsilon);
        }
        constexpr std::array isovalues{0.1, 0.3};
        const SweptIndicator cuts =
            cut_deviations({grid, field}, isovalues, offsets, Spread{}, executor);
        const SweptIndicator slopes =
            slope_deviations({grid, field}, isovalues, offsets, Spread{.slope = 0.1}, executor);
        for (const double epsilon : {0.05, 0.3}) {
            draw(cuts, epsilon);
            draw(slopes, epsilon);
        }
        draw(geometry_indicator({grid, field}), 0.1);
        draw(NodeLevels(grid), -2);
    }
};

TEST(DistributedIndicators, PiecesAreTheSurfaceOfOneRank) {
    compare_on<UnbalancedOctree>("indicators, octrees", DrawUnderIndicators{}, 4);
    compare_on<Prisms>("indicators, prisms", DrawUnderIndicators{}, 3);
    compare_on<RedGreenMixed3>("indicators, red-green", DrawUnderIndicators{}, 3);
    compare_on<BisectionTetrahedra>("indicators, bisections", DrawUnderIndicators{}, 4);
    compare_on<UnbalancedQuadtree>("indicators, quadtrees", DrawUnderIndicators{}, 6);
}

/// Other values of the same solver: those of a field where they are low, and half of the others.
template <class Field>
struct Later : Field {
    explicit Later(const Field& field) : Field(field) {}
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return changed(Field::coarse_values(i, out), out);
    }
    template <class Element>
    NodeMask new_values(const Element& e, NodeMask which, std::span<double> out) const {
        return changed(Field::new_values(e, which, out), out);
    }

private:
    static NodeMask changed(NodeMask missing, std::span<double> out) {
        for (double& value : out) value = value < 0.2 ? value : value / 2;
        return missing;
    }
};

/// Calls draw(field) with a field of the solver, on ranks or on one.
template <class Grid, class Field, class Draw>
void with_field(const Grid& grid, const Field& field, const Draw& draw) {
    if constexpr (requires { grid.shared_nodes(); }) {
        draw(DistributedField(grid, field));
    } else {
        draw(field);
    }
}

struct DrawLater {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    Record& record) const {
        using Own = CutField<Grid::dimension, double>;
        const Own& now = field;
        const Later<Own> later(now);
        HierarchicalIndicator offsets(grid, field, executor);
        HierarchicalIndicator deviations(grid, field, NodeError::deviation, executor);
        constexpr double far = 1e3;
        const ChangedBox everywhere{{-far, -far, -far}, {far, far, far}};
        with_field(grid, later, [&](const auto& changed) {
            const HierarchicalIndicator of_later(grid, changed, executor);
            between(grid, now, offsets, of_later, executor, record);
            offsets.update(grid, changed, everywhere);
            deviations.update(grid, changed, everywhere);
            for (const double epsilon : {0.0, 0.1, 0.4}) {
                put(isosurface(grid, changed, 0.1, under(offsets, epsilon), {}, {executor}),
                    record);
                put(isosurface(grid, changed, 0.1, under(deviations, epsilon), {}, {executor}),
                    record);
            }
            record.put({offsets.least(), offsets.greatest(), deviations.greatest()});
        });
    }
    template <class Grid, class Own>
    static void between(const Grid& grid, const Own& now, const HierarchicalIndicator& first,
                        const HierarchicalIndicator& second, const Executor& executor,
                        Record& record) {
        constexpr std::array weights{0.25F, 0.75F};
        const KeyFrames frames({&first, &second}, weights);
        const Mixed<Own> mixed(now, weights);
        with_field(grid, mixed, [&](const auto& field) {
            for (const double epsilon : {0.05, 0.3}) {
                put(isosurface(grid, field, 0.1, under(frames, epsilon), {.cap = epsilon > 0.1},
                               {executor}),
                    record);
            }
        });
    }
    /// The field Between of two types.
    template <class Own>
    struct Mixed {
        using value_type = double;
        static constexpr int components = Own::components;
        struct Either : Own {
            Either(const Own& field, bool does) : Own(field), is_later{does} {}
            NodeMask coarse_values(std::size_t i, std::span<double> out) const {
                return is_later ? Later<Own>(*this).coarse_values(i, out)
                                : Own::coarse_values(i, out);
            }
            template <class Element>
            NodeMask new_values(const Element& e, NodeMask which, std::span<double> out) const {
                return is_later ? Later<Own>(*this).new_values(e, which, out)
                                : Own::new_values(e, which, out);
            }
            bool is_later;
        };
        Mixed(const Own& now, std::span<const float> w)
            : frames{Either(now, false), Either(now, true)}, weights{w[0], w[1]} {}
        template <class Context>
        NodeMask coarse_values(std::size_t i, std::span<double> out, Context& context) const {
            return Between({&frames[0], &frames[1]}, weights).coarse_values(i, out, context);
        }
        template <class Element, class Context>
        NodeMask new_values(const Element& e, NodeMask which, std::span<double> out,
                            Context& context) const {
            return Between({&frames[0], &frames[1]}, weights).new_values(e, which, out, context);
        }
        std::array<Either, 2> frames;
        std::array<float, 2> weights;
    };
};

TEST(DistributedIndicators, UpdatesAndKeyFrames) {
    compare_on<UnbalancedOctree>("updates, octrees", DrawLater{}, 4);
    compare_on<RedGreenMixed3>("updates, red-green", DrawLater{}, 3);
    compare_on<BisectionTetrahedra>("updates, bisections", DrawLater{}, 4);
    compare_on<UnbalancedQuadtree>("updates, quadtrees", DrawLater{}, 6);
}

/// A library that forgets the exchanges of an indicator, from one on.
template <class Family, class Make>
void expect_fails(const char* name, const Make& make, int exchange) {
    Tally tally;
    std::mt19937 random(3);
    for (auto& grid : Family::grids()) {
        refine_at_random(grid, random, 3, 4, 3, 200);
        const Whole whole(grid);
        for (unsigned data = 0; data < 3; ++data) {
            std::vector<double> values = some_values(whole, data);
            const CutGrid<3> one(whole, nullptr, true);
            const auto expected = make(one, CutField<3, double>{&one, &values});
            const std::vector<int> owner = whole.partition(4, Whole::Cut::in_runs, random);
            std::atomic<std::uint64_t> other{0};
            SimulatedRanks::run(4, [&](Ranks& all) {
                ForgetfulRanks ranks(all, {name, ForgetfulRanks::Step::draw, exchange, false});
                ranks.begin(ForgetfulRanks::Step::share);
                const Part part(whole, owner, ranks.rank());
                const CutGrid<3> mine(whole, &part, true);
                const Distributed on_ranks(mine, ranks);
                const DistributedField field(on_ranks, CutField<3, double>{&mine, &values});
                ranks.begin(ForgetfulRanks::Step::draw);
                const auto found = make(on_ranks, field);
                for (std::size_t n = 0; n < part.visited.size(); ++n) {
                    const NodeKey key = mine.key(n);
                    if (part.visited[n]) other += found.stop(key) != expected.stop(key) ? 1 : 0;
                }
            });
            ++tally.drawn;
            tally.other += other != 0 ? 1 : 0;
        }
    }
    std::printf("%s, exchange %d on forgotten: of %llu runs %llu differ\n", name, exchange,
                static_cast<unsigned long long>(tally.drawn),
                static_cast<unsigned long long>(tally.other));
    EXPECT_EQ(tally.other > 0, exchange < 99) << name;
}

TEST(DistributedIndicators, MutantsFail) {
    const auto visual = [](const auto& g, const auto& f) { return visual_indicator({g, f}); };
    const auto numerical = [](const auto& g, const auto& f) { return numerical_indicator({g, f}); };
    const auto cuts = [](const auto& g, const auto& f) {
        const engine::LeafBounds bounds(erase(g, f));
        return slope_deviations({g, f}, std::array{0.1}, bounds);
    };
    const auto levels = [](const auto& g, const auto&) { return NodeLevels(g); };
    // 0: what ranks keep of nodes; 1: maxima. 99: nothing is forgotten.
    for (const int exchange : {0, 1, 99}) {
        expect_fails<UnbalancedOctree>("normals", visual, exchange);
        expect_fails<UnbalancedOctree>("jumps", numerical, exchange);
    }
    for (const int exchange : {0, 99}) {
        expect_fails<UnbalancedOctree>("cuts", cuts, exchange);
        // Bisections make a node on several levels.
        expect_fails<BisectionTetrahedra>("levels", levels, exchange);
    }
}

}  // namespace
