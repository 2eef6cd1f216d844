// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writing a surface with the writers of the program, beside a dump of its numbers from memory: the
// gyroid in 65^3 to 193^3 samples, with normals. The dump has positions and normals as float and
// corners as 32-bit integers, one write each, to a file in the same folder. Processor time, that of
// the system included. One "name value" line per figure; --quick takes a small surface.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_field.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>

#include "bucky_samples.hpp"
#include "contest.hpp"
#include "output/surface_file.hpp"

namespace {

namespace fs = std::filesystem;

nestgrid::Surface<3> gyroid(int n) {
    std::vector<float> samples;
    const auto angle = [&](int i) { return 12.0 * i / n; };
    for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                const double x = angle(i);
                const double y = angle(j);
                const double z = angle(k);
                samples.push_back(static_cast<float>(std::sin(x) * std::cos(y) +
                                                     std::sin(y) * std::cos(z) +
                                                     std::sin(z) * std::cos(x)));
            }
        }
    }
    const nestgrid::LatticeBisection<3> grid({.samples = {n, n, n}});
    const nestgrid::LatticeField field(grid, std::span<const float>(samples));
    return nestgrid::IsosurfaceSeries(grid, field)
        .draw(0.1, {}, {.normals = true, .elements = false})
        .surface;
}

std::vector<float> floats_of(std::span<const nestgrid::Point> points) {
    std::vector<float> floats;
    for (const nestgrid::Point& x : points) {
        for (const double number : x) floats.push_back(static_cast<float>(number));
    }
    return floats;
}

template <class Number>
void put(std::ofstream& file, std::span<const Number> numbers) {
    file.write(reinterpret_cast<const char*>(numbers.data()),
               static_cast<std::streamsize>(numbers.size_bytes()));
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = is_quick(argc, argv);
    nestgrid::Surface<3> surface = gyroid(quick ? 65 : 193);
    const auto data = nestgrid::share_poly_data(surface);
    const vtkNew<vtkFloatArray> single;  // as the program has them
    single->DeepCopy(data->GetPointData()->GetNormals());
    data->GetPointData()->SetNormals(single);
    const std::vector<float> positions = floats_of(surface.vertices);
    const std::vector<float> normals = floats_of(surface.normals);

    const fs::path folder =
        fs::temp_directory_path() / ("bench_writing." + std::to_string(getpid()));
    fs::create_directory(folder);
    Contest contest(quick ? 3 : 9, Clock::processor);
    contest.add("dump", [&] {
        std::ofstream file(folder / "dump", std::ios::binary);
        put(file, std::span<const float>(positions));
        put(file, std::span<const float>(normals));
        put(file, std::span<const std::array<std::uint32_t, 3>>(surface.simplices));
    });
    using Compression = SurfaceEncoding::Compression;
    struct Case {
        std::string name;
        std::string file;
        SurfaceEncoding encoding;
    };
    const std::vector<Case> cases{{"vtp_lz4", "lz4.vtp", {}},
                                  {"vtp_none", "none.vtp", {Compression::none}},
                                  {"vtp_zlib", "zlib.vtp", {Compression::zlib}},
                                  {"vtp_double_none", "double.vtp", {Compression::none, true}},
                                  {"ply", "x.ply", {}}};
    for (const Case& c : cases) {
        contest.add(c.name, [&] { write_surface(data, folder / c.file, c.encoding); });
    }
    contest.run();
    Contest::print_figure("triangles", static_cast<double>(surface.simplices.size()));
    Contest::print_figure("dump_ms", contest.time("dump"));
    const auto dumped = static_cast<double>(fs::file_size(folder / "dump"));
    for (const Case& c : cases) {
        Contest::print_figure(c.name + "_over_dump", contest.time(c.name) / contest.time("dump"));
        Contest::print_figure(c.name + "_bytes_over_dump",
                              static_cast<double>(fs::file_size(folder / c.file)) / dumped);
    }
    fs::remove_all(folder);
    return 0;
}
