// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of the bucky ball's samples: how the work grows with the data; beside VTK's cutters on the
// tetrahedra written down, and beside its cutter for images. One process, one thread, in turns,
// medians of processor time; memory is the heap's peak during a call, results included. One "name
// value" line per figure; --quick takes small data.
#include <cmath>
#include <cstdlib>

#include <vtkCompositeDataIterator.h>
#include <vtkCutter.h>
#include <vtkFlyingEdgesPlaneCutter.h>
#include <vtkMultiPieceDataSet.h>
#include <vtkPlane.h>
#include <vtkPlaneCutter.h>
#include <vtkPolyData.h>

#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/slices.hpp>

#include "counted_heap.hpp"
#include "vtk_samples.hpp"

namespace {

using namespace nestgrid;

constexpr double megabyte = 1e6;

void print(const std::string& name, double value) { Contest::print_figure(name, value); }

struct NamedPlane {
    std::string name;
    Point through;
    Point normal;

    Plane ours() const { return {through, normal}; }
    vtkNew<vtkPlane> vtk() const {
        vtkNew<vtkPlane> plane;
        plane->SetOrigin(through[0], through[1], through[2]);
        const Point unit = (1 / norm(normal)) * normal;
        plane->SetNormal(unit[0], unit[1], unit[2]);
        return plane;
    }
};

/// Planes through the middle of n samples along each direction, one of them through nodes.
std::vector<NamedPlane> planes_of(int n) {
    const double m = (n - 1) / 2.0;
    return {{"oblique", {m, m, m + 0.3}, {0.3, 0.5, 0.81}},
            {"between_nodes", {m, m, m + 0.3}, {0, 0, 1}},
            {"through_nodes", {m, m, m}, {0, 0, 1}}};
}

const IsosurfaceOptions indexed{.elements = false};

/// Elements visited at threshold 0 by size, and the slope of their logarithm against that of the
/// number of tetrahedra.
void measure_growth(const std::vector<int>& sizes, std::size_t rounds) {
    std::vector<std::array<double, 2>> visited(3);
    double first_count = 0;
    for (const int n : sizes) {
        const std::vector<float> samples = bucky_ball(n);
        const Tetrahedra grid({.samples = {n, n, n}});
        const Samples field(grid, std::span<const float>(samples));
        const double count = 6 * std::pow(n - 1, 3);
        if (n == sizes.front()) first_count = count;
        const std::string size = "_of_" + std::to_string(n);
        print("tetrahedra" + size, count);
        std::size_t which = 0;
        for (const NamedPlane& plane : planes_of(n)) {
            Slice result;
            Contest contest(rounds, Clock::processor);
            contest.add("slice", [&] { result = slice(grid, field, plane.ours(), {}, indexed); });
            contest.run();
            const auto now = static_cast<double>(result.counts.visited);
            print(plane.name + "_visited" + size, now);
            print(plane.name + "_triangles" + size,
                  static_cast<double>(result.surface.simplices.size()));
            print(plane.name + "_ms" + size, contest.time("slice"));
            print(plane.name + "_ns_per_visited" + size, contest.time("slice") * 1e6 / now);
            std::array<double, 2>& of = visited[which++];
            if (n == sizes.front()) of[0] = now;
            if (n == sizes.back()) {
                print(plane.name + "_slope", std::log(now / of[0]) / std::log(count / first_count));
            }
        }
    }
}

std::size_t cells_of(vtkDataObject* output) {
    if (auto* surface = vtkPolyData::SafeDownCast(output)) {
        return static_cast<std::size_t>(surface->GetNumberOfCells());
    }
    return static_cast<std::size_t>(output->GetNumberOfElements(vtkDataObject::CELL));
}

template <class Filter>
vtkNew<Filter> make_filter(vtkDataSet* data, const NamedPlane& plane) {
    vtkNew<Filter> filter;
    filter->SetInputData(data);
    if constexpr (std::is_same_v<Filter, vtkCutter>) {
        filter->SetCutFunction(plane.vtk());
        filter->GenerateCutScalarsOff();
    } else {
        filter->SetPlane(plane.vtk());
    }
    if constexpr (std::is_same_v<Filter, vtkFlyingEdgesPlaneCutter>) filter->ComputeNormalsOff();
    if constexpr (std::is_same_v<Filter, vtkPlaneCutter>) filter->ComputeNormalsOff();
    return filter;
}

template <class Filter>
void update_anew(Filter* filter) {
    filter->Modified();
    filter->Update();
}

/// The peak of memory of a filter that runs for the first time, and what its output has.
template <class Filter>
void print_first_run(const std::string& name, vtkDataSet* data, const NamedPlane& plane) {
    std::size_t cells = 0;
    std::size_t peak = 0;
    Contest contest(1, Clock::processor);
    contest.add("first", [&] {
        peak = peak_heap_bytes([&] {
            const auto filter = make_filter<Filter>(data, plane);
            filter->Update();
            cells = cells_of(filter->GetOutputDataObject(0));
        });
    });
    contest.run();
    print(name + "_first_ms", contest.time("first"));
    print(name + "_cells", static_cast<double>(cells));
    print(name + "_peak_mb", static_cast<double>(peak) / megabyte);
}

/// Slices by nestgrid in a contest, under the names of the plane.
template <class Grid, class Field>
class OurSlices {
public:
    OurSlices(const Grid& grid, const Field& field, const HierarchicalIndicator& indicator)
        : grid_{&grid}, field_{&field}, indicator_{&indicator} {}

    Slice at(const NamedPlane& plane, double threshold) const {
        const Projection projection = threshold == 0 ? Projection{} : under(*indicator_, threshold);
        return slice(*grid_, *field_, plane.ours(), projection, indexed);
    }
    /// Hands the triangles to a function, and keeps none.
    std::size_t stream(const NamedPlane& plane) const {
        std::size_t count = 0;
        const SimplexStream<3> sink([&](const auto&) { ++count; });
        const Plane function = plane.ours();
        extract_slices({*grid_, *field_}, {{&function}}, std::vector{sink},
                       under(Exact{}, *indicator_), indexed);
        return count;
    }
    void add_to(Contest& contest, const NamedPlane& plane) const {
        contest.add("ours", [this, plane] { at(plane, 0); });
        contest.add("ours_at_0.02", [this, plane] { at(plane, 0.02); });
        contest.add("ours_streamed", [this, plane] { stream(plane); });
    }
    void print_sizes(const std::string& name, const NamedPlane& plane) const {
        std::size_t triangles = 0;
        const auto figures = [&](const std::string& of, const std::function<std::size_t()>& draw) {
            const std::size_t peak = peak_heap_bytes([&] { triangles = draw(); });
            print(name + of + "_triangles", static_cast<double>(triangles));
            print(name + of + "_peak_mb", static_cast<double>(peak) / megabyte);
        };
        figures("ours", [&] { return at(plane, 0).surface.simplices.size(); });
        figures("ours_at_0.02", [&] { return at(plane, 0.02).surface.simplices.size(); });
        figures("ours_streamed", [&] { return stream(plane); });
    }

private:
    const Grid* grid_;
    const Field* field_;
    const HierarchicalIndicator* indicator_;
};

void print_contest(const std::string& name, const Contest& contest,
                   const std::vector<std::string>& ours, const std::vector<std::string>& theirs) {
    for (const auto& each : {ours, theirs}) {
        for (const std::string& one : each) print(name + one + "_ms", contest.time(one));
    }
    for (const std::string& their : theirs) {
        for (const std::string& our : ours) {
            print(name + their + "_over_" + our, contest.time(their) / contest.time(our));
        }
    }
}

const std::vector<std::string> our_names{"ours", "ours_at_0.02", "ours_streamed"};

/// Beside VTK's cutters on the tetrahedra as an unstructured grid.
void compare_tetrahedra(int n, std::size_t rounds) {
    const std::vector<float> samples = bucky_ball(n);
    const Tetrahedra grid({.samples = {n, n, n}});
    const Samples field(grid, std::span<const float>(samples));
    const std::string size = std::to_string(n) + "_";
    Contest preroll(rounds, Clock::processor);
    preroll.add("preroll", [&] { HierarchicalIndicator(grid, field); });
    preroll.run();
    print(size + "preroll_ms", preroll.time("preroll"));
    const std::size_t before = heap_bytes();
    const HierarchicalIndicator indicator(grid, field);
    print(size + "indicator_mb", static_cast<double>(heap_bytes() - before) / megabyte);
    vtkSmartPointer<vtkUnstructuredGrid> written;
    Contest writing(1, Clock::processor);
    const std::size_t without = heap_bytes();
    writing.add("written", [&] { written = make_unstructured(grid, field, samples).Get(); });
    writing.run();
    print(size + "written_grid_made_ms", writing.time("written"));
    print(size + "written_grid_mb", static_cast<double>(heap_bytes() - without) / megabyte);
    const OurSlices ours(grid, field, indicator);
    for (const NamedPlane& plane : planes_of(n)) {
        const std::string name = size + plane.name + "_";
        ours.print_sizes(name, plane);
        print_first_run<vtkCutter>(name + "cutter", written, plane);
        print_first_run<vtkPlaneCutter>(name + "plane_cutter", written, plane);
        const auto cutter = make_filter<vtkCutter>(written, plane);
        const auto plane_cutter = make_filter<vtkPlaneCutter>(written, plane);
        plane_cutter->Update();  // builds its tree
        Contest contest(rounds, Clock::processor);
        ours.add_to(contest, plane);
        contest.add("cutter", [&] { update_anew(cutter.Get()); });
        contest.add("plane_cutter", [&] { update_anew(plane_cutter.Get()); });
        contest.run();
        print_contest(name, contest, our_names, {"cutter", "plane_cutter"});
    }
}

/// The samples as an octree beside VTK's cutters for images.
void compare_image(int n, std::size_t rounds) {
    const std::vector<float> samples = bucky_ball(n);
    const LatticeOctree<3> octree({.samples = {n, n, n}});
    const LatticeField field(octree, std::span<const float>(samples));
    const HierarchicalIndicator indicator(octree, field);
    const vtkNew<vtkImageData> image = make_image(samples, n);
    const OurSlices ours(octree, field, indicator);
    for (const NamedPlane& plane : planes_of(n)) {
        const std::string name = "image_" + std::to_string(n) + "_" + plane.name + "_";
        ours.print_sizes(name, plane);
        print_first_run<vtkFlyingEdgesPlaneCutter>(name + "flying_edges", image, plane);
        const auto edges = make_filter<vtkFlyingEdgesPlaneCutter>(image, plane);
        Contest contest(3 * rounds, Clock::processor);
        ours.add_to(contest, plane);
        contest.add("flying_edges", [&] { update_anew(edges.Get()); });
        contest.run();
        print_contest(name, contest, our_names, {"flying_edges"});
        print(name + "ours_over_flying_edges", contest.time("ours") / contest.time("flying_edges"));
        print(name + "ours_streamed_over_flying_edges",
              contest.time("ours_streamed") / contest.time("flying_edges"));
    }
}

}  // namespace

int main(int argc, char** argv) {
    setenv("VTK_SMP_MAX_THREADS", "1", 1);  // read when VTK first looks for threads
    const bool quick = is_quick(argc, argv);
    const std::size_t rounds = quick ? 1 : 7;
    measure_growth(quick ? std::vector{9, 17, 33} : std::vector{33, 65, 129, 257}, rounds);
    for (const int n : quick ? std::vector{17} : std::vector{65, 129}) {
        compare_tetrahedra(n, rounds);
    }
    compare_image(quick ? 33 : 129, rounds);
    return 0;
}
