// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of forests that p8est distributes over MPI, refined and repartitioned several times: the
// pieces of all ranks, gathered, are the surface of the same forest on one process. Run under
// mpirun; prints what it compared, and returns 1 where something differs. With the arguments "kill"
// or "exit" and the number of a step one rank ends in that without a word, and MPI ends the others.
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <p8est_extended.h>
#include <p8est_ghost.h>

#include <nestgrid/adapters/mpi.hpp>
#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/algorithms/cell_data.hpp>

#include "drawn_on_ranks.hpp"

using namespace nestgrid_test;

namespace {

/// Refines at a sphere.
int wants(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* q) {
    const int deepest = *static_cast<const int*>(forest->user_pointer);
    if (q->level < 1) return 1;
    if (q->level >= deepest) return 0;
    std::array<double, 3> x{};
    const auto half = P8EST_QUADRANT_LEN(q->level) / 2;
    p8est_qcoord_to_vertex(forest->connectivity, tree, q->x + half, q->y + half, q->z + half,
                           x.data());
    const double off = norm(Point{x[0] - 0.51, x[1] - 0.47, x[2] - 0.52}) - 0.35;
    return std::abs(off) < 0.8 / (1 << q->level) ? 1 : 0;
}

/// Refines wherever a hash says so, too, so that neighbours are several levels apart.
int wants_or_wild(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* q) {
    const auto at = [](std::int32_t x) { return static_cast<std::uint64_t>(x); };
    const std::uint64_t hash = detail::mix64(31 * at(q->x) + 1031 * at(q->y) + 131071 * at(q->z) +
                                             at(tree) + at(q->level));
    if (q->level < *static_cast<const int*>(forest->user_pointer) && hash % 9 < 2) return 1;
    return wants(forest, tree, q);
}

class Forest {
public:
    /// \param balanced across corners, so that there are lnodes
    Forest(MPI_Comm communicator, p8est_connectivity_t* shape, int deepest, bool balanced)
        : deepest_{deepest},
          forest_{p8est_new_ext(communicator, shape, 0, 1, 1, 0, nullptr, &deepest_)} {
        for (int level = 1; level < deepest; ++level) {
            p8est_refine(forest_, 0, balanced ? wants : wants_or_wild, nullptr);
            if (balanced) p8est_balance(forest_, P8EST_CONNECT_FULL, nullptr);
            p8est_partition(forest_, 0, nullptr);
        }
        if (!balanced) return;
        p8est_ghost_t* const ghost = p8est_ghost_new(forest_, P8EST_CONNECT_FULL);
        nodes_ = p8est_lnodes_new(forest_, ghost, 1);
        p8est_ghost_destroy(ghost);
    }
    ~Forest() {
        if (nodes_ != nullptr) p8est_lnodes_destroy(nodes_);
        p8est_destroy(forest_);
    }
    Forest(const Forest&) = delete;
    Forest& operator=(const Forest&) = delete;

    const p8est_t* get() const { return forest_; }
    const p8est_lnodes_t* nodes() const { return nodes_; }

private:
    int deepest_;
    p8est_t* forest_;
    p8est_lnodes_t* nodes_ = nullptr;
};

using Grid = P4estGrid<3>;

/// Calls function(leaf, keys, places of the corners) for the leaves here.
template <class Function>
void for_each_leaf(const Grid& grid, const Grid::Element& e, const Function& function) {
    if (grid.presence(e) == Presence::elsewhere) return;
    if (grid.split(e) != nullptr) {
        std::array<Grid::Element, 8> children;
        grid.children(e, children);
        for (const Grid::Element& child : children) for_each_leaf(grid, child, function);
        return;
    }
    std::array<NodeKey, 8> keys;
    grid.corner_keys(e, keys);
    std::array<Point, 8> x;
    const auto length = P8EST_QUADRANT_LEN(e.level);
    for (unsigned k = 0; k < 8; ++k) {
        p8est_qcoord_to_vertex(grid.forest().connectivity, static_cast<p4est_topidx_t>(e.tree),
                               e.anchor[0] + ((k & 1U) != 0 ? length : 0),
                               e.anchor[1] + ((k & 2U) != 0 ? length : 0),
                               e.anchor[2] + ((k & 4U) != 0 ? length : 0), x[k].data());
    }
    function(e, keys, x);
}

/// Values at the corners of the leaves here, by key: for forests without lnodes.
struct KeyedField {
    using value_type = double;

    KeyedField(const Grid& of, bool noise) : grid{&of} {
        for (std::size_t t = 0; t < of.coarse_count(); ++t) {
            for_each_leaf(of, of.coarse(t).element,
                          [&](const Grid::Element&, const auto& keys, const auto& x) {
                              for (std::size_t k = 0; k < 8; ++k) {
                                  values.insert(keys[k], sphere(x[k], false, noise));
                              }
                          });
        }
    }
    NodeMask give(std::span<const NodeKey> keys, std::span<double> out) const {
        NodeMask missing = 0;
        for (std::size_t n = 0; n < keys.size(); ++n) {
            const double* const found = values.find(keys[n]);
            if (found != nullptr) out[n] = *found;
            missing |= NodeMask{found == nullptr} << n;
        }
        return missing;
    }
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        std::array<NodeKey, 8> keys;
        grid->corner_keys(grid->coarse(i).element, keys);
        return give(keys, out);
    }
    NodeMask new_values(const Grid::Element& e, NodeMask, std::span<double> out) const {
        std::array<NodeKey, 19> keys;
        grid->new_keys(e, keys);
        return give(keys, out);
    }

    const Grid* grid;
    KeyTable<NodeKey, double> values;
};

/// Values of the lnodes, in the solver's own vector.
std::vector<double> lnode_values(const Grid& grid, const p8est_lnodes_t& nodes, bool noise) {
    std::vector<double> values(static_cast<std::size_t>(nodes.num_local_nodes));
    const detail::P4estFaceCodes<3> codes(&nodes, grid.leaf_count());
    for (std::size_t t = 0; t < grid.coarse_count(); ++t) {
        for_each_leaf(grid, grid.coarse(t).element,
                      [&](const Grid::Element& e, const auto&, const auto& x) {
                          const std::size_t leaf = grid.leaf_index(e);
                          const unsigned code = codes[leaf];
                          for (unsigned k = 0; k < 8; ++k) {
                              if (codes.hangs(code, codes.own_corner(code) ^ k)) continue;
                              values[static_cast<std::size_t>(nodes.element_nodes[8 * leaf + k])] =
                                  sphere(x[k], false, noise);
                          }
                      });
    }
    return values;
}

/// Bends trees, continuously where those of the unit cube, of bricks and of rotated cubes meet.
struct Bent {
    const p8est_connectivity_t* connectivity;
    Point operator()(std::size_t tree, const Point& reference) const {
        Point x{0, 0, 0};
        std::array<p4est_qcoord_t, 3> at{};
        for (std::size_t d = 0; d < 3; ++d) {
            at[d] = static_cast<p4est_qcoord_t>(reference[d] * P8EST_ROOT_LEN);
        }
        p8est_qcoord_to_vertex(const_cast<p8est_connectivity_t*>(connectivity),
                               static_cast<p4est_topidx_t>(tree), at[0], at[1], at[2], x.data());
        return {x[0] + 0.05 * std::sin(4 * x[1]), x[1] + 0.05 * x[2] * x[2], x[2]};
    }
};

/// Data of the cells here.
std::vector<double> cell_values(const Grid& grid, bool noise) {
    std::vector<double> values(grid.leaf_count());
    for (std::size_t t = 0; t < grid.coarse_count(); ++t) {
        for_each_leaf(grid, grid.coarse(t).element,
                      [&](const Grid::Element& e, const auto&, const auto& x) {
                          values[grid.leaf_index(e)] = sphere(0.5 * (x[0] + x[7]), false, noise);
                      });
    }
    return values;
}

std::vector<Drawn<3>> draw_on_ranks(const Forest& forest, bool noise, std::size_t sharers,
                                    Ranks& ranks) {
    const Grid mine(forest.get());
    const Distributed grid(mine, ranks, sharers);
    if (forest.nodes() == nullptr) {
        auto all = draw<3>(grid, DistributedField(grid, KeyedField(mine, noise)));
        const std::vector<double> cells = cell_values(mine, noise);
        const P4estCellValues of_cells(mine, std::span<const double>(cells));
        append(all, draw<3>(grid, DistributedField(grid, CellAverages(grid, of_cells))));
        return all;
    }
    const auto values = lnode_values(mine, *forest.nodes(), noise);
    auto all = draw<3>(grid, DistributedField(grid, P4estNodalField(mine, forest.nodes(), values)));
    const P4estGrid curved(forest.get(), Bent{forest.get()->connectivity});
    const Distributed bent(curved, ranks, sharers);
    const DistributedField field(bent, P4estNodalField(curved, forest.nodes(), values));
    append(all, draw<3>(bent, field));
    return all;
}

std::vector<Drawn<3>> draw_alone(const Forest& forest, bool noise) {
    const Grid grid(forest.get());
    std::vector<Drawn<3>> all;
    if (forest.nodes() == nullptr) {
        all = draw<3>(grid, KeyedField(grid, noise));
        const std::vector<double> cells = cell_values(grid, noise);
        const P4estCellValues of_cells(grid, std::span<const double>(cells));
        append(all, draw<3>(grid, CellAverages(grid, of_cells)));
    } else {
        const auto values = lnode_values(grid, *forest.nodes(), noise);
        all = draw<3>(grid, P4estNodalField(grid, forest.nodes(), values));
        const P4estGrid bent(forest.get(), Bent{forest.get()->connectivity});
        append(all, draw<3>(bent, P4estNodalField(bent, forest.nodes(), values)));
    }
    sort(all);
    return all;
}

/// How many surfaces differ from those of the same forest on one process.
int compare(const char* name, p8est_connectivity_t* shape, bool balanced, bool noise,
            std::size_t sharers, Ranks& ranks) {
    constexpr int deepest = 4;
    const Forest parts(MPI_COMM_WORLD, shape, deepest, balanced);
    const auto found = gathered(draw_on_ranks(parts, noise, sharers, ranks), ranks);
    int wrong = 0;
    if (ranks.rank() == 0) {
        const auto expected = draw_alone(Forest(MPI_COMM_SELF, shape, deepest, balanced), noise);
        const std::string what = std::string(name) + (balanced ? ", balanced" : ", unbalanced") +
                                 (noise ? ", noise, " : ", smooth, ") + std::to_string(sharers) +
                                 " sharers";
        wrong = count_different(what, ranks.size(),
                                static_cast<unsigned long long>(parts.get()->global_num_quadrants),
                                found, expected);
    }
    sleep_until_all();
    return wrong;
}

/// A plane through many nodes, along a diagonal of all leaves: where each rank merges vertices at
/// nodes alone, one edge of it is open.
int slice_along_diagonal(Ranks& ranks) {
    p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
    const Plane diagonal({0.5, 0.5, 0.5}, {1, 1, 0});
    std::size_t triangles = 0;
    std::uint64_t together = 0;
    {
        const Forest forest(MPI_COMM_SELF, cube, 4, true);
        const Grid grid(forest.get());
        triangles = slice(grid, KeyedField(grid, false), diagonal).surface.simplices.size();
    }
    {
        const Forest forest(MPI_COMM_WORLD, cube, 4, true);
        const Grid mine(forest.get());
        const Distributed grid(mine, ranks);
        const DistributedField field(grid, KeyedField(mine, false));
        together = slice(grid, field, diagonal).surface.simplices.size();
    }
    p8est_connectivity_destroy(cube);
    ranks.reduce(std::span(&together, 1), Ranks::Reduction::sum);
    if (ranks.rank() == 0) {
        std::printf("%d ranks, diagonal slice of a cube: %zu triangles, on one rank %zu\n",
                    ranks.size(), static_cast<std::size_t>(together), triangles);
    }
    return together == triangles ? 0 : 1;
}

/// A distributed forest without ranks is refused.
int refuse_without_ranks(Ranks& ranks) {
    p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
    int wrong = 0;
    {
        const Forest forest(MPI_COMM_WORLD, cube, 3, false);
        const Grid grid(forest.get());
        try {
            isosurface(grid, KeyedField(grid, false), 0.0);
            wrong = ranks.size() == 1 ? 0 : 1;
        } catch (const GridError& e) {
            wrong = std::string(e.what()).find("on other processes") == std::string::npos ? 1 : 0;
        }
    }
    p8est_connectivity_destroy(cube);
    if (wrong != 0) std::printf("rank %d draws without ranks\n", ranks.rank());
    return wrong;
}

/// A field that fails on the last rank.
struct BrokenField : KeyedField {
    BrokenField(const Grid& of, bool does) : KeyedField(of, false), fails{does} {}
    NodeMask new_values(const Grid::Element& e, NodeMask which, std::span<double> out) const {
        if (fails) throw std::runtime_error("the disk is gone");
        return KeyedField::new_values(e, which, out);
    }
    bool fails;
};

/// One rank fails, or asks for something else: all end with one sentence, and none waits.
int end_together(Ranks& ranks) {
    p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
    Refusals refusals(ranks);
    {
        const Forest forest(MPI_COMM_WORLD, cube, 3, false);
        const Grid mine(forest.get());
        const Distributed grid(mine, ranks);
        const int last = ranks.size() - 1;
        refusals.expect<std::exception>("rank " + std::to_string(last) + ": the disk is gone", [&] {
            const DistributedField broken(grid, BrokenField(mine, ranks.rank() == last));
            const HierarchicalIndicator indicator(grid, broken);
        });
        const DistributedField field(grid, KeyedField(mine, false));
        const HierarchicalIndicator indicator(grid, field);
        const std::string sentence = last == 0 ? "isovalue" : "all ranks must ask for the same";
        refusals.expect<InvalidInput>(sentence, [&] {
            const double other = last == 0 ? std::nan("") : 0.125;
            isosurface(grid, field, ranks.rank() == last ? other : 0.0, under(indicator, 0));
        });
    }
    p8est_connectivity_destroy(cube);
    return refusals.wrong;
}

/// Ranks of another communicator than the forest's.
int refuse_other_ranks(Ranks& ranks) {
    p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
    Refusals refusals(ranks);
    {
        const Forest parts(MPI_COMM_WORLD, cube, 2, false);
        const Forest whole(MPI_COMM_SELF, cube, 2, false);
        nestgrid_test::refuse_other_ranks(Grid(parts.get()), Grid(whole.get()), ranks, refusals);
    }
    p8est_connectivity_destroy(cube);
    return refusals.wrong;
}

/// A field with which the last rank dies in a step: 0 values, 1 preroll, 2 surface.
struct DyingField : KeyedField {
    DyingField(const Grid& of, const int* now, int in, void (*how)())
        : KeyedField(of, false), step{now}, dies_in{in}, die{how} {}
    NodeMask new_values(const Grid::Element& e, NodeMask which, std::span<double> out) const {
        if (*step == dies_in) die();
        return KeyedField::new_values(e, which, out);
    }
    const int* step;
    int dies_in;
    void (*die)();
};

/// The last rank dies in a step, before the first where it is -1: MPI ends the others.
void die_in(int step, void (*how)()) {
    MpiRanks ranks(MPI_COMM_WORLD);
    const bool dies = ranks.rank() == ranks.size() - 1;
    if (dies && step < 0) how();
    int now = 0;
    p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
    const Forest forest(MPI_COMM_WORLD, cube, 3, false);
    const Grid mine(forest.get());
    const Distributed grid(mine, ranks);
    const DistributedField field(grid, DyingField(mine, &now, dies ? step : -1, how));
    now = 1;
    const HierarchicalIndicator indicator(grid, field);
    now = 2;
    isosurface(grid, field, 0.0, under(indicator, 0.01));
}

int run() {
    MpiRanks ranks(MPI_COMM_WORLD);
    int wrong = refuse_without_ranks(ranks) + refuse_other_ranks(ranks) + end_together(ranks) +
                slice_along_diagonal(ranks);
    struct Shape {
        const char* name;
        p8est_connectivity_t* connectivity;
    };
    for (const Shape& shape : {Shape{"cube", p8est_connectivity_new_unitcube()},
                               Shape{"brick", p8est_connectivity_new_brick(2, 2, 1, 0, 0, 0)},
                               Shape{"rotated", p8est_connectivity_new_rotcubes()}}) {
        for (const bool balanced : {true, false}) {
            for (const bool noise : {false, true}) {
                const std::size_t sharers = noise ? 1 : 24;
                wrong += compare(shape.name, shape.connectivity, balanced, noise, sharers, ranks);
            }
        }
        p8est_connectivity_destroy(shape.connectivity);
    }
    return status_of_all(ranks, wrong);
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    sc_init(MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    if (argc > 2) {
        const bool exits = std::string(argv[1]) == "exit";
        die_in(
            std::atoi(argv[2]), exits ? [] { std::exit(0); } : [] { std::raise(SIGKILL); });
        return 0;
    }
    const int failed = run();
    MPI_Finalize();
    return failed;
}
