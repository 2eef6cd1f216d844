// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The same level sets on the same adaptive meshes of hexahedra with hanging nodes: ours, VTK's
// contour of the leaves as an unstructured grid, and deal.II's MarchingCubeAlgorithm where the
// package was found. Prints the table of docs/beside_others.md.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <random>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkContourFilter.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#ifdef NESTGRID_WITH_DEAL_II
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/vector.h>
#endif

#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <walk/walk.hpp>

#include "open_edges.hpp"
#include "sample_grids.hpp"

using namespace nestgrid;

namespace {

constexpr int coarse = 4;  // elements along each direction

using Grid = OctreeGrid<3>;
using Clock = std::chrono::steady_clock;

struct Timed {
    double preparation = 0;
    double seconds = 0;
};

/// Median of three runs.
double time_of(const std::function<void()>& run) {
    std::array<double, 3> seconds{};
    for (double& s : seconds) {
        const auto start = Clock::now();
        run();
        s = std::chrono::duration<double>(Clock::now() - start).count();
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds[1];
}

/// Leaves with the values of a continuous function, hanging nodes interpolated.
struct Leaves {
    std::vector<Point> nodes;
    std::vector<double> values;
    std::vector<std::array<std::size_t, 8>> hexahedra;
    std::map<std::pair<Point, int>, std::size_t> by_centre;  // and level
};

class Collect final : public engine::Visitor<double> {
public:
    using View = engine::ElementView<double>;

    Collect(const engine::Walk<double>& walk, Leaves& leaves) : walk_{&walk}, leaves_{&leaves} {}

    engine::Decision inspect(const View&, const engine::Split&) override { return {}; }
    void extract(const View& view) override {
        std::array<NodeKey, max_corners> key;
        std::array<Point, max_corners> x;
        walk_->corners(view, key.data(), x.data());
        std::array<std::size_t, 8> corners;
        Point centre{0, 0, 0};
        for (std::size_t i = 0; i < 8; ++i) {
            const auto [at, is_new] = number_.insert({key[i], leaves_->nodes.size()});
            corners[i] = at->second;
            centre = centre + 0.125 * x[i];
            if (!is_new) continue;
            leaves_->nodes.push_back(x[i]);
            leaves_->values.push_back(view.value[i]);
        }
        leaves_->by_centre[{centre, view.level}] = leaves_->hexahedra.size();
        leaves_->hexahedra.push_back(corners);
    }

private:
    const engine::Walk<double>* walk_;
    Leaves* leaves_;
    std::map<NodeKey, std::size_t> number_;
};

void print(const char* mesh, const char* field, const char* by, const EdgeCount& row,
           const Timed& t) {
    std::printf("| %s | %s | %s | %zu | %zu | %zu | %.3f | %.3f |\n", mesh, field, by,
                row.triangles, row.open, row.nonmanifold, t.preparation, t.seconds);
}

void run_ours(const char* mesh, const char* name, const Grid& grid,
              const std::vector<double>& values) {
    const NodeField<Grid, double> field(grid, values);
    std::optional<HierarchicalIndicator> indicator;
    const double preparation = time_of([&] { indicator.emplace(grid, field); });
    const double range = indicator->greatest() - indicator->least();
    for (const double threshold : {0.0, 0.02 * range}) {
        Surface<3> surface;
        const double seconds = time_of(
            [&] { surface = isosurface(grid, field, 0.0, under(*indicator, threshold)).surface; });
        Triangles triangles;
        for (const auto& t : surface.simplices) triangles.push_back({t[0], t[1], t[2]});
        print(mesh, name, threshold == 0 ? "nestgrid" : "nestgrid, 2 %",
              count_edges(surface.vertices, triangles), {preparation, seconds});
    }
}

void run_vtk(const char* mesh, const char* name, const Leaves& leaves) {
    vtkNew<vtkUnstructuredGrid> grid;
    const double preparation = time_of([&] {
        vtkNew<vtkPoints> points;
        points->SetDataTypeToDouble();
        for (const Point& x : leaves.nodes) points->InsertNextPoint(x.data());
        vtkNew<vtkDoubleArray> values;
        values->SetName("U");
        for (const double v : leaves.values) values->InsertNextValue(v);
        vtkNew<vtkCellArray> cells;
        for (const auto& h : leaves.hexahedra) {
            std::array<vtkIdType, 8> ids;
            for (std::size_t i = 0; i < 8; ++i) {
                constexpr std::array<std::size_t, 8> order{0, 1, 3, 2, 4, 5, 7, 6};
                ids[i] = static_cast<vtkIdType>(h[order[i]]);
            }
            cells->InsertNextCell(8, ids.data());
        }
        grid->SetPoints(points);
        grid->SetCells(VTK_HEXAHEDRON, cells);
        grid->GetPointData()->SetScalars(values);
    });
    vtkNew<vtkContourFilter> contour;
    contour->SetInputData(grid);
    contour->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    contour->ComputeNormalsOff();
    contour->SetValue(0, 0.0);
    const double seconds = time_of([&] {
        contour->Modified();
        contour->Update();
    });
    std::vector<Point> vertices;
    Triangles triangles;
    vtkPolyData* surface = contour->GetOutput();
    for (vtkIdType v = 0; v < surface->GetNumberOfPoints(); ++v) {
        vertices.emplace_back();
        surface->GetPoint(v, vertices.back().data());
    }
    vtkNew<vtkIdList> ids;
    for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c) {
        surface->GetCellPoints(c, ids);
        const auto id = [&](vtkIdType i) { return static_cast<std::size_t>(ids->GetId(i)); };
        triangles.push_back({id(0), id(1), id(2)});
    }
    print(mesh, name, "VTK", count_edges(vertices, triangles), {preparation, seconds});
}

#ifdef NESTGRID_WITH_DEAL_II
void run_deal_ii(const char* mesh, const char* name, const Leaves& leaves) {
    dealii::Triangulation<3> grid;
    dealii::GridGenerator::subdivided_hyper_cube(grid, coarse);
    for (bool refined = true; refined;) {
        refined = false;
        for (const auto& cell : grid.active_cell_iterators()) {
            const auto c = cell->center();
            if (leaves.by_centre.count({Point{c[0], c[1], c[2]}, cell->level()}) != 0) continue;
            cell->set_refine_flag();
            refined = true;
        }
        if (refined) grid.execute_coarsening_and_refinement();
    }
    if (grid.n_active_cells() != leaves.hexahedra.size()) {
        throw GridError("deal.II has other cells");
    }
    const dealii::FE_Q<3> element(1);
    const dealii::MappingQ<3> mapping(1);
    dealii::DoFHandler<3> dofs(grid);
    dofs.distribute_dofs(element);
    std::map<Point, double> value_at;
    for (std::size_t i = 0; i < leaves.nodes.size(); ++i) {
        value_at[leaves.nodes[i]] = leaves.values[i];
    }
    std::vector<dealii::Point<3>> support(dofs.n_dofs());
    dealii::DoFTools::map_dofs_to_support_points(mapping, dofs, support);
    dealii::Vector<double> values(dofs.n_dofs());
    for (unsigned i = 0; i < support.size(); ++i) {
        values[i] = value_at.at({support[i][0], support[i][1], support[i][2]});
    }
    std::vector<dealii::Point<3>> vertices;
    std::vector<dealii::CellData<2>> cells;
    const dealii::GridTools::MarchingCubeAlgorithm<3, dealii::Vector<double>> algorithm(mapping,
                                                                                        element);
    const double seconds = time_of([&] {
        vertices.clear();
        cells.clear();
        algorithm.process(dofs, values, 0.0, vertices, cells);
    });
    std::vector<Point> points;
    for (const auto& x : vertices) points.push_back({x[0], x[1], x[2]});
    Triangles triangles;
    for (const auto& cell : cells) {
        triangles.push_back({cell.vertices[0], cell.vertices[1], cell.vertices[2]});
    }
    merge(points, triangles);
    print(mesh, name, "deal.II", count_edges(points, triangles), {0, seconds});
}
#endif

void run(const char* mesh, const Grid& grid) {
    std::mt19937 random(1);
    const std::vector<std::pair<const char*, std::function<double(const Point&)>>> fields{
        {"sphere",
         [](const Point& x) {
             return 0.36 - norm(x - Point{0.51, 0.49, 0.5});
         }},
        {"gyroid",
         [](const Point& x) {
             const auto [a, b, c] = 15.0 * x;
             return std::sin(a) * std::cos(b) + std::sin(b) * std::cos(c) +
                    std::sin(c) * std::cos(a) + 1e-3;
         }},
        {"noise", [&](const Point&) { return static_cast<double>(random()) / 4294967296.0 - 0.5; }},
        {"integers -1, 0, 1",
         [&](const Point&) { return static_cast<double>(random() % 3) - 1.0; }},
    };
    for (const auto& [name, f] : fields) {
        std::vector<double> values;
        for (const Point& x : grid.node_positions()) values.push_back(f(x));
        const NodeField<Grid, double> field(grid, values);
        Leaves leaves;
        const auto hierarchy = erase(grid, field);
        const engine::Walk<double> walk(hierarchy, {.keys = true, .positions = true});
        Collect collect(walk, leaves);
        walk.run(collect);
        run_ours(mesh, name, grid, values);
        run_vtk(mesh, name, leaves);
#ifdef NESTGRID_WITH_DEAL_II
        run_deal_ii(mesh, name, leaves);
#endif
    }
}

/// \param refine whether to refine a leaf, once per leaf and round
Grid refined(int rounds, const std::function<bool(const Leaf&)>& refine) {
    Grid grid(nestgrid_test::hexahedra(coarse), {.balanced = true});
    for (int i = 0; i < rounds; ++i) {
        grid.adapt([&](const Leaf& leaf) { return refine(leaf) ? Mark::refine : Mark::keep; });
    }
    return grid;
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
    const int rounds = quick ? 2 : 4;
    std::printf(
        "| mesh | field | by | triangles | open edges | edges of more than two | "
        "preparation, s | extraction, s |\n|---|---|---|---|---|---|---|---|\n");
    const auto at_sphere = refined(rounds, [](const Leaf& leaf) {
        int inside = 0;
        for (const Point& x : leaf.corners) inside += norm(x - Point{0.51, 0.49, 0.5}) < 0.36;
        return inside != 0 && inside != static_cast<int>(leaf.corners.size());
    });
    run("at a sphere", at_sphere);
    std::mt19937 random(2);
    const auto scattered = refined(rounds, [&](const Leaf&) { return random() % 5 == 0; });
    run("scattered", scattered);
    std::printf("\nhexahedra: %zu at a sphere, %zu scattered\n", at_sphere.leaf_count(),
                scattered.leaf_count());
    return 0;
}
