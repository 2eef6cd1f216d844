// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What grids of our own, and tables in C, say in every state in which they are wrong.
#include <cmath>
#include <limits>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/adapters/linear_octree.hpp>
#include <nestgrid/adapters/union.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/probe.hpp>

#include "refusal_rows.hpp"
#include "sample_grids.hpp"
#include "table_in_c.hpp"

using namespace nestgrid_test;

namespace refusals_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A coarse grid of two triangles.
CoarseGrid two_triangles() {
    CoarseGrid grid;
    grid.dimension = 2;
    grid.nodes = Coordinates(std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    grid.add(Shape::triangle, {0, 1, 2});
    grid.add(Shape::triangle, {3, 2, 1});
    return grid;
}

CoarseGrid with_nodes(std::vector<Point> nodes) {
    CoarseGrid grid = two_triangles();
    grid.nodes = Coordinates(std::move(nodes));
    return grid;
}

TEST(Refusals, OfCoarseGrids) {
    RefusalRows rows("coarse grids");
    using Grid = BisectionGrid<2>;
    rows.add("no element", [] { Grid(CoarseGrid{}); });
    rows.add("a shape that the family does not refine", [] { OctreeGrid<3>(tetrahedra(1)); });
    rows.add("a coordinate that is no number", [] {
        Grid(with_nodes({{0, 0, 0}, {1, nan, 0}, {0, 1, 0}, {1, 1, 0}}));
    });
    rows.add("two nodes at one place", [] {
        Grid(with_nodes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}));
    });
    rows.add("a flat element", [] {
        Grid(with_nodes({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}));
    });
    rows.add("a node that is not there", [] {
        CoarseGrid grid = two_triangles();
        grid.corners[5] = 7;
        Grid{grid};
    });
    rows.add("a node twice in an element", [] {
        CoarseGrid grid = two_triangles();
        grid.corners[5] = 3;
        Grid{grid};
    });
    rows.add("an edge of three triangles", [] {
        CoarseGrid grid = with_nodes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 1, 1}});
        grid.add(Shape::triangle, {1, 2, 4});
        Grid{grid};
    });
}

TEST(Refusals, OfStoredGrids) {
    RefusalRows rows("stored grids");
    OctreeGrid<3> grid(hexahedra(2));
    using Field = NodeField<OctreeGrid<3>, double>;
    std::vector<double> values(grid.node_count(), 1.0);
    const std::vector<double> few(5);
    rows.add("values for another number of nodes", [&] { Field(grid, few); });
    rows.add("a mark that the family does not have",
             [&] { grid.adapt([](const Leaf&) { return Mark::refine_vertically; }); });
    values[13] = nan;
    const Field field(grid, values);
    rows.add("a value that is no number", [&] { isosurface(grid, field, 0.5); });
    const std::vector<double> ones(grid.node_count(), 1.0);
    const Field before(grid, ones);
    const HierarchicalIndicator indicator(grid, before);
    grid.adapt([](const Leaf&) { return Mark::refine; });
    rows.add<GridError>("a field from before a refinement", [&] { isosurface(grid, before, 0.5); });
    const std::vector<double> more(grid.node_count(), 1.0);
    const Field after(grid, more);
    rows.add<GridError>("an indicator from before a refinement",
                        [&] { isosurface(grid, after, 0.5, under(indicator, 0.1)); });
}

TEST(Refusals, OfLattices) {
    RefusalRows rows("lattices of samples");
    using Grid = LatticeBisection<3>;
    rows.add("one sample along a direction", [] { Grid({.samples = {5, 1, 5}}); });
    rows.add("a spacing that is no number", [] {
        Grid({.samples = {5, 5, 5}, .spacing = {1, nan, 1}});
    });
    rows.add("blocks that are too large", [] {
        LatticeOctree<3>({.samples = {5, 5, 5}, .block_levels = 40});
    });
    const Grid grid({.samples = {5, 5, 5}});
    std::vector<float> samples(100);
    rows.add("another number of samples",
             [&] { LatticeField(grid, std::span<const float>(samples)); });
    samples.resize(125);
    samples[31] = std::numeric_limits<float>::infinity();
    const LatticeField field(grid, std::span<const float>(samples));
    rows.add("a sample that is infinite", [&] { isosurface(grid, field, 0.5); });
}

TEST(Refusals, OfUnions) {
    RefusalRows rows("unions");
    OctreeGrid<2> one(quadrilaterals(2));
    OctreeGrid<2> other(quadrilaterals(2));
    const std::vector<double> values(one.node_count(), 1.0);
    using Field = NodeField<OctreeGrid<2>, double>;
    const Field field(one, values);
    const Field other_field(other, values);
    const Union both(one, field, other, other_field);
    other.adapt([](const Leaf&) { return Mark::refine; });
    rows.add<GridError>("a side that has changed", [&] {
        auto context = both.make_context();
        both.coarse(0, context);
    });
}

TEST(Refusals, OfTablesInC) {
    RefusalRows rows("tables in C");
    OctreeGrid<2> grid(quadrilaterals(2));
    grid.adapt([](const Leaf&) { return Mark::refine; });
    const std::vector<double> values(grid.node_count(), 1.0);
    const NodeField<OctreeGrid<2>, double> field(grid, values);
    const TableInC in_c(grid);
    const nestgrid_field f = field_in_c(grid, field);
    const auto with = [&](const auto& change) {
        return [&in_c, &f, change] {
            nestgrid_grid table = in_c.table;
            nestgrid_field of = f;
            change(table, of);
            open_table<double>(table, of);
        };
    };
    rows.add("no size", with([](auto& t, auto&) { t.size = 0; }));
    rows.add("another dimension", with([](auto& t, auto&) { t.dimension = 4; }));
    rows.add("a required function that is NULL", with([](auto& t, auto&) { t.split = nullptr; }));
    rows.add("no rules", with([](auto& t, auto&) { t.rules = nullptr; }));
    rows.add("no component", with([](auto&, auto& of) { of.components = 0; }));
    rows.add("a type of values that does not exist",
             with([](auto&, auto& of) { of.value_type = 9; }));
    rows.add("a field without values", with([](auto&, auto& of) { of.new_values = nullptr; }));
}

}  // namespace refusals_test
