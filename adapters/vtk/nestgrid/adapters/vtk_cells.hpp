// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A vtkUnstructuredGrid of linear, quadratic and Lagrange cells as a grid and a field.
//
//     const VtkCells cells(*unstructured);
//     const std::vector<double> u = vtk_point_values(*unstructured, "u");
//     const LagrangeGrid<3> grid(cells.arrays());
//     const LagrangeField<3> field(grid, u);
//
// What is refused, and what becomes of points at one place, lagrange.hpp says. Readers of VTK turn
// cells of older files into the order of VTK 9.
#pragma once

#include <string>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <nestgrid/adapters/lagrange.hpp>

namespace nestgrid {

/// The arrays of an unstructured grid, copied. Ghost cells that are duplicates, refined or hidden
/// are empty ones, which are left out.
class VtkCells {
public:
    explicit VtkCells(vtkUnstructuredGrid& grid) {
        for (vtkIdType i = 0; i < grid.GetNumberOfPoints(); ++i) {
            std::array<double, 3> x{};
            grid.GetPoint(i, x.data());
            coordinates_.insert(coordinates_.end(), x.begin(), x.end());
        }
        vtkUnsignedCharArray* const types = grid.GetCellTypesArray();
        vtkUnsignedCharArray* const ghosts = grid.GetCellGhostArray();
        constexpr int left_out = vtkDataSetAttributes::DUPLICATECELL |
                                 vtkDataSetAttributes::REFINEDCELL |
                                 vtkDataSetAttributes::HIDDENCELL;
        for (vtkIdType i = 0; i < grid.GetNumberOfCells(); ++i) {
            const bool is_drawn = ghosts == nullptr || (ghosts->GetValue(i) & left_out) == 0;
            types_.push_back(is_drawn ? types->GetValue(i) : std::uint8_t{VTK_EMPTY_CELL});
            vtkIdType count = 0;
            const vtkIdType* points = nullptr;
            grid.GetCellPoints(i, count, points);
            points_.insert(points_.end(), points, points + count);
            first_.push_back(static_cast<std::int64_t>(points_.size()));
        }
        vtkDataArray* const degrees = grid.GetCellData()->GetHigherOrderDegrees();
        if (degrees == nullptr || degrees->GetNumberOfComponents() != 3) return;
        for (vtkIdType i = 0; i < 3 * degrees->GetNumberOfTuples(); ++i) {
            degrees_.push_back(degrees->GetComponent(i / 3, static_cast<int>(i % 3)));
        }
    }

    CellArrays arrays() const { return {coordinates_, types_, first_, points_, degrees_}; }

private:
    std::vector<double> coordinates_;
    std::vector<std::uint8_t> types_;
    std::vector<std::int64_t> first_{0};
    std::vector<std::int64_t> points_;
    std::vector<double> degrees_;
};

/// The values of an array of points.
///
/// \throw InvalidInput where there is no such array, or none of its components has this number, and
///        for a value that is not a finite number, with its point
inline std::vector<double> vtk_point_values(vtkUnstructuredGrid& grid, const std::string& name,
                                            int component = 0) {
    vtkDataArray* const array = grid.GetPointData()->GetArray(name.c_str());
    if (array == nullptr) throw InvalidInput("there is no array of points '" + name + "'");
    if (component < 0 || component >= array->GetNumberOfComponents()) {
        throw InvalidInput("'" + name + "' has " + std::to_string(array->GetNumberOfComponents()) +
                           " components, and none with number " + std::to_string(component));
    }
    std::vector<double> values;
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
        values.push_back(array->GetComponent(i, component));
    }
    require_point_values(values, static_cast<std::size_t>(grid.GetNumberOfPoints()), name);
    return values;
}

}  // namespace nestgrid
