// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Forests of p4est and p8est: the laws of a nested grid, closed surfaces, refusals.
#include <map>
#include <set>

#include <nestgrid/algorithms/hanging_nodes.hpp>

#include "p4est_laws.hpp"
#include "probe_laws.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

static_assert(NestedGrid<P4estGrid<2>> && NestedGrid<P4estGrid<3>>);
static_assert(std::is_trivially_copyable_v<P4estGrid<3>::Element>);
static_assert(sizeof(P4estGrid<3>::Element) <= 48);

TEST(P4estGrid, KeepsTheContract) {
    for_each_forest([](const char*, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const NodePlaces nodes(grid);
        EXPECT_GT(grid.leaf_count(), grid.coarse_count());
        const std::vector<double> values = noise(nodes.places.size(), 1);
        expect_sound(grid, KeyedField(grid, nodes, values));
    });
}

/// p4est's own idea of where a quadrant is.
Point anchor_of(const Forest<2>& forest, std::size_t tree, const p4est_quadrant_t& q) {
    Point x{};
    p4est_qcoord_to_vertex(&forest.connectivity(), static_cast<p4est_topidx_t>(tree), q.x, q.y,
                           x.data());
    return x;
}
Point anchor_of(const Forest<3>& forest, std::size_t tree, const p8est_quadrant_t& q) {
    Point x{};
    p8est_qcoord_to_vertex(&forest.connectivity(), static_cast<p4est_topidx_t>(tree), q.x, q.y, q.z,
                           x.data());
    return x;
}

TEST(P4estGrid, LeavesFillTheTrees) {
    for_each_forest([](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        constexpr int dim = std::decay_t<decltype(grid)>::dimension;
        double trees = 0;
        for (std::size_t t = 0; t < grid.coarse_count(); ++t) {
            const auto c = grid.coarse(t);
            trees += measure(c.shape, c.corners) * (dim == 3 ? c.orientation : 1);
        }
        std::size_t leaves = 0;
        double volume = 0;
        for_each_leaf(grid, [&](const auto& view, const auto& walk) {
            const auto& e = element_in(grid, view);
            EXPECT_EQ(grid.leaf_index(e), leaves++);
            const auto& quadrant = grid.quadrant(e);
            EXPECT_EQ(quadrant.level, view.level);
            std::array<Point, max_corners> x;
            walk.corners(view, nullptr, x.data());
            volume += measure(view.shape, x) * (dim == 3 ? view.orientation : 1);
            if constexpr (std::is_same_v<std::decay_t<decltype(map)>, P4estVertices>) {
                EXPECT_LE(norm(x[0] - anchor_of(forest, view.coarse, quadrant)), 1e-12);
            }
        });
        EXPECT_EQ(leaves, grid.leaf_count());
        if (name == "shell") {
            EXPECT_NEAR(volume / (4 * M_PI / 3 * (1 - std::pow(0.55, 3))), 1, 0.1);
        } else if (name != "moebius" && name != "ring") {  // vector areas of bent trees
            EXPECT_NEAR(volume / trees, 1, 1e-12);
        }
    });
}

/// Squares or cubes at lattice points, connected in all their corners, edges and faces.
template <int dim>
Forest<dim> lattice_forest(const std::vector<std::array<int, 3>>& trees) {
    const auto count = static_cast<p4est_topidx_t>(trees.size());
    std::map<std::array<int, 3>, p4est_topidx_t> vertices;
    std::vector<p4est_topidx_t> tree_to_vertex;
    for (const auto& tree : trees) {
        for (int c = 0; c < 1 << dim; ++c) {
            const std::array<int, 3> at{tree[0] + (c & 1), tree[1] + (c >> 1 & 1),
                                        tree[2] + (c >> 2)};
            const auto next = static_cast<p4est_topidx_t>(vertices.size());
            tree_to_vertex.push_back(vertices.try_emplace(at, next).first->second);
        }
    }
    typename P4estTypes<dim>::Connectivity* connectivity = nullptr;
    if constexpr (dim == 2) {
        connectivity =
            p4est_connectivity_new(static_cast<p4est_topidx_t>(vertices.size()), count, 0, 0);
    } else {
        connectivity =
            p8est_connectivity_new(static_cast<p4est_topidx_t>(vertices.size()), count, 0, 0, 0, 0);
    }
    for (const auto& [at, v] : vertices) {
        for (std::size_t d = 0; d < 3; ++d) {
            connectivity->vertices[3 * static_cast<std::size_t>(v) + d] = at[d];
        }
    }
    std::copy(tree_to_vertex.begin(), tree_to_vertex.end(), connectivity->tree_to_vertex);
    for (p4est_topidx_t t = 0; t < count; ++t) {
        for (int f = 0; f < 2 * dim; ++f) {
            connectivity->tree_to_tree[2 * dim * t + f] = t;
            connectivity->tree_to_face[2 * dim * t + f] = static_cast<int8_t>(f);
        }
    }
    if constexpr (dim == 2) p4est_connectivity_complete(connectivity);
    if constexpr (dim == 3) p8est_connectivity_complete(connectivity);
    return Forest<dim>(connectivity);
}

template <int dim>
void check_touching(const std::vector<std::array<int, 3>>& trees) {
    Forest<dim> forest = lattice_forest<dim>(trees);
    forest.refine_at_random(3, 4);
    const P4estGrid grid(static_cast<const typename P4estTypes<dim>::Forest*>(forest.get()));
    std::map<Point, NodeKey> key_of;
    KeyTable<NodeKey, Point> place_of;
    for_each_leaf(grid, [&](const auto& view, const auto& walk) {
        std::array<NodeKey, max_corners> keys;
        std::array<Point, max_corners> x;
        walk.corners(view, keys.data(), x.data());
        for (std::size_t c = 0; c < view.corner_count(); ++c) {
            EXPECT_EQ(key_of.try_emplace(x[c], keys[c]).first->second, keys[c]);
            EXPECT_EQ(*place_of.insert(keys[c], x[c]).first, x[c]);
        }
    });
    const ZeroField<std::decay_t<decltype(grid)>> zero;
    expect_sound(grid, zero);
}

TEST(P4estGrid, TreesMayTouchInAnEdgeOrACorner) {
    check_touching<2>({{0, 0, 0}, {1, 1, 0}});
    check_touching<2>({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}});
    check_touching<3>({{0, 0, 0}, {1, 1, 0}});
    check_touching<3>({{0, 0, 0}, {0, 1, 1}, {1, 0, 1}});
    check_touching<3>({{0, 0, 0}, {1, 1, 1}});
    check_touching<3>({{0, 0, 0}, {1, 1, 0}, {0, 0, 2}, {1, 1, 1}});
}

/// Whatever the faces through which two trees meet and the turn between them; p4est 2.2 has no
/// right vertices for one in four of these connectivities.
TEST(P4estGrid, KeysAgreeForAllTurnsOfTrees) {
    int sound = 0;
    for (int left = 0; left < 6; ++left) {
        for (int right = 0; right < 6; ++right) {
            for (int turn = 0; turn < 4; ++turn) {
                Forest<3> forest(p8est_connectivity_new_twotrees(left, right, turn));
                forest.refine_at_random(static_cast<unsigned>(left), 3);
                // Each leaf at the face, from both trees, has the nodes of its other side.
                forest.balance();
                const auto nodes = forest.nodes();
                try {
                    const P4estGrid grid(forest.get());
                    ++sound;
                    KeyTable<NodeKey, p4est_locidx_t> number_of;
                    for_each_leaf(grid, [&](const auto& view, const auto& walk) {
                        std::array<NodeKey, max_corners> keys;
                        walk.corners(view, keys.data(), nullptr);
                        const std::size_t leaf = grid.leaf_index(element_in(grid, view));
                        for (std::size_t c = 0; nodes->face_code[leaf] == 0 && c < 8; ++c) {
                            const p4est_locidx_t number = nodes->element_nodes[8 * leaf + c];
                            EXPECT_EQ(*number_of.insert(keys[c], number).first, number);
                        }
                    });
                    std::set<p4est_locidx_t> numbers;
                    number_of.for_each([&](NodeKey, p4est_locidx_t n) { numbers.insert(n); });
                    EXPECT_EQ(numbers.size(), number_of.size());
                } catch (const InvalidInput& error) {
                    EXPECT_NE(std::string(error.what()).find("at another place"),
                              std::string::npos);
                }
            }
        }
    }
    EXPECT_GE(sound, 108);
}

TEST(P4estGrid, SurfacesAreClosedAtEveryThreshold) {
    for_each_forest([](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const NodePlaces nodes(grid);
        for (const NodalSamples& samples : catching_fields(nodes.places, 7)) {
            SCOPED_TRACE(samples.name);
            expect_closed_at_all_thresholds(
                grid, KeyedField(grid, nodes, samples.values),
                {.orientable = name != "moebius", .generic = samples.generic});
        }
    });
}

TEST(P4estGrid, ProjectedValuesAreSingleValued) {
    for_each_forest([](const char*, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const NodePlaces nodes(grid);
        const std::vector<double> values = noise(nodes.places.size(), 2);
        const KeyedField field(grid, nodes, values);
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : six_thresholds) {
            expect_single_valued(grid, field, indicator, threshold);
        }
    });
}

template <int dim>
std::string sentence_of_grid(typename P4estTypes<dim>::Connectivity* connectivity) {
    const Forest<dim> forest(connectivity);
    return refusal([&] { P4estGrid<dim> grid(forest.get()); });
}

void expect_part(const std::string& got, const std::string& part) {
    EXPECT_NE(got.find(part), std::string::npos) << got;
}

TEST(P4estGrid, ProbesLoseNoPoint) {
    for_each_forest([](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        using Grid = std::decay_t<decltype(grid)>;
        if constexpr (Grid::curved) {
            expect_no_point_lost(grid, 100'000, 1);
        } else if (name != "moebius") {  // a surface in space
            const NodePlaces nodes(grid);
            std::vector<double> values(nodes.places.size());
            for_each_leaf(grid, [&](const auto& view, const auto& walk) {
                std::array<NodeKey, max_corners> keys;
                std::array<Point, max_corners> x;
                walk.corners(view, keys.data(), x.data());
                for (std::size_t k = 0; k < view.corner_count(); ++k) {
                    values[*nodes.number.find(keys[k])] = LinearField<Grid>::at(x[k]);
                }
            });
            expect_no_point_lost(grid, KeyedField(grid, nodes, values), 100'000, 1);
        }
    });
}

TEST(P4estGrid, RefusesWhatItCannotRead) {
    EXPECT_EQ(refusal([] { P4estGrid<2> grid(nullptr); }), "there is no forest");
    const std::string twice = "tree 0 has one node at two of its corners: the forest is periodic";
    EXPECT_EQ(sentence_of_grid<2>(p4est_connectivity_new_periodic()), twice);
    EXPECT_EQ(sentence_of_grid<3>(p8est_connectivity_new_periodic()), twice);
    EXPECT_EQ(sentence_of_grid<2>(p4est_connectivity_new_rotwrap()), twice);
    EXPECT_EQ(sentence_of_grid<3>(p8est_connectivity_new_rotwrap()), twice);
    expect_part(sentence_of_grid<2>(p4est_connectivity_new_brick(2, 3, 1, 0)),
                "two different edges, faces or trees have the same corners, one in tree");
    expect_part(sentence_of_grid<3>(p8est_connectivity_new_brick(3, 2, 1, 0, 1, 0)),
                "two different edges, faces or trees have the same corners, one in tree");
    expect_part(sentence_of_grid<2>(p4est_connectivity_new_pillow()),
                "one in tree 0, one in tree 1");
    expect_part(sentence_of_grid<2>(p4est_connectivity_new_brick(3, 1, 1, 0)),
                "at another place than in tree 0: the forest is periodic, or needs a map");
    expect_part(sentence_of_grid<3>(p8est_connectivity_new_brick(3, 3, 3, 1, 1, 1)),
                "the forest is periodic, or needs a map of its trees");
    expect_part(sentence_of_grid<3>(p8est_connectivity_new_shell()), "needs a map of its trees");

    Forest<3> cube(p8est_connectivity_new_unitcube());
    double* const vertices = cube.connectivity().vertices;
    cube.connectivity().vertices = nullptr;
    EXPECT_EQ(refusal([&] { P4estGrid<3> grid(cube.get()); }),
              "the connectivity of the forest has no vertices; give a map of its trees");
    cube.connectivity().vertices = vertices;
    EXPECT_EQ(refusal([&] {
                  P4estGrid grid(cube.get(), [](std::size_t, const Point& r) {
                      return Point{r[0], r[1], 0};
                  });
              }),
              "tree 0 is flat");
    EXPECT_NE(refusal([&] {
                  P4estGrid grid(cube.get(),
                                 [](std::size_t, const Point& r) { return std::sqrt(-1) * r; });
              }),
              "");
}

/// On several processes (tests/adapters/CMakeLists.txt runs it on two) no leaf of another one is
/// asked for; alone, the forest is told that there are others. p4est_ranks_test draws such forests.
TEST(P4estGrid, RefusesADistributedForestWithoutRanks) {
    const Forest<3> forest(p8est_connectivity_new_brick(2, 2, 2, 0, 0, 0));
    p8est_t part = *forest.get();
    std::array<p8est_quadrant_t, 2> positions{};
    positions[1].p.which_tree = 7;
    if (part.mpisize == 1) {
        ++part.global_num_quadrants;
        part.global_first_position = positions.data();
    }
    const P4estGrid<3> grid(&part);
    EXPECT_NE(refusal<GridError>([&] {
                  derive_hanging_nodes(grid);
              }).find("are on other processes, and the grid does not say how to reach them"),
              std::string::npos);
}

}  // namespace
