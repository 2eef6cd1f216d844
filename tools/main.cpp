// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The command-line program: options in, one line per result out.
#include <unistd.h>

#include <cstdio>
#include <optional>

#include <vtkObject.h>
#include <CLI/CLI.hpp>

#include <nestgrid/error.hpp>

#include "expression.hpp"
#include "extract.hpp"
#include "hierarchy.hpp"
#include "mesh.hpp"
#include "picture.hpp"
#include "print.hpp"

namespace {

namespace fs = std::filesystem;

struct Options {
    fs::path input;
    std::string array;
    RawFormat raw;
    std::string endian = "little";
    double read_limit = 0;
    double value = 0;
    std::vector<std::string> thresholds;
    std::vector<std::int64_t> budgets;
    std::vector<double> box;
    double box_threshold = 0;
    int threads = 0;
    fs::path output;
    fs::path image;
    bool cap = false;
    bool flat = false;
    bool against_vtk = false;
    MeshRequest mesh;
};

void add_read_limit(CLI::App& command, Options& o) {
    command
        .add_option("--read-limit", o.read_limit,
                    "seconds after which a file is refused that is still being read; default: 60 "
                    "and one for each MB, ten times that for .poly and .smesh")
        ->check(CLI::PositiveNumber);
}

void add_input_options(CLI::App& command, Options& o) {
    command
        .add_option("INPUT", o.input,
                    ".vti, .mhd, .mha, .nrrd, .nhdr, .nii, .nii.gz, .raw or .nestgrid")
        ->required();
    command.add_option("--array", o.array, "point data array of a .vti file, field of a .nestgrid");
    command.add_option("--dims", o.raw.dims, "samples of a .raw file along x,y,z")->delimiter(',');
    command.add_option("--type", o.raw.type,
                       "their type: uint8, int8, uint16, int16, uint32, int32, uint64, int64, "
                       "float32, float64");
    command.add_option("--endian", o.endian, "their byte order")
        ->check(CLI::IsMember({"little", "big"}))
        ->capture_default_str();
    command.add_option("--spacing", o.raw.spacing, "their distances along x,y,z")->delimiter(',');
    add_read_limit(command, o);
}

/// Overwrites one line on a terminal; does nothing elsewhere.
class ProgressLine {
public:
    void show(const std::string& text) {
        if (!terminal_) return;
        std::fprintf(stderr, "\r\033[K%s", text.c_str());
        std::fflush(stderr);
    }
    ~ProgressLine() {
        if (terminal_) std::fprintf(stderr, "\r\033[K");
    }

private:
    bool terminal_ = isatty(STDERR_FILENO) == 1;
};

/// out.vtp for one surface; out-1.vtp, out-2.vtp, ... for several.
fs::path numbered(const fs::path& path, std::size_t number, std::size_t count) {
    if (count == 1) return path;
    return path.parent_path() /
           (path.stem().string() + "-" + std::to_string(number + 1) + path.extension().string());
}

Volume read(Options& o) {
    o.raw.big_endian = o.endian == "big";
    return read_volume(o.input, o.array, o.raw, o.read_limit);
}

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
    ExtractionRequest request{.isovalue = o.value, .cap = o.cap, .normals = !o.flat};
    if (o.thresholds.empty() && o.budgets.empty()) o.thresholds = {"0"};
    for (const std::int64_t budget : o.budgets) {
        if (budget <= 0) throw nestgrid::InvalidInput("--max-triangles is not positive");
        request.budgets.push_back(static_cast<std::uint64_t>(budget));
    }
    if (o.threads < 0) throw nestgrid::InvalidInput("--threads is negative");
    request.threads = o.threads;
    if (!o.box.empty()) request.box = fine_box(o);
    for (const std::string& t : o.thresholds) request.thresholds.push_back(parse_threshold(t));
    if (!std::isfinite(o.value)) throw nestgrid::InvalidInput("--value is not a finite number");
    if (!o.output.empty()) check_output(o.output);
    if (!o.image.empty()) check_output(o.image);
    if (!o.image.empty() && o.image.extension() != ".png") {
        throw nestgrid::IoError("'" + o.image.string() + "' is no name of a .png picture");
    }
    if (is_hierarchy(o.input) && o.against_vtk) {
        throw nestgrid::InvalidInput("--against-vtk is for volumes");
    }
    request.keep_surfaces = !o.output.empty() || !o.image.empty();
    Seconds seconds;
    std::optional<ProgressLine> progress(std::in_place);
    request.progress = [&](const std::string& text) { progress->show(text); };
    progress->show("reading");
    double start = now();
    std::optional<Volume> volume;
    if (!is_hierarchy(o.input)) volume = read(o);
    seconds.read = now() - start;
    const ExtractionRun run =
        volume ? extract(*volume, request) : extract(o.input, o.array, request);

    start = now();
    std::vector<Panel> panels;
    for (std::size_t i = 0; i < run.surfaces.size(); ++i) {
        const Extraction& e = run.surfaces[i];
        if (!e.surface) break;
        if (!o.output.empty()) {
            progress->show("writing");
            write_surface(e.surface, numbered(o.output, i, run.surfaces.size()));
        }
        panels.push_back({e.surface, caption(e)});
    }
    seconds.write = now() - start;
    start = now();
    if (!o.image.empty()) {
        progress->show("drawing");
        write_picture(panels, o.image);
    }
    seconds.draw = now() - start;
    std::optional<Contour> contour;
    if (o.against_vtk) {
        progress->show("contouring with VTK");
        contour = contour_with_vtk(*volume, o.value);
    }
    progress.reset();
    if (run.surfaces.size() == 1 && !contour) {
        print_result(run, o.value, seconds);
    } else {
        print_table(run, o.value, seconds, contour);
    }
}

void run_info(Options& o) {
    if (is_hierarchy(o.input)) {
        print_info(hierarchy_info(o.input));
    } else {
        print_info(read(o));
    }
}

void run_mesh(Options& o) {
    o.mesh.output = o.output;
    o.mesh.read_limit = o.read_limit;
    if (!is_hierarchy(o.output)) {
        throw nestgrid::IoError("'" + o.output.string() + "' is no name of a .nestgrid file");
    }
    check_writable(o.output);
    {
        ProgressLine progress;
        o.mesh.progress = [&](const std::string& text) { progress.show(text); };
        make_hierarchy(o.mesh);
    }
    print_info(hierarchy_info(o.output));
}

void add_mesh_options(CLI::App& command, Options& o) {
    command
        .add_option("INPUT", o.mesh.input,
                    "a surface, .off, .obj, .ply or .stl; tetrahedra, .node and .ele; or a "
                    "piecewise linear complex to be filled, .poly or .smesh")
        ->required();
    command.add_option("--family", o.mesh.family, "red-green, bisection, octree or prism")
        ->check(CLI::IsMember({"red-green", "bisection", "octree", "prism"}))
        ->required();
    command.add_option("--layers", o.mesh.layers, "thicknesses of layers of prisms on a surface")
        ->delimiter(',');
    command
        .add_option("--direction", o.mesh.direction,
                    "of the layers, x,y,z; default: along the normals of the surface")
        ->delimiter(',')
        ->expected(3);
    command.add_flag("--unbalanced", o.mesh.unbalanced,
                     "let neighbours in an octree differ by more than one level");
    command.add_option("--max-volume", o.mesh.maximum_volume,
                       "of the tetrahedra that fill a .poly or .smesh");
    command.add_option("--refine", o.mesh.refine, "uniform refinements");
    command.add_option("--field", o.mesh.field,
                       "a name (see below) or an expression in x, y and z, kept at the nodes");
    command.add_option("--tolerance", o.mesh.tolerance,
                       "refine until the field is interpolated up to this");
    command.add_option("--levels", o.mesh.levels, "refinements of an element at most")
        ->capture_default_str();
    command.add_option("--max-elements", o.mesh.maximum_elements, "refuse to make more than these")
        ->capture_default_str();
    add_read_limit(command, o);
    command.add_option("-o,--output", o.output, ".nestgrid")->required();
    command.footer("Fields:\n" + Expression::names());
}

}  // namespace

int main(int argc, char** argv) {
    vtkObject::GlobalWarningDisplayOff();
    CLI::App app{"Adaptive, crack-free surfaces from hierarchical grids"};
    app.set_version_flag("--version", "nestgrid " NESTGRID_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Examples:\n"
        "  nestgrid isosurface head.nii.gz --value 60 --threshold 2% -o head.vtp\n"
        "  nestgrid isosurface head.nii.gz --value 60 --threshold 0 --threshold 5 --image "
        "head.png\n"
        "  nestgrid isosurface ct.raw --dims 512,512,300 --type int16 --spacing 0.5,0.5,1 \\\n"
        "           --value 300 -o bone.stl\n"
        "  nestgrid info head.nii.gz\n"
        "  nestgrid mesh part.poly --family bisection --field front --tolerance 0.01 -o "
        "part.nestgrid");
    Options o;

    CLI::App* isosurface = app.add_subcommand("isosurface", "extract an adaptive isosurface");
    add_input_options(*isosurface, o);
    isosurface->add_option("--value", o.value, "the isovalue, in units of the data")->required();
    isosurface
        ->add_option("--threshold", o.thresholds,
                     "offsets up to this are projected away: in units of the data, or in percent "
                     "of their range (2%); give it again for a table of several")
        ->take_all();
    isosurface
        ->add_option(
            "--max-triangles", o.budgets,
            "in the place of a threshold: the least one that gives no more triangles; give "
            "it again for a table of several")
        ->take_all()
        ->excludes("--threshold");
    isosurface
        ->add_option("--box", o.box,
                     "bounds x,x,y,y,z,z of a region with a threshold of its own, --box-threshold")
        ->delimiter(',')
        ->expected(6);
    isosurface->add_option("--box-threshold", o.box_threshold, "in units of the data; default: 0")
        ->needs("--box");
    isosurface->add_option("--threads", o.threads,
                           "how many to use; default: all. The surface does not depend on it");
    isosurface->add_option("-o,--output", o.output, ".vtp, .ply, .stl, .obj or .gltf");
    isosurface->add_option("--image", o.image, "a picture, .png");
    isosurface->add_flag("--cap", o.cap, "close the surface along the boundary of the volume");
    isosurface->add_flag("--no-normals", o.flat, "leave out the normals");
    isosurface->add_flag("--against-vtk", o.against_vtk,
                         "add VTK's own contour of the same samples to the table");
    CLI::App* info = app.add_subcommand("info", "describe a volume or a hierarchy");
    add_input_options(*info, o);
    CLI::App* mesh = app.add_subcommand("mesh", "build a hierarchy on a mesh and refine it");
    add_mesh_options(*mesh, o);

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        // Who misspells an option that is required has left it out, too.
        const std::vector<std::string> unknown = app.remaining(true);
        const std::string what =
            unknown.empty() ? error.what() : unknown.front() + " was not expected";
        std::fprintf(stderr, "nestgrid: %s (see nestgrid --help)\n", what.c_str());
        return 2;
    }
    try {
        if (*isosurface) run_isosurface(o);
        if (*info) run_info(o);
        if (*mesh) run_mesh(o);
        return 0;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "nestgrid: not enough memory\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "nestgrid: %s\n", error.what());
    }
    return 1;
}
