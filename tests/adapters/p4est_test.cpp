// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Forests of p4est and p8est: the laws of a nested grid, closed surfaces, both kinds of data.
#include <cstdio>
#include <filesystem>
#include <set>

#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/project.hpp>
#include <nestgrid/any_grid.hpp>
#include <nestgrid/check_grid.hpp>

#include "counting_allocator.hpp"
#include "p4est_samples.hpp"
#include "thread_executor.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

class Mpi : public testing::Environment {
public:
    void SetUp() override {
        MPI_Init(nullptr, nullptr);
        sc_init(sc_MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_SILENT);
        p4est_init(nullptr, SC_LP_SILENT);
    }
    void TearDown() override { MPI_Finalize(); }
};
[[maybe_unused]] const auto* const mpi = testing::AddGlobalTestEnvironment(new Mpi);

static_assert(NestedGrid<P4estGrid<2>> && NestedGrid<P4estGrid<3>>);
static_assert(std::is_trivially_copyable_v<P4estGrid<3>::Element>);
static_assert(sizeof(P4estGrid<3>::Element) <= 48);

constexpr std::array<double, 6> thresholds{0, 0.01, 0.1, 0.3, 1, 10};

/// Calls function(name, forest, map) for forests over all kinds of connectivities.
template <int dim, class Function>
void for_each_forest(bool balanced, Function&& function) {
    const auto call = [&](const char* name, Forest<dim>&& forest, unsigned seed, int depth,
                          const auto& map) {
        SCOPED_TRACE(std::string(name) + (balanced ? ", balanced" : ", unbalanced"));
        forest.refine_at_random(seed, depth);
        if (balanced) forest.balance();
        function(name, forest, map);
    };
    const P4estVertices straight;
    if constexpr (dim == 2) {
        call("square", Forest<2>(p4est_connectivity_new_unitsquare()), 1, 9, straight);
        call("brick", Forest<2>(p4est_connectivity_new_brick(3, 2, 0, 0)), 2, 7, straight);
        call("star", Forest<2>(p4est_connectivity_new_star()), 3, 5, straight);
        call("cubed", Forest<2>(p4est_connectivity_new_cubed()), 4, 6, straight);
        call("moebius", Forest<2>(p4est_connectivity_new_moebius()), 5, 6, straight);
        // A ring of four trees, periodic in one direction, which the map closes.
        call("ring", Forest<2>(p4est_connectivity_new_brick(4, 1, 1, 0)), 6, 6,
             [](std::size_t tree, const Point& r) {
                 const double angle = 0.5 * M_PI * (static_cast<double>(tree) + r[0]);
                 return (1 + r[1]) * Point{std::cos(angle), std::sin(angle), 0};
             });
    } else {
        call("cube", Forest<3>(p8est_connectivity_new_unitcube()), 8, 5, straight);
        call("brick", Forest<3>(p8est_connectivity_new_brick(2, 2, 1, 0, 0, 0)), 2, 4, straight);
        call("rotated cubes", Forest<3>(p8est_connectivity_new_rotcubes()), 3, 4, straight);
        call("two trees", Forest<3>(p8est_connectivity_new_twotrees(1, 4, 3)), 4, 4, straight);
        Forest<3> shell(p8est_connectivity_new_shell());
        p8est_geometry_t* geometry = p8est_geometry_new_shell(&shell.connectivity(), 1, 0.55);
        call("shell", std::move(shell), 5, 2, P4estGeometry{geometry});
        p8est_geometry_destroy(geometry);
    }
}

template <class Function>
void for_each_forest(Function&& function) {
    for (const bool balanced : {false, true}) {
        for_each_forest<2>(balanced, function);
        for_each_forest<3>(balanced, function);
    }
}

std::vector<double> noise(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<double> values(count);
    for (double& v : values) v = static_cast<double>(random()) / 4294967296.0 - 0.5;
    return values;
}

TEST(P4estGrid, KeepsTheContract) {
    for_each_forest([](const char*, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const NodePlaces nodes(grid);
        EXPECT_GT(grid.leaf_count(), grid.coarse_count());
        const std::vector<double> values = noise(nodes.places.size(), 1);
        const auto violation = check_grid(grid, KeyedField(grid, nodes, values));
        EXPECT_FALSE(violation) << violation->sentence;
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
        for_each_leaf(grid, [&](const auto& s, const auto& walk) {
            EXPECT_EQ(grid.leaf_index(s.element), leaves++);
            const auto& quadrant = grid.quadrant(s.element);
            EXPECT_EQ(quadrant.level, s.level);
            std::array<Point, max_corners> x;
            walk.positions(s, x);
            volume += measure(s.shape, x) * (dim == 3 ? s.orientation : 1);
            if constexpr (std::is_same_v<std::decay_t<decltype(map)>, P4estVertices>) {
                EXPECT_LE(norm(x[0] - anchor_of(forest, s.coarse, quadrant)), 1e-12);
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
                    for_each_leaf(grid, [&](const auto& s, const auto& walk) {
                        std::array<NodeKey, max_corners> keys;
                        walk.keys(s, keys);
                        const std::size_t leaf = grid.leaf_index(s.element);
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

/// In two dimensions on a surface that cannot be oriented: every vertex ends two segments.
template <class Element>
void expect_lines(const Surface<2, Element>& lines) {
    std::vector<int> ends(lines.vertices.size(), 0);
    for (const auto& segment : lines.simplices) {
        for (const auto v : segment) ++ends[v];
    }
    for (const auto& [v] : lines.boundary) ++ends[v];
    for (const int n : ends) EXPECT_EQ(n, 2);
}

template <class Grid, class Field>
void expect_closed_at_all_thresholds(const Grid& grid, const Field& field, bool orientable) {
    const HierarchicalIndicator indicator(grid, field);
    EXPECT_LT(indicator.least(), 0);
    EXPECT_GT(indicator.greatest(), 0);
    for (const double threshold : thresholds) {
        SCOPED_TRACE("threshold " + std::to_string(threshold));
        const auto result =
            isosurface(grid, field, 0, indicator, {.threshold = threshold, .verify = true});
        if constexpr (Grid::dimension == 2) {
            if (orientable) expect_closed(result.surface);
            if (!orientable) expect_lines(result.surface);
        } else {
            expect_closed(result.surface);
        }
        EXPECT_TRUE(threshold > 0 || !result.surface.simplices.empty());
        for (const auto& e : result.surface.elements) {
            EXPECT_TRUE(threshold > 0 || grid.split(e) == nullptr);
        }
    }
}

TEST(P4estGrid, SurfacesAreClosedAtEveryThreshold) {
    for_each_forest([](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const NodePlaces nodes(grid);
        for (const NodalSamples& samples : catching_fields(nodes.places, 7)) {
            SCOPED_TRACE(samples.name);
            const KeyedField field(grid, nodes, samples.values);
            if (samples.generic) {
                expect_closed_at_all_thresholds(grid, field, name != "moebius");
            } else {
                const auto result = isosurface(grid, field, 0, {.threshold = 0.1});
                if (name != "moebius") expect_closed(result.surface);
            }
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
        for (const double threshold : thresholds) {
            KeyTable<NodeKey, double> known;
            const Traversal<std::decay_t<decltype(grid)>, std::decay_t<decltype(field)>,
                            Needs{.keys = true}>
                walk(grid, field, indicator.hanging());
            project(walk, Threshold<HierarchicalIndicator>{&indicator, threshold},
                    [&](const auto& s) {
                        std::array<NodeKey, max_corners> keys;
                        walk.keys(s, keys);
                        for (std::size_t i = 0; i < std::size_t(s.corner_count()); ++i) {
                            EXPECT_EQ(*known.insert(keys[i], s.value[i]).first, s.value[i]);
                        }
                    });
        }
    });
}

double linear(const Point& x) { return 0.3 + x[0] - 2 * x[1] + 0.7 * x[2]; }

template <class Real, int dim>
void check_nodal_field(double threshold) {
    for_each_forest<dim>(true, [&](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const auto nodes = forest.nodes();
        const std::vector<Real> values =
            nodal_values(grid, *nodes, [](const Point& x) { return static_cast<Real>(linear(x)); });
        const P4estNodalField field(grid, nodes.get(), values);
        const auto violation = check_grid(grid, field, {.hanging_values = true});
        EXPECT_FALSE(violation) << violation->sentence;
        const HierarchicalIndicator indicator(grid, field);
        EXPECT_LE(indicator.hanging_violation(), 0);
        // Corners of trees first, then what lies below.
        const Traversal<std::decay_t<decltype(grid)>, std::decay_t<decltype(field)>,
                        Needs{.keys = true, .positions = true}>
            walk(grid, field, indicator.hanging());
        const bool straight = name != "ring" && name != "shell";
        int deepest = 0;
        project(walk, Threshold<HierarchicalIndicator>{&indicator, threshold}, [&](const auto& s) {
            deepest = std::max(deepest, s.level);
            std::array<Point, max_corners> x;
            walk.positions(s, x);
            for (std::size_t c = 0; straight && c < std::size_t(s.corner_count()); ++c) {
                EXPECT_NEAR(s.value[c], linear(x[c]), threshold);
            }
        });
        EXPECT_EQ(deepest == 0, straight);
    });
}

TEST(P4estNodalField, ReproducesLinearFunctionsAndInterpolatesHangingNodes) {
    check_nodal_field<double, 2>(1e-13);
    check_nodal_field<double, 3>(1e-13);
    check_nodal_field<float, 2>(1e-5);
    check_nodal_field<float, 3>(1e-5);
}

TEST(P4estNodalField, SurfacesAreClosedAtEveryThreshold) {
    const auto check = [](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const auto nodes = forest.nodes();
        const std::vector<double> values =
            noise(static_cast<std::size_t>(nodes->num_local_nodes), 3);
        const P4estNodalField field(grid, nodes.get(), values);
        const auto violation = check_grid(grid, field, {.hanging_values = true});
        EXPECT_FALSE(violation) << violation->sentence;
        expect_closed_at_all_thresholds(grid, field, name != "moebius");
    };
    for_each_forest<2>(true, check);
    for_each_forest<3>(true, check);
}

struct CompareHanging {
    const HangingNodes& hanging;
    template <class State>
    Decision inspect(const State&, const Split& split) {
        EXPECT_EQ(split.constrained, hanging.mask(split.keys));
        return {};
    }
    template <class State>
    void extract(const State&) {}
};

/// What face codes tell is what the library derives.
TEST(P4estBalancedGrid, KnowsWhichNodesHang) {
    const auto check = [](const std::string& name, const auto& forest, const auto& map) {
        const auto nodes = forest.nodes();
        const P4estGrid plain(forest.get(), map);
        const P4estBalancedGrid grid(forest.get(), nodes.get(), map);
        using Grid = std::decay_t<decltype(grid)>;
        const HangingNodes hanging = derive_hanging_nodes(plain);
        EXPECT_GT(hanging.size(), 0U);
        const ZeroField<Grid> zero;
        const Traversal<Grid, ZeroField<Grid>, Needs{.keys = true}> walk(grid, zero);
        CompareHanging compare{hanging};
        walk.run(compare);

        const std::vector<double> values =
            noise(static_cast<std::size_t>(nodes->num_local_nodes), 5);
        const P4estNodalField field(grid, nodes.get(), values);
        const auto violation = check_grid(grid, field, {.hanging_values = true});
        EXPECT_FALSE(violation) << violation->sentence;
        const auto a = isosurface(plain, field, 0, {.threshold = 0.2});
        const auto b = isosurface(grid, field, 0, {.threshold = 0.2});
        EXPECT_EQ(a.surface.vertices, b.surface.vertices);
        EXPECT_EQ(a.surface.simplices, b.surface.simplices);
        if (name != "moebius") expect_closed(b.surface);
    };
    for_each_forest<2>(true, check);
    for_each_forest<3>(true, check);
}

TEST(P4estCellValues, BecomeMeansAroundNodes) {
    for_each_forest([](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const std::vector<double> values = noise(grid.leaf_count(), 4);
        const CellAverages field(grid, P4estCellValues(grid, values));
        KeyTable<NodeKey, std::pair<double, int>> sums;
        for_each_leaf(grid, [&](const auto& s, const auto& walk) {
            EXPECT_EQ(field.leaf_value(s.element), values[grid.leaf_index(s.element)]);
            std::array<NodeKey, max_corners> keys;
            walk.keys(s, keys);
            for (std::size_t c = 0; c < std::size_t(s.corner_count()); ++c) {
                auto& [sum, count] = *sums.insert(keys[c], {0, 0}).first;
                sum += field.leaf_value(s.element);
                ++count;
            }
        });
        const Traversal<std::decay_t<decltype(grid)>, std::decay_t<decltype(field)>,
                        Needs{.keys = true}>
            walk(grid, field);
        project(walk, Exact{}, [&](const auto& s) {
            std::array<NodeKey, max_corners> keys;
            walk.keys(s, keys);
            for (std::size_t c = 0; c < std::size_t(s.corner_count()); ++c) {
                const auto [sum, count] = *sums.find(keys[c]);
                EXPECT_NEAR(s.value[c], sum / count, 1e-15);
            }
        });
        const auto violation = check_grid(grid, field);
        EXPECT_FALSE(violation) << violation->sentence;
        expect_closed_at_all_thresholds(grid, field, name != "moebius");
    });
}

TEST(P4estCellValues, PlateausStayFlat) {
    for_each_forest<3>(false, [](const char*, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const std::vector<float> values(grid.leaf_count(), 0.1F);
        const CellAverages field(grid, P4estCellValues(grid, values));
        const HierarchicalIndicator indicator(grid, field);
        EXPECT_EQ(indicator.least(), static_cast<double>(0.1F));
        EXPECT_EQ(indicator.greatest(), static_cast<double>(0.1F));
    });
}

/// A forest refined at a sphere, with the distance to it in each leaf's own data.
Forest<3> refined_at_sphere(int depth) {
    Forest<3> forest(p8est_connectivity_new_brick(2, 2, 1, 0, 0, 0), sizeof(double));
    const auto distance = [](const p8est_quadrant_t& q, double& half) {
        half = 0.5 * P8EST_QUADRANT_LEN(q.level) / P8EST_ROOT_LEN;
        const auto at = [&](p4est_qcoord_t x) { return double(x) / P8EST_ROOT_LEN + half; };
        return norm(Point{at(q.x), at(q.y), at(q.z)}) - 0.6;
    };
    forest.refine([&](const p8est_quadrant_t& q) {
        double half = 0;
        return q.level < depth && std::abs(distance(q, half)) < 2 * half;
    });
    forest.balance();
    const P4estGrid grid(forest.get());
    for_each_leaf(grid, [&](const auto& s, const auto&) {
        double half = 0;
        *static_cast<double*>(grid.quadrant(s.element).p.user_data) =
            distance(grid.quadrant(s.element), half);
    });
    return forest;
}

auto own_data(const P4estGrid<3>& grid) {
    return CellAverages(grid, [&grid](const P4estGrid<3>::Element& leaf) {
        return *static_cast<const double*>(grid.quadrant(leaf).p.user_data);
    });
}

TEST(P4estGrid, SavedAndLoadedGivesTheSameSurface) {
    const Forest<3> forest = refined_at_sphere(5);
    const std::string file = testing::TempDir() + "nestgrid_p4est_test.p8est";
    p8est_save(file.c_str(), forest.get(), 1);
    p8est_connectivity_t* connectivity = nullptr;
    p8est_t* loaded =
        p8est_load(file.c_str(), sc_MPI_COMM_WORLD, sizeof(double), 1, nullptr, &connectivity);
    std::filesystem::remove(file);
    const Forest<3> again(loaded, connectivity);
    const P4estGrid<3> grid(forest.get());
    const P4estGrid<3> other(again.get());
    ASSERT_EQ(other.leaf_count(), grid.leaf_count());
    for (const double threshold : {0.0, 0.05}) {
        const auto a = isosurface(grid, own_data(grid), 0, {.threshold = threshold});
        const auto b = isosurface(other, own_data(other), 0, {.threshold = threshold});
        EXPECT_GT(a.surface.simplices.size(), 500U);
        EXPECT_EQ(a.surface.vertices, b.surface.vertices);
        EXPECT_EQ(a.surface.simplices, b.surface.simplices);
    }
}

TEST(P4estGrid, LargeForestsAreReadInPlace) {
    const Forest<3> forest = refined_at_sphere(7);
    const std::size_t before = allocated_bytes();
    const P4estGrid grid(forest.get());
    EXPECT_GE(grid.leaf_count(), 100000U);
    const auto nodes = forest.nodes();
    const std::vector<double> values = nodal_values(grid, *nodes, [](const Point& x) {
        return norm(x - Point{1, 1, 0}) - 0.6;
    });
    const P4estNodalField field(grid, nodes.get(), values);
    EXPECT_LE(allocated_bytes() - before, values.size() * sizeof(double) + 4096);

    const Traversal<P4estGrid<3>, decltype(field), Needs{.keys = true, .positions = true}> walk(
        grid, field);
    std::size_t leaves = 0;
    const std::size_t calls = allocation_count();
    project(walk, Exact{}, [&](const auto& s) { leaves += grid.split(s.element) == nullptr; });
    EXPECT_EQ(allocation_count(), calls);
    EXPECT_EQ(leaves, grid.leaf_count());

    const HierarchicalIndicator indicator(grid, field);
    EXPECT_LE(indicator.hanging_violation(), 0);
    for (const double threshold : thresholds) {
        const auto one = isosurface(grid, field, 0, indicator, {.threshold = threshold});
        expect_closed(one.surface);
        const auto two =
            isosurface(grid, field, 0, indicator, {.threshold = threshold}, ThreadExecutor(2));
        EXPECT_EQ(one.surface.vertices, two.surface.vertices);
        EXPECT_EQ(one.surface.simplices, two.surface.simplices);
    }
}

TEST(P4estGrid, TypeErasedItIsTheSame) {
    const Forest<3> forest = refined_at_sphere(4);
    const P4estGrid<3> grid(forest.get());
    const auto field = own_data(grid);
    const AnyGrid<3> any(grid);
    const AnyField<double> any_field(grid, field);
    const auto a = isosurface(grid, field, 0, {.threshold = 0.01});
    const auto b = isosurface(any, any_field, 0, {.threshold = 0.01});
    EXPECT_EQ(a.surface.vertices, b.surface.vertices);
    EXPECT_EQ(a.surface.simplices, b.surface.simplices);
}

TEST(P4estGrid, NoticesThatTheForestHasChanged) {
    Forest<3> forest = refined_at_sphere(3);
    const P4estGrid<3> grid(forest.get());
    const auto nodes = forest.nodes();
    const std::vector<double> values(static_cast<std::size_t>(nodes->num_local_nodes));
    const P4estNodalField nodal(grid, nodes.get(), values);
    const auto cells = own_data(grid);
    const HierarchicalIndicator indicator(grid, cells);
    forest.refine([](const p8est_quadrant_t& q) { return q.level < 4; });
    EXPECT_THROW(isosurface(grid, cells, 0, indicator), GridError);
    EXPECT_THROW(isosurface(grid, cells, 0), GridError);
    EXPECT_THROW(isosurface(grid, nodal, 0), GridError);
    const ZeroField<P4estGrid<3>> zero;
    EXPECT_FALSE(check_grid(grid, zero));
}

template <class Function>
std::string sentence(Function&& function) {
    try {
        function();
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

void expect_part(const std::string& got, const std::string& part) {
    EXPECT_NE(got.find(part), std::string::npos) << got;
}

template <int dim>
std::string sentence_of_grid(typename P4estTypes<dim>::Connectivity* connectivity) {
    const Forest<dim> forest(connectivity);
    return sentence([&] { P4estGrid<dim> grid(forest.get()); });
}

TEST(P4estGrid, RefusesWhatItCannotRead) {
    EXPECT_EQ(sentence([] { P4estGrid<2> grid(nullptr); }), "there is no forest");
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
    EXPECT_EQ(sentence([&] { P4estGrid<3> grid(cube.get()); }),
              "the connectivity of the forest has no vertices; give a map of its trees");
    cube.connectivity().vertices = vertices;
    EXPECT_EQ(sentence([&] {
                  P4estGrid grid(cube.get(), [](std::size_t, const Point& r) {
                      return Point{r[0], r[1], 0};
                  });
              }),
              "tree 0 is flat");
    EXPECT_NE(sentence([&] {
                  P4estGrid grid(cube.get(),
                                 [](std::size_t, const Point& r) { return std::sqrt(-1) * r; });
              }),
              "");
}

/// On several processes (tests/adapters/CMakeLists.txt runs it on two) no leaf of another one is
/// asked for; alone, the forest is told that there are others.
TEST(P4estGrid, RefusesADistributedForest) {
    const Forest<3> forest(p8est_connectivity_new_brick(2, 2, 2, 0, 0, 0));
    p8est_t part = *forest.get();
    if (part.mpisize == 1) ++part.global_num_quadrants;
    expect_part(sentence([&] { P4estGrid<3> grid(&part); }), "the forest is distributed: process");
}

TEST(P4estFields, RefuseWhatDoesNotFit) {
    Forest<2> forest(p4est_connectivity_new_unitsquare());
    const auto foreign = forest.nodes();
    forest.refine([](const p4est_quadrant_t& q) { return q.level < 2; });
    const P4estGrid grid(forest.get());
    const auto nodes = forest.nodes();
    const auto quadratic = forest.nodes(2);
    const std::vector<double> values(25);
    const auto field = [&](const p4est_lnodes_t* of, std::size_t count) {
        return sentence(
            [&] { P4estNodalField nodal(grid, of, std::span<const double>(values).first(count)); });
    };
    EXPECT_EQ(field(nodes.get(), 25), "");
    EXPECT_EQ(field(nullptr, 25), "there are no lnodes");
    EXPECT_EQ(field(quadratic.get(), 25), "the lnodes have degree 2, not 1");
    EXPECT_EQ(field(foreign.get(), 25),
              "the lnodes belong to another forest: they number 1 elements, but there are 16 "
              "leaves");
    EXPECT_EQ(field(nodes.get(), 24), "there are 24 values, but the lnodes number 25 nodes");
    EXPECT_EQ(sentence([&] { P4estBalancedGrid balanced(forest.get(), quadratic.get()); }),
              "the lnodes have degree 2, not 1");
    EXPECT_EQ(sentence([&] { P4estCellValues cells(grid, values); }),
              "there are 25 values of cells, but 16 leaves");
}

}  // namespace
