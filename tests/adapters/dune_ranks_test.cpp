// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces on grids that Dune distributes over MPI: structured ones, and UG's, which are adapted
// before they are balanced. The pieces of all ranks, gathered, are the surface of one process. Run
// under mpirun; prints what it compared with the hash of all on one process, and returns 1 where
// something differs.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <type_traits>

#include <dune/common/parallel/mpihelper.hh>
#include <dune/grid/yaspgrid.hh>

#include <nestgrid/adapters/mpi.hpp>
#include <nestgrid/check_grid.hpp>

#include "drawn_on_ranks.hpp"
#include "dune_ug_grids.hpp"
#include "refusal_rows.hpp"

using namespace nestgrid_test;

namespace {

template <int dim>
using Even = Dune::EquidistantCoordinates<double, dim>;
template <int dim>
using Shifted = Dune::EquidistantOffsetCoordinates<double, dim>;
template <int dim>
using Given = Dune::TensorProductCoordinates<double, dim>;

/// A grid of the unit square or cube, twice as fine as its coarse grid in each direction.
template <class Coordinates>
struct Structured {
    static constexpr int dim = Coordinates::dimension;
    using Solver = Dune::YaspGrid<dim, Coordinates>;
    using Place = Dune::FieldVector<double, dim>;

    Structured(MPI_Comm communicator, int overlap, bool keeps_overlap)
        : solver{make(communicator, overlap)} {
        solver->refineOptions(keeps_overlap);
        solver->globalRefine(dim == 2 ? 2 : 1);
    }
    static std::unique_ptr<Solver> make(MPI_Comm communicator, int overlap) {
        std::array<int, dim> along;
        along.fill(dim == 2 ? 18 : 6);
        along[0] = 20;  // enough for five processes
        const std::bitset<dim> periodic;
        if constexpr (std::is_same_v<Coordinates, Even<dim>>) {
            return std::make_unique<Solver>(Place(1), along, periodic, overlap, communicator);
        } else if constexpr (std::is_same_v<Coordinates, Shifted<dim>>) {
            return std::make_unique<Solver>(Place(0.1), Place(0.9), along, periodic, overlap,
                                            communicator);
        } else {
            std::array<std::vector<double>, dim> places;
            for (std::size_t d = 0; d < places.size(); ++d) {
                for (int i = 0; i <= along[d]; ++i)
                    places[d].push_back(std::sqrt(i / (1. * along[d])));
            }
            return std::make_unique<Solver>(places, periodic, overlap, communicator);
        }
    }
    std::unique_ptr<Solver> solver;
};

/// Without the last bits of the place, which Dune computes anew, and otherwise, on every process.
double value_at(Point x, bool plane, bool noise) {
    for (double& along : x) along = std::round(along * 0x1p30) * 0x1p-30;
    return sphere(x, plane, noise);
}

template <class Solver>
std::vector<double> sphere_at_vertices(const Solver& solver, bool noise) {
    return at_vertices(solver,
                       [&](const Point& x) { return value_at(x, Solver::dimension == 2, noise); });
}

/// Of a grid that one process has wholly, even if others take part.
template <class Solver>
std::vector<Drawn<Solver::dimension>> draw_alone(const Solver& solver, bool noise) {
    const DuneGrid grid(solver);
    const std::vector<double> values = sphere_at_vertices(solver, noise);
    auto all = draw<Solver::dimension>(grid, DuneVertexField(grid, values));
    sort(all);
    return all;
}

template <class Solver>
std::vector<Drawn<Solver::dimension>> draw_on_ranks(const Solver& solver, bool noise,
                                                    Ranks& ranks) {
    const DuneGrid mine(solver);
    const Distributed grid(mine, ranks);
    const std::vector<double> values = sphere_at_vertices(solver, noise);
    const DistributedField field(grid, DuneVertexField(mine, values));
    auto all = draw<Solver::dimension>(grid, field);
    return gathered(std::move(all), ranks);
}

/// Of functions of leaves. \return whether they are other surfaces than those of their values
template <class Solver>
int compare_functions(const Solver& solver, Ranks& ranks) {
    constexpr int dim = Solver::dimension;
    const DuneGrid mine(solver);
    const Distributed grid(mine, ranks);
    const auto f = [](const auto& leaf, const auto& local) {
        return value_at(nestgrid::detail::dune_point(leaf.geometry().global(local)), dim == 2,
                        false);
    };
    const std::vector<double> values = sphere_at_vertices(solver, false);
    const auto of_functions = draw<dim>(grid, DistributedField(grid, DuneFunctionField(mine, f)));
    const auto of_values = draw<dim>(grid, DistributedField(grid, DuneVertexField(mine, values)));
    return of_functions == of_values ? 0 : 1;
}

template <class Solver>
unsigned long long leaves_of(const Solver& solver) {
    unsigned long long own = 0;
    for ([[maybe_unused]] const auto& e :
         elements(solver.leafGridView(), Dune::Partitions::interior)) {
        ++own;
    }
    return solver.comm().sum(own);
}

/// How much is wrong with what processes claim to have: check_grid() finds nothing on any of them,
/// and each coarse element is on one.
/// \param coarse how many there are on all processes
template <class Solver>
int wrong_claims(const Solver& solver, std::size_t coarse, Ranks& ranks) {
    const DuneGrid mine(solver);
    const std::vector<double> values = sphere_at_vertices(solver, false);
    const auto violation = check_grid(mine, DuneVertexField(mine, values));
    if (violation) std::printf("rank %d: %s\n", ranks.rank(), violation->sentence.c_str());
    Ranks::Bytes own;
    for (std::size_t i = 0; i < mine.coarse_count(); ++i) {
        if (mine.presence(mine.coarse(i).element) == Presence::elsewhere) continue;
        const std::uint64_t place = mine.coarse_place(i);
        const auto* const bytes = reinterpret_cast<const std::byte*>(&place);
        own.insert(own.end(), bytes, bytes + sizeof place);
    }
    std::vector<std::uint64_t> places;
    for (const Ranks::Bytes& claims : ranks.gather(std::move(own))) {
        for (std::size_t at = 0; at < claims.size(); at += sizeof(std::uint64_t)) {
            std::memcpy(&places.emplace_back(), claims.data() + at, sizeof(std::uint64_t));
        }
    }
    std::sort(places.begin(), places.end());
    const bool twice = std::adjacent_find(places.begin(), places.end()) != places.end();
    if (twice || places.size() != coarse) {
        std::printf("%zu claims of %zu coarse elements%s\n", places.size(), coarse,
                    twice ? ", some by two processes" : "");
    }
    return (violation ? 1 : 0) + (twice || places.size() != coarse ? 1 : 0);
}

template <class Coordinates>
int compare_structured(const char* name, Ranks& ranks) {
    int wrong = 0;
    for (const int overlap : {1, 2}) {
        const bool noise = overlap == 2;
        const Structured<Coordinates> parts(MPI_COMM_WORLD, overlap, overlap == 2);
        const auto leaves = leaves_of(*parts.solver);
        const auto found = draw_on_ranks(*parts.solver, noise, ranks);
        if (!noise) wrong += compare_functions(*parts.solver, ranks);
        wrong +=
            wrong_claims(*parts.solver, Coordinates::dimension == 2 ? 20 * 18 : 20 * 6 * 6, ranks);
        if (ranks.rank() == 0) {
            const Structured<Coordinates> whole(MPI_COMM_SELF, 1, true);
            wrong += count_different(std::string("YaspGrid, ") + name + ", overlap " +
                                         std::to_string(overlap) + (noise ? ", noise" : ""),
                                     ranks.size(), leaves, found, draw_alone(*whole.solver, noise));
        }
        sleep_until_all();
    }
    return wrong;
}

int compare_structured(Ranks& ranks) {
    return compare_structured<Even<2>>("2-D", ranks) + compare_structured<Even<3>>("3-D", ranks) +
           compare_structured<Shifted<2>>("2-D, shifted", ranks) +
           compare_structured<Given<2>>("2-D, uneven", ranks);
}

/// Without normals and values at points: once UG has moved elements, it gives the children of
/// tetrahedra in another order, which decides about their last bits.
template <int dim>
std::vector<Drawn<dim>> up_to_order(std::vector<Drawn<dim>> all) {
    for (Drawn<dim>& drawn : all) {
        if (drawn.simplices.empty()) drawn.values.clear();
        for (Simplex<dim>& simplex : drawn.simplices) {
            for (Corner& corner : simplex) corner[1] = {0, 0, 0};
        }
    }
    sort(all);
    return all;
}

/// \param make makes a grid, which one process has until it is balanced
template <class Make>
int compare_unstructured(const char* name, const Make& make, Ranks& ranks) {
    int wrong = 0;
    for (const bool noise : {false, true}) {
        const auto solver = make();
        const auto leaves = leaves_of(*solver);
        auto expected = draw_alone(*solver, noise);
        sleep_until_all();
        const auto on_one = noise ? expected : draw_on_ranks(*solver, noise, ranks);
        const auto coarse = solver->comm().sum(static_cast<std::size_t>(solver->size(0, 0)));
        solver->loadBalance();
        wrong += wrong_claims(*solver, coarse, ranks);
        const auto found = draw_on_ranks(*solver, noise, ranks);
        if (ranks.rank() == 0) {
            const std::string what = std::string("UG, ") + name + (noise ? ", noise" : "");
            if (!noise) {
                wrong += count_different(what + ", on one", ranks.size(), leaves, on_one, expected);
            }
            wrong += count_different(what, ranks.size(), leaves, up_to_order(found),
                                     up_to_order(expected));
        }
        sleep_until_all();
    }
    return wrong;
}

int compare_ug(Ranks& ranks) {
    const auto closed = [](auto solver, int levels, double width) {
        refine_at_sphere(*solver, levels, width);
        return solver;
    };
    int wrong = 0;
    wrong += compare_unstructured(
        "triangles", [&] { return closed(simplices<2>(4), 4, 0.15); }, ranks);
    wrong += compare_unstructured(
        "quadrilaterals, hanging", [] { return hanging_cubes<2>(4, 4, 0.15); }, ranks);
    wrong += compare_unstructured(
        "tetrahedra", [&] { return closed(simplices<3>(3), 2, 0.2); }, ranks);
    wrong += compare_unstructured(
        "hexahedra, hanging", [] { return hanging_cubes<3>(4, 2, 0.2); }, ranks);
    wrong += compare_unstructured(
        "hexahedra and pyramids", [&] { return closed(cubes<3>(4), 2, 0.15); }, ranks);
    return wrong;
}

/// Grids and values that are not drawn on ranks, or not without them. What the first of two ranks
/// says stands in docs/refusals.md.
class DuneRefusals {
public:
    explicit DuneRefusals(Ranks& ranks) : refusals_(ranks) {
        if (ranks.size() == 2 && ranks.rank() == 0) rows_.emplace("Dune on ranks");
    }
    /// \param sentence a part of what all ranks say
    template <class Exception, class Ask>
    void expect(const char* state, const char* sentence, const Ask& ask) {
        if (rows_) {
            rows_->add<Exception>(state, ask);
        } else {
            refusals_.expect<Exception>(sentence, ask);
        }
    }
    Refusals& of_rank() { return refusals_; }
    /// How many were wrong.
    int end() {
        rows_.reset();
        return refusals_.wrong + (testing::UnitTest::GetInstance()->Failed() ? 1 : 0);
    }

private:
    Refusals refusals_;
    std::optional<RefusalRows> rows_;
};

int refuse(Ranks& ranks) {
    if (ranks.size() == 1) return 0;
    DuneRefusals refusals(ranks);
    const Dune::YaspGrid<2> bare({1, 1}, {20, 20}, std::bitset<2>(), 0);
    refusals.expect<InvalidInput>("no overlap", "make it with an overlap of 1",
                                  [&] { const DuneGrid g(bare); });
    const Dune::YaspGrid<2> periodic({1, 1}, {20, 20}, std::bitset<2>("01"), 1);
    refusals.expect<InvalidInput>("a periodic grid", "the Dune grid is periodic",
                                  [&] { const DuneGrid g(periodic); });
    Structured<Even<2>> parts(MPI_COMM_WORLD, 1, true);
    const DuneGrid mine(*parts.solver);
    std::vector<double> values = sphere_at_vertices(*parts.solver, false);
    const DuneVertexField own(mine, values);
    refusals.expect<GridError>("a grid without its ranks", "are on other processes",
                               [&] { isosurface(mine, own, 0.0); });
    const Structured<Even<2>> whole(MPI_COMM_SELF, 1, true);
    const DuneGrid alone(*whole.solver);
    refuse_other_ranks(mine, alone, ranks, refusals.of_rank());
    MpiRanks self(MPI_COMM_SELF);
    refusals.expect<InvalidInput>("ranks of another communicator", "that of the ranks 1:", [&] {
        const Distributed other(mine, self);
    });
    const Distributed grid(mine, ranks);
    const DistributedField field(grid, own);
    for (double& value : values) value += ranks.rank();
    refusals.expect<InvalidInput>("values that differ between processes",
                                  "its field differs from that of rank",
                                  [&] { const DistributedField other(grid, own); });
    parts.solver->globalRefine(1);
    values = sphere_at_vertices(*parts.solver, false);
    refusals.expect<GridError>("ranks from before a refinement", "the grid has changed",
                               [&] { const DistributedField stale(grid, own); });
    return refusals.end();
}

}  // namespace

int main(int argc, char** argv) {
    Dune::MPIHelper::instance(argc, argv);
    MpiRanks ranks(MPI_COMM_WORLD);
    int wrong = 0;
    try {
        wrong = compare_structured(ranks) + compare_ug(ranks) + refuse(ranks);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "rank %d: %s\n", ranks.rank(), e.what());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    return status_of_all(ranks, wrong);
}
