// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A structured grid that Dune distributes over MPI, refined twice, and one closed surface of it
// (docs/distributed.md). Each process has values at the vertices of its elements, which those that
// have a vertex together make equal first. All write into one file.
//     mpirun -n 4 dune_ranks [file]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <dune/common/parallel/mpihelper.hh>
#include <dune/grid/common/datahandleif.hh>
#include <dune/grid/yaspgrid.hh>

#include <nestgrid/adapters/dune_fields.hpp>
#include <nestgrid/adapters/mpi_files.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/join_pieces.hpp>

using namespace nestgrid;

namespace {

using Solver = Dune::YaspGrid<3>;

// [equal]
/// Gives all processes the greatest of their values at a vertex, overlap and ghosts, too, where the
/// vector has no number yet. A solver's vector often needs it: what two processes compute at a
/// vertex may differ in its last bits.
class MakeEqual : public Dune::CommDataHandleIF<MakeEqual, double> {
public:
    MakeEqual(const Solver& solver, std::vector<double>& values)
        : indices_{&solver.leafIndexSet()}, values_{&values} {}

    bool contains(int, int codimension) const { return codimension == Solver::dimension; }
    bool fixedSize(int, int) const { return true; }
    template <class Vertex>
    std::size_t size(const Vertex&) const {
        return 1;
    }
    template <class Buffer, class Vertex>
    void gather(Buffer& buffer, const Vertex& vertex) const {
        buffer.write((*values_)[indices_->index(vertex)]);
    }
    template <class Buffer, class Vertex>
    void scatter(Buffer& buffer, const Vertex& vertex, std::size_t) {
        double other = 0;
        buffer.read(other);
        double& own = (*values_)[indices_->index(vertex)];
        own = std::max(own, other);
    }

private:
    const Solver::LeafIndexSet* indices_;
    std::vector<double>* values_;
};
// [equal]

/// Waves around a point of the cube, at the vertices of the elements that this process owns.
std::vector<double> wave(const Solver& solver) {
    std::vector<double> values(static_cast<std::size_t>(solver.size(Solver::dimension)),
                               std::numeric_limits<double>::lowest());
    for (const auto& vertex : vertices(solver.leafGridView(), Dune::Partitions::interiorBorder)) {
        const auto x = vertex.geometry().corner(0) - Dune::FieldVector<double, 3>{0.5, 0.4, 0.45};
        values[solver.leafIndexSet().index(vertex)] = std::sin(14 * x.two_norm());
    }
    return values;
}

void run(const char* path) {
    // [surface]
    Solver solver({1, 1, 1}, {10, 10, 10});  // of all processes, overlap 1
    solver.globalRefine(2);
    std::vector<double> values = wave(solver);
    MakeEqual equal(solver, values);
    solver.leafGridView().communicate(equal, Dune::InteriorBorder_All_Interface,
                                      Dune::ForwardCommunication);

    MpiRanks ranks(MPI_COMM_WORLD);
    const DuneGrid mine(solver);
    const Distributed grid(mine, ranks);
    const DistributedField field(grid, DuneVertexField(mine, values));
    const auto piece = isosurface(grid, field, 0.0, {.threshold = 0.02}, {.cap = true});
    const JoinedPiece joined = join_pieces(piece, grid);
    write_vtp(ranks, piece, joined, path);
    // [surface]
    if (ranks.rank() != 0) return;
    std::printf("%d ranks, %llu triangles, %llu open edges, |U| <= %.3f\n", ranks.size(),
                static_cast<unsigned long long>(joined.simplices),
                static_cast<unsigned long long>(joined.open), piece.error_bound);
}

}  // namespace

int main(int argc, char** argv) {
    Dune::MPIHelper::instance(argc, argv);
    try {
        run(argc > 1 ? argv[1] : "dune.vtp");
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dune_ranks: %s\n", e.what());
        return 1;
    }
}
