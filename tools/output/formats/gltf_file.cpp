// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// glTF (.gltf), in one file, by VTK. Points of glTF are of single precision: where that would move
// them, they are written relative to an origin, by which the scene is translated. What is known of
// the surface stands in the extras of the scene's node.
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>

#include <json/reader.h>
#include <json/writer.h>

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkGLTFWriter.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>

#include "formats.hpp"
#include "output/formats/vtk_writing.hpp"
#include "output/precision.hpp"

namespace {

/// glTF takes a tree of blocks.
vtkSmartPointer<vtkMultiBlockDataSet> as_blocks(vtkPolyData* surface) {
    const vtkNew<vtkMultiBlockDataSet> building;
    building->SetBlock(0, surface);
    auto scene = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    scene->SetBlock(0, building);
    return scene;
}

using Origin = std::optional<std::array<double, 3>>;

vtkSmartPointer<vtkPoints> relative_to(const std::array<double, 3>& origin, vtkPoints* points) {
    auto result = vtkSmartPointer<vtkPoints>::New();
    result->SetNumberOfPoints(points->GetNumberOfPoints());
    std::array<double, 3> x{};
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i) {
        points->GetPoint(i, x.data());
        for (std::size_t d = 0; d < 3; ++d) x[d] -= origin[d];
        result->SetPoint(i, x.data());
    }
    return result;
}

/// The surface as VTK's writer wants it: normals have the name that glTF gives them.
vtkSmartPointer<vtkPolyData> prepared(vtkPolyData* surface, const Origin& origin) {
    auto result = vtkSmartPointer<vtkPolyData>::New();
    result->ShallowCopy(surface);
    if (origin) result->SetPoints(relative_to(*origin, surface->GetPoints()));
    if (vtkDataArray* const normals = surface->GetPointData()->GetNormals()) {
        const vtkNew<vtkFloatArray> named;
        named->DeepCopy(normals);
        named->SetName("NORMAL");
        result->GetPointData()->AddArray(named);
    }
    return result;
}

/// The field data: the unit of length, the space and values.
Json::Value known_of(vtkPolyData* surface) {
    Json::Value known(Json::objectValue);
    vtkFieldData* const data = surface->GetFieldData();
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        vtkAbstractArray* const array = data->GetAbstractArray(i);
        if (array->GetName() == nullptr || array->GetNumberOfValues() == 0) continue;
        const vtkVariant value = array->GetVariantValue(0);
        known[array->GetName()] =
            value.IsNumeric() ? Json::Value(value.ToDouble()) : Json::Value(value.ToString());
    }
    return known;
}

/// Adds to a file what VTK's writer leaves out.
/// \return why it could not be done, or nothing
std::string complete(const std::filesystem::path& path, const Json::Value& known,
                     const Origin& origin) {
    Json::Value document;
    std::string reason;
    std::ifstream in(path);
    if (!Json::parseFromStream(Json::CharReaderBuilder(), in, &document, &reason)) return reason;
    const Json::ArrayIndex root = document["scenes"][0]["nodes"][0].asUInt();
    Json::Value& node = document["nodes"][root];
    if (!known.empty()) node["extras"] = known;
    for (std::size_t d = 0; origin && d < 3; ++d) node["translation"].append((*origin)[d]);
    Json::StreamWriterBuilder builder;
    builder["indentation"] = "";
    std::ofstream out(path);
    out << Json::writeString(builder, document) << "\n";
    out.close();
    return out ? "" : std::strerror(errno);
}

std::string write_gltf(vtkPolyData* surface, const std::filesystem::path& path,
                       const SurfaceEncoding& /*no choice*/) {
    const vtkNew<vtkGLTFWriter> writer;
    writer->InlineDataOn();
    writer->SaveNormalOn();
    Origin origin;
    if (!single_keeps_shape(surface)) {
        origin.emplace();
        surface->GetCenter(origin->data());
    }
    writer->SetInputData(as_blocks(prepared(surface, origin)));
    std::string reason = written_by(writer.Get(), path);
    const Json::Value known = known_of(surface);
    if (!reason.empty() || (known.empty() && !origin)) return reason;
    return complete(path, known, origin);
}

const RegisteredFormat gltf({.name = "glTF",
                             .endings = {".gltf"},
                             .holds = "triangles and normals",
                             .write_surface = write_gltf});

}  // namespace
