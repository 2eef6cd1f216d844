// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/meshes/weld.hpp"

#include <algorithm>
#include <set>

#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticPointLocator.h>

namespace {

using nestgrid::CoarseGrid;
using nestgrid::Point;

/// For each node, the one that it becomes.
std::vector<vtkIdType> merged_nodes(const CoarseGrid& grid, double tolerance) {
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
        const Point x = grid.nodes[i];
        points->InsertNextPoint(x.data());
    }
    const vtkNew<vtkPolyData> cloud;
    cloud->SetPoints(points);
    const vtkNew<vtkStaticPointLocator> locator;
    locator->SetDataSet(cloud);
    std::vector<vtkIdType> merged(grid.nodes.size());
    if (merged.empty()) return merged;
    locator->BuildLocator();
    locator->MergePoints(tolerance, merged.data());
    return merged;
}

}  // namespace

std::size_t weld_nodes(CoarseGrid& grid, double tolerance) {
    const std::vector<vtkIdType> merged = merged_nodes(grid, tolerance);
    CoarseGrid welded;
    welded.dimension = grid.dimension;
    std::vector<std::uint32_t> number(merged.size());
    std::vector<Point> nodes;
    for (std::size_t i = 0; i < merged.size(); ++i) {
        if (merged[i] != static_cast<vtkIdType>(i)) continue;
        number[i] = static_cast<std::uint32_t>(nodes.size());
        nodes.push_back(grid.nodes[i]);
    }
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        std::vector<std::uint32_t> corners;
        for (const std::uint32_t corner : grid.element(e)) {
            corners.push_back(number[static_cast<std::size_t>(merged[corner])]);
        }
        if (std::set(corners.begin(), corners.end()).size() == corners.size()) {
            welded.add(grid.shapes[e], corners);
        } else if (corners.size() == 4 && grid.dimension == 2) {
            // A quadrilateral with one edge of no length is a triangle.
            std::swap(corners[2], corners[3]);
            corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
            if (corners.front() == corners.back()) corners.pop_back();
            if (corners.size() == 3) welded.add_loop(corners);
        }
    }
    const std::size_t joined = merged.size() - nodes.size();
    welded.nodes = nestgrid::Coordinates(std::move(nodes));
    grid = std::move(welded);
    return joined;
}

bool has_nodes_in_one_place(const CoarseGrid& grid) {
    const std::vector<vtkIdType> merged = merged_nodes(grid, 0);
    for (std::size_t i = 0; i < merged.size(); ++i) {
        if (merged[i] != static_cast<vtkIdType>(i)) return true;
    }
    return false;
}
