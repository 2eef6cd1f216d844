// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// UGGrid as a nested grid: red-green tetrahedra, hexahedra with hanging nodes and with green
// closures, prisms, the same in the plane, and a boundary that vertices are moved onto.
#include <algorithm>
#include <map>

#include "dune_ug_grids.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

std::unique_ptr<UGGrid<3>> prisms() {
    Dune::GridFactory<UGGrid<3>> factory;
    for (unsigned i = 0; i < 8; ++i) {
        factory.insertVertex({double(i & 1U), double(i >> 1U & 1U), double(i >> 2U)});
    }
    factory.insertElement(Dune::GeometryTypes::prism, {0, 1, 2, 4, 5, 6});
    factory.insertElement(Dune::GeometryTypes::prism, {1, 3, 2, 5, 7, 6});
    return factory.createGrid();
}

/// Eight tetrahedra about a point, long and short and their corners in another order each, so that
/// red refinement cuts their octahedra along each of the three diagonals.
std::unique_ptr<UGGrid<3>> crooked_octahedron() {
    Dune::GridFactory<UGGrid<3>> factory;
    const std::array<Dune::FieldVector<double, 3>, 7> x{
        {{0.1, 0.2, -0.1}, {1, 0, 0}, {-3, 0, 0}, {0, 2, 0}, {0, -1, 0.3}, {0, 0, 5}, {0, 0, -1}}};
    for (const auto& v : x) factory.insertVertex(v);
    for (unsigned i = 0; i < 8; ++i) {
        std::vector<unsigned> corners{0, 1 + (i & 1U), 3 + (i >> 1U & 1U), 5 + (i >> 2U)};
        std::rotate(corners.begin(), corners.begin() + i % 4, corners.end());
        if (i % 3 == 0) std::swap(corners[1], corners[2]);
        factory.insertElement(Dune::GeometryTypes::simplex(3), corners);
    }
    return factory.createGrid();
}

template <class Solver>
std::map<Shape, std::size_t> count_shapes(const Solver& solver) {
    std::map<Shape, std::size_t> count;
    for (const auto& e : elements(solver.leafGridView())) {
        ++count[nestgrid::detail::dune_shape(e.type())];
    }
    return count;
}

/// A copy has one child, equal to it.
template <class Solver>
std::size_t count_copies(const Solver& solver) {
    std::size_t copies = 0;
    for (int level = 0; level < solver.maxLevel(); ++level) {
        for (const auto& e : elements(solver.levelGridView(level))) {
            std::size_t children = 0;
            for ([[maybe_unused]] const auto& c : descendantElements(e, level + 1)) ++children;
            copies += children == 1 ? 1 : 0;
        }
    }
    return copies;
}

TEST(DuneUG, RedGreenTetrahedra) {
    const auto solver = simplices<3>(3);
    refine_at_sphere(*solver, 3, 0.2);
    EXPECT_GT(count_copies(*solver), 100U);
    expect_laws(*solver);
}

TEST(DuneUG, ManyTetrahedra) {
    const auto solver = simplices<3>(4);
    refine_at_sphere(*solver, 4, 0.17);
    EXPECT_GT(solver->leafGridView().size(0), 100'000);
    const DuneGrid grid(*solver);
    expect_sound(grid, 1);
    expect_closed_at_all_thresholds(grid, at_vertices(*solver, ball));
}

TEST(DuneUG, HexahedraWithHangingNodes) {
    const auto solver = hanging_cubes<3>(3, 3, 0.15);
    const DuneGrid grid(*solver);
    EXPECT_GT(derive_hanging_nodes(grid).size(), 1000U);
    expect_laws(*solver);
}

TEST(DuneUG, HexahedraClosedByPyramids) {
    const auto solver = cubes<3>(4);
    refine_at_sphere(*solver, 3, 0.15);
    auto shapes = count_shapes(*solver);
    EXPECT_GT(shapes[Shape::pyramid], 1000U);
    EXPECT_GT(shapes[Shape::tetrahedron], 1000U);
    const DuneGrid grid(*solver);
    EXPECT_GT(grid.rules().size(), 50U);
    EXPECT_EQ(derive_hanging_nodes(grid).size(), 0U);
    expect_laws(*solver);
}

TEST(DuneUG, Prisms) {
    const auto solver = prisms();
    solver->setClosureType(UGGrid<3>::NONE);
    solver->globalRefine(2);
    refine_at_sphere(*solver, 4, 0.4);
    EXPECT_EQ(count_shapes(*solver).size(), 1U);
    const DuneGrid grid(*solver);
    EXPECT_GT(derive_hanging_nodes(grid).size(), 100U);
    expect_laws(*solver);
}

TEST(DuneUG, Triangles) {
    const auto solver = simplices<2>(4);
    refine_at_sphere(*solver, 5, 0.15);
    expect_laws(*solver);
}

TEST(DuneUG, Quadrilaterals) {
    expect_laws(*hanging_cubes<2>(4, 5, 0.15));
    const auto closed = cubes<2>(4);
    refine_at_sphere(*closed, 5, 0.15);
    EXPECT_EQ(count_shapes(*closed).size(), 2U);
    expect_laws(*closed);
}

/// The same rules and children by Dune's interface alone.
template <class Solver>
void expect_same_as_generic(const Solver& solver) {
    const DuneGrid fast(solver);
    const DuneGrid<Solver, DuneDefaults<Solver>> slow(solver);
    EXPECT_EQ(fast.rules().size(), slow.rules().size());
    auto fast_context = fast.make_context();
    auto slow_context = slow.make_context();
    std::vector<typename DuneGrid<Solver>::Element> fast_children(64);
    auto slow_children = fast_children;
    const auto compare = [&](const auto& e) {
        const Rule* const a = fast.split(e, fast_context);
        const Rule* const b = slow.split(e, slow_context);
        ASSERT_EQ(a == nullptr, b == nullptr);
        if (a == nullptr) return;
        EXPECT_EQ(a->parent, b->parent);
        EXPECT_EQ(a->new_nodes, b->new_nodes);
        ASSERT_EQ(a->children.size(), b->children.size());
        fast.children(e, fast_children, fast_context);
        slow.children(e, slow_children, slow_context);
        for (std::size_t c = 0; c < a->children.size(); ++c) {
            EXPECT_EQ(fast_children[c], slow_children[c]);
            EXPECT_EQ(a->children[c].shape, b->children[c].shape);
            EXPECT_EQ(a->children[c].corner, b->children[c].corner);
        }
    };
    for (int level = 0; level <= solver.maxLevel(); ++level) {
        for (const auto& e : elements(solver.levelGridView(level))) compare(e);
    }
}

TEST(DuneUG, RulesAreThoseOfGeometryInFather) {
    for (const unsigned n : {2U, 3U}) {
        const auto tetrahedra = simplices<3>(n);
        refine_at_sphere(*tetrahedra, 3, 0.2);
        expect_same_as_generic(*tetrahedra);
        const auto closed = cubes<3>(n);
        refine_at_sphere(*closed, 3, 0.3);
        expect_same_as_generic(*closed);
    }
    expect_same_as_generic(*hanging_cubes<3>(3, 3, 0.15));
    const auto crooked = crooked_octahedron();
    crooked->globalRefine(2);
    EXPECT_EQ(DuneGrid(*crooked).rules().size(), 3U);
    expect_same_as_generic(*crooked);
    const auto wedges = prisms();
    wedges->globalRefine(3);
    expect_same_as_generic(*wedges);
    const auto plane = cubes<2>(4);
    refine_at_sphere(*plane, 5, 0.15);
    expect_same_as_generic(*plane);
}

/// The unit sphere through the corners of an octahedron.
struct Octant : Dune::BoundarySegment<3> {
    std::array<Dune::FieldVector<double, 3>, 3> corner;
    Dune::FieldVector<double, 3> operator()(const Dune::FieldVector<double, 2>& at) const override {
        auto x = corner[0];
        x.axpy(at[0], corner[1] - corner[0]);
        x.axpy(at[1], corner[2] - corner[0]);
        return x /= x.two_norm();
    }
};

TEST(DuneUG, FollowsParametrisedBoundaries) {
    Dune::GridFactory<UGGrid<3>> factory;
    std::vector<Dune::FieldVector<double, 3>> x{{0, 0, 0},  {1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                                                {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const auto& v : x) factory.insertVertex(v);
    for (unsigned i = 0; i < 8; ++i) {
        const std::array<unsigned, 3> on{1 + (i & 1U), 3 + (i >> 1U & 1U), 5 + (i >> 2U)};
        factory.insertElement(Dune::GeometryTypes::simplex(3), {0, on[0], on[1], on[2]});
        auto octant = std::make_shared<Octant>();
        octant->corner = {x[on[0]], x[on[1]], x[on[2]]};
        factory.insertBoundarySegment({on[0], on[1], on[2]}, octant);
    }
    const auto solver = factory.createGrid();
    std::vector<double> errors;
    for (int level = 1; level <= 4; ++level) {
        solver->globalRefine(1);
        const DuneGrid grid(*solver);
        const std::vector<double> values = at_vertices(
            *solver, [](const Point& p) { return p[0] * p[0] - 0.3 + 0.2 * p[1] * p[2]; });
        const DuneVertexField field(grid, values);
        const auto violation = check_grid(grid, field);
        ASSERT_FALSE(violation) << violation->sentence;
        const HierarchicalIndicator indicator(grid, field);
        const auto hierarchy = erase(grid, field);
        const engine::Walk<double> walk(hierarchy, {.positions = true});
        double volume = 0;
        engine::project(walk, Exact{}, [&](const auto& view) {
            std::array<Point, max_corners> p;
            walk.corners(view, nullptr, p.data());
            for (int k = 0; k < 4; ++k) {
                const auto y = element_in(grid, view).geometry().corner(k);
                EXPECT_EQ(p[static_cast<std::size_t>(k)], nestgrid::detail::dune_point(y));
            }
            volume += view.orientation * measure(view.shape, std::span(p).first(4));
        });
        errors.push_back(4 * std::acos(-1.0) / 3 - volume);
        expect_closed_at_all_thresholds(grid, values);
    }
    EXPECT_GT(errors.back(), 0);
    EXPECT_NEAR(errors[2] / errors[3], 4, 0.3);
}

TEST(DuneUG, ThreadsDrawTheSame) {
    const auto solver = hanging_cubes<3>(3, 3, 0.15);
    const DuneGrid grid(*solver);
    const std::vector<double> values = noise(*solver);
    const DuneVertexField field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    IsosurfaceOptions options;
    const auto one = isosurface(grid, field, 0, under(indicator, 0.3), options).surface;
    const auto four =
        isosurface(grid, field, 0, under(indicator, 0.3), options, {ThreadExecutor(4)}).surface;
    EXPECT_GT(one.simplices.size(), 1000U);
    EXPECT_EQ(one.vertices, four.vertices);
    EXPECT_EQ(one.simplices, four.simplices);
}

}  // namespace
