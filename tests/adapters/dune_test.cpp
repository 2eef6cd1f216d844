// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// YaspGrid as a nested grid; fields on grids of Dune; what is refused.
#include <set>

#include <dune/common/bigunsignedint.hh>
#include <dune/grid/common/mcmgmapper.hh>
#include <dune/grid/yaspgrid.hh>

#include "changed_laws.hpp"
#include "dune_laws.hpp"
#include "dune_ug_grids.hpp"
#include "refusal_rows.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

template <int dim>
using Yasp = Dune::YaspGrid<dim>;

TEST(DuneYasp, Quadrilaterals) {
    Yasp<2> solver({1, 1}, {3, 4});
    solver.globalRefine(4);
    EXPECT_TRUE(DuneGrid(solver).conforming());
    expect_laws(solver);
}

TEST(DuneYasp, Hexahedra) {
    Yasp<3> solver({1, 1, 1}, {3, 2, 4});
    solver.globalRefine(3);
    expect_laws(solver);
}

TEST(DuneYasp, GridOfOneLevel) {
    const Yasp<2> solver({1, 1}, {30, 40});
    const DuneGrid grid(solver);
    EXPECT_EQ(grid.rules().size(), 0U);
    expect_sound(grid, 1);
}

TEST(DuneTraits, ForbidOtherThreads) {
    const auto solver = hanging_cubes<3>(2, 1, 0.3);
    const DuneGrid<UGGrid<3>, DuneDefaults<UGGrid<3>>> grid(*solver);
    expect_one_thread_only(grid);
}

/// Components go with the first; floats stay floats; a mapper gives the indices.
TEST(DuneVertexField, ReadsWhatVectorsHold) {
    const auto solver = hanging_cubes<2>(4, 3, 0.15);
    const DuneGrid grid(*solver);
    const auto n = static_cast<std::size_t>(solver->size(2));
    const std::vector<float> floats(n, 1.5F);
    const DuneVertexField single(grid, floats);
    static_assert(std::is_same_v<decltype(single)::value_type, float>);
    EXPECT_FALSE(check_grid(grid, single));

    std::vector<Dune::FieldVector<double, 2>> pairs(n);
    const std::vector<double> first = at_vertices(*solver, linear);
    for (std::size_t i = 0; i < n; ++i) pairs[i] = {first[i], -3 * first[i]};
    const auto leaf_view = solver->leafGridView();
    const Dune::MultipleCodimMultipleGeomTypeMapper mapper(leaf_view, Dune::mcmgVertexLayout());
    const DuneVertexField both(grid, pairs, mapper);
    static_assert(decltype(both)::components == 2);
    EXPECT_FALSE(check_grid(grid, both));
    const auto hierarchy = erase(grid, both);
    const engine::Walk<double> walk(hierarchy, {});
    std::size_t leaves = 0;
    engine::project(walk, Exact{}, [&](const auto& view) {
        ++leaves;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto x = element_in(grid, view).geometry().corner(static_cast<int>(k));
            EXPECT_EQ(view.value[2 * k], linear(nestgrid::detail::dune_point(x)));
            EXPECT_EQ(view.value[2 * k + 1], -3 * view.value[2 * k]);
        }
    });
    EXPECT_EQ(leaves, static_cast<std::size_t>(solver->size(0)));
}

TEST(DuneVertexField, RefusesVectorsOfAnotherLength) {
    const Yasp<2> solver({1, 1}, {3, 4});
    const DuneGrid grid(solver);
    const std::vector<double> values(12);
    EXPECT_EQ(refusal([&] { DuneVertexField(grid, values); }),
              "there are 12 values, but the leaf grid has 20 vertices");
}

/// A function of leaves gives the values of its vector at the vertices.
template <class Solver>
void expect_function_is_vector(const Solver& solver) {
    const DuneGrid grid(solver);
    const std::vector<double> values = at_vertices(solver, ball);
    const DuneVertexField field(grid, values);
    using Element = typename DuneGrid<Solver>::Element;
    using Local = typename Element::Geometry::LocalCoordinate;
    const auto f = [&](const Element& leaf, const Local& x) {
        EXPECT_TRUE(leaf.isLeaf());
        const auto corners = static_cast<int>(leaf.subEntities(Solver::dimension));
        for (int i = 0; i < corners; ++i) {
            if (referenceElement(leaf.geometry()).position(i, Solver::dimension) != x) continue;
            return values[static_cast<std::size_t>(
                solver.leafIndexSet().subIndex(leaf, i, Solver::dimension))];
        }
        ADD_FAILURE() << "not at a corner";
        return 0.0;
    };
    const DuneFunctionField function(grid, f);
    const auto violation = check_grid(grid, function);
    ASSERT_FALSE(violation) << violation->sentence;
    const auto a = isosurface(grid, field, 0, {.threshold = 0.01}).surface;
    const auto b = isosurface(grid, function, 0, {.threshold = 0.01}).surface;
    EXPECT_GT(a.simplices.size(), 8U);
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.simplices, b.simplices);
}

TEST(DuneFunctionField, SeesFunctionsAtVertices) {
    const auto closed = cubes<3>(2);
    refine_at_sphere(*closed, 3, 0.3);
    expect_function_is_vector(*closed);
    expect_function_is_vector(*hanging_cubes<2>(4, 3, 0.15));
    Yasp<3> solver({1, 1, 1}, {3, 2, 4});
    solver.globalRefine(2);
    expect_function_is_vector(solver);
}

TEST(DuneGrid, RefusesPeriodicGrids) {
    const Yasp<2> periodic({1, 1}, {3, 4}, std::bitset<2>("01"), 1);
    EXPECT_EQ(refusal([&] { DuneGrid g(periodic); }), "the Dune grid is periodic");
}

/// A small id is the key itself; of others all bytes count, or what std::hash makes of them.
TEST(DuneGrid, HashesIds) {
    using nestgrid::detail::dune_id;
    EXPECT_EQ(dune_id(7U), 7U);
    std::set<std::uint64_t> keys;
    for (int bit = 0; bit < 100; ++bit) keys.insert(dune_id(Dune::bigunsignedint<100>(1) << bit));
    EXPECT_EQ(keys.size(), 100U);
    EXPECT_NE(dune_id(std::string("one")), dune_id(std::string("two")));
}

TEST(DuneGrid, RefusesUnknownShapes) {
    EXPECT_EQ(refusal([] { nestgrid::detail::dune_shape(Dune::GeometryTypes::none(3)); }),
              "an element of the Dune grid is of dimension 3 and none of the known shapes");
}

template <class Solver>
struct LosesAChild : DuneDefaults<Solver> {
    using Element = typename Solver::template Codim<0>::Entity;
    static void children(const Solver& solver, const Element& e, std::vector<Element>& out) {
        DuneDefaults<Solver>::children(solver, e, out);
        out.pop_back();
    }
};

TEST(DuneGrid, RefusesChildrenThatLeaveAGap) {
    Yasp<2> solver({1, 1}, {3, 4});
    solver.globalRefine(1);
    EXPECT_EQ(refusal([&] { DuneGrid<Yasp<2>, LosesAChild<Yasp<2>>> g(solver); }),
              "rule 'quadrilateral into 3': volume lost: the children hold 0.750000 of their "
              "father");
}

TEST(DuneGrid, NoticesThatItWasAdapted) {
    const auto solver = simplices<3>(2);
    refine_at_sphere(*solver, 1, 0.1);
    const DuneGrid grid(*solver);
    std::vector<double> values = noise(*solver);
    const DuneVertexField field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    const auto vertices = std::to_string(values.size());
    refine_at_sphere(*solver, 2, 0.2);
    EXPECT_EQ(refusal([&] { HierarchicalIndicator(DuneGrid(*solver), field); }),
              "there are " + vertices + " values, but the leaf grid has " +
                  std::to_string(solver->size(3)) + " vertices");
    values = noise(*solver);
    EXPECT_EQ(refusal<GridError>([&] { isosurface(grid, field, 0, under(indicator, 0)); }),
              "the grid has changed since its indicator was computed");
    EXPECT_EQ(refusal<GridError>([&] { derive_hanging_nodes(grid); }),
              "the Dune grid was adapted; its adapter must be made anew");
    expect_laws(*solver);
}

TEST(DuneGrid, RefusesWhatWasMadeBeforeAChange) {
    const auto solver = simplices<3>(2);
    refine_at_sphere(*solver, 1, 0.1);
    const DuneGrid grid(*solver);
    using Grid = std::remove_const_t<decltype(grid)>;
    const std::vector<double> values = at_vertices(*solver, ball);
    const DuneVertexField field(grid, values);
    using Field = std::remove_const_t<decltype(field)>;
    MadeOnce<Grid, Field> before(grid, field);
    refine_at_sphere(*solver, 2, 0.2);
    const DuneGrid anew(*solver);
    const std::vector<double> finer_values = at_vertices(*solver, ball);
    const DuneVertexField finer(anew, finer_values);
    expect_refused_after_change(before, anew, finer);
    expect_usable(anew, finer);
}

TEST(Refusals, OfDune) {
    RefusalRows rows("Dune");
    rows.add("an element of an unknown shape",
             [] { nestgrid::detail::dune_shape(Dune::GeometryTypes::none(3)); });
    rows.add("a periodic grid", [] {
        Yasp<2> periodic({1, 1}, {3, 4}, std::bitset<2>(1), 1);
        DuneGrid{periodic};
    });
    rows.add("children that leave a gap", [] {
        Yasp<2> solver({1, 1}, {3, 4});
        solver.globalRefine(1);
        DuneGrid<Yasp<2>, LosesAChild<Yasp<2>>>{solver};
    });
    const auto solver = simplices<3>(2);
    const DuneGrid grid(*solver);
    const std::vector<double> few(3);
    rows.add("a vector of another size", [&] { DuneVertexField(grid, few); });
    std::vector<double> values = noise(*solver);
    const DuneVertexField field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    solver->globalRefine(1);
    rows.add("values from before an adaptation",
             [&] { HierarchicalIndicator(DuneGrid(*solver), field); });
    values = noise(*solver);
    rows.add<GridError>("an indicator from before an adaptation",
                        [&] { isosurface(grid, field, 0, under(indicator, 0)); });
    rows.add<GridError>("an adapter from before an adaptation",
                        [&] { derive_hanging_nodes(grid); });
}

}  // namespace
