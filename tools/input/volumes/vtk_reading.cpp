// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/volumes/vtk_reading.hpp"

#include <algorithm>

#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <nestgrid/error.hpp>

namespace {

using nestgrid::InvalidInput;
using nestgrid::IoError;

std::string type_name(vtkDataArray* array) {
    const std::string bits = std::to_string(8 * array->GetDataTypeSize());
    switch (array->GetDataType()) {
        case VTK_FLOAT:
        case VTK_DOUBLE:
            return "float" + bits;
        case VTK_UNSIGNED_CHAR:
        case VTK_UNSIGNED_SHORT:
        case VTK_UNSIGNED_INT:
        case VTK_UNSIGNED_LONG:
        case VTK_UNSIGNED_LONG_LONG:
            return "uint" + bits;
        case VTK_CHAR:
        case VTK_SIGNED_CHAR:
        case VTK_SHORT:
        case VTK_INT:
        case VTK_LONG:
        case VTK_LONG_LONG:
            return "int" + bits;
        default:
            return "";
    }
}

}  // namespace

void VtkReading::listen(vtkAlgorithm* reader) const {
    reader->AddObserver(vtkCommand::ErrorEvent, errors_);
    reader->AddObserver(vtkCommand::WarningEvent, errors_);
}

void VtkReading::check() const {
    if (errors_->message.empty()) return;
    throw IoError(path_.string() + " cannot be read: " + errors_->message);
}

std::uintmax_t VtkReading::read_header(vtkAlgorithm* reader) const {
    reader->UpdateInformation();
    check();
    std::array<int, 6> extent{0, -1, 0, -1, 0, -1};
    vtkInformation* info = reader->GetOutputInformation(0);
    info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
    double samples = 1;
    for (std::size_t d = 0; d < 3; ++d) {
        samples *= std::max(0.0, extent[2 * d + 1] - extent[2 * d] + 1.0);
    }
    check_plausible(path_, std::filesystem::file_size(path_), samples);
    return static_cast<std::uintmax_t>(samples);
}

vtkSmartPointer<vtkImageData> VtkReading::read_samples(vtkAlgorithm* reader) const {
    reader->Update();
    check();
    auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
    if (image == nullptr) throw IoError(path_.string() + " holds no image data");
    return image;
}

void set_numbers(FileSamples& samples, vtkDataArray* array) {
    samples.type = type_name(array);
    if (samples.type.empty()) {
        throw InvalidInput(samples.path.string() + " has samples of a type that is not read");
    }
    double count = 1;
    for (const int n : samples.geometry.samples) count *= n;
    if (static_cast<double>(array->GetNumberOfTuples()) != count) {
        throw IoError(samples.path.string() + " holds fewer samples than its header says");
    }
    const vtkSmartPointer<vtkDataArray> kept = array;
    samples.memory = std::make_shared<vtkSmartPointer<vtkDataArray>>(kept);
    samples.data = static_cast<std::byte*>(array->GetVoidPointer(0));
    samples.components.count = static_cast<std::size_t>(array->GetNumberOfComponents());
    set_dense_strides(samples);
}

void set_geometry(FileSamples& samples, vtkImageData* image) {
    auto& geometry = samples.geometry;
    image->GetDimensions(geometry.samples.data());
    image->GetSpacing(geometry.spacing.data());
    std::array<int, 6> extent{};
    image->GetExtent(extent.data());
    image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], geometry.origin.data());
    const double* direction = image->GetDirectionMatrix()->GetData();
    for (std::size_t i = 0; i < 9; ++i) geometry.direction[i / 3][i % 3] = direction[i];
}
