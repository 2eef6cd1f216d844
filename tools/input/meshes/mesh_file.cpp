// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/meshes/mesh_file.hpp"

#include "formats.hpp"
#include "input/child_process.hpp"
#include "input/input_file.hpp"
#include "input/meshes/weld.hpp"
#include "suggestion.hpp"

namespace {

using namespace nestgrid;
namespace fs = std::filesystem;

void put_grid(const CoarseGrid& grid, Parcel& parcel) {
    std::vector<Point> points(grid.nodes.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = grid.nodes[i];
    parcel.put(std::span<const int>(&grid.dimension, 1));
    parcel.put(std::span<const Point>(points));
    parcel.put(std::span<const Shape>(grid.shapes));
    parcel.put(std::span<const std::uint32_t>(grid.corners));
    parcel.put(std::span<const std::uint32_t>(grid.first_corner));
}

CoarseGrid grid_in(const Parcel& parcel) {
    const auto copy = [&]<class Value>(std::size_t block, Value) {
        const auto values = parcel.block<Value>(block);
        return std::vector<Value>(values.begin(), values.end());
    };
    CoarseGrid grid;
    grid.dimension = parcel.block<int>(0).front();
    grid.nodes = Coordinates(copy(1, Point{}));
    grid.shapes = copy(2, Shape{});
    grid.corners = copy(3, std::uint32_t{});
    grid.first_corner = copy(4, std::uint32_t{});
    return grid;
}

/// Seconds to read a mesh, and to fill a complex, which takes longer.
double time_for(const fs::path& path, const Format& format) {
    std::error_code none;
    const std::uintmax_t size = fs::file_size(path, none);
    const double seconds = reading_time(none ? 0 : size);
    return format.fills_complexes ? 10 * seconds : seconds;
}

}  // namespace

MeshFromFile read_mesh(const fs::path& path, const WantedMesh& wanted, std::optional<double> weld,
                       double seconds) {
    require_file(path);
    const std::string name = "'" + path.string() + "'";
    const Format* const format = format_of(path);
    if (format == nullptr || format->read_mesh == nullptr) {
        const std::vector<std::string> known = endings_for(&Format::read_mesh);
        throw IoError(name + " is of no format for meshes (" + listed(known) + ")" +
                      did_you_mean(ending_of(path), known));
    }
    if (!(seconds > 0)) seconds = time_for(path, *format);
    const auto parcel = run_apart(name, seconds, [&](Parcel& out) {
        CoarseGrid grid = format->read_mesh(path, wanted);
        const std::size_t welded = weld ? weld_nodes(grid, *weld) : 0;
        put_grid(grid, out);
        out.put(std::span<const std::size_t>(&welded, 1));
    });
    return {grid_in(*parcel), parcel->block<std::size_t>(5).front()};
}
