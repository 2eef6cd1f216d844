// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/precision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <nestgrid/detail/geometry.hpp>

#include "output/cells.hpp"

namespace {

nestgrid::Point point_of(vtkPolyData* surface, vtkIdType number) {
    nestgrid::Point x{};
    surface->GetPoint(number, x.data());
    return x;
}

/// The lengths of edges, but for those of no length.
struct Lengths {
    double least = std::numeric_limits<double>::infinity();
    double sum = 0;
    std::size_t count = 0;
};

void add_lengths(vtkPolyData* surface, vtkCellArray* cells, bool rings, Lengths& lengths) {
    using nestgrid::operator-;
    const auto look = [&](vtkIdType a, vtkIdType b) {
        const double length = nestgrid::norm(point_of(surface, a) - point_of(surface, b));
        if (!(length > 0)) return;
        lengths.least = std::min(lengths.least, length);
        lengths.sum += length;
        ++lengths.count;
    };
    for_each_cell(cells, [&](std::span<const vtkIdType> corners) {
        for (std::size_t i = 1; i < corners.size(); ++i) look(corners[i - 1], corners[i]);
        if (rings && corners.size() > 2) look(corners.back(), corners.front());
    });
}

}  // namespace

SinglePrecision single_precision(vtkPolyData* surface) {
    SinglePrecision result;
    double square = 0;
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i) {
        double moved = 0;
        for (const double x : point_of(surface, i)) {
            const double difference = x - static_cast<double>(static_cast<float>(x));
            moved += difference * difference;
        }
        square = std::max(square, moved);
    }
    result.moved = std::sqrt(square);
    Lengths lengths;
    add_lengths(surface, surface->GetPolys(), true, lengths);
    add_lengths(surface, surface->GetLines(), false, lengths);
    result.shortest_edge = lengths.least;
    result.mean_edge =
        lengths.count == 0 ? lengths.least : lengths.sum / static_cast<double>(lengths.count);
    return result;
}
