// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/precision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkSmartPointer.h>

#include <nestgrid/detail/geometry.hpp>

namespace {

nestgrid::Point point_of(vtkPolyData* surface, vtkIdType number) {
    nestgrid::Point x{};
    surface->GetPoint(number, x.data());
    return x;
}

/// The least square of the length of an edge, but for those of no length.
double least_square(vtkPolyData* surface, vtkCellArray* cells, bool rings) {
    using nestgrid::operator-;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](vtkIdType a, vtkIdType b) {
        const nestgrid::Point edge = point_of(surface, a) - point_of(surface, b);
        const double square = nestgrid::dot(edge, edge);
        if (square > 0) least = std::min(least, square);
    };
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    const auto cell = vtkSmartPointer<vtkCellArrayIterator>::Take(cells->NewIterator());
    for (cell->GoToFirstCell(); !cell->IsDoneWithTraversal(); cell->GoToNextCell()) {
        cell->GetCurrentCell(count, corners);
        for (vtkIdType i = 1; i < count; ++i) look(corners[i - 1], corners[i]);
        if (rings && count > 2) look(corners[count - 1], corners[0]);
    }
    return least;
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
    result.shortest_edge = std::sqrt(std::min(least_square(surface, surface->GetPolys(), true),
                                              least_square(surface, surface->GetLines(), false)));
    return result;
}
