// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "coarse_file.hpp"

#include "child_process.hpp"

namespace {

using namespace nestgrid;

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

}  // namespace

CoarseGrid read_grid_apart(const std::string& file, double seconds,
                           const std::function<CoarseGrid()>& read) {
    const auto parcel = run_apart(file, seconds, [&](Parcel& out) { put_grid(read(), out); });
    return grid_in(*parcel);
}
