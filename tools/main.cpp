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

#include "extract.hpp"
#include "picture.hpp"
#include "print.hpp"

namespace {

namespace fs = std::filesystem;

struct Options {
    fs::path input;
    std::string array;
    RawFormat raw;
    std::string endian = "little";
    double value = 0;
    std::vector<std::string> thresholds{"0"};
    fs::path output;
    fs::path image;
    bool cap = false;
    bool flat = false;
    bool against_vtk = false;
};

void add_input_options(CLI::App& command, Options& o) {
    command.add_option("INPUT", o.input, ".vti, .mhd, .mha, .nrrd, .nii, .nii.gz or .raw")
        ->required();
    command.add_option("--array", o.array, "point data array of a .vti file");
    command.add_option("--dims", o.raw.dims, "samples of a .raw file along x,y,z")->delimiter(',');
    command.add_option("--type", o.raw.type,
                       "their type: uint8, int8, uint16, int16, uint32, int32, uint64, int64, "
                       "float32, float64");
    command.add_option("--endian", o.endian, "their byte order")
        ->check(CLI::IsMember({"little", "big"}))
        ->capture_default_str();
    command.add_option("--spacing", o.raw.spacing, "their distances along x,y,z")->delimiter(',');
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
    return read_volume(o.input, o.array, o.raw);
}

void run_isosurface(Options& o) {
    ExtractionRequest request{.isovalue = o.value, .cap = o.cap, .normals = !o.flat};
    for (const std::string& t : o.thresholds) request.thresholds.push_back(parse_threshold(t));
    if (!std::isfinite(o.value)) throw nestgrid::InvalidInput("--value is not a finite number");
    if (!o.output.empty()) check_output(o.output);
    if (!o.image.empty()) check_output(o.image);
    if (!o.image.empty() && o.image.extension() != ".png") {
        throw nestgrid::IoError("'" + o.image.string() + "' is no name of a .png picture");
    }
    Seconds seconds;
    std::optional<ProgressLine> progress(std::in_place);
    request.progress = [&](const std::string& text) { progress->show(text); };
    progress->show("reading");
    double start = now();
    const Volume volume = read(o);
    seconds.read = now() - start;
    ExtractionRun run = extract(volume, request);

    start = now();
    std::vector<Panel> panels;
    for (std::size_t i = 0; i < run.surfaces.size(); ++i) {
        const Extraction& e = run.surfaces[i];
        if (o.output.empty() && o.image.empty()) break;
        const auto data = make_poly_data(e.result.surface);
        if (!o.output.empty()) {
            progress->show("writing");
            write_surface(data, numbered(o.output, i, run.surfaces.size()));
        }
        panels.push_back({data, caption(e)});
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
        contour = contour_with_vtk(volume, o.value);
    }
    progress.reset();
    if (run.surfaces.size() == 1 && !contour) {
        print_result(run, o.value, seconds);
    } else {
        print_table(run, o.value, seconds, contour);
    }
}

void run_info(Options& o) { print_info(read(o)); }

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
        "  nestgrid info head.nii.gz");
    Options o;

    CLI::App* isosurface = app.add_subcommand("isosurface", "extract an adaptive isosurface");
    add_input_options(*isosurface, o);
    isosurface->add_option("--value", o.value, "the isovalue, in units of the data")->required();
    isosurface
        ->add_option("--threshold", o.thresholds,
                     "offsets up to this are projected away: in units of the data, or in percent "
                     "of their range (2%); give it again for a table of several")
        ->take_all();
    isosurface->add_option("-o,--output", o.output, ".vtp, .ply, .stl, .obj or .gltf");
    isosurface->add_option("--image", o.image, "a picture, .png");
    isosurface->add_flag("--cap", o.cap, "close the surface along the boundary of the volume");
    isosurface->add_flag("--no-normals", o.flat, "leave out the normals");
    isosurface->add_flag("--against-vtk", o.against_vtk,
                         "add VTK's own contour of the same samples to the table");
    CLI::App* info = app.add_subcommand("info", "describe a volume and its hierarchy");
    add_input_options(*info, o);

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "nestgrid: %s (see nestgrid --help)\n", error.what());
        return 2;
    }
    try {
        if (*isosurface) run_isosurface(o);
        if (*info) run_info(o);
        return 0;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "nestgrid: not enough memory\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "nestgrid: %s\n", error.what());
    }
    return 1;
}
