// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Samples as VTK's images, and their tetrahedra as VTK's unstructured grids.
#pragma once

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <walk/walk.hpp>

#include "bucky_samples.hpp"

/// Samples of a cube as an image that borrows them.
inline vtkNew<vtkImageData> make_image(const std::vector<float>& samples, int n) {
    vtkNew<vtkImageData> image;
    image->SetDimensions(n, n, n);
    vtkNew<vtkFloatArray> array;
    array->SetName("u");
    array->SetArray(const_cast<float*>(samples.data()), static_cast<vtkIdType>(samples.size()), 1);
    image->GetPointData()->SetScalars(array);
    return image;
}

/// Keeps the corners of the leaves of the tetrahedra.
class Leaves final : public nestgrid::engine::Visitor<float> {
public:
    using View = nestgrid::engine::ElementView<float>;

    explicit Leaves(const nestgrid::engine::Walk<float>& walk) : walk_{&walk} {}

    nestgrid::engine::Decision inspect(const View&, const nestgrid::engine::Split&) override {
        return {};
    }
    void extract(const View& view) override {
        std::array<nestgrid::NodeKey, nestgrid::max_corners> key;
        walk_->corners(view, key.data(), nullptr);
        if (view.orientation < 0) std::swap(key[0], key[1]);
        for (std::size_t i = 0; i < 4; ++i) corners.push_back(static_cast<vtkIdType>(key[i]));
    }

    std::vector<vtkIdType> corners;

private:
    const nestgrid::engine::Walk<float>* walk_;
};

/// The leaves of a bisection written down; the samples are borrowed.
inline vtkNew<vtkUnstructuredGrid> make_unstructured(const Tetrahedra& grid, const Samples& field,
                                                     const std::vector<float>& samples) {
    const auto hierarchy = nestgrid::erase(grid, field);
    const nestgrid::engine::Walk<float> walk(hierarchy, {});
    Leaves leaves(walk);
    walk.run(leaves);
    const auto count = static_cast<vtkIdType>(leaves.corners.size() / 4);
    vtkNew<vtkPoints> points;
    points->SetDataTypeToFloat();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const nestgrid::Point x = grid.node_position(i);
        points->InsertNextPoint(x.data());
    }
    vtkNew<vtkIdTypeArray> offsets;
    offsets->SetNumberOfValues(count + 1);
    for (vtkIdType i = 0; i <= count; ++i) offsets->SetValue(i, 4 * i);
    vtkNew<vtkIdTypeArray> connectivity;
    connectivity->SetNumberOfValues(4 * count);
    std::copy(leaves.corners.begin(), leaves.corners.end(), connectivity->GetPointer(0));
    vtkNew<vtkCellArray> cells;
    cells->SetData(offsets, connectivity);
    vtkNew<vtkUnsignedCharArray> types;
    types->SetNumberOfValues(count);
    types->FillValue(VTK_TETRA);
    vtkNew<vtkUnstructuredGrid> result;
    result->SetPoints(points);
    result->SetCells(types, cells);
    vtkNew<vtkFloatArray> array;
    array->SetName("u");
    array->SetArray(const_cast<float*>(samples.data()), static_cast<vtkIdType>(samples.size()), 1);
    result->GetPointData()->SetScalars(array);
    return result;
}
