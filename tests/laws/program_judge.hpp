// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// That what a program draws on ranks is, together, what it draws on one.
#pragma once

#include <mutex>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/join_pieces.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "distributed_judge.hpp"

namespace nestgrid_test {

/// The surfaces that a program draws, in pieces or not. Corners are positions, two attributes and
/// normals, as far as there are any; each simplex begins with the least corner.
template <int dim>
struct Cut {
    using Simplex = std::array<std::array<double, 8>, dim>;
    using Ridge = std::array<Point, static_cast<std::size_t>(dim - 1)>;

    std::vector<Simplex> simplices;
    std::vector<Ridge> boundary;  ///< of the domain
    std::array<double, 4> bounds{};
    std::uint64_t extracted = 0;
    std::size_t elements = 0;  ///< simplices whose element is kept

    void add(const Isosurface<dim>& piece) {
        const Surface<dim>& surface = piece.surface;
        for (const auto& v : surface.simplices) add_simplex(surface, v);
        for (const auto& v : surface.boundary) {
            Ridge ridge;
            for (std::size_t k = 0; k < v.size(); ++k) ridge[k] = surface.vertices[v[k]];
            std::ranges::sort(ridge);
            boundary.push_back(ridge);
        }
        bounds = {piece.error_bound, piece.range_bound, piece.surface_error, piece.position_bound};
        extracted = piece.counts.extracted;
        elements += surface.element_of.size();
        for (const std::uint32_t e : surface.element_of) EXPECT_LT(e, surface.level_of.size());
    }
    void sort() {
        std::ranges::sort(simplices);
        std::ranges::sort(boundary);
    }
    bool operator==(const Cut&) const = default;

private:
    void add_simplex(const Surface<dim>& surface, const typename Surface<dim>::Simplex& v) {
        const std::size_t stride = surface.attributes.size() / surface.vertices.size();
        Simplex simplex{};
        for (std::size_t k = 0; k < v.size(); ++k) {
            const auto put = [&](const Point& x, std::size_t at) {
                std::copy(x.begin(), x.end(), simplex[k].data() + at);
            };
            put(surface.vertices[v[k]], 0);
            for (std::size_t c = 0; c < stride; ++c) {
                simplex[k][3 + c] = surface.attributes[v[k] * stride + c];
            }
            if (!surface.normals.empty()) put(surface.normals[v[k]], 5);
        }
        std::rotate(simplex.begin(), std::ranges::min_element(simplex), simplex.end());
        simplices.push_back(simplex);
    }
};

/// A surface whose attributes are the positions of its vertices.
inline Surface<3> with_positions(Surface<3> surface) {
    surface.attributes.clear();
    for (const Point& x : surface.vertices) {
        surface.attributes.insert(surface.attributes.end(), x.begin(), x.end());
    }
    return surface;
}

/// Measures and fluxes of all components, in an order of their own, and of the whole.
using Measures = std::vector<std::vector<double>>;

inline Measures numbers_of(const SurfaceMeasurement& measured, const std::vector<double>& flux) {
    const auto numbers = [](const SurfaceMeasures& m) {
        std::vector<double> row{static_cast<double>(m.triangles), m.area, m.volume,
                                m.closed ? 1.0 : 0.0};
        row.insert(row.end(), m.area_vector.begin(), m.area_vector.end());
        row.insert(row.end(), m.integrals.begin(), m.integrals.end());
        return row;
    };
    Measures rows;
    for (std::size_t c = 0; c < flux.size(); ++c) {
        rows.push_back(numbers(measured.components.at(c)));
        rows.back().push_back(flux[c]);
    }
    std::ranges::sort(rows);
    rows.push_back(numbers(measured.total));
    return rows;
}

/// The pieces of all ranks, as one indexed surface.
template <int dim>
struct Joined {
    Surface<dim> surface;
    JoinedPiece totals;
    std::vector<std::uint64_t> component_of;
    std::vector<Measures> measures;  ///< as each rank knows them
    std::uint64_t elsewhere = 0;     ///< vertices that two pieces have at different places

    void add(const Isosurface<dim>& piece, const JoinedPiece& as) {
        totals = as;
        constexpr double nowhere = -1e300;
        surface.vertices.resize(as.vertices, Point{nowhere, 0, 0});
        for (std::size_t v = 0; v < as.number.size(); ++v) {
            Point& at = surface.vertices.at(as.number[v]);
            elsewhere += at[0] != nowhere && at != piece.surface.vertices[v] ? 1 : 0;
            at = piece.surface.vertices[v];
        }
        const auto put = [&](const auto& from, auto& to) {
            for (auto simplex : from) {
                for (std::uint32_t& v : simplex) v = static_cast<std::uint32_t>(as.number[v]);
                to.push_back(simplex);
            }
        };
        put(piece.surface.simplices, surface.simplices);
        put(piece.surface.boundary, surface.boundary);
        component_of.insert(component_of.end(), as.component_of.begin(), as.component_of.end());
    }
    /// Whether simplices have the number of a component, and the same one where they meet.
    bool has_components() const {
        std::vector<std::uint64_t> of_vertex(surface.vertices.size(), totals.components);
        if (component_of.size() != surface.simplices.size()) return false;
        for (std::size_t s = 0; s < component_of.size(); ++s) {
            if (component_of[s] >= totals.components) return false;
            for (const std::uint32_t v : surface.simplices[s]) {
                if (of_vertex[v] == totals.components) of_vertex[v] = component_of[s];
                if (of_vertex[v] != component_of[s]) return false;
            }
        }
        return true;
    }
    /// What differs from the surface of one rank.
    std::string compare(const Surface<dim>& whole) const {
        if (elsewhere != 0) return "copies of vertices are at different places";
        if (totals.vertices != whole.vertices.size()) return "another number of vertices";
        if (totals.simplices != whole.simplices.size()) return "another number of simplices";
        if (!has_components()) return "other components";
        if constexpr (dim == 3) {
            const SurfaceReport a = surface_report(surface);
            const SurfaceReport b = surface_report(whole);
            const auto numbers = [](const SurfaceReport& r) {
                return std::array<std::size_t, 9>{r.vertices,          r.edges,
                                                  r.triangles,         r.open_edges,
                                                  r.boundary_edges,    r.nonmanifold_edges,
                                                  r.misoriented_edges, r.nonmanifold_vertices,
                                                  r.components};
            };
            if (numbers(a) != numbers(b)) return "another report";
            if (totals.components != b.components) return "another number of components";
            if (totals.open != b.open_edges) return "other open edges";
            if (totals.on_boundary != b.boundary_edges) return "other boundary edges";
            if (a.area != b.area || a.volume != b.volume) return "another area or volume";
            const Surface<3> positions = with_positions(whole);
            const SurfaceMeasurement measured = measure_surface(positions);
            const Measures expected = numbers_of(measured, flux(positions, measured));
            for (const Measures& of_rank : measures) {
                if (of_rank != expected) return "other measures";
            }
        }
        return {};
    }
};

struct Tally {
    std::uint64_t functions = 0;
    std::uint64_t through_nodes = 0;
    std::uint64_t drawn = 0;
    std::uint64_t other = 0;
    std::uint64_t simplices = 0;
    std::uint64_t ended = 0;
    std::string first;

    void expect_none(const char* name) const {
        EXPECT_EQ(other, 0U) << name << ": " << first;
        EXPECT_EQ(ended, 0U) << name << ": " << first;
        EXPECT_GT(simplices, 0U) << name;
        std::printf("%-26s drawn %5llu times, %llu other, %llu ended, %llu simplices\n", name,
                    static_cast<unsigned long long>(drawn), static_cast<unsigned long long>(other),
                    static_cast<unsigned long long>(ended),
                    static_cast<unsigned long long>(simplices));
        std::fflush(stdout);
    }
};

/// What a program draws of a whole grid, and comparisons with that.
/// \tparam Program program(grid, field, executor, take) calls take(isosurface) for what it draws
template <int dim, class Real, class Program>
class ProgramJudge {
public:
    ProgramJudge(const Whole& whole, std::vector<Real> values, Program program)
        : whole_{&whole}, values_{std::move(values)}, program_{std::move(program)} {
        const CutGrid<dim> grid(*whole_, nullptr, true);
        const CutField<dim, Real> field{&grid, &values_};
        program_(grid, field, SequentialExecutor{}, [&](const Isosurface<dim>& drawn) {
            expected_.emplace_back().add(drawn);
            expected_.back().sort();
            whole_surfaces_.push_back(drawn.surface);
        });
    }

    void compare(const Cutting& cutting, const std::vector<int>& owner, Tally& tally) const {
        std::vector<Cut<dim>> drawn(expected_.size());
        std::vector<Joined<dim>> joined(expected_.size());
        std::mutex mutex;
        const auto ended = SimulatedRanks::run(cutting.ranks, [&](Ranks& all) {
            ForgetfulRanks ranks(all, cutting.omission);
            ranks.begin(ForgetfulRanks::Step::share);
            const Part part(*whole_, owner, ranks.rank());
            const CutGrid<dim> mine(*whole_, &part, cutting.own_keys);
            const Distributed grid(mine, ranks, cutting.most_sharers);
            const DistributedField field(grid, CutField<dim, Real>{&mine, &values_});
            const ThreadExecutor threads(cutting.threads);
            std::size_t i = 0;
            ranks.begin(ForgetfulRanks::Step::draw);
            program_(grid, field, threads, [&](const Isosurface<dim>& piece) {
                ranks.begin(ForgetfulRanks::Step::share);
                const JoinedPiece as = join_pieces(piece, grid);
                Measures measures;
                if constexpr (dim == 3) {
                    Isosurface<3> positions;
                    positions.surface = with_positions(piece.surface);
                    measures = numbers_of(measure_pieces(positions, as, grid),
                                          flux_of_pieces(positions, as, grid));
                }
                const std::scoped_lock lock(mutex);
                joined.at(i).add(piece, as);
                joined.at(i).measures.push_back(std::move(measures));
                drawn.at(i++).add(piece);
                ranks.begin(ForgetfulRanks::Step::draw);
            });
        });
        const std::string where =
            std::to_string(cutting.ranks) + " ranks, cut " + std::to_string(int(cutting.how));
        for (const std::string& sentence : ended) {
            if (!sentence.empty()) return note(tally, tally.ended, where + ": " + sentence);
        }
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            ++tally.drawn;
            drawn[i].sort();
            tally.simplices += drawn[i].simplices.size();
            if (drawn[i] == expected_[i]) {
                const std::string differs = joined[i].compare(whole_surfaces_[i]);
                if (differs.empty()) continue;
                note(tally, tally.other,
                     where + ", surface " + std::to_string(i) + ": joined, " + differs);
                continue;
            }
            note(tally, tally.other,
                 where + ", surface " + std::to_string(i) + ": " +
                     std::to_string(drawn[i].simplices.size()) + " simplices for " +
                     std::to_string(expected_[i].simplices.size()) + ", boundary " +
                     std::to_string(drawn[i].boundary.size()) + " for " +
                     std::to_string(expected_[i].boundary.size()) + ", error " +
                     std::to_string(drawn[i].bounds[0]) + " for " +
                     std::to_string(expected_[i].bounds[0]));
        }
    }

private:
    static void note(Tally& tally, std::uint64_t& count, const std::string& what) {
        ++count;
        if (tally.first.empty()) tally.first = what;
    }

    const Whole* whole_;
    std::vector<Real> values_;
    Program program_;
    std::vector<Cut<dim>> expected_;
    std::vector<Surface<dim>> whole_surfaces_;
};

/// Two components, the first of them noise of three numbers, smooth, or in steps.
inline std::vector<double> some_values(const Whole& whole, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<double> values;
    for (const Point& x : whole.positions) {
        const double noise = static_cast<double>(random()) / 0x1p32;
        values.push_back(seed % 3 == 0   ? std::floor(3 * noise) - 1
                         : seed % 3 == 1 ? 0.3 * noise + std::sin(5 * x[0]) * x[1] - x[2] * x[2]
                                         : std::floor(4 * (x[0] + x[1] - x[2])) / 4);
        values.push_back(x[0] + 2 * x[1] - x[2]);
    }
    return values;
}

/// One of many ways to cut a grid.
inline Cutting some_cutting(unsigned i, std::mt19937& random) {
    return {std::array{2, 3, 5, 8, 1, 13, 4}[i % 7], static_cast<Whole::Cut>(random() % 4),
            std::array<std::size_t, 2>{24, 2}[i % 2], i % 2 == 0,
            i % 4 == 3 ? std::size_t{2} : std::size_t{1}};
}

}  // namespace nestgrid_test
