// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// That what ranks draw of their parts of a grid is, together, what one rank draws of all of it.
#pragma once

#include <atomic>
#include <map>
#include <mutex>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <ranks/shared_nodes.hpp>
#include <walk/hanging_nodes.hpp>

#include "cut_grid.hpp"
#include "simulated_ranks.hpp"
#include "thread_executor.hpp"

namespace nestgrid_test {

/// Positions and attributes of the corners of a triangle or segment, beginning with the least.
template <int dim>
using Piece = std::array<std::array<double, 4>, dim>;

template <int dim>
void add_pieces(const Surface<dim>& surface, std::vector<Piece<dim>>& all) {
    for (const auto& simplex : surface.simplices) {
        Piece<dim> piece;
        for (std::size_t k = 0; k < dim; ++k) {
            const Point& x = surface.vertices[simplex[k]];
            piece[k] = {x[0], x[1], x[2], surface.attributes.at(simplex[k])};
        }
        std::rotate(piece.begin(), std::min_element(piece.begin(), piece.end()), piece.end());
        all.push_back(piece);
    }
}

/// What is compared of one surface.
template <int dim>
struct Drawn {
    std::vector<Piece<dim>> pieces;
    std::array<double, 3> bounds{};
    std::array<std::uint64_t, 3> counts{};

    void add(const Isosurface<dim>& result) {
        add_pieces<dim>(result.surface, pieces);
        bounds = {result.error_bound, result.range_bound, result.surface_error};
        counts = {result.counts.calls, result.counts.visited, result.counts.extracted};
    }
    bool operator==(const Drawn&) const = default;
};

struct Runs {
    std::uint64_t surfaces = 0;  ///< drawn by ranks and compared
    std::uint64_t other = 0;     ///< with other triangles, bounds or counts
    std::uint64_t prerolls = 0;  ///< of which stop, bound and hanging bit of every node compared
    std::uint64_t other_nodes = 0;
    std::uint64_t ended = 0;   ///< where ranks ended by an exception
    std::uint64_t common = 0;  ///< most common nodes of a run
    std::uint64_t triangles = 0;
    std::string first;  ///< the first mistake

    void note(std::uint64_t& count, const std::string& what) {
        ++count;
        if (first.empty()) first = what;
    }
    std::uint64_t mistakes() const { return other + other_nodes + ended; }
};

/// One way to cut a grid.
struct Cutting {
    int ranks;
    Whole::Cut how;
    std::size_t most_sharers;
    bool own_keys;
    std::size_t threads;
    /// What ranks forget, in mutants.
    ForgetfulRanks::Omission omission{"nothing", ForgetfulRanks::Step::none, 0, false};
    bool all_draw = false;  ///< in a mutant: each rank draws the elements of which it has a part
};

/// A field on a whole grid, what one rank draws of it, and comparisons with that.
template <int dim, class Real>
class DistributedJudge {
public:
    static constexpr std::array isovalues{0.0, 0.25};

    DistributedJudge(const Whole& whole, std::vector<Real> values, std::span<const double> epsilons)
        : whole_{&whole}, values_{std::move(values)}, epsilons_{epsilons.begin(), epsilons.end()} {
        for (const bool own_keys : {false, true}) draw_whole(own_keys);
    }

    /// \param owner the rank that has each leaf
    void compare(const Cutting& cut, const std::vector<int>& owner, Runs& runs) const {
        const Reference& expected = reference_[cut.own_keys ? 1 : 0];
        std::vector<Drawn<dim>> drawn(expected.drawn.size());
        std::atomic<std::uint64_t> wrong_nodes{0};
        std::atomic<std::uint64_t> common{0};
        std::mutex mutex;
        const auto ended = SimulatedRanks::run(cut.ranks, [&](Ranks& all) {
            ForgetfulRanks ranks(all, cut.omission);
            Part part(*whole_, owner, ranks.rank());
            for (Presence& presence : part.presence) {
                if (cut.all_draw && presence == Presence::partly) presence = Presence::partly_first;
            }
            ranks.begin(ForgetfulRanks::Step::share);
            const CutGrid<dim> mine(*whole_, &part, cut.own_keys);
            const Distributed grid(mine, ranks, cut.most_sharers);
            ranks.begin(ForgetfulRanks::Step::values);
            const DistributedField field(grid, CutField<dim, Real>{&mine, &values_});
            const ThreadExecutor threads(cut.threads);
            ranks.begin(ForgetfulRanks::Step::preroll);
            const HierarchicalIndicator indicator(grid, field, threads);
            wrong_nodes += wrong(expected, part, mine, *grid.shared_nodes(), indicator);
            common = grid.shared_nodes()->common_count();
            std::size_t i = 0;
            ranks.begin(ForgetfulRanks::Step::draw);
            draw(grid, field, indicator, threads, [&](const Isosurface<dim>& result) {
                const std::scoped_lock lock(mutex);
                drawn[i++].add(result);
            });
        });
        const std::string where = describe(cut);
        for (const std::string& sentence : ended) {
            if (!sentence.empty()) return runs.note(runs.ended, where + ": " + sentence);
        }
        ++runs.prerolls;
        runs.common = std::max<std::uint64_t>(runs.common, common);
        if (wrong_nodes != 0) {
            runs.note(runs.other_nodes,
                      where + ": numbers of " + std::to_string(wrong_nodes) + " nodes are others");
        }
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            ++runs.surfaces;
            runs.triangles += expected.drawn[i].pieces.size();
            std::sort(drawn[i].pieces.begin(), drawn[i].pieces.end());
            if (drawn[i] == expected.drawn[i]) continue;
            runs.note(runs.other, where + ": surface " + std::to_string(i) + " differs, with " +
                                      std::to_string(drawn[i].pieces.size()) + " simplices for " +
                                      std::to_string(expected.drawn[i].pieces.size()) +
                                      text_of(drawn[i], expected.drawn[i]));
        }
    }

private:
    struct Reference {
        std::vector<Drawn<dim>> drawn;
        std::vector<std::array<double, 3>> of_node;  // stop, bound, and whether it hangs
    };

    static std::string text_of(const Drawn<dim>& a, const Drawn<dim>& b) {
        std::string text;
        for (std::size_t k = 0; k < 3; ++k) {
            text +=
                ", bound " + std::to_string(a.bounds[k]) + " for " + std::to_string(b.bounds[k]);
            text +=
                ", count " + std::to_string(a.counts[k]) + " for " + std::to_string(b.counts[k]);
        }
        return text;
    }
    static std::string describe(const Cutting& cut) {
        return std::to_string(cut.ranks) + " ranks, cut " + std::to_string(int(cut.how)) +
               ", sharers " + std::to_string(cut.most_sharers) + ", own keys " +
               std::to_string(cut.own_keys) + ", threads " + std::to_string(cut.threads);
    }

    /// Draws all surfaces that are compared.
    template <class Grid, class Field, class Take>
    void draw(const Grid& grid, const Field& field, const HierarchicalIndicator& indicator,
              const Executor& executor, const Take& take) const {
        for (const double epsilon : epsilons_) {
            for (const bool cap : {false, true}) {
                const IsosurfaceOptions options{.cap = cap, .verify = true};
                take(isosurface(grid, field, isovalues[0], under(indicator, epsilon), options,
                                {executor}));
            }
        }
        const Threshold s(&indicator, epsilons_.back());
        for (const auto& result :
             isosurfaces(grid, field, isovalues, under(s, indicator), {.cap = true}, {executor})) {
            take(result);
        }
        take(isosurface(grid, field, isovalues[1], under(Exact(), indicator), {}, {executor}));
        take(isoband(grid, field, isovalues[0], isovalues[1], under(s, indicator), {}, {executor}));
    }

    void draw_whole(bool own_keys) {
        Reference& reference = reference_[own_keys ? 1 : 0];
        const CutGrid<dim> grid(*whole_, nullptr, own_keys);
        const CutField<dim, Real> field{&grid, &values_};
        const HierarchicalIndicator indicator(grid, field);
        draw(grid, field, indicator, SequentialExecutor{}, [&](const Isosurface<dim>& result) {
            reference.drawn.emplace_back().add(result);
            std::sort(reference.drawn.back().pieces.begin(), reference.drawn.back().pieces.end());
        });
        const auto hierarchy = erase(grid, field);
        const HangingNodes hanging = engine::find_hanging_nodes<Real>(hierarchy);
        for (std::size_t n = 0; n < whole_->positions.size(); ++n) {
            const NodeKey key = grid.key(n);
            reference.of_node.push_back({indicator.stop(key), double{indicator.bound(key)},
                                         hanging.contains(key) ? 1.0 : 0.0});
        }
    }

    /// At how many of its nodes a rank has other numbers than one rank has.
    std::uint64_t wrong(const Reference& expected, const Part& part, const CutGrid<dim>& grid,
                        const engine::SharedNodes& shared,
                        const HierarchicalIndicator& indicator) const {
        std::uint64_t wrong = 0;
        for (std::size_t n = 0; n < part.visited.size(); ++n) {
            if (!part.visited[n]) continue;
            const NodeKey key = grid.key(n);
            const std::array<double, 3> found{indicator.stop(key), double{indicator.bound(key)},
                                              shared.hanging().contains(key) ? 1.0 : 0.0};
            wrong += found != expected.of_node[n];
        }
        return wrong;
    }

    const Whole* whole_;
    std::vector<Real> values_;
    std::vector<double> epsilons_;
    std::array<Reference, 2> reference_;  // with derived keys, with own ones
};

}  // namespace nestgrid_test
