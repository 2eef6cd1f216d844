// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Level sets as vtkPolyData, filled while they are extracted.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>

#include <nestgrid/algorithms/polylines.hpp>
#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// A sink (surface.hpp): triangles become polygons, segments lines. Cells have the number of their
/// element in the order of extraction ("element") and its level ("level"), and where references are
/// asked for, three numbers for each of their corners ("reference"); points have the attributes,
/// each an array of its own name, and normals where they are asked for ("Normals").
template <int dimension>
class PolyDataSink final : public MeshSink<dimension> {
public:
    /// \param attributes names of the attributes: of components 1 ... of the field on isosurfaces,
    /// 0
    ///        ... on slices; the others are called "attribute 0", "attribute 1", ...
    explicit PolyDataSink(std::vector<std::string> attributes = {})
        : names_{std::move(attributes)} {
        points_->SetDataTypeToDouble();
        element_->SetName("element");
        level_->SetName("level");
        data_->SetPoints(points_);
        dimension == 3 ? data_->SetPolys(cells_) : data_->SetLines(cells_);
        data_->GetCellData()->AddArray(element_);
        data_->GetCellData()->AddArray(level_);
    }

    vtkPolyData* data() const { return data_; }

    void take(const Surface<dimension>& part) override {
        for (const Point& x : part.vertices) points_->InsertNextPoint(x.data());
        if (!part.vertices.empty()) {
            add_attributes(part.attributes, part.attributes.size() / part.vertices.size());
        }
        for (std::size_t t = 0; t < part.simplices.size(); ++t) {
            cells_->InsertNextCell(dimension);
            for (const std::uint32_t v : part.simplices[t]) {
                cells_->InsertCellPoint(static_cast<vtkIdType>(v));
            }
            const bool known = !part.element_of.empty();
            const std::uint32_t e = known ? part.element_of[t] : 0;
            element_->InsertNextValue(known ? elements_ + static_cast<int>(e) : -1);
            level_->InsertNextValue(known ? part.level_of[e] : 0);
        }
        elements_ += static_cast<int>(part.level_of.size());
        add_references(part.reference);
    }
    Point position(std::uint32_t vertex) const override {
        Point x;
        points_->GetPoint(static_cast<vtkIdType>(vertex), x.data());
        return x;
    }
    bool keeps_elements() const override { return true; }
    void set_normals(std::span<const Point> normals) override {
        const vtkNew<vtkFloatArray> array;
        array->SetName("Normals");
        array->SetNumberOfComponents(3);
        array->SetNumberOfTuples(static_cast<vtkIdType>(normals.size()));
        for (std::size_t v = 0; v < normals.size(); ++v) {
            array->SetTuple(static_cast<vtkIdType>(v), normals[v].data());
        }
        data_->GetPointData()->SetNormals(array);
    }

private:
    /// \param places of the corners of simplices, corner by corner
    void add_references(std::span<const Point> places) {
        if (places.empty()) return;
        if (reference_ == nullptr) {
            reference_ = vtkSmartPointer<vtkDoubleArray>::New();
            reference_->SetName("reference");
            reference_->SetNumberOfComponents(3 * dimension);
            data_->GetCellData()->AddArray(reference_);
        }
        for (const Point& place : places) {
            for (const double x : place) reference_->InsertNextValue(x);
        }
    }
    /// \param count of attributes, vertex by vertex
    void add_attributes(std::span<const double> values, std::size_t count) {
        for (std::size_t i = attributes_.size(); i < count; ++i) {
            attributes_.push_back(vtkSmartPointer<vtkDoubleArray>::New());
            const std::string name =
                i < names_.size() ? names_[i] : "attribute " + std::to_string(i);
            attributes_[i]->SetName(name.c_str());
            data_->GetPointData()->AddArray(attributes_[i]);
        }
        for (std::size_t i = 0; i < values.size(); ++i) {
            attributes_[i % count]->InsertNextValue(values[i]);
        }
    }

    std::vector<std::string> names_;
    vtkSmartPointer<vtkPolyData> data_ = vtkSmartPointer<vtkPolyData>::New();
    vtkSmartPointer<vtkPoints> points_ = vtkSmartPointer<vtkPoints>::New();
    vtkSmartPointer<vtkCellArray> cells_ = vtkSmartPointer<vtkCellArray>::New();
    vtkSmartPointer<vtkIntArray> element_ = vtkSmartPointer<vtkIntArray>::New();
    vtkSmartPointer<vtkIntArray> level_ = vtkSmartPointer<vtkIntArray>::New();
    std::vector<vtkSmartPointer<vtkDoubleArray>> attributes_;
    vtkSmartPointer<vtkDoubleArray> reference_;
    int elements_ = 0;
};

/// The surface as vtkPolyData with copies of its arrays.
/// \param attributes names, as of the PolyDataSink
template <int dimension>
vtkSmartPointer<vtkPolyData> make_poly_data(const Surface<dimension>& surface,
                                            std::vector<std::string> attributes = {}) {
    PolyDataSink<dimension> sink(std::move(attributes));
    sink.take(surface);
    if (!surface.normals.empty()) sink.set_normals(surface.normals);
    return sink.data();
}

/// Lines as vtkPolyData: one cell a line, with its value ("value"); points have the attributes.
/// \param attributes their names
inline vtkSmartPointer<vtkPolyData> make_poly_data(
    const Polylines& lines, const std::vector<std::string>& attributes = {}) {
    Surface<2> vertices;
    vertices.vertices = lines.vertices;
    vertices.attributes = lines.attributes;
    PolyDataSink<2> sink(attributes);
    sink.take(vertices);
    const vtkNew<vtkPolyData> data;
    data->SetPoints(sink.data()->GetPoints());
    data->GetPointData()->ShallowCopy(sink.data()->GetPointData());
    const vtkNew<vtkCellArray> cells;
    const vtkNew<vtkDoubleArray> value;
    value->SetName("value");
    for (std::size_t i = 0; i < lines.count(); ++i) {
        cells->InsertNextCell(static_cast<int>(lines.line(i).size()));
        for (const std::uint32_t v : lines.line(i)) {
            cells->InsertCellPoint(static_cast<vtkIdType>(v));
        }
        value->InsertNextValue(lines.value[i]);
    }
    data->SetLines(cells);
    data->GetCellData()->AddArray(value);
    return data.GetPointer();
}

/// The surface as vtkPolyData on its own arrays: positions, corners of simplices, normals and
/// attributes ("attributes", one component each). It must outlive the result and stay as it is.
/// \throw InvalidInput for more vertices, or corners of simplices, than 32 bits number
template <int dimension>
vtkSmartPointer<vtkPolyData> share_poly_data(Surface<dimension>& surface) {
    constexpr std::size_t limit = std::numeric_limits<std::int32_t>::max();
    if (std::max(surface.vertices.size(), dimension * surface.simplices.size()) > limit) {
        throw InvalidInput("the surface is too large for VTK's arrays of 32 bits");
    }
    const auto share = [](double* of, std::size_t tuples, std::size_t components) {
        const vtkNew<vtkDoubleArray> array;
        array->SetNumberOfComponents(static_cast<int>(components));
        array->SetArray(of, static_cast<vtkIdType>(tuples) * static_cast<vtkIdType>(components), 1);
        return vtkSmartPointer<vtkDoubleArray>(array);
    };
    const std::size_t vertices = surface.vertices.size();
    const vtkNew<vtkPolyData> data;
    const vtkNew<vtkPoints> points;
    if (vertices > 0) points->SetData(share(surface.vertices[0].data(), vertices, 3));
    data->SetPoints(points);
    const auto n = static_cast<vtkIdType>(surface.simplices.size());
    const vtkNew<vtkTypeInt32Array> offsets;
    offsets->SetNumberOfTuples(n + 1);
    for (vtkIdType i = 0; i <= n; ++i) {
        offsets->SetValue(i, static_cast<std::int32_t>(dimension * i));
    }
    const vtkNew<vtkTypeInt32Array> corners;
    if (n > 0) {
        // Signed and unsigned integers of one width may share memory.
        corners->SetArray(reinterpret_cast<std::int32_t*>(surface.simplices[0].data()),
                          dimension * n, 1);
    }
    const vtkNew<vtkCellArray> cells;
    cells->SetData(offsets, corners);
    dimension == 3 ? data->SetPolys(cells) : data->SetLines(cells);
    if (!surface.normals.empty()) {
        const auto normals = share(surface.normals[0].data(), vertices, 3);
        normals->SetName("Normals");
        data->GetPointData()->SetNormals(normals);
    }
    if (!surface.attributes.empty()) {
        const auto attributes =
            share(surface.attributes.data(), vertices, surface.attributes.size() / vertices);
        attributes->SetName("attributes");
        data->GetPointData()->AddArray(attributes);
    }
    return data;
}

}  // namespace nestgrid
