// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Linear, quadratic and Lagrange cells, beside VTK's own shape functions.
#include <cmath>
#include <random>

#include <vtkBiQuadraticQuad.h>
#include <vtkBiQuadraticQuadraticHexahedron.h>
#include <vtkBiQuadraticQuadraticWedge.h>
#include <vtkHexahedron.h>
#include <vtkLagrangeHexahedron.h>
#include <vtkLagrangeQuadrilateral.h>
#include <vtkLagrangeTetra.h>
#include <vtkLagrangeTriangle.h>
#include <vtkLagrangeWedge.h>
#include <vtkNew.h>
#include <vtkPixel.h>
#include <vtkPyramid.h>
#include <vtkQuad.h>
#include <vtkQuadraticHexahedron.h>
#include <vtkQuadraticLinearWedge.h>
#include <vtkQuadraticPyramid.h>
#include <vtkQuadraticQuad.h>
#include <vtkQuadraticTetra.h>
#include <vtkQuadraticTriangle.h>
#include <vtkQuadraticWedge.h>
#include <vtkTriQuadraticHexahedron.h>
#include <vtkVoxel.h>

#include <nestgrid/adapters/vtk_cells.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/polynomial_values.hpp>
#include <nestgrid/check_grid.hpp>

#include "closedness.hpp"
#include "lagrange_meshes.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace {

/// The place of a node among the points of a cell, as VTK says.
vtkIdType vtk_place(Shape shape, const LatticePlace& at, int p) {
    const std::array<int, 3> order{p, p, p};
    const auto [i, j, k] = at;
    switch (shape) {
        case Shape::triangle: {
            const std::array<vtkIdType, 3> b{i, j, p - i - j};
            return vtkLagrangeTriangle::Index(b.data(), p);
        }
        case Shape::tetrahedron: {
            const std::array<vtkIdType, 4> b{i, j, k, p - i - j - k};
            return vtkLagrangeTetra::Index(b.data(), p);
        }
        case Shape::quadrilateral:
            return vtkLagrangeQuadrilateral::PointIndexFromIJK(i, j, order.data());
        case Shape::prism:
            return vtkLagrangeWedge::PointIndexFromIJK(i, j, k, order.data());
        default:
            return vtkLagrangeHexahedron::PointIndexFromIJK(i, j, k, order.data());
    }
}

TEST(Lagrange, PointsStandInTheOrderOfVtk) {
    for (const Shape shape : {Shape::triangle, Shape::quadrilateral, Shape::tetrahedron,
                              Shape::prism, Shape::hexahedron}) {
        for (int p = 1; p <= max_degree; ++p) {
            const auto lattice = nestgrid::detail::lattice(shape, p);
            ASSERT_EQ(lattice.size(), nestgrid::detail::lattice_size(shape, p));
            for (const LatticePlace& at : lattice) {
                ASSERT_EQ(nestgrid::detail::lattice_point(shape, at, p),
                          std::size_t(vtk_place(shape, at, p)))
                    << topology(shape).name << ", degree " << p << ": " << at[0] << ' ' << at[1]
                    << ' ' << at[2];
            }
        }
    }
}

/// One cell with random values, by VTK and by the library.
template <int dim, class Cell>
void expect_shape_functions_of(std::size_t points, int degree) {
    vtkNew<Cell> cell;
    cell->GetPoints()->SetNumberOfPoints(vtkIdType(points));
    cell->GetPointIds()->SetNumberOfIds(vtkIdType(points));
    if constexpr (requires { cell->SetUniformOrderFromNumPoints(vtkIdType(points)); }) {
        cell->SetUniformOrderFromNumPoints(vtkIdType(points));
    }
    if constexpr (requires { cell->Initialize(); }) cell->Initialize();
    const double* const places = cell->GetParametricCoords();
    std::vector<double> coordinates(places, places + 3 * points);
    const bool in_box = cell->GetCellType() == 14 || cell->GetCellType() == 27;
    for (std::size_t i = 0; in_box && i < points; ++i) {  // of a pyramid, as x and y below
        for (std::size_t d = 0; d < 2; ++d) coordinates[3 * i + d] *= 1 - coordinates[3 * i + 2];
    }
    const Mesh mesh{.coordinates = coordinates,
                    .types = {std::uint8_t(cell->GetCellType())},
                    .first = {0, std::int64_t(points)},
                    .points = numbers_to(points)};
    const LagrangeGrid<dim> grid(mesh.arrays());
    EXPECT_EQ(grid.kind(0).degree, degree);
    EXPECT_EQ(grid.curved().count, 0U);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<double> values;
    for (std::size_t i = 0; i < points; ++i) values.push_back(uniform(random));
    const LagrangeField<dim> field(grid, values);
    for (int sample = 0; sample < 50; ++sample) {
        std::array<double, 3> x{uniform(random), uniform(random), dim == 3 ? uniform(random) : 0};
        const Shape shape = grid.kind(0).shape;
        const std::array<double, 3> parametric = x;
        if (shape == Shape::pyramid) {  // VTK's coordinates of pyramids are those of a box
            x[0] *= 1 - x[2];
            x[1] *= 1 - x[2];
        } else if (shape != Shape::quadrilateral && shape != Shape::hexahedron) {
            x[1] *= 1 - x[0];
            if (shape == Shape::tetrahedron) x[2] *= 1 - x[0] - x[1];
        }
        std::vector<double> weights(points);
        cell->InterpolateFunctions((shape == Shape::pyramid ? parametric : x).data(),
                                   weights.data());
        double expected = 0;
        for (std::size_t i = 0; i < points; ++i) expected += weights[i] * values[i];
        std::array<double, 1> found{};
        const std::array<Point, 1> at{Point{x[0], x[1], x[2]}};
        field.evaluate(0, at, found);
        ASSERT_NEAR(found[0], expected, 1e-10) << cell->GetClassName();
    }
}

TEST(Lagrange, PolynomialsAreThoseOfVtk) {
    expect_shape_functions_of<2, vtkPixel>(4, 1);
    expect_shape_functions_of<2, vtkQuad>(4, 1);
    expect_shape_functions_of<2, vtkQuadraticQuad>(8, 2);
    expect_shape_functions_of<2, vtkBiQuadraticQuad>(9, 2);
    expect_shape_functions_of<3, vtkVoxel>(8, 1);
    expect_shape_functions_of<3, vtkHexahedron>(8, 1);
    expect_shape_functions_of<3, vtkQuadraticHexahedron>(20, 2);
    expect_shape_functions_of<3, vtkBiQuadraticQuadraticHexahedron>(24, 2);
    expect_shape_functions_of<3, vtkTriQuadraticHexahedron>(27, 2);
    expect_shape_functions_of<2, vtkQuadraticTriangle>(6, 2);
    expect_shape_functions_of<3, vtkQuadraticTetra>(10, 2);
    expect_shape_functions_of<3, vtkQuadraticWedge>(15, 2);
    expect_shape_functions_of<3, vtkBiQuadraticQuadraticWedge>(18, 2);
    expect_shape_functions_of<3, vtkQuadraticLinearWedge>(12, 2);
    expect_shape_functions_of<3, vtkPyramid>(5, 1);
    expect_shape_functions_of<3, vtkQuadraticPyramid>(13, 2);
    for (std::size_t p = 1; p <= max_degree; ++p) {
        expect_shape_functions_of<2, vtkLagrangeTriangle>((p + 1) * (p + 2) / 2, int(p));
        expect_shape_functions_of<3, vtkLagrangeTetra>((p + 1) * (p + 2) * (p + 3) / 6, int(p));
        expect_shape_functions_of<3, vtkLagrangeWedge>((p + 1) * (p + 1) * (p + 2) / 2, int(p));
        expect_shape_functions_of<2, vtkLagrangeQuadrilateral>((p + 1) * (p + 1), int(p));
        expect_shape_functions_of<3, vtkLagrangeHexahedron>((p + 1) * (p + 1) * (p + 1), int(p));
    }
}

double waves(const Point& x) { return std::sin(4 * x[0]) + std::cos(3 * x[1]) * (1 + x[2] * x[2]); }

template <int dim>
Isosurface<dim> draw(const Mesh& mesh, double isovalue, double tolerance, double jump = 1e-12) {
    const LagrangeGrid<dim> grid(mesh.arrays());
    const std::vector<double> values = mesh.sampled(waves);
    const LagrangeField<dim> field(grid, values);
    const HighOrder data(grid, field);
    EXPECT_LE(data.jump(), jump);
    const VirtualRefinement fine(data, {.tolerance = tolerance});
    auto result =
        isosurface<dim>(fine, isovalue, under(fine.criterion(), fine.bounds()), {.verify = true});
    EXPECT_LE(result.error_bound, (tolerance + data.jump()) * (1 + 1e-6));
    return result;
}

template <int dim>
void expect_one_surface(int p) {
    SCOPED_TRACE("dimension " + std::to_string(dim) + ", degree " + std::to_string(p));
    const auto shared = draw<dim>(lagrange_box(dim, 3, p, {}), 0.4, 0.01);
    EXPECT_GT(shared.surface.simplices.size(), 40U);
    expect_closed(shared.surface);
    const auto own = draw<dim>(lagrange_box(dim, 3, p, {.own_points = true}), 0.4, 0.01);
    EXPECT_EQ(own.surface.simplices, shared.surface.simplices);
    EXPECT_EQ(own.surface.vertices, shared.surface.vertices);
    // Places as files of single precision keep them, another rounding for each cell.
    const auto rounded =
        draw<dim>(lagrange_box(dim, 3, p, {.own_points = true, .noise = 1e-7}), 0.4, 0.01, 1e-3);
    expect_closed(rounded.surface);
    EXPECT_EQ(rounded.surface.simplices.size(), shared.surface.simplices.size());
    const auto mirrored =
        draw<dim>(lagrange_box(dim, 3, p, {.own_points = true, .mirrored = true}), 0.4, 0.01);
    expect_closed(mirrored.surface);
}

TEST(Lagrange, PointsMayBeSharedOrEachCellsOwn) {
    for (const int p : {2, 3, 5}) {
        expect_one_surface<2>(p);
        expect_one_surface<3>(p);
    }
}

/// A cube of six quadratic pyramids beside a quadratic hexahedron.
Mesh quadratic_pyramids() {
    Mesh mesh = lagrange_box(3, 1, 2, {.offset = {1, 0, 0}});
    mesh.types = {25};
    mesh.points.resize(20);
    mesh.first = {0, 20};
    for (std::size_t face = 0; face < 6; ++face) {
        std::array<Point, 5> corner;
        for (std::size_t k = 0; k < 4; ++k) {
            corner[k][face / 2] = face % 2 == 0 ? 0 : 1;
            corner[k][(face / 2 + 1) % 3] = k == 1 || k == 2 ? 1 : 0;
            corner[k][(face / 2 + 2) % 3] = k > 1 ? 1 : 0;
        }
        corner[4] = {0.5, 0.5, 0.5};
        std::vector<Point> points(corner.begin(), corner.end());
        for (std::size_t k = 0; k < 4; ++k) {
            points.push_back(0.5 * (corner[k] + corner[(k + 1) % 4]));
        }
        for (std::size_t k = 0; k < 4; ++k) points.push_back(0.5 * (corner[k] + corner[4]));
        Mesh pyramid{.types = {27}, .first = {0, 13}, .points = numbers_to(13)};
        for (const Point& x : points) {
            pyramid.coordinates.insert(pyramid.coordinates.end(), x.begin(), x.end());
        }
        mesh.append(pyramid);
    }
    return mesh;
}

TEST(Lagrange, QuadraticPyramidsMeetHexahedra) {
    const auto mesh = quadratic_pyramids();
    const LagrangeGrid<3> grid(mesh.arrays());
    EXPECT_EQ(grid.greatest_degree(), 2);
    EXPECT_EQ(grid.curved().count, 0U);
    const std::vector<double> values = mesh.sampled([](const Point& x) {
        return x[0] * x[0] + x[1] * x[1] + 2 * x[2] * x[2] + std::sin(3 * x[0] * x[1] * x[2]);
    });
    const LagrangeField<3> field(grid, values);
    const auto violation = check_grid(grid, field);
    EXPECT_FALSE(violation.has_value()) << (violation ? violation->sentence : "");
    const HighOrder data(grid, field);
    EXPECT_LE(data.jump(), 1e-12);
    const VirtualRefinement fine(data, {.tolerance = 0.02});
    const auto result =
        isosurface<3>(fine, 1.4, under(fine.criterion(), fine.bounds()), {.verify = true});
    EXPECT_GT(result.surface.simplices.size(), 100U);
    expect_closed(result.surface);
    EXPECT_LE(result.error_bound, 0.02);
    std::vector<Point> middles;
    for (const auto& simplex : result.surface.simplices) {
        Point& middle = middles.emplace_back(Point{0, 0, 0});
        for (const auto v : simplex) middle = middle + (1.0 / 3) * result.surface.vertices[v];
    }
    const ProbeResult found = probe(data, middles);
    for (std::size_t i = 0; i < middles.size(); ++i) {
        ASSERT_TRUE(found.found(i));
        EXPECT_LE(std::abs(found.values[i] - 1.4), result.error_bound + 1e-6);
    }
}

TEST(Lagrange, NodesApartFromStraightCellsAreTold) {
    const LagrangeGrid<3> straight(lagrange_box(3, 2, 3, {.shear = 0.3}).arrays());
    EXPECT_EQ(straight.curved().count, 0U);
    Mesh mesh = lagrange_box(3, 2, 3, {.own_points = true});
    const std::size_t inner = 8;  // the first inner node of an edge
    mesh.coordinates[3 * inner + 1] += 0.01;
    const LagrangeGrid<3> bent(mesh.arrays());
    EXPECT_EQ(bent.curved().count, 1U);
    EXPECT_NEAR(bent.curved().distance, 0.01, 1e-12);
}

/// A plane in a bent box is bent: closed, and where the cells put it.
TEST(Lagrange, CurvedCellsAreDrawnWhereTheyAre) {
    for (const bool own_points : {false, true}) {
        Mesh mesh = lagrange_box(3, 2, 3, {.own_points = own_points});
        const std::vector<double> heights = mesh.sampled([](const Point& x) { return x[2]; });
        for (std::size_t i = 0; i < mesh.coordinates.size(); i += 3) {
            mesh.coordinates[i + 2] += 0.3 * mesh.coordinates[i] * mesh.coordinates[i];
        }
        const LagrangeGrid<3> grid(mesh.arrays());
        EXPECT_EQ(grid.curved().count, grid.coarse_count());
        const LagrangeField<3> field(grid, heights);
        const auto violation = check_grid(grid, field);
        EXPECT_FALSE(violation.has_value()) << (violation ? violation->sentence : "");
        const HighOrder data(grid, field);
        EXPECT_EQ(data.geometry_degree(), 3);
        EXPECT_LE(data.position_jump(), 1e-12);
        const VirtualRefinement fine(data, {.tolerance = 1, .position_tolerance = 1e-3});
        const auto plane = isosurface<3>(fine, 0.4 * heights.back(),
                                         under(fine.criterion(), fine.bounds()), {.verify = true});
        expect_closed(plane.surface);
        EXPECT_GT(plane.surface.simplices.size(), 100U);
        double off = 0;
        for (const auto& t : plane.surface.simplices) {
            Point x{0, 0, 0};
            for (const auto v : t) x = x + (1.0 / 3) * plane.surface.vertices[v];
            off = std::max(off, std::abs(x[2] - 0.3 * x[0] * x[0] - 0.4 * heights.back()));
        }
        EXPECT_GT(off, 0);
        EXPECT_LE(off, 2e-3);
    }
}

TEST(Lagrange, ValuesOfLinearCellsAreMeansWhereCellsDisagree) {
    const Mesh mesh = lagrange_box(3, 2, 1, {.own_points = true});
    const LagrangeGrid<3> grid(mesh.arrays());
    EXPECT_EQ(grid.vertex_count(), 27U);
    std::vector<double> values = mesh.sampled(waves);
    EXPECT_EQ(LagrangeCornerField<3>(grid, values).jump(), 0);
    values[0] += 1;  // a corner of the box, which has one cell
    EXPECT_EQ(LagrangeCornerField<3>(grid, values).jump(), 0);
    const auto middle = grid.points(0)[grid.kind(0).corner[7]];
    values[middle] += 1;
    EXPECT_NEAR(LagrangeCornerField<3>(grid, values).jump(), 7.0 / 8, 1e-12);
}

/// Empty cells, as ghosts are, and faces, edges and points beside cells in space, as mesh
/// generators write them, are left out wherever they are in the list; sentences name cells by their
/// numbers in it.
TEST(Lagrange, CellsThatAreNotDrawnAreLeftOut) {
    const Mesh good = lagrange_box(3, 2, 2, {});
    Mesh mesh;
    mesh.coordinates = good.coordinates;
    const auto add = [&](std::uint8_t type, const std::vector<std::int64_t>& points) {
        mesh.types.push_back(type);
        mesh.points.insert(mesh.points.end(), points.begin(), points.end());
        mesh.first.push_back(std::int64_t(mesh.points.size()));
    };
    add(1, {0});
    add(21, {0, 1, 2});
    add(5, {0, 1, 2});
    add(7, {0, 1, 2, 3, 4});
    for (std::size_t c = 0; c < good.types.size(); ++c) {
        add(good.types[c],
            {good.points.begin() + good.first[c], good.points.begin() + good.first[c + 1]});
    }
    add(0, {});
    mesh.types[6] = 0;
    EXPECT_EQ(dimension_of(mesh.arrays()), 3);
    const LagrangeGrid<3> grid(mesh.arrays());
    EXPECT_EQ(grid.coarse_count(), 7U);
    EXPECT_EQ(grid.left_out(), 6U);
    const LagrangeGrid<3> all(good.arrays());
    for (std::uint32_t c = 0; c < 7; ++c) {
        const std::uint32_t of_all = c < 2 ? c : c + 1;
        EXPECT_TRUE(std::ranges::equal(grid.points(c), all.points(of_all)));
    }
    Mesh flat;
    flat.coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    flat.types = {1, 10};
    flat.first = {0, 1, 5};
    flat.points = {0, 0, 1, 2, 3};
    expect_refused([&] { LagrangeGrid<3> of(flat.arrays()); }, "cell 1 is flat");
    mesh = good;
    mesh.types = {1, 3};
    mesh.first = {0, 1, 3};
    EXPECT_EQ(dimension_of(mesh.arrays()), 2);
    expect_refused([&] { LagrangeGrid<2> of(mesh.arrays()); }, "there are no cells of dimension 2");
}

template <int dim = 3>
void expect_mesh_refused(const Mesh& mesh, const std::string& words) {
    expect_refused([&] { LagrangeGrid<dim>(mesh.arrays()); }, words);
}

TEST(Lagrange, RefusalsNameTheCell) {
    const Mesh good = lagrange_box(3, 2, 2, {});
    const auto changed = [&](const auto& change) {
        Mesh mesh = good;
        change(mesh);
        return mesh;
    };
    expect_mesh_refused(changed([](Mesh& m) { m.types[3] = 42; }),
                        "cell 3 is of VTK's type 42, which is not drawn");
    expect_mesh_refused(changed([](Mesh& m) { m.types[3] = 71; }),
                        "cell 3, a Lagrange tetrahedron, has 27 points, which no one degree has");
    expect_mesh_refused(changed([](Mesh& m) { m.types[3] = 25; }),
                        "cell 3, a quadratic hexahedron, has 27 points, not 20");
    expect_mesh_refused(changed([](Mesh& m) {
                            m.points.erase(m.points.begin() + 30);
                            for (std::size_t i = 2; i < m.first.size(); ++i) --m.first[i];
                        }),
                        "cell 1, a Lagrange hexahedron, has 26 points, which no one degree has");
    expect_mesh_refused(changed([](Mesh& m) { m.points[100] = 1000; }),
                        "cell 3 names the point 1000, but there are 125");
    expect_mesh_refused(changed([](Mesh& m) { m.coordinates[31] = NAN; }),
                        "point 10 has a coordinate that is not a finite number");
    expect_mesh_refused(changed([](Mesh& m) {
                            m.degrees = {2, 2, 2, 2, 3, 2};
                            m.degrees.resize(24, 2);
                        }),
                        "cell 1 has other degrees in HigherOrderDegrees");
    expect_mesh_refused(lagrange_box(3, 1, 9, {}), "has degree 9; degrees to 8 are drawn");
    expect_mesh_refused<2>(lagrange_box(3, 1, 2, {}),
                           "cell 0 is a hexahedron among cells of dimension 2");
    expect_mesh_refused(lagrange_box(2, 1, 2, {}), "there are no cells of dimension 3");
    Mesh pyramid;
    pyramid.types = {74};
    pyramid.coordinates.resize(42);
    pyramid.first = {0, 14};
    pyramid.points = numbers_to(14);
    expect_mesh_refused(pyramid, "cell 0, a Lagrange pyramid, has degree 2; of pyramids linear");
    expect_mesh_refused(Mesh{}, "there are no cells");
    expect_mesh_refused(beside_halves(3), "a face of cell 0 is divided on its other side");
    expect_mesh_refused<2>(beside_halves(2), "a face of cell 0 is divided");
}

TEST(Lagrange, FacesThatOnlyComeNearAreNotDivided) {
    // Two boxes with a gap, one with smaller cells.
    Mesh mesh = lagrange_box(3, 1, 2, {});
    mesh.append(lagrange_box(3, 2, 2, {.offset = {1.001, 0, 0}}));
    EXPECT_EQ(LagrangeGrid<3>(mesh.arrays()).coarse_count(), 9U);
}

TEST(Lagrange, ValuesThatAreNoNumbersAreRefused) {
    vtkNew<vtkUnstructuredGrid> grid;
    to_vtk(lagrange_box(3, 2, 2, {}), *grid);
    add_values(*grid, "u", [](const Point& x) { return x[0] > 0.9 ? NAN : x[0]; });
    EXPECT_EQ(refusal([&] { vtk_point_values(*grid, "u"); }),
              "'u' is not a finite number at point 28");
    EXPECT_EQ(refusal([&] { vtk_point_values(*grid, "v"); }), "there is no array of points 'v'");
    EXPECT_EQ(refusal([&] { vtk_point_values(*grid, "u", 1); }),
              "'u' has 1 components, and none with number 1");
}

TEST(Lagrange, UnstructuredGridsOfVtkAreTaken) {
    const Mesh mesh = lagrange_box(3, 3, 3, {});
    vtkNew<vtkUnstructuredGrid> grid;
    to_vtk(mesh, *grid);
    add_values(*grid, "u", waves);
    const VtkCells cells(*grid);
    EXPECT_TRUE(std::ranges::equal(cells.arrays().points, mesh.points));
    EXPECT_TRUE(std::ranges::equal(cells.arrays().first, mesh.first));
    EXPECT_TRUE(std::ranges::equal(cells.arrays().types, mesh.types));
    EXPECT_TRUE(std::ranges::equal(cells.arrays().coordinates, mesh.coordinates));
    EXPECT_EQ(vtk_point_values(*grid, "u"), mesh.sampled(waves));
}

}  // namespace
