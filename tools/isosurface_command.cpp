// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include <nestgrid/error.hpp>

#include "collection.hpp"
#include "command_line.hpp"
#include "extract.hpp"
#include "film.hpp"
#include "picture.hpp"
#include "print.hpp"

namespace {

namespace fs = std::filesystem;

struct Options {
    Input input;
    SurfaceOptions surface;
    TimeOptions time;
    double value = 0;
    std::vector<double> box;
    double box_threshold = 0;
    LensText lens;
    bool cap = false;
    bool flat = false;
    bool at_nodes = false;
    bool against_vtk = false;
};

FineBox fine_box(const Options& o) {
    FineBox box{{}, o.box_threshold};
    std::copy_n(o.box.begin(), 6, box.bounds.begin());
    for (std::size_t d = 0; d < 3; ++d) {
        if (!(box.bounds[2 * d] <= box.bounds[2 * d + 1])) {
            throw nestgrid::InvalidInput(
                "--box is empty: its bounds are x,x,y,y,z,z in ascending order");
        }
    }
    if (!(box.threshold >= 0)) {
        throw nestgrid::InvalidInput("--box-threshold is negative or not a number");
    }
    return box;
}

void run_isosurface(Options& o) {
    ExtractionRequest request{
        .isovalue = o.value, .cap = o.cap, .normals = !o.flat, .at_nodes = o.at_nodes};
    SurfaceOptions& s = o.surface;
    check(s);
    check(o.time, o.input.path);
    check_film(o.time, s);
    request.budgets.assign(s.budgets.begin(), s.budgets.end());
    request.threads = s.threads;
    request.projection = s.projection;
    if (!o.box.empty() && s.projection.blend != 1) {
        throw nestgrid::InvalidInput("--box has two thresholds: leave out --blend");
    }
    if (!o.box.empty()) request.box = fine_box(o);
    request.lens = parse(o.lens);
    for (const std::string& t : s.thresholds) request.thresholds.push_back(parse_threshold(t));
    if (s.budgets.empty()) set_default_threshold(request.thresholds, request.lens.has_value());
    if (!std::isfinite(o.value)) throw nestgrid::InvalidInput("--value is not a finite number");
    request.keep_surfaces = !s.output.empty() || !s.image.empty();
    Seconds seconds;
    std::optional<ProgressLine> progress(std::in_place);
    request.progress = [&](const std::string& text) { progress->show(text); };
    progress->show("reading");
    double start = now();
    std::optional<Film> film;
    if (o.time.frames) {
        film.emplace(s.output);
        request.drawn = [&film](Extraction& e) {
            film->add(e.surface, *e.time);
            e.surface = nullptr;
        };
    }
    const fs::path path = o.input.path;
    const InputField field = read_field(o.input, o.time.more, o.time.times);
    if (o.against_vtk && (!field.volumes || o.time.in_use())) {
        throw nestgrid::InvalidInput("--against-vtk is for one volume");
    }
    seconds.read = now() - start;
    const ExtractionRun run = extract(field, o.time, path, request);
    if (film) film->finish();

    start = now();
    std::vector<Panel> panels;
    std::vector<vtkSmartPointer<vtkPolyData>> surfaces;
    for (const Extraction& e : run.surfaces) {
        if (!e.surface) break;
        surfaces.push_back(e.surface);
        panels.push_back({e.surface, caption(e)});
    }
    if (!s.output.empty() && !surfaces.empty()) {
        progress->show("writing");
        write_surfaces(surfaces, s.output);
    }
    seconds.write = now() - start;
    start = now();
    if (!s.image.empty()) {
        progress->show("drawing");
        write_picture(panels, s.image);
    }
    seconds.draw = now() - start;
    std::optional<Contour> contour;
    if (o.against_vtk) {
        progress->show("contouring with VTK");
        contour = contour_with_vtk(field.volumes->front(), o.value);
    }
    progress.reset();
    if (o.time.in_use()) {
        print_times(run, o.value);
    } else if (run.surfaces.size() == 1 && !contour) {
        print_result(run, o.value, seconds);
    } else {
        print_table(run, o.value, seconds, contour);
    }
}

}  // namespace

Command add_isosurface(CLI::App& program) {
    auto o = std::make_shared<Options>();
    CLI::App* isosurface = program.add_subcommand("isosurface", "extract an adaptive isosurface");
    add_input_options(*isosurface, o->input);
    isosurface->add_option("--value", o->value, "the isovalue, in units of the data")->required();
    add_surface_options(*isosurface, o->surface);
    add_time_options(*isosurface, o->time);
    isosurface
        ->add_option("--box", o->box,
                     "bounds x,x,y,y,z,z of a region with a threshold of its own, --box-threshold")
        ->delimiter(',')
        ->expected(6);
    isosurface
        ->add_option("--box-threshold", o->box_threshold, "in units of --threshold; default: 0")
        ->needs("--box");
    add_lens_options(*isosurface, o->lens);
    isosurface->get_option("--lens")->excludes("--box");
    isosurface->add_flag("--cap", o->cap, "close the surface along the boundary of the volume");
    isosurface->add_flag("--no-normals", o->flat, "leave out the normals");
    isosurface->add_flag("--at-nodes", o->at_nodes,
                         "put vertices at samples that equal the isovalue, in the place of slivers "
                         "around them");
    isosurface->add_flag("--against-vtk", o->against_vtk,
                         "add VTK's own contour of the same samples to the table");
    return {isosurface, [o] { run_isosurface(*o); }};
}
