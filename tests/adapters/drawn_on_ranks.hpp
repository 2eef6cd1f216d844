// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What ranks draw of a solver's distributed grid, gathered, beside what one process draws of all.
#pragma once

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <nestgrid/adapters/mpi.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/slice.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// Where a vertex is, and its normal where normals were asked for.
using Corner = std::array<Point, 2>;
template <int dim>
using Simplex = std::array<Corner, dim>;

template <int dim>
struct Drawn {
    std::vector<Simplex<dim>> simplices;
    std::vector<double> values;  // bounds, and values at points
    std::array<std::uint64_t, 3> counts{};
    bool operator==(const Drawn&) const = default;
};

/// A number from -0.5 to 0.5 that depends on each bit of a place.
inline double random_of(const Point& x) {
    std::uint64_t sum = 0;
    for (const double along : x) {
        sum = detail::mix64(sum + std::bit_cast<std::uint64_t>(along + 0.0));
    }
    return static_cast<double>(sum >> 11U) * 0x1p-53 - 0.5;
}

/// The distance from a sphere in the unit square or cube, perhaps with noise.
inline double sphere(const Point& x, bool plane, bool noise) {
    return 0.35 - norm(x - Point{0.51, 0.47, plane ? 0 : 0.52}) + (noise ? random_of(x) : 0);
}

/// Surfaces of three thresholds, capped or not, with normals, slices, and values at points.
template <int dim, class AnyGrid, class Field>
std::vector<Drawn<dim>> draw(const AnyGrid& grid, const Field& field) {
    std::vector<Drawn<dim>> all;
    const HierarchicalIndicator indicator(grid, field);
    const auto add = [&](const Isosurface<dim>& result) {
        Drawn<dim>& drawn = all.emplace_back();
        const Surface<dim>& surface = result.surface;
        for (const auto& simplex : surface.simplices) {
            Simplex<dim>& corners = drawn.simplices.emplace_back();
            for (std::size_t k = 0; k < dim; ++k) {
                const bool any = !surface.normals.empty();
                corners[k] = {surface.vertices[simplex[k]],
                              any ? surface.normals[simplex[k]] : Point{0, 0, 0}};
            }
        }
        drawn.values = {result.error_bound};
        drawn.counts = {result.counts.calls, result.counts.visited, result.counts.extracted};
    };
    for (const double epsilon : {0.0, 0.02, 0.3}) {
        for (const bool cap : {false, true}) {
            add(isosurface(grid, field, 0.0, under(indicator, epsilon), {.cap = cap}));
        }
    }
    if constexpr (dim == 3) {
        add(isosurface(grid, field, 0.0, under(indicator, 0.02), {.normals = true}));
        for (const Point& normal : {Point{1, 1, 0}, Point{1, 0, 0}, Point{0.3, 0.2, 1}}) {
            const Plane plane({0.5, 0.5, 0.5}, normal);
            add(slice(grid, field, plane));
            add(slice(grid, field, plane, under(indicator, 0.3)));
        }
    }
    std::vector<Point> points;
    for (const double along : {0.25, 0.5, 0.7}) {
        points.push_back({along, 0.5, dim == 3 ? 0.5 : 0});
        points.push_back({along, 0.3, dim == 3 ? 0.8 : 0});
    }
    all.emplace_back().values = probe(grid, field, points, under(indicator, 0.02)).values;
    return all;
}

template <class Result>
void append(std::vector<Result>& all, std::vector<Result> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
}

template <int dim>
void sort(std::vector<Drawn<dim>>& all) {
    for (Drawn<dim>& drawn : all) {
        for (Simplex<dim>& s : drawn.simplices) {
            std::rotate(s.begin(), std::min_element(s.begin(), s.end()), s.end());
        }
        std::sort(drawn.simplices.begin(), drawn.simplices.end());
    }
}

/// Waits for the other ranks asleep. Within MPI a rank waits awake, and takes a processor's time.
inline void sleep_until_all() {
    MPI_Request barrier = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &barrier);
    for (int there = 0; there == 0;) {
        MPI_Test(&barrier, &there, MPI_STATUS_IGNORE);
        if (there == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

/// What all ranks drew together, on the first of them.
template <int dim>
std::vector<Drawn<dim>> gathered(std::vector<Drawn<dim>> own, Ranks& ranks) {
    for (Drawn<dim>& drawn : own) {
        const auto bytes = std::as_bytes(std::span(drawn.simplices));
        const auto all = ranks.gather({bytes.begin(), bytes.end()});
        drawn.simplices.clear();
        if (ranks.rank() != 0) continue;
        for (const Ranks::Bytes& each : all) {
            const auto* const begin = reinterpret_cast<const Simplex<dim>*>(each.data());
            drawn.simplices.insert(drawn.simplices.end(), begin,
                                   begin + each.size() / sizeof(Simplex<dim>));
        }
    }
    sort(own);
    return own;
}

template <int dim>
std::uint64_t hash_of(const std::vector<Drawn<dim>>& all) {
    std::uint64_t sum = 0;
    const auto add = [&](double x) {
        sum = detail::mix64(sum + std::bit_cast<std::uint64_t>(x + 0.0));
    };
    for (const Drawn<dim>& drawn : all) {
        for (const auto& simplex : drawn.simplices) {
            for (const Corner& corner : simplex) {
                for (const Point& x : corner) std::for_each(x.begin(), x.end(), add);
            }
        }
        std::for_each(drawn.values.begin(), drawn.values.end(), add);
    }
    return sum;
}

/// Prints what was compared.
/// \param found, expected sorted
/// \return how many of them differ
template <int dim>
int count_different(const std::string& name, int ranks, unsigned long long leaves,
                    const std::vector<Drawn<dim>>& found, const std::vector<Drawn<dim>>& expected) {
    int wrong = found.size() == expected.size() ? 0 : 1;
    std::size_t simplices = 0;
    for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
        wrong += found[i] == expected[i] ? 0 : 1;
        simplices += expected[i].simplices.size();
    }
    std::printf(
        "%d ranks, %-36s: %6llu leaves, %zu results, %6zu simplices, hash %016llx, %d "
        "differ\n",
        ranks, name.c_str(), leaves, expected.size(), simplices,
        static_cast<unsigned long long>(hash_of(expected)), wrong);
    return wrong + (simplices == 0 ? 1 : 0);
}

/// Counts what does not end all ranks with the sentence that it should.
class Refusals {
public:
    explicit Refusals(Ranks& ranks) : ranks_{&ranks} {}

    /// \param sentence a part of what all ranks must say
    template <class Exception, class Ask>
    void expect(const std::string& sentence, const Ask& ask) {
        try {
            ask();
        } catch (const Exception& e) {
            const std::string said = e.what();
            if (said.find(sentence) != std::string::npos) return;
            std::printf("rank %d: %s\n", ranks_->rank(), said.c_str());
        }
        std::printf("rank %d does not say: %s\n", ranks_->rank(), sentence.c_str());
        ++wrong;
    }

    int wrong = 0;

private:
    Ranks* ranks_;
};

/// Ranks of another communicator than the grid's are refused before they exchange anything, each
/// process alone.
/// \param mine of all processes
/// \param alone of this process
template <class AnyGrid>
void refuse_other_ranks(const AnyGrid& mine, const AnyGrid& alone, Ranks& all, Refusals& refusals) {
    const auto expect = [&](const AnyGrid& grid, int processes, Ranks& ranks) {
        if (processes == ranks.size()) return;
        refusals.expect<InvalidInput>(
            "the communicator of the grid has " + std::to_string(processes) +
                " processes, that of the ranks " + std::to_string(ranks.size()) + ": ",
            [&] { const Distributed on_ranks(grid, ranks); });
    };
    MPI_Comm every_second = MPI_COMM_NULL;
    MPI_Comm_split(MPI_COMM_WORLD, all.rank() % 2, 0, &every_second);
    for (const MPI_Comm communicator : {MPI_COMM_SELF, every_second}) {
        MpiRanks fewer(communicator);
        expect(mine, all.size(), fewer);
    }
    MPI_Comm_free(&every_second);
    expect(alone, 1, all);
}

/// The status of a program of which this rank has found so much wrong.
inline int status_of_all(Ranks& ranks, int wrong) {
    auto all = static_cast<std::uint64_t>(wrong);
    ranks.reduce(std::span(&all, 1), Ranks::Reduction::sum);
    return all == 0 ? 0 : 1;
}

}  // namespace nestgrid_test
