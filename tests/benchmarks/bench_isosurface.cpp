// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The isosurface of the bucky ball, by nestgrid, by a recursion written by hand for this one grid,
// and by what users would take instead: VTK's filters for images and for unstructured tetrahedra,
// and OpenVDB. All in one process and on one thread, in turns, medians; what each prepares once per
// data is reported apart. One "name value" line per figure; --quick takes 33^3 samples instead of
// 129^3.
#include <cstdlib>

#include <vtkContour3DLinearGrid.h>
#include <vtkContourGrid.h>
#include <vtkFlyingEdges3D.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSpanSpace.h>
#include <vtkSynchronizedTemplates3D.h>

#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>

#ifdef NESTGRID_WITH_OPENVDB
#include "openvdb_mesh.hpp"
#endif

#include "bucky_samples.hpp"
#include "vtk_samples.hpp"

namespace {

using nestgrid::HierarchicalIndicator;

/// Runs a contour filter of VTK anew.
template <class Filter>
std::size_t contour(Filter* filter, double isovalue) {
    filter->SetValue(0, isovalue);
    filter->Modified();
    filter->Update();
    return static_cast<std::size_t>(
        vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfCells());
}

template <class Filter>
void set_up(Filter* filter, vtkDataSet* data) {
    filter->SetInputData(data);
    filter->ComputeNormalsOff();
    filter->ComputeScalarsOff();
}

template <int n>
void compare(std::size_t rounds) {
    const auto print = [](const std::string& name, double value) {
        Contest::print_figure(name, value);
    };
    Bucky<n> bucky;
    const vtkNew<vtkImageData> image = make_image(bucky.samples, n);
    vtkNew<vtkFlyingEdges3D> flying_edges;
    vtkNew<vtkSynchronizedTemplates3D> templates;
    set_up(flying_edges.Get(), image);
    set_up(templates.Get(), image);
    flying_edges->ComputeGradientsOff();
    templates->ComputeGradientsOff();

    using Hexahedra = nestgrid::LatticeOctree<3>;
    const Hexahedra octree({.samples = {n, n, n}});
    const nestgrid::LatticeField octree_field(octree, std::span<const float>(bucky.samples));
    const HierarchicalIndicator octree_indicator(octree, octree_field);

    const nestgrid::IsosurfaceOptions indexed{.elements = false};
    std::size_t triangles = 0;
    std::size_t flying_edges_triangles = 0;
    Contest on_image(rounds);
    on_image.add("preroll", [&] { HierarchicalIndicator(bucky.grid, bucky.field); });
    on_image.add("handwritten", [&] { bucky.handwritten(0); });
    on_image.add("soup", [&] { triangles = bucky.draw_soup(bucky.grid, bucky.field, 0); });
    on_image.add("indexed", [&] {
        isosurface(bucky.grid, bucky.field, double{bucky_isovalue}, under(bucky.indicator, 0),
                   indexed);
    });
    nestgrid::IsosurfaceSeries series(bucky.grid, bucky.field);
    on_image.add("indexed_again", [&] { series.draw(double{bucky_isovalue}, {}, indexed); });
    BuckySamples padded(n - 1);
    on_image.add("padded_preroll", [&] { HierarchicalIndicator(padded.grid, padded.field); });
    on_image.add("padded_soup", [&] { padded.draw_soup(padded.grid, padded.field, 0); });
    on_image.add("padded_indexed", [&] {
        isosurface(padded.grid, padded.field, double{bucky_isovalue}, under(padded.indicator, 0),
                   indexed);
    });
    on_image.add("hexahedra_indexed", [&] {
        isosurface(octree, octree_field, double{bucky_isovalue}, under(octree_indicator, 0),
                   indexed);
    });
    on_image.add("flying_edges", [&] {
        flying_edges_triangles = contour(flying_edges.Get(), double{bucky_isovalue});
    });
    on_image.add("synchronized_templates",
                 [&] { contour(templates.Get(), double{bucky_isovalue}); });
#ifdef NESTGRID_WITH_OPENVDB
    const OpenVdbVolume volume(bucky.samples, n);
    std::size_t openvdb_triangles = 0;
    on_image.add("openvdb", [&] { openvdb_triangles = volume.mesh(double{bucky_isovalue}); });
#endif
    on_image.run();
    print("triangles", static_cast<double>(triangles));
    print("flying_edges_triangles", static_cast<double>(flying_edges_triangles));
    on_image.print_times();
    const auto ratio = [&](const char* a, const char* b) {
        return on_image.time(a) / on_image.time(b);
    };
    print("soup_over_handwritten", ratio("soup", "handwritten"));
    print("padded_soup_over_soup", ratio("padded_soup", "soup"));
    print("padded_indexed_over_indexed", ratio("padded_indexed", "indexed"));
    print("soup_over_flying_edges", ratio("soup", "flying_edges"));
    print("indexed_over_flying_edges", ratio("indexed", "flying_edges"));
    print("indexed_again_over_flying_edges", ratio("indexed_again", "flying_edges"));
    print("synchronized_templates_over_ours", ratio("synchronized_templates", "indexed"));
    print("preroll_ms_over_flying_edges_ms", ratio("preroll", "flying_edges"));
#ifdef NESTGRID_WITH_OPENVDB
    print("openvdb_triangles", static_cast<double>(openvdb_triangles));
    print("openvdb_over_ours", ratio("openvdb", "indexed"));
    print("openvdb_over_soup", ratio("openvdb", "soup"));
#endif

    // A small surface in large data: a sphere around the middle.
    {
        std::vector<float> distance(bucky.samples.size());
        for (std::size_t i = 0; i < distance.size(); ++i) {
            const nestgrid::Point x = bucky.grid.node_position(i);
            double sum = 0;
            for (const double c : x) sum += (c / (n - 1) - 0.5) * (c / (n - 1) - 0.5);
            distance[i] = static_cast<float>(std::sqrt(sum));
        }
        const Samples field(bucky.grid, std::span<const float>(distance));
        const HierarchicalIndicator indicator(bucky.grid, field);
        const vtkNew<vtkImageData> sphere = make_image(distance, n);
        vtkNew<vtkFlyingEdges3D> edges;
        set_up(edges.Get(), sphere);
        edges->ComputeGradientsOff();
        Contest small(3 * rounds);
        small.add("small_flying_edges", [&] { contour(edges.Get(), 0.05); });
        nestgrid::TraversalCounts counts;
        const std::array<double, 4> radii{0.02, 0.05, 0.15, 0.45};
        const auto name = [](double radius) { return "small_" + std::to_string(radius); };
        const auto draw = [&](double radius) {
            return [&, radius] {
                counts = isosurface(bucky.grid, field, radius, under(indicator, 0), indexed).counts;
            };
        };
        for (const double radius : radii) small.add(name(radius), draw(radius));
        small.add("small_soup",
                  [&] { bucky.draw_soup_of(bucky.grid, field, indicator, 0.05, 0.0F); });
        small.run();
        print("flying_edges_over_ours", small.time("small_flying_edges") / small.time(name(0.05)));
        print("flying_edges_over_soup",
              small.time("small_flying_edges") / small.time("small_soup"));
        for (const double radius : radii) {
            Contest alone(3 * rounds);  // as in a series; above, other data are in the caches
            alone.add(name(radius), draw(radius));
            alone.run();
            const std::string at = "_at_radius_" + std::to_string(radius).substr(0, 4);
            const double ns_per_visited = 1e6 / static_cast<double>(counts.visited);
            print("ns_per_visited_alone" + at, alone.time(name(radius)) * ns_per_visited);
            print("ns_per_visited_in_turns" + at, small.time(name(radius)) * ns_per_visited);
        }
    }

    // The same tetrahedra, written down.
    const auto start = std::chrono::steady_clock::now();
    const vtkNew<vtkUnstructuredGrid> tetrahedra =
        make_unstructured(bucky.grid, bucky.field, bucky.samples);
    const std::chrono::duration<double, std::milli> made = std::chrono::steady_clock::now() - start;
    print("unstructured_tetrahedra", static_cast<double>(tetrahedra->GetNumberOfCells()));
    print("unstructured_making_ms", made.count());
    vtkNew<vtkContour3DLinearGrid> linear;
    linear->SetInputData(tetrahedra);
    linear->MergePointsOn();
    linear->ComputeScalarsOff();
    linear->SequentialProcessingOn();
    vtkNew<vtkContour3DLinearGrid> with_tree;
    with_tree->SetInputData(tetrahedra);
    with_tree->MergePointsOn();
    with_tree->ComputeScalarsOff();
    with_tree->SequentialProcessingOn();
    vtkNew<vtkSpanSpace> tree;
    with_tree->SetScalarTree(tree);
    with_tree->UseScalarTreeOn();
    vtkNew<vtkContourGrid> grid_filter;
    grid_filter->SetInputData(tetrahedra);
    grid_filter->ComputeNormalsOff();
    grid_filter->ComputeScalarsOff();
    Contest tree_making(1);
    tree_making.add("spanspace_first_call",
                    [&] { contour(with_tree.Get(), double{bucky_isovalue}); });
    tree_making.run();
    tree_making.print_times();
    Contest unstructured(std::max<std::size_t>(3, rounds / 3));
    unstructured.add("ours", [&] {
        isosurface(bucky.grid, bucky.field, double{bucky_isovalue}, under(bucky.indicator, 0),
                   indexed);
    });
    std::size_t linear_triangles = 0;
    unstructured.add("contour3dlineargrid",
                     [&] { linear_triangles = contour(linear.Get(), double{bucky_isovalue}); });
    unstructured.add("contour3dlineargrid_spanspace",
                     [&] { contour(with_tree.Get(), double{bucky_isovalue}); });
    unstructured.add("soup_ours", [&] { bucky.draw_soup(bucky.grid, bucky.field, 0.0F); });
    unstructured.add("contour3dlineargrid_spanspace_soup", [&] {
        with_tree->MergePointsOff();
        contour(with_tree.Get(), double{bucky_isovalue});
        with_tree->MergePointsOn();
    });
    unstructured.add("contourgrid", [&] { contour(grid_filter.Get(), double{bucky_isovalue}); });
    unstructured.run();
    unstructured.print_times();
    print("contour3dlineargrid_triangles", static_cast<double>(linear_triangles));
    for (const char* name :
         {"contour3dlineargrid", "contour3dlineargrid_spanspace", "contourgrid"}) {
        print(std::string(name) + "_over_ours",
              unstructured.time(name) / unstructured.time("ours"));
        print(std::string(name) + "_over_soup",
              unstructured.time(name) / unstructured.time("soup_ours"));
    }
    print("contour3dlineargrid_spanspace_soup_over_ours",
          unstructured.time("contour3dlineargrid_spanspace_soup") / unstructured.time("soup_ours"));
}

}  // namespace

int main(int argc, char** argv) {
    setenv("VTK_SMP_MAX_THREADS", "1", 1);  // read when VTK first looks for threads
    at_either_size(argc, argv, 9, [](auto n, std::size_t rounds) { compare<n.value>(rounds); });
    return 0;
}
