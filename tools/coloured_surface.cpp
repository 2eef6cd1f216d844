// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "coloured_surface.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include <vtkAppendPolyData.h>

#include <nestgrid/adapters/tbb.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/outlines.hpp>
#include <nestgrid/algorithms/surface_isolines.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/detail/geometry.hpp>

#include "extract.hpp"
#include "input_hierarchy.hpp"
#include "picture.hpp"
#include "print.hpp"
#include "surface_file.hpp"

namespace {

using nestgrid::dot;
using nestgrid::operator*;
using nestgrid::operator-;

/// One surface and what it cost.
struct Drawn {
    double threshold = 0;
    nestgrid::Slice slice;
    nestgrid::SurfaceReport report;
    nestgrid::Polylines isolines;
    double seconds = 0;
};

/// All surfaces of one field.
struct DrawnField {
    std::string name;
    double least = 0;  ///< of the colours
    double greatest = 0;
    double preroll_seconds = 0;
    std::vector<Drawn> surfaces;
    std::vector<double> values;  ///< of isolines
};

template <class Real>
class Drawing {
public:
    Drawing(const nestgrid::Hierarchy<Real>& hierarchy, const SurfaceOptions& options,
            const ColouredSurface& what)
        : hierarchy_{hierarchy}, options_{options}, what_{what}, executor_{options.threads} {
        if (what.function == nullptr && hierarchy.facts().dimension == 3) {
            throw nestgrid::InvalidInput(
                "the field is one in space: give a slice, for isolines, or use 'isosurface'");
        }
        hierarchy.facts().require_dimension(what.function == nullptr ? 2 : 3);
        if (what.function == nullptr && !options.budgets.empty()) {
            throw nestgrid::InvalidInput("--max-triangles is for grids of dimension 3");
        }
        if (what.lens && !options.budgets.empty()) {
            throw nestgrid::InvalidInput("--max-triangles with --lens is for isosurfaces");
        }
    }

    void draw_all(DrawnField& field) {
        const double start = now();
        const bool plain = options_.thresholds.empty() && options_.budgets.empty() && !what_.lens;
        if (!plain) {
            indicators_.emplace(hierarchy_, options_.projection, what_.lens, executor_);
        }
        field.preroll_seconds = now() - start;
        if (plain) field.surfaces.push_back(draw(0, [&] { return draw_exactly(); }));
        for (const std::int64_t budget : options_.budgets) {
            field.surfaces.push_back(
                draw(0, [&] { return draw_within(static_cast<std::uint64_t>(budget)); }));
        }
        std::vector<ThresholdText> thresholds;
        for (const std::string& text : options_.thresholds) {
            thresholds.push_back(parse_threshold(text));
        }
        if (what_.lens) set_default_threshold(thresholds, true);
        for (const ThresholdText& t : thresholds) {
            const double threshold = indicators_->threshold(t);
            indicators_->with_criteria([&](const auto& criterion_at) {
                field.surfaces.push_back(
                    draw(threshold, [&] { return draw_with(criterion_at(threshold)); }));
            });
        }
    }

private:
    template <class Draw>
    Drawn draw(double threshold, const Draw& make_slice) {
        Drawn drawn;
        drawn.threshold = threshold;
        const double start = now();
        drawn.slice = make_slice();
        drawn.seconds = now() - start;
        drawn.report = nestgrid::surface_report(drawn.slice.surface);
        return drawn;
    }

    nestgrid::Slice draw_exactly() const {
        if (what_.function == nullptr) return triangles();
        return slice(hierarchy_, *what_.function, {.cap = what_.cap}, executor_);
    }
    nestgrid::Slice draw_within(std::uint64_t budget) const {
        return slice(hierarchy_, *what_.function, indicators_->offsets(),
                     {.max_triangles = budget, .cap = what_.cap}, executor_);
    }
    nestgrid::Slice draw_with(const nestgrid::Criterion& criterion) const {
        const nestgrid::HierarchicalIndicator& bounds = indicators_->offsets();
        if (what_.function == nullptr) return triangles(criterion, bounds);
        return slice(hierarchy_, *what_.function, criterion, bounds, {.cap = what_.cap}, executor_);
    }

    /// The grid of dimension 2.
    template <class... With>
    nestgrid::Slice triangles(const With&... with) const {
        const nestgrid::ShadingOptions options;
        nestgrid::Shading s =
            what_.scale == 0 ? shading(hierarchy_, with..., options, executor_)
                             : height_field(hierarchy_, what_.scale, with..., options, executor_);
        return {std::move(s.surface), s.counts, s.error_bound};
    }

    const nestgrid::Hierarchy<Real>& hierarchy_;
    const SurfaceOptions& options_;
    const ColouredSurface& what_;
    nestgrid::TbbExecutor executor_;
    std::optional<ChosenIndicator> indicators_;
};

void print(const Drawn& d, const DrawnField& field) {
    line("threshold", d.threshold);
    line("inspect_calls", std::size_t{d.slice.counts.calls});
    line("visited", std::size_t{d.slice.counts.visited});
    line("extracted", std::size_t{d.slice.counts.extracted});
    line("triangles", d.report.triangles);
    line("vertices", d.report.vertices);
    line("least_value", field.least);
    line("greatest_value", field.greatest);
    line("error_bound", d.slice.error_bound);
    line("open_edges", d.report.open_edges);
    line("boundary_edges", d.report.boundary_edges);
    line("area", d.report.area);
    for (std::size_t i = 0; i < d.isolines.count(); ++i) {
        std::printf("%-22s %.6g, %s, length %.6g\n", "isoline", d.isolines.value[i],
                    d.isolines.closed(i) ? "ring" : "open", d.isolines.length(i));
    }
    line("preroll_seconds", field.preroll_seconds);
    line("seconds", d.seconds);
}

void print_table(const DrawnField& field) {
    std::printf("%10s %10s %10s %12s %10s %10s\n", "threshold", "triangles", "visited",
                "error_bound", "open_edges", "seconds");
    for (const Drawn& d : field.surfaces) {
        std::printf("%10.4g %10zu %10llu %12.4g %10zu %10.4g\n", d.threshold, d.report.triangles,
                    static_cast<unsigned long long>(d.slice.counts.visited), d.slice.error_bound,
                    d.report.open_edges, d.seconds);
    }
}

/// Draws the isolines on all surfaces.
void draw_isolines(DrawnField& field, const ColouredSurface& what) {
    field.values = what.values;
    for (int i = 1; i <= what.value_count; ++i) {
        field.values.push_back(field.least +
                               i * (field.greatest - field.least) / (what.value_count + 1));
    }
    if (field.values.empty()) return;
    for (Drawn& d : field.surfaces) {
        const double start = now();
        d.isolines = nestgrid::isolines(d.slice.surface, 0, field.values);
        d.seconds += now() - start;
    }
}

/// Sets the range of the colours, over all surfaces.
void find_range(DrawnField& field) {
    field.least = std::numeric_limits<double>::infinity();
    field.greatest = -field.least;
    for (const Drawn& d : field.surfaces) {
        for (const double value : d.slice.surface.attributes) {
            field.least = std::min(field.least, value);
            field.greatest = std::max(field.greatest, value);
        }
    }
}

/// Whether the surface lies in a plane across the z axis.
bool is_level(const nestgrid::Surface<3>& surface) {
    return std::ranges::all_of(surface.vertices, [&](const nestgrid::Point& x) {
        return x[2] == surface.vertices.front()[2];
    });
}

/// Looks across a flat surface, or, where it is closed to a solid, onto the cut.
void set_view(Panel& panel, const ColouredSurface& what, const nestgrid::Surface<3>& surface) {
    const nestgrid::Point normal = what.flat ? what.normal : nestgrid::Point{0, 0, 1};
    if (!what.flat && !is_level(surface)) return;
    if (!what.cap) {
        panel.from = normal;
        panel.lit = false;
        return;
    }
    const double side = dot(panel.from, normal);
    if (side > 0) panel.from = panel.from - 2 * side / dot(normal, normal) * normal;
}

Panel make_panel(const Drawn& d, const DrawnField& field, const ColouredSurface& what) {
    nestgrid::PolyDataSink<3> sink({field.name});
    sink.take(d.slice.surface);
    Panel panel{sink.data(), {}};
    char text[200];
    std::snprintf(text, sizeof(text), "%s, threshold %.4g\n%zu triangles",
                  short_name(field.name).c_str(), d.threshold, d.report.triangles);
    panel.caption = text;
    panel.colour = {field.name, field.least, field.greatest};
    if (!field.values.empty()) {
        panel.lines = make_poly_data(d.isolines, {field.name});
        panel.line_width = 2;
        panel.detail = false;
    }
    if (what.outlines) {
        nestgrid::PolyDataSink<2> edges({field.name});
        edges.take(nestgrid::outlines(d.slice.surface));
        panel.lines = edges.data();
        panel.detail = false;
    }
    if (what.cap) panel.detail = false;
    set_view(panel, what, d.slice.surface);
    return panel;
}

/// One data set of a surface and lines.
vtkSmartPointer<vtkPolyData> with_lines(vtkPolyData* surface, vtkPolyData* lines) {
    const vtkNew<vtkAppendPolyData> append;
    append->AddInputData(surface);
    append->AddInputData(lines);
    append->Update();
    return append->GetOutput();
}

void write(const SurfaceOptions& options, const DrawnField& field, const ColouredSurface& what) {
    std::vector<Panel> panels;
    for (std::size_t i = 0; i < field.surfaces.size(); ++i) {
        panels.push_back(make_panel(field.surfaces[i], field, what));
        if (options.output.empty()) continue;
        const auto data = !field.values.empty() ? panels[i].lines
                          : what.outlines       ? with_lines(panels[i].surface, panels[i].lines)
                                                : panels[i].surface;
        write_surface(data, numbered(options.output, i, field.surfaces.size()));
    }
    if (!options.image.empty()) write_picture(panels, options.image);
}

}  // namespace

void draw_coloured(Input& input, SurfaceOptions& options, const ColouredSurface& what) {
    check(options);
    DrawnField field;
    {
        ProgressLine progress;
        progress.show("reading");
        with_field(input, [&]<class Real>(const nestgrid::Hierarchy<Real>& hierarchy,
                                          const std::string& name) {
            progress.show("drawing");
            field.name = name;
            Drawing<Real>(hierarchy, options, what).draw_all(field);
        });
        find_range(field);
        draw_isolines(field, what);
        if (field.surfaces.front().report.triangles == 0) throw nestgrid::InvalidInput(what.empty);
        progress.show("writing");
        write(options, field, what);
    }
    if (field.surfaces.size() == 1) {
        print(field.surfaces.front(), field);
    } else {
        print_table(field);
    }
}
