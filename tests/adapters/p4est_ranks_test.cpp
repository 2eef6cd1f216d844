// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of forests that p8est distributes over MPI, refined and repartitioned several times: the
// pieces of all ranks, gathered, are the surface of the same forest on one process. Run under
// mpirun; prints what it compared, and returns 1 where something differs. With the argument "die"
// one rank ends without a word, and MPI ends the others.
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>

#include <p8est_extended.h>
#include <p8est_ghost.h>

#include <nestgrid/adapters/mpi.hpp>
#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/slice.hpp>

using namespace nestgrid;

namespace {

using Triangle = std::array<Point, 3>;

struct Drawn {
    std::vector<Triangle> triangles;
    double bound = 0;
    std::array<std::uint64_t, 3> counts{};
    bool operator==(const Drawn&) const = default;
};

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

double value(const Point& x, NodeKey key, bool noise) {
    const double random = static_cast<double>(hash(key) >> 11U) * 0x1p-53 - 0.5;
    return 0.35 - norm(x - Point{0.51, 0.47, 0.52}) + (noise ? random : 0.0);
}

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
                                  values.insert(keys[k], value(x[k], keys[k], noise));
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
                      [&](const Grid::Element& e, const auto& keys, const auto& x) {
                          const std::size_t leaf = grid.leaf_index(e);
                          const unsigned code = codes[leaf];
                          for (unsigned k = 0; k < 8; ++k) {
                              if (codes.hangs(code, codes.own_corner(code) ^ k)) continue;
                              values[static_cast<std::size_t>(nodes.element_nodes[8 * leaf + k])] =
                                  value(x[k], keys[k], noise);
                          }
                      });
    }
    return values;
}

template <class AnyGrid, class Field>
std::vector<Drawn> draw(const AnyGrid& grid, const Field& field) {
    std::vector<Drawn> all;
    const HierarchicalIndicator indicator(grid, field);
    const auto add = [&](const Isosurface<3>& result) {
        Drawn& drawn = all.emplace_back();
        for (const auto& t : result.surface.simplices) {
            const auto& x = result.surface.vertices;
            drawn.triangles.push_back({x[t[0]], x[t[1]], x[t[2]]});
        }
        drawn.bound = result.error_bound;
        drawn.counts = {result.counts.calls, result.counts.visited, result.counts.extracted};
    };
    for (const double epsilon : {0.0, 0.01, 0.3}) {
        for (const bool cap : {false, true}) {
            add(isosurface(grid, field, 0.0, under(indicator, epsilon), {.cap = cap}));
        }
    }
    for (const Point& normal : {Point{1, 1, 0}, Point{1, 0, 0}, Point{0.3, 0.2, 1}}) {
        const Plane plane({0.5, 0.5, 0.5}, normal);
        add(slice(grid, field, plane));
        add(slice(grid, field, plane, under(indicator, 0.3)));
    }
    return all;
}

void sort(std::vector<Triangle>& triangles) {
    for (Triangle& t : triangles)
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
}

/// On rank 0, the surfaces of all ranks together.
std::vector<Drawn> gathered(std::vector<Drawn> own, Ranks& ranks) {
    for (Drawn& drawn : own) {
        const auto bytes = std::as_bytes(std::span(drawn.triangles));
        const auto all = ranks.gather({bytes.begin(), bytes.end()});
        drawn.triangles.clear();
        for (const Ranks::Bytes& each : all) {
            const auto* const begin = reinterpret_cast<const Triangle*>(each.data());
            drawn.triangles.insert(drawn.triangles.end(), begin,
                                   begin + each.size() / sizeof(Triangle));
        }
        sort(drawn.triangles);
    }
    return own;
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

std::vector<Drawn> draw_on_ranks(const Forest& forest, bool noise, std::size_t sharers,
                                 Ranks& ranks) {
    const Grid mine(forest.get());
    const Distributed grid(mine, ranks, sharers);
    if (forest.nodes() == nullptr) {
        return draw(grid, DistributedField(grid, KeyedField(mine, noise)));
    }
    const auto values = lnode_values(mine, *forest.nodes(), noise);
    auto all = draw(grid, DistributedField(grid, P4estNodalField(mine, forest.nodes(), values)));
    const P4estGrid curved(forest.get(), Bent{forest.get()->connectivity});
    const Distributed bent(curved, ranks, sharers);
    const DistributedField field(bent, P4estNodalField(curved, forest.nodes(), values));
    for (Drawn& drawn : draw(bent, field)) all.push_back(std::move(drawn));
    return all;
}

std::vector<Drawn> draw_alone(const Forest& forest, bool noise) {
    const Grid grid(forest.get());
    std::vector<Drawn> all;
    if (forest.nodes() == nullptr) {
        all = draw(grid, KeyedField(grid, noise));
    } else {
        const auto values = lnode_values(grid, *forest.nodes(), noise);
        all = draw(grid, P4estNodalField(grid, forest.nodes(), values));
        const P4estGrid bent(forest.get(), Bent{forest.get()->connectivity});
        for (Drawn& drawn : draw(bent, P4estNodalField(bent, forest.nodes(), values))) {
            all.push_back(std::move(drawn));
        }
    }
    for (Drawn& drawn : all) sort(drawn.triangles);
    return all;
}

/// How many surfaces differ from those of the same forest on one process.
int compare(const char* name, p8est_connectivity_t* shape, bool balanced, bool noise,
            std::size_t sharers, Ranks& ranks) {
    constexpr int deepest = 4;
    const Forest parts(MPI_COMM_WORLD, shape, deepest, balanced);
    const auto found = gathered(draw_on_ranks(parts, noise, sharers, ranks), ranks);
    if (ranks.rank() != 0) return 0;
    const auto expected = draw_alone(Forest(MPI_COMM_SELF, shape, deepest, balanced), noise);
    int wrong = 0;
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        wrong += found[i] == expected[i] ? 0 : 1;
        triangles += expected[i].triangles.size();
    }
    std::printf(
        "%d ranks, %-9s %-10s %-6s %2zu sharers: %lld leaves, %zu surfaces of %zu "
        "triangles, %d differ\n",
        ranks.size(), name, balanced ? "balanced" : "unbalanced", noise ? "noise" : "smooth",
        sharers, static_cast<long long>(parts.get()->global_num_quadrants), expected.size(),
        triangles, wrong);
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
    int wrong = 0;
    {
        const Forest forest(MPI_COMM_WORLD, cube, 3, false);
        const Grid mine(forest.get());
        const Distributed grid(mine, ranks);
        const int last = ranks.size() - 1;
        const auto expect = [&](const std::string& sentence, const auto& draws) {
            try {
                draws();
                ++wrong;
            } catch (const std::exception& e) {
                wrong += std::string(e.what()).find(sentence) == std::string::npos ? 1 : 0;
            }
        };
        expect("rank " + std::to_string(last) + ": the disk is gone", [&] {
            const DistributedField broken(grid, BrokenField(mine, ranks.rank() == last));
            const HierarchicalIndicator indicator(grid, broken);
        });
        const DistributedField field(grid, KeyedField(mine, false));
        const HierarchicalIndicator indicator(grid, field);
        expect(last == 0 ? "isovalue" : "all ranks must ask for the same", [&] {
            const double other = last == 0 ? std::nan("") : 0.125;
            isosurface(grid, field, ranks.rank() == last ? other : 0.0, under(indicator, 0));
        });
    }
    p8est_connectivity_destroy(cube);
    if (wrong != 0) std::printf("rank %d does not end with the others\n", ranks.rank());
    return wrong;
}

int run() {
    MpiRanks ranks(MPI_COMM_WORLD);
    int wrong = refuse_without_ranks(ranks) + end_together(ranks) + slice_along_diagonal(ranks);
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
    std::array<std::uint64_t, 1> all{static_cast<std::uint64_t>(wrong)};
    ranks.reduce(all, Ranks::Reduction::sum);
    return all[0] == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    sc_init(MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    if (argc > 1 && std::string(argv[1]) == "die") {
        MpiRanks ranks(MPI_COMM_WORLD);
        if (ranks.rank() == ranks.size() - 1) std::raise(SIGKILL);
        ranks.gather({});
    }
    const int failed = run();
    MPI_Finalize();
    return failed;
}
