// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A forest that p8est distributes over MPI, refined and repartitioned, and one closed surface of
// it: docs/distributed.md goes through it. Each rank draws its piece where the leaves are, and
// writes it into its part of one file; and into one of its own, where a list of these is asked for.
//     p4est_ranks [surface.vtp [surface.pvtp]]
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <p8est_extended.h>

#include <nestgrid/adapters/mpi_files.hpp>
#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

using namespace nestgrid;

namespace {

/// Waves around a point of the cube.
double wave(const Point& x) { return std::sin(14 * norm(x - Point{0.5, 0.4, 0.45})); }

Point place(const p8est_t& forest, std::uint32_t tree, const std::array<std::int32_t, 3>& at) {
    Point x;
    p8est_qcoord_to_vertex(forest.connectivity, static_cast<p4est_topidx_t>(tree), at[0], at[1],
                           at[2], x.data());
    return x;
}

/// Refines where the wave crosses zero.
int crosses(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* q) {
    const auto half = P8EST_QUADRANT_LEN(q->level) / 2;
    const Point middle =
        place(*forest, static_cast<std::uint32_t>(tree), {q->x + half, q->y + half, q->z + half});
    return std::abs(wave(middle)) < 10.0 / (1 << q->level) ? 1 : 0;
}

// [field]
/// What a solver has: a value at every corner of its own leaves, and none of other ranks.
struct Wave {
    using value_type = double;
    using Element = P4estGrid<3>::Element;

    NodeMask coarse_values(std::size_t tree, std::span<double> out) const {
        NodeMask missing = 0;
        for (unsigned k = 0; k < 8; ++k) missing |= put(grid->coarse(tree).element, k, k, out);
        return missing;
    }
    NodeMask new_values(const Element& e, NodeMask, std::span<double> out) const {
        std::array<Element, 8> children;
        grid->children(e, children);
        NodeMask missing = 0;
        for (std::size_t n = 0; n < out.size(); ++n) {
            const auto [child, corner] = grid->split(e)->new_corner[n];
            missing |= put(children[child], corner, n, out);
        }
        return missing;
    }
    /// Puts the value at a corner into out[n], or returns bit n.
    NodeMask put(const Element& e, unsigned k, std::size_t n, std::span<double> out) const {
        if (grid->corner_leaf(e, k) == grid->no_leaf) return NodeMask{1} << n;
        const auto length = P8EST_QUADRANT_LEN(e.level);
        std::array<std::int32_t, 3> at = e.anchor;
        for (unsigned d = 0; d < 3; ++d) at[d] += (k >> d & 1U) != 0 ? length : 0;
        out[n] = wave(place(grid->forest(), e.tree, at));
        return 0;
    }
    const P4estGrid<3>* grid;
};
// [field]

void draw(p8est_t* forest, const char* path, const char* list) {
    // [ranks]
    MpiRanks ranks(MPI_COMM_WORLD);
    const P4estGrid<3> mine(forest);                  // what this rank has
    const Distributed grid(mine, ranks);              // anew when the forest has changed
    const DistributedField field(grid, Wave{&mine});  // anew when the values have changed
    const HierarchicalIndicator indicator(grid, field);
    const auto piece = isosurface(grid, field, 0.0, under(indicator, 0.02), {.cap = true});
    // [ranks]
    // [file]
    const JoinedPiece joined = join_pieces(piece, grid);
    write_vtp(ranks, piece, joined, path);
    // [file]
    // [measures]
    const SurfaceMeasures whole = measure_pieces(piece, joined, grid).total;
    // [measures]
    if (list != nullptr) write_pvtp(ranks, piece, joined, list);
    if (ranks.rank() != 0) return;
    std::printf("%d ranks, %llu triangles, %llu open edges, ", ranks.size(),
                static_cast<unsigned long long>(joined.simplices),
                static_cast<unsigned long long>(joined.open));
    std::printf("|U| <= %.3f, area %.6f, volume %.6f\n", piece.error_bound, whole.area,
                whole.volume);
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    sc_init(MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
    p8est_t* const forest = p8est_new_ext(MPI_COMM_WORLD, cube, 0, 2, 1, 0, nullptr, nullptr);
    for (int level = 2; level < 6; ++level) {
        p8est_refine(forest, 0, crosses, nullptr);
        p8est_partition(forest, 0, nullptr);
    }
    draw(forest, argc > 1 ? argv[1] : "surface.vtp", argc > 2 ? argv[2] : nullptr);
    p8est_destroy(forest);
    p8est_connectivity_destroy(cube);
    MPI_Finalize();
}
