// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/precision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <vtkDoubleArray.h>
#include <vtkNew.h>

#include <nestgrid/detail/geometry.hpp>

#include "output/cells.hpp"

namespace {

using nestgrid::Point;

/// The points of a surface in double precision, copied only where they are in another one.
class Points {
public:
    explicit Points(vtkPolyData* surface) {
        vtkDataArray* const data = surface->GetPoints()->GetData();
        doubles_ = vtkDoubleArray::FastDownCast(data);
        if (doubles_ == nullptr) {
            const vtkNew<vtkDoubleArray> copy;
            copy->DeepCopy(data);
            doubles_ = copy.GetPointer();
        }
        count_ = surface->GetNumberOfPoints();
    }
    vtkIdType count() const { return count_; }
    Point operator[](vtkIdType i) const {
        const double* const x = doubles_->GetPointer(3 * i);
        return {x[0], x[1], x[2]};
    }

private:
    vtkSmartPointer<vtkDoubleArray> doubles_;
    vtkIdType count_ = 0;
};

/// How far the farthest point moves.
double moved_by_single(const Points& points) {
    double square = 0;
    for (vtkIdType i = 0; i < points.count(); ++i) {
        double moved = 0;
        for (const double x : points[i]) {
            const double difference = x - static_cast<double>(static_cast<float>(x));
            moved += difference * difference;
        }
        square = std::max(square, moved);
    }
    return std::sqrt(square);
}

/// Calls function(length) for the edges of cells, in the order of the cells, until it returns
/// false.
/// \return whether it never did
template <class Function>
bool for_edges(const Points& points, vtkCellArray* cells, bool rings, const Function& function) {
    using nestgrid::operator-;
    return for_each_cell(cells, [&](auto corners) {
        const std::size_t count = corners.size();
        const std::size_t edges = rings && count > 2 ? count : count - 1;
        for (std::size_t i = 0; i < edges; ++i) {
            const Point along = points[corners[(i + 1) % count]] - points[corners[i]];
            if (!function(nestgrid::norm(along))) return false;
        }
        return true;
    });
}
template <class Function>
bool for_edges(const Points& points, vtkPolyData* surface, const Function& function) {
    return for_edges(points, surface->GetPolys(), true, function) &&
           for_edges(points, surface->GetLines(), false, function);
}

/// At least as many as there are edges, an edge of two triangles counted twice.
double most_edges(vtkPolyData* surface) {
    return static_cast<double>(surface->GetPolys()->GetNumberOfConnectivityIds() +
                               surface->GetLines()->GetNumberOfConnectivityIds());
}

}  // namespace

SinglePrecision single_precision(vtkPolyData* surface) {
    const Points points(surface);
    double sum = 0;
    double count = 0;
    for_edges(points, surface, [&](double length) {
        sum += length;
        count += length > 0 ? 1 : 0;
        return true;
    });
    return {moved_by_single(points),
            count > 0 ? sum / count : std::numeric_limits<double>::infinity()};
}

bool single_keeps_shape(vtkPolyData* surface) {
    const Points points(surface);
    const double moved = moved_by_single(points);
    // The edges seen so far are long enough even if all others have no length.
    const double enough = 1000 * moved * most_edges(surface);
    double sum = 0;
    const auto add = [&](double length) { return (sum += length) < enough; };
    if (moved == 0 || !for_edges(points, surface, add)) return true;
    const SinglePrecision whole = single_precision(surface);
    return 1000 * whole.moved <= whole.mean_edge;
}

bool single_keeps_edges(vtkPolyData* surface) {
    const Points points(surface);
    const double moved = moved_by_single(points);
    return moved == 0 || for_edges(points, surface, [&](double length) {
               return length == 0 || 1000 * moved <= length;
           });
}
