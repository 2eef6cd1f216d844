// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver_slices.hpp"

#include <optional>

#include <vtkCellArray.h>
#include <vtkCompositeDataIterator.h>
#include <vtkContourFilter.h>
#include <vtkCutter.h>
#include <vtkDoubleArray.h>
#include <vtkMultiPieceDataSet.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPlaneCutter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/surface_isolines.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <walk/project.hpp>

#include "contest.hpp"
#include "counted_heap.hpp"

namespace {

using nestgrid::HierarchicalIndicator;
using nestgrid::Hierarchy;
using nestgrid::norm;
using nestgrid::Point;
using nestgrid::Shape;
using nestgrid::operator*;
using nestgrid::operator+;
using nestgrid::operator-;

constexpr int isoline_count = 9;

void print(const std::string& name, double value) { Contest::print_figure(name, value); }
void print(const std::string& name, std::size_t value) { print(name, static_cast<double>(value)); }
void print_megabytes(const std::string& name, std::size_t bytes) {
    print(name + "_mb", static_cast<double>(bytes) / 1e6);
}

/// The leaves with the values at their corners, a point for each node, as VTK numbers corners.
/// \throw nestgrid::InvalidInput for other shapes than tetrahedra and hexahedra
vtkSmartPointer<vtkUnstructuredGrid> write_leaves(const Hierarchy<double>& hierarchy,
                                                  const HierarchicalIndicator& indicator) {
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    const vtkNew<vtkDoubleArray> u;
    u->SetName("u");
    const vtkNew<vtkUnstructuredGrid> leaves;
    leaves->Allocate();
    nestgrid::KeyTable<nestgrid::NodeKey, vtkIdType> number;
    const nestgrid::engine::Walk<double> walk(hierarchy, {.positions = true}, indicator.hanging());
    nestgrid::engine::project(walk, nestgrid::Exact{}, [&](const auto& view) {
        std::array<nestgrid::NodeKey, nestgrid::max_corners> key;
        std::array<Point, nestgrid::max_corners> x;
        walk.corners(view, key.data(), x.data());
        std::array<vtkIdType, nestgrid::max_corners> corner{};
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            const auto [known, is_new] = number.insert(key[k], points->GetNumberOfPoints());
            corner[k] = *known;
            if (!is_new) continue;
            points->InsertNextPoint(x[k].data());
            u->InsertNextValue(view.value[k * walk.components()]);
        }
        if (view.shape == Shape::tetrahedron) {
            if (view.orientation < 0) std::swap(corner[0], corner[1]);
            leaves->InsertNextCell(VTK_TETRA, 4, corner.data());
        } else if (view.shape == Shape::hexahedron) {
            std::swap(corner[2], corner[3]);
            std::swap(corner[6], corner[7]);
            leaves->InsertNextCell(VTK_HEXAHEDRON, 8, corner.data());
        } else {
            throw nestgrid::InvalidInput("leaves are written as tetrahedra and hexahedra");
        }
    });
    leaves->SetPoints(points);
    leaves->GetPointData()->SetScalars(u);
    leaves->Squeeze();
    return leaves;
}

struct NamedPlane {
    std::string name;
    Point through;
    Point normal;
};

/// The parts of a slice by one of VTK's cutters.
std::vector<vtkPolyData*> parts_of(vtkDataObject* output) {
    if (auto* whole = vtkPolyData::SafeDownCast(output)) return {whole};
    std::vector<vtkPolyData*> parts;
    const auto all =
        vtk::TakeSmartPointer(vtkCompositeDataSet::SafeDownCast(output)->NewIterator());
    for (all->InitTraversal(); !all->IsDoneWithTraversal(); all->GoToNextItem()) {
        parts.push_back(vtkPolyData::SafeDownCast(all->GetCurrentDataObject()));
    }
    return parts;
}

template <class Filter>
vtkSmartPointer<Filter> make_cutter(vtkUnstructuredGrid* leaves, const NamedPlane& at) {
    const vtkNew<vtkPlane> plane;
    plane->SetOrigin(at.through.data());
    const Point unit = (1 / norm(at.normal)) * at.normal;
    plane->SetNormal(unit.data());
    const vtkNew<Filter> filter;
    filter->SetInputData(leaves);
    if constexpr (std::is_same_v<Filter, vtkCutter>) {
        filter->SetCutFunction(plane);
        filter->GenerateCutScalarsOff();
        filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    } else {
        filter->SetPlane(plane);
        filter->ComputeNormalsOff();
    }
    return filter.Get();
}

/// Isolines on a slice by VTK.
std::vector<vtkSmartPointer<vtkPolyData>> contour(const std::vector<vtkPolyData*>& parts,
                                                  const std::vector<double>& values) {
    std::vector<vtkSmartPointer<vtkPolyData>> lines;
    for (vtkPolyData* part : parts) {
        const vtkNew<vtkContourFilter> filter;
        part->GetPointData()->SetActiveScalars("u");
        filter->SetInputData(part);
        for (std::size_t i = 0; i < values.size(); ++i) {
            filter->SetValue(static_cast<int>(i), values[i]);
        }
        filter->Update();
        lines.emplace_back(filter->GetOutput());
    }
    return lines;
}

/// Adds the points of a part. \return how many there were before
std::size_t add_points(std::vector<Point>& to, vtkPolyData* part) {
    const std::size_t before = to.size();
    for (vtkIdType v = 0; v < part->GetNumberOfPoints(); ++v) {
        part->GetPoint(v, to.emplace_back().data());
    }
    return before;
}

ColouredTriangles triangles_of(const std::vector<vtkPolyData*>& parts) {
    ColouredTriangles all;
    for (vtkPolyData* part : parts) {
        const std::size_t before = add_points(all.vertices, part);
        vtkDataArray* const u = part->GetPointData()->GetArray("u");
        for (vtkIdType v = 0; v < part->GetNumberOfPoints(); ++v) {
            all.values.push_back(u->GetTuple1(v));
        }
        vtkIdType n = 0;
        const vtkIdType* corner = nullptr;
        vtkCellArray* const cells = part->GetPolys();
        for (cells->InitTraversal(); cells->GetNextCell(n, corner) != 0;) {
            const auto at = [&](vtkIdType i) {
                return before + static_cast<std::size_t>(corner[i]);
            };
            for (vtkIdType i = 2; i < n; ++i) all.triangles.push_back({at(0), at(i - 1), at(i)});
        }
    }
    return all;
}

Segments segments_of(const std::vector<vtkSmartPointer<vtkPolyData>>& parts) {
    Segments all;
    for (const auto& part : parts) {
        const std::size_t before = add_points(all.vertices, part);
        vtkIdType n = 0;
        const vtkIdType* point = nullptr;
        vtkCellArray* const cells = part->GetLines();
        for (cells->InitTraversal(); cells->GetNextCell(n, point) != 0;) {
            const auto at = [&](vtkIdType i) {
                return before + static_cast<std::size_t>(point[i]);
            };
            for (vtkIdType i = 1; i < n; ++i) all.segments.push_back({at(i - 1), at(i)});
        }
    }
    return all;
}

ColouredTriangles triangles_of(const nestgrid::Surface<3>& surface) {
    ColouredTriangles all{surface.vertices, surface.attributes, {}};
    for (const auto& t : surface.simplices) all.triangles.push_back({t[0], t[1], t[2]});
    return all;
}

Segments segments_of(const nestgrid::Polylines& lines) {
    Segments all{lines.vertices, {}};
    for (std::size_t i = 0; i < lines.count(); ++i) {
        const auto line = lines.line(i);
        for (std::size_t k = 1; k < line.size(); ++k)
            all.segments.push_back({line[k - 1], line[k]});
    }
    return all;
}

/// The contestants on one solution.
class Measurement {
public:
    Measurement(const SolverCase& solver, const Hierarchy<double>& hierarchy)
        : solver_{&solver}, hierarchy_{&hierarchy}, rounds_{solver.quick ? 1U : 7U} {
        const std::size_t before = heap_bytes();
        time_once("_preroll", [&] { indicator_.emplace(hierarchy); });
        print_megabytes(solver.name + "_indicator", heap_bytes() - before);
        time_once("_position_bounds", [&] { bounds_ = position_bounds(hierarchy); });
        const std::size_t without = heap_bytes();
        time_once("_leaves_written", [&] { leaves_ = write_leaves(hierarchy, *indicator_); });
        print_megabytes(solver.name + "_written_leaves", heap_bytes() - without);
        print(solver.name + "_leaves", static_cast<std::size_t>(leaves_->GetNumberOfCells()));
        std::array<double, 2> range{};
        leaves_->GetPointData()->GetArray("u")->GetRange(range.data());
        range_ = range[1] - range[0];
        for (int i = 1; i <= isoline_count; ++i) {
            values_.push_back(range[0] + i * range_ / (isoline_count + 1));
        }
    }

    std::vector<NamedPlane> planes() const {
        std::array<double, 6> box{};
        leaves_->GetBounds(box.data());
        const Point middle{(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2};
        return {{"oblique", middle + Point{0.011, 0.007, 0.013}, {0.3, 0.5, 0.81}},
                {"through_nodes", middle, {1, 1, 1}}};
    }

    void compare(const NamedPlane& plane) const {
        judge(plane);
        const auto name = [&](const std::string& who) {
            return solver_->name + "_" + plane.name + "_" + who;
        };
        Contest contest(rounds_, Clock::processor);
        const auto drawn = ours(plane, 0);
        const auto cut = make_cutter<vtkCutter>(leaves_, plane);
        const auto plane_cut = make_cutter<vtkPlaneCutter>(leaves_, plane);
        plane_cut->Update();  // builds its tree
        cut->Update();
        contest.add("ours_slice", [&] { ours(plane, 0); });
        contest.add("ours_at_1_percent_slice", [&] { ours(plane, range_ / 100); });
        contest.add("ours_without_position_bounds_slice", [&] { ours(plane, 0, false); });
        contest.add("cutter_slice", [&] { update_anew(cut.Get()); });
        contest.add("plane_cutter_slice", [&] { update_anew(plane_cut.Get()); });
        contest.add("ours_isolines", [&] { isolines(drawn.surface, 0, values_); });
        contest.add("cutter_isolines", [&] { contour(parts_of(cut->GetOutput()), values_); });
        contest.run();
        for (const char* who :
             {"ours_slice", "ours_at_1_percent_slice", "ours_without_position_bounds_slice",
              "cutter_slice", "plane_cutter_slice", "ours_isolines", "cutter_isolines"}) {
            print(name(who) + "_ms", contest.time(who));
        }
    }

private:
    void time_once(const std::string& what, const std::function<void()>& run) const {
        Contest contest(1, Clock::processor);
        contest.add("once", run);
        contest.run();
        print(solver_->name + what + "_ms", contest.time("once"));
    }

    nestgrid::Slice ours(const NamedPlane& at, double threshold, bool bounded = true) const {
        const nestgrid::Plane plane(at.through, at.normal);
        nestgrid::IsosurfaceOptions options{.elements = false};
        if (bounded) options.position_bounds = &*bounds_;
        return slice(*hierarchy_, plane, under(*indicator_, threshold), options);
    }

    template <class Filter>
    static void update_anew(Filter* filter) {
        filter->Modified();
        filter->Update();
    }

    void print_judgement(const std::string& name, std::size_t peak,
                         const ColouredTriangles& triangles, const Segments& segments) const {
        const JumpCount count = count_jumps(triangles, solver_->on_boundary, 1e-6 * range_);
        print_megabytes(name + "_peak", peak);
        print(name + "_triangles", triangles.triangles.size());
        print(name + "_open_edges", count.open_edges);
        print(name + "_jumping_edges", count.jumping_edges);
        print(name + "_greatest_jump_of_range", count.greatest_jump / range_);
        print(name + "_segments", segments.segments.size());
        print(name + "_open_ends", count_open_ends(segments, solver_->on_boundary));
    }

    /// Draws with each contestant once, and prints what its slice and isolines are like, and the
    /// peak of memory of both together.
    void judge(const NamedPlane& plane) const {
        const std::string name = solver_->name + "_" + plane.name + "_";
        for (const bool coarse : {false, true}) {
            nestgrid::Slice drawn;
            nestgrid::Polylines lines;
            const std::size_t peak = peak_heap_bytes([&] {
                drawn = ours(plane, coarse ? range_ / 100 : 0);
                lines = isolines(drawn.surface, 0, values_);
            });
            print_judgement(name + (coarse ? "ours_at_1_percent" : "ours"), peak,
                            triangles_of(drawn.surface), segments_of(lines));
        }
        judge_filter<vtkCutter>(name + "cutter", plane);
        judge_filter<vtkPlaneCutter>(name + "plane_cutter", plane);
    }

    template <class Filter>
    void judge_filter(const std::string& name, const NamedPlane& plane) const {
        vtkSmartPointer<Filter> filter;
        std::vector<vtkPolyData*> parts;
        std::vector<vtkSmartPointer<vtkPolyData>> lines;
        const std::size_t peak = peak_heap_bytes([&] {
            filter = make_cutter<Filter>(leaves_, plane);
            filter->Update();
            parts = parts_of(filter->GetOutputDataObject(0));
            lines = contour(parts, values_);
        });
        print_judgement(name, peak, triangles_of(parts), segments_of(lines));
    }

    const SolverCase* solver_;
    const Hierarchy<double>* hierarchy_;
    std::size_t rounds_;
    std::optional<HierarchicalIndicator> indicator_;
    std::optional<nestgrid::SweptIndicator> bounds_;
    vtkSmartPointer<vtkUnstructuredGrid> leaves_;
    double range_ = 0;
    std::vector<double> values_;
};

}  // namespace

void measure_slices(const SolverCase& solver, const Hierarchy<double>& hierarchy) {
    const Measurement measurement(solver, hierarchy);
    for (const NamedPlane& plane : measurement.planes()) measurement.compare(plane);
}
