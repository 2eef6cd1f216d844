// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data on forests of p4est and p8est: by lnodes and by cells, on small and large ones.
#include <filesystem>

#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/hanging_nodes.hpp>

#include "changed_laws.hpp"
#include "counting_allocator.hpp"
#include "p4est_advection.hpp"
#include "p4est_laws.hpp"
#include "table_in_c.hpp"
#include "thread_executor.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

double linear(const Point& x) { return 0.3 + x[0] - 2 * x[1] + 0.7 * x[2]; }

template <class Real, int dim>
void check_nodal_field(double threshold) {
    for_each_forest<dim>(true, [&](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const auto nodes = forest.nodes();
        const std::vector<Real> values =
            nodal_values(grid, *nodes, [](const Point& x) { return static_cast<Real>(linear(x)); });
        const P4estNodalField field(grid, nodes.get(), values);
        expect_sound(grid, field, {.hanging_values = true});
        const HierarchicalIndicator indicator(grid, field);
        EXPECT_LE(indicator.hanging_violation(), 0);
        // Corners of trees first, then what lies below.
        const auto hierarchy = erase(grid, field);
        const engine::Walk<Real> walk(hierarchy, {.positions = true}, indicator.hanging());
        const bool straight = name != "ring" && name != "shell";
        int deepest = 0;
        engine::project(walk, Threshold(&indicator, threshold), [&](const auto& view) {
            deepest = std::max(deepest, view.level);
            std::array<Point, max_corners> x;
            walk.corners(view, nullptr, x.data());
            for (std::size_t c = 0; straight && c < view.corner_count(); ++c) {
                EXPECT_NEAR(view.value[c], linear(x[c]), threshold);
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

template <int dim>
void expect_planes() {
    for_each_forest<dim>(true, [](const std::string& name, const auto& forest, const auto& map) {
        if (name != "square" && name != "cube") return;
        const P4estGrid grid(forest.get(), map);
        const auto nodes = forest.nodes();
        const std::vector<double> values = nodal_values(grid, *nodes, slanted<dim>);
        expect_linear_exact(grid, P4estNodalField(grid, nodes.get(), values));
    });
}
TEST(P4estNodalField, LevelSetsOfLinearFunctionsArePlanes) {
    expect_planes<2>();
    expect_planes<3>();
}

TEST(P4estNodalField, SurfacesAreClosedAtEveryThreshold) {
    const auto check = [](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const auto nodes = forest.nodes();
        const std::vector<double> values =
            noise(static_cast<std::size_t>(nodes->num_local_nodes), 3);
        const P4estNodalField field(grid, nodes.get(), values);
        expect_sound(grid, field, {.hanging_values = true});
        expect_closed_at_all_thresholds(grid, field, {.orientable = name != "moebius"});
    };
    for_each_forest<2>(true, check);
    for_each_forest<3>(true, check);
}

class CompareHanging final : public engine::Visitor<float> {
public:
    explicit CompareHanging(const HangingNodes& hanging) : hanging_{&hanging} {}

    engine::Decision inspect(const engine::ElementView<float>&,
                             const engine::Split& split) override {
        EXPECT_EQ(split.constrained, hanging_->mask(split.keys));
        return {};
    }
    void extract(const engine::ElementView<float>&) override {}

private:
    const HangingNodes* hanging_;
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
        const auto hierarchy = erase(grid, zero);
        const engine::Walk<float> walk(hierarchy, {});
        CompareHanging compare(hanging);
        walk.run(compare);

        const std::vector<double> values =
            noise(static_cast<std::size_t>(nodes->num_local_nodes), 5);
        const P4estNodalField field(grid, nodes.get(), values);
        expect_sound(grid, field, {.hanging_values = true});
        expect_closed_at_all_thresholds(grid, field, {.orientable = name != "moebius"});
    };
    for_each_forest<2>(true, check);
    for_each_forest<3>(true, check);
}

/// The mean of the corners of a leaf.
Point centre_of(const auto& view, const auto& walk) {
    std::array<Point, max_corners> x;
    walk.corners(view, nullptr, x.data());
    Point centre{0, 0, 0};
    const std::size_t count = view.corner_count();
    for (std::size_t c = 0; c < count; ++c) centre = centre + (1.0 / double(count)) * x[c];
    return centre;
}

/// Linear functions of position come back from cells, whatever the map.
TEST(P4estCellValues, OfLinearFunctionsGiveThemAtNodes) {
    const auto f = [](const Point& x) { return 0.3 * x[0] - 0.7 * x[1] + 0.4 * x[2]; };
    for_each_forest<3>(false, [&](const std::string& name, const auto& forest, const auto& map) {
        SCOPED_TRACE(name);
        const P4estGrid grid(forest.get(), map);
        std::vector<double> values(grid.leaf_count());
        for_each_leaf(grid, [&](const auto& view, const auto& walk) {
            values[grid.leaf_index(element_in(grid, view))] = f(centre_of(view, walk));
        });
        const CellAverages field(grid, P4estCellValues(grid, values));
        const auto hierarchy = erase(grid, field);
        const engine::Walk<double> walk(hierarchy, {.positions = true});
        engine::project(walk, Exact{}, [&](const auto& view) {
            std::array<Point, max_corners> x;
            walk.corners(view, nullptr, x.data());
            for (std::size_t c = 0; c < view.corner_count(); ++c) {
                EXPECT_NEAR(view.value[c], f(x[c]), 1e-12);
            }
        });
    });
}

TEST(P4estCellValues, KeepTheLaws) {
    for_each_forest([](const std::string& name, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const std::vector<double> values = noise(grid.leaf_count(), 4);
        const CellAverages field(grid, P4estCellValues(grid, values));
        for_each_leaf(grid, [&](const auto& view, const auto&) {
            const auto& e = element_in(grid, view);
            EXPECT_EQ(field.leaf_value(e), values[grid.leaf_index(e)]);
        });
        expect_sound(grid, field);
        expect_closed_at_all_thresholds(grid, field, {.orientable = name != "moebius"});
    });
}

TEST(P4estCellValues, PlateausStayFlat) {
    for_each_forest<3>(false, [](const char*, const auto& forest, const auto& map) {
        const P4estGrid grid(forest.get(), map);
        const std::vector<double> values(grid.leaf_count(), 0.1);
        const CellAverages field(grid, P4estCellValues(grid, values));
        const HierarchicalIndicator indicator(grid, field);
        EXPECT_EQ(indicator.least(), 0.1);
        EXPECT_EQ(indicator.greatest(), 0.1);
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
    for_each_leaf(grid, [&](const auto& view, const auto&) {
        double half = 0;
        const auto& quadrant = grid.quadrant(element_in(grid, view));
        *static_cast<double*>(quadrant.p.user_data) = distance(quadrant, half);
    });
    return forest;
}

auto own_data(const P4estGrid<3>& grid) {
    return CellAverages(grid, [&grid](const P4estGrid<3>::Element& leaf) {
        return *static_cast<const double*>(grid.quadrant(leaf).p.user_data);
    });
}

TEST(P4estFields, SavedAndLoadedGivesTheSameSurface) {
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

/// What a solver left in its quadrants, on the forest that followed it.
TEST(P4estFields, LawsHoldForASolution) {
    p4est_advection::Advection solver(
        {.finest = 7, .largest_jump = 0.05, .steps_per_rotation = 720});
    for (int step = 0; step < 2 * p4est_advection::steps_per_adaptation; ++step) solver.step();
    const P4estGrid grid(solver.forest());
    EXPECT_GE(grid.leaf_count(), 100000U);
    const CellAverages field(
        grid, [&](const auto& leaf) { return p4est_advection::cell_of(grid.quadrant(leaf)).u; });
    expect_sound_grid(grid, field);
    expect_closed_levels(grid, field, 0.5, 0.03);
}

TEST(P4estFields, LargeForestsAreReadInPlace) {
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

    // A walk allocates some frames for each level, and nothing when they are there.
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.positions = true});
    for (const std::size_t allocations : {std::size_t{8 * 10}, std::size_t{0}}) {
        std::size_t leaves = 0;
        const std::size_t calls = allocation_count();
        engine::project(walk, Exact{}, [&](const auto& view) {
            leaves += grid.split(element_in(grid, view)) == nullptr;
        });
        EXPECT_LE(allocation_count() - calls, allocations);
        EXPECT_EQ(leaves, grid.leaf_count());
    }

    const HierarchicalIndicator indicator(grid, field);
    EXPECT_LE(indicator.hanging_violation(), 0);
    for (const double threshold : six_thresholds) {
        const auto one = isosurface(grid, field, 0, under(indicator, threshold));
        expect_closed(one.surface);
        const auto two =
            isosurface(grid, field, 0, under(indicator, threshold), {}, {ThreadExecutor(2)});
        EXPECT_EQ(one.surface.vertices, two.surface.vertices);
        EXPECT_EQ(one.surface.simplices, two.surface.simplices);
    }
    const P4estBalancedGrid balanced(forest.get(), nodes.get());
    const auto a = isosurface(grid, field, 0, under(indicator, 0.01));
    const auto b = isosurface(balanced, field, 0, {.threshold = 0.01});
    EXPECT_EQ(a.surface.vertices, b.surface.vertices);
    EXPECT_EQ(a.surface.simplices, b.surface.simplices);
}

TEST(P4estFields, BehindTablesTheyAreTheSame) {
    const Forest<3> forest = refined_at_sphere(4);
    const P4estGrid<3> grid(forest.get());
    const auto field = own_data(grid);
    const BehindTables tables(grid, field);
    const auto a = isosurface(grid, field, 0, {.threshold = 0.01});
    const auto b = isosurface<3>(*tables.hierarchy, 0, {.threshold = 0.01});
    EXPECT_EQ(a.surface.vertices, b.surface.vertices);
    EXPECT_EQ(a.surface.simplices, b.surface.simplices);
}

TEST(P4estFields, NoticeThatTheForestHasChanged) {
    Forest<3> forest = refined_at_sphere(3);
    const P4estGrid<3> grid(forest.get());
    const auto nodes = forest.nodes();
    const std::vector<double> values(static_cast<std::size_t>(nodes->num_local_nodes));
    const P4estNodalField nodal(grid, nodes.get(), values);
    const auto cells = own_data(grid);
    const HierarchicalIndicator indicator(grid, cells);
    forest.refine([](const p8est_quadrant_t& q) { return q.level < 4; });
    EXPECT_THROW(isosurface(grid, cells, 0, under(indicator, 0)), GridError);
    EXPECT_THROW(isosurface(grid, cells, 0), GridError);
    EXPECT_THROW(isosurface(grid, nodal, 0), GridError);
}

TEST(P4estFields, RefuseWhatWasMadeBeforeAChange) {
    Forest<3> forest = refined_at_sphere(3);
    const P4estGrid<3> grid(forest.get());
    const auto numbers = [](const auto& nodes) {
        std::vector<double> values(static_cast<std::size_t>(nodes->num_local_nodes));
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(double(i));
        return values;
    };
    const auto nodes = forest.nodes();
    const std::vector<double> values = numbers(nodes);
    const P4estNodalField field(grid, nodes.get(), std::span<const double>(values));
    MadeOnce<P4estGrid<3>, std::remove_const_t<decltype(field)>> before(grid, field);
    forest.refine([](const p8est_quadrant_t& q) { return q.level < 4; });
    const auto finer_nodes = forest.nodes();
    const std::vector<double> finer_values = numbers(finer_nodes);
    const P4estNodalField finer(grid, finer_nodes.get(), std::span<const double>(finer_values));
    expect_refused_after_change(before, grid, finer);
    expect_usable(grid, finer);
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
        return refusal(
            [&] { P4estNodalField nodal(grid, of, std::span<const double>(values).first(count)); });
    };
    EXPECT_EQ(field(nodes.get(), 25), "");
    EXPECT_EQ(field(nullptr, 25), "there are no lnodes");
    EXPECT_EQ(field(quadratic.get(), 25), "the lnodes have degree 2, not 1");
    EXPECT_EQ(field(foreign.get(), 25),
              "the lnodes belong to another forest: they number 1 elements, but there are 16 "
              "leaves");
    EXPECT_EQ(field(nodes.get(), 24), "there are 24 values, but the lnodes number 25 nodes");
    EXPECT_EQ(refusal([&] { P4estBalancedGrid balanced(forest.get(), quadratic.get()); }),
              "the lnodes have degree 2, not 1");
    EXPECT_EQ(refusal([&] { P4estCellValues cells(grid, values); }),
              "there are 25 values of cells, but 16 leaves");
}

}  // namespace
