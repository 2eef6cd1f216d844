// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A forest that p8est refines at a sphere, balances and distributes over MPI, drawn from the
// solver's own lnodes: of the slowest or busiest rank, seconds, exchanges, messages and bytes of
// each step, and the most memory that a rank has had.
//     mpirun --oversubscribe -n 8 bench_forest [deepest level]
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <p8est_extended.h>
#include <p8est_ghost.h>
#include <p8est_lnodes.h>

#include <nestgrid/adapters/mpi.hpp>
#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

using namespace nestgrid;

namespace {

constexpr double radius = 0.3;
const Point middle{0.5, 0.45, 0.55};

/// What a rank has sent, by way of other ranks.
class CountedRanks final : public Ranks {
public:
    explicit CountedRanks(Ranks& ranks) : ranks_{&ranks} {}

    int rank() const override { return ranks_->rank(); }
    int size() const override { return ranks_->size(); }
    std::vector<Message> exchange(std::vector<Message> to) override {
        ++sent["exchanges"];
        for (const Message& message : to) {
            if (message.rank == rank()) continue;
            ++sent["messages"];
            sent["bytes"] += message.bytes.size();
        }
        return ranks_->exchange(std::move(to));
    }
    std::vector<Bytes> gather(Bytes own) override {
        sent["bytes_to_all"] += own.size();
        return ranks_->gather(std::move(own));
    }
    void reduce(std::span<std::uint64_t> numbers, Reduction how) override {
        ++sent["reductions"];
        sent["bytes_reduced"] += 8 * numbers.size();
        ranks_->reduce(numbers, how);
    }

    std::map<std::string, std::uint64_t> sent;

private:
    Ranks* ranks_;
};

double greatest(double own) {
    MPI_Allreduce(MPI_IN_PLACE, &own, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return own;
}
/// Prints the greatest number of any rank.
void print(const std::string& name, double own) {
    const double most = greatest(own);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0) std::printf("%s %.6g\n", name.c_str(), most);
}
/// Calls function(), and prints how long the slowest rank took.
template <class Function>
void timed(const std::string& name, const Function& function) {
    MPI_Barrier(MPI_COMM_WORLD);
    const double begin = MPI_Wtime();
    function();
    print(name + "_seconds", MPI_Wtime() - begin);
}
/// Megabytes that this process has had at most.
double peak_memory() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kilobytes = 0;
        if (word == "VmHWM:" && status >> kilobytes) return kilobytes / 1e3;
    }
    return 0;
}

Point place(const p8est_t& forest, p4est_topidx_t tree, p4est_qcoord_t x, p4est_qcoord_t y,
            p4est_qcoord_t z) {
    Point at;
    p8est_qcoord_to_vertex(forest.connectivity, tree, x, y, z, at.data());
    return at;
}
double wave(const Point& x) {
    return norm(x - middle) - radius + 0.003 * std::sin(60 * x[0]) * std::cos(50 * x[1]);
}

/// Refines at the sphere.
int meets(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* q) {
    const auto half = P8EST_QUADRANT_LEN(q->level) / 2;
    const Point x = place(*forest, tree, q->x + half, q->y + half, q->z + half);
    return std::abs(norm(x - middle) - radius) < 0.75 / (1 << q->level) ? 1 : 0;
}

/// Values of the lnodes here, in the solver's own vector.
std::vector<double> lnode_values(const p8est_t& forest, const p8est_lnodes_t& nodes) {
    std::vector<double> values(static_cast<std::size_t>(nodes.num_local_nodes));
    const detail::P4estFaceCodes<3> codes(&nodes,
                                          static_cast<std::size_t>(forest.local_num_quadrants));
    std::size_t leaf = 0;
    for (p4est_topidx_t t = forest.first_local_tree; t <= forest.last_local_tree; ++t) {
        sc_array_t& leaves = p8est_tree_array_index(forest.trees, t)->quadrants;
        for (std::size_t l = 0; l < leaves.elem_count; ++l, ++leaf) {
            const p8est_quadrant_t& q = *p8est_quadrant_array_index(&leaves, l);
            const auto length = P8EST_QUADRANT_LEN(q.level);
            const unsigned code = codes[leaf];
            for (unsigned k = 0; k < 8; ++k) {
                if (codes.hangs(code, codes.own_corner(code) ^ k)) continue;
                values[static_cast<std::size_t>(nodes.element_nodes[8 * leaf + k])] = wave(
                    place(forest, t, q.x + ((k & 1U) != 0 ? length : 0),
                          q.y + ((k & 2U) != 0 ? length : 0), q.z + ((k & 4U) != 0 ? length : 0)));
            }
        }
    }
    return values;
}

void draw(const p8est_t* forest, const p8est_lnodes_t* nodes) {
    MpiRanks mpi(MPI_COMM_WORLD);
    CountedRanks ranks(mpi);
    const std::vector<double> values = lnode_values(*forest, *nodes);
    const auto step = [&](const std::string& name, const auto& function) {
        ranks.sent.clear();
        timed(name, function);
        for (const char* what :
             {"exchanges", "messages", "bytes", "reductions", "bytes_reduced", "bytes_to_all"}) {
            print(name + "_" + what, static_cast<double>(ranks.sent[what]));
        }
    };
    std::optional<P4estGrid<3>> mine;
    std::optional<Distributed<P4estGrid<3>>> grid;
    step("grid", [&] {
        mine.emplace(forest);
        grid.emplace(*mine, ranks);
    });
    const auto nodal = [&] { return P4estNodalField(*mine, nodes, std::span(values)); };
    std::optional<DistributedField<P4estGrid<3>, decltype(nodal())>> field;
    step("field", [&] { field.emplace(*grid, nodal()); });
    std::optional<HierarchicalIndicator> indicator;
    step("indicator", [&] { indicator.emplace(*grid, *field); });
    std::uint64_t triangles = 0;
    step("surface", [&] {
        triangles = isosurface(*grid, *field, 0.0, under(*indicator, 0)).surface.simplices.size();
    });
    step("next_surface", [&] { (void)isosurface(*grid, *field, 0.001, under(*indicator, 1e-4)); });
    MPI_Allreduce(MPI_IN_PLACE, &triangles, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
    print("triangles", static_cast<double>(triangles));
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    sc_init(MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    int size = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    const int deepest = argc > 1 ? std::atoi(argv[1]) : 7;
    p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
    p8est_t* const forest = p8est_new_ext(MPI_COMM_WORLD, cube, 0, 3, 1, 0, nullptr, nullptr);
    for (int level = 3; level < deepest; ++level) {
        p8est_refine(forest, 0, meets, nullptr);
        p8est_partition(forest, 0, nullptr);
    }
    // What a solver does after each adaptation.
    p8est_ghost_t* ghost = nullptr;
    p8est_lnodes_t* nodes = nullptr;
    timed("forest_balance_and_partition", [&] {
        p8est_balance(forest, P8EST_CONNECT_FULL, nullptr);
        p8est_partition(forest, 0, nullptr);
    });
    timed("forest_nodes", [&] {
        ghost = p8est_ghost_new(forest, P8EST_CONNECT_FULL);
        nodes = p8est_lnodes_new(forest, ghost, 1);
    });
    print("ranks", size);
    print("leaves", static_cast<double>(forest->global_num_quadrants));
    print("forest_megabytes", peak_memory());
    draw(forest, nodes);
    print("megabytes", peak_memory());
    p8est_lnodes_destroy(nodes);
    p8est_ghost_destroy(ghost);
    p8est_destroy(forest);
    p8est_connectivity_destroy(cube);
    MPI_Finalize();
}
