// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "volume.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkImageReader.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkMetaImageReader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkNrrdReader.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLImageDataReader.h>

#include <nestgrid/error.hpp>

#include "file_checks.hpp"

namespace {

using nestgrid::InvalidInput;
using nestgrid::IoError;
namespace fs = std::filesystem;

/// Collects what VTK would print.
class ErrorCollector : public vtkCommand {
public:
    static ErrorCollector* New() { return new ErrorCollector; }  // NOLINT(*-naming)
    void Execute(vtkObject*, unsigned long, void* data) override {
        if (!message.empty()) return;
        const std::string text = data == nullptr ? "" : static_cast<const char*>(data);
        const std::size_t start = text.find("): ");
        message = start == std::string::npos ? text : text.substr(start + 3);
        std::replace(message.begin(), message.end(), '\n', ' ');
        message.erase(message.find_last_not_of(' ') + 1);
        if (message.empty()) message = "it cannot be read";
    }
    std::string message;
};

struct NamedType {
    const char* name;
    int vtk;
};
constexpr std::array<NamedType, 10> types{{{"uint8", VTK_UNSIGNED_CHAR},
                                           {"int8", VTK_SIGNED_CHAR},
                                           {"uint16", VTK_UNSIGNED_SHORT},
                                           {"int16", VTK_SHORT},
                                           {"uint32", VTK_UNSIGNED_INT},
                                           {"int32", VTK_INT},
                                           {"uint64", VTK_UNSIGNED_LONG},
                                           {"int64", VTK_LONG},
                                           {"float32", VTK_FLOAT},
                                           {"float64", VTK_DOUBLE}}};

std::string type_name(int vtk_type) {
    if (vtk_type == VTK_CHAR) return "int8";
    if (vtk_type == VTK_UNSIGNED_LONG_LONG) return "uint64";
    if (vtk_type == VTK_LONG_LONG) return "int64";
    for (const NamedType& t : types) {
        if (t.vtk == vtk_type) return t.name;
    }
    return "";
}

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

struct Reading {
    fs::path path;
    vtkSmartPointer<ErrorCollector> errors = vtkSmartPointer<ErrorCollector>::New();

    void listen(vtkAlgorithm* reader) const {
        reader->AddObserver(vtkCommand::ErrorEvent, errors);
        reader->AddObserver(vtkCommand::WarningEvent, errors);
    }
    void check() const {
        if (!errors->message.empty()) {
            throw IoError(path.string() + " cannot be read: " + errors->message);
        }
    }
    /// The header first; what it asks for must be plausible for the size of the file.
    vtkSmartPointer<vtkImageData> run(vtkAlgorithm* reader, bool compressed,
                                      int sample_bytes) const {
        reader->UpdateInformation();
        check();
        std::array<int, 6> extent{0, -1, 0, -1, 0, -1};
        vtkInformation* info = reader->GetOutputInformation(0);
        info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
        double expected = sample_bytes;
        for (std::size_t d = 0; d < 3; ++d) expected *= extent[2 * d + 1] - extent[2 * d] + 1.0;
        const auto found = static_cast<double>(fs::file_size(path));
        // Deflate packs at most 1032 to 1.
        if (expected > found * (compressed ? 1100 : 1)) {
            truncated(path, fs::file_size(path),
                      static_cast<std::uintmax_t>(std::min(expected, 1e18)));
        }
        reader->Update();
        check();
        auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
        if (image == nullptr) throw IoError(path.string() + " holds no image data");
        return image;
    }
};

void set_direction(Volume& volume, const vtkMatrix4x4* matrix) {
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            volume.geometry.direction[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] =
                matrix->GetElement(r, c);
        }
        volume.geometry.origin[static_cast<std::size_t>(r)] = matrix->GetElement(r, 3);
    }
}

void set_geometry(Volume& volume) {
    std::array<int, 3> dims{};
    volume.image->GetDimensions(dims.data());
    volume.geometry.samples = dims;
    volume.image->GetSpacing(volume.geometry.spacing.data());
    std::array<int, 6> extent{};
    volume.image->GetExtent(extent.data());
    volume.image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4],
                                                volume.geometry.origin.data());
    const double* direction = volume.image->GetDirectionMatrix()->GetData();
    for (std::size_t i = 0; i < 9; ++i) volume.geometry.direction[i / 3][i % 3] = direction[i];
}

Volume read_meta(const Reading& reading) {
    check_meta_sizes(reading.path);
    const vtkNew<vtkMetaImageReader> reader;
    reading.listen(reader);
    reader->SetFileName(reading.path.c_str());
    Volume volume;
    volume.image = reading.run(reader, true, 1);
    set_geometry(volume);
    const TextHeader header = read_text_header(reading.path, '=', "elementdatafile");
    for (const char* key : {"transformmatrix", "rotation", "orientation"}) {
        const std::vector<double> m = header.numbers(key);
        if (m.size() != 9) continue;
        // MetaImage lists the axes one after the other.
        for (std::size_t i = 0; i < 9; ++i) volume.geometry.direction[i % 3][i / 3] = m[i];
        break;
    }
    return volume;
}

Volume read_nrrd(const Reading& reading) {
    const TextHeader header = read_text_header(reading.path, ':', "");
    check_nrrd_sizes(reading.path, header);
    const vtkNew<vtkNrrdReader> reader;
    reading.listen(reader);
    if (reader->CanReadFile(reading.path.c_str()) == 0) {
        throw IoError(reading.path.string() + " is no NRRD file that can be read");
    }
    reader->SetFileName(reading.path.c_str());
    Volume volume;
    volume.image = reading.run(reader, true, 1);
    set_geometry(volume);
    const std::vector<double> axes = header.numbers("space directions");
    const std::vector<double> origin = header.numbers("space origin");
    if (axes.size() == 9) {
        for (std::size_t d = 0; d < 3; ++d) {
            const nestgrid::Point axis{axes[3 * d], axes[3 * d + 1], axes[3 * d + 2]};
            volume.geometry.spacing[d] = nestgrid::norm(axis);
            for (std::size_t r = 0; r < 3; ++r) {
                volume.geometry.direction[r][d] = axis[r] / volume.geometry.spacing[d];
            }
        }
    }
    if (origin.size() == 3) std::copy_n(origin.begin(), 3, volume.geometry.origin.begin());
    return volume;
}

Volume read_nifti(const Reading& reading, bool compressed) {
    const vtkNew<vtkNIFTIImageReader> reader;
    reading.listen(reader);
    if (reader->CanReadFile(reading.path.c_str()) == 0) {
        throw IoError(reading.path.string() + " is no NIfTI file, or truncated in its header");
    }
    reader->SetFileName(reading.path.c_str());
    reader->UpdateInformation();
    reading.check();
    std::array<int, 6> extent{};
    reader->GetDataExtent(extent.data());
    auto expected =
        static_cast<std::uintmax_t>(vtkDataArray::GetDataTypeSize(reader->GetDataScalarType()));
    for (std::size_t d = 0; d < 3; ++d) {
        expected *= static_cast<std::uintmax_t>(extent[2 * d + 1] - extent[2 * d] + 1);
    }
    expected += nifti_offset(reading.path);
    const std::uintmax_t found =
        compressed ? unpacked_size(reading.path) : fs::file_size(reading.path);
    if (found < expected) truncated(reading.path, found, expected);
    Volume volume;
    volume.image = reading.run(reader, compressed, 1);
    set_geometry(volume);
    const vtkMatrix4x4* matrix =
        reader->GetSFormMatrix() != nullptr ? reader->GetSFormMatrix() : reader->GetQFormMatrix();
    if (matrix != nullptr) set_direction(volume, matrix);
    return volume;
}

Volume read_vti(const Reading& reading, const std::string& array) {
    const vtkNew<vtkXMLImageDataReader> reader;
    reading.listen(reader);
    if (reader->CanReadFile(reading.path.c_str()) == 0) {
        throw IoError(reading.path.string() + " is no VTK image data file");
    }
    check_xml_end(reading.path);
    reader->SetFileName(reading.path.c_str());
    Volume volume;
    volume.image = reading.run(reader, true, 1);
    vtkPointData* data = volume.image->GetPointData();
    if (!array.empty() && data->SetActiveScalars(array.c_str()) < 0) {
        throw InvalidInput(reading.path.string() + " has no point data array '" + array + "'");
    }
    if (data->GetScalars() == nullptr && data->GetNumberOfArrays() == 1 &&
        data->GetArray(0) != nullptr) {
        data->SetActiveScalars(data->GetArray(0)->GetName());
    }
    set_geometry(volume);
    return volume;
}

Volume read_raw(const Reading& reading, const RawFormat& raw) {
    const auto type = std::find_if(types.begin(), types.end(),
                                   [&](const NamedType& t) { return raw.type == t.name; });
    if (type == types.end() || *std::min_element(raw.dims.begin(), raw.dims.end()) < 1) {
        throw InvalidInput(reading.path.string() +
                           " does not describe itself: give --dims NX,NY,NZ and --type");
    }
    const auto size = static_cast<std::uintmax_t>(vtkDataArray::GetDataTypeSize(type->vtk));
    const std::uintmax_t expected = size * static_cast<std::uintmax_t>(raw.dims[0]) *
                                    static_cast<std::uintmax_t>(raw.dims[1]) *
                                    static_cast<std::uintmax_t>(raw.dims[2]);
    const std::uintmax_t found = fs::file_size(reading.path);
    if (found != expected) {
        throw IoError(reading.path.string() + " has " + std::to_string(found) +
                      " bytes, but --dims and --type ask for " + std::to_string(expected));
    }
    const vtkNew<vtkImageReader> reader;
    reading.listen(reader);
    reader->SetFileName(reading.path.c_str());
    reader->SetFileDimensionality(3);
    reader->SetDataExtent(0, raw.dims[0] - 1, 0, raw.dims[1] - 1, 0, raw.dims[2] - 1);
    reader->SetDataSpacing(raw.spacing[0], raw.spacing[1], raw.spacing[2]);
    reader->SetDataScalarType(type->vtk);
    reader->SetHeaderSize(0);
    reader->FileLowerLeftOn();
    raw.big_endian ? reader->SetDataByteOrderToBigEndian()
                   : reader->SetDataByteOrderToLittleEndian();
    Volume volume;
    volume.image = reading.run(reader, false, static_cast<int>(size));
    set_geometry(volume);
    return volume;
}

void check_samples(const Volume& volume, const fs::path& path) {
    const auto n = volume.geometry.samples;
    if (*std::min_element(n.begin(), n.end()) < 2) {
        throw InvalidInput(path.string() + " has " + std::to_string(n[0]) + " x " +
                           std::to_string(n[1]) + " x " + std::to_string(n[2]) +
                           " samples; an isosurface needs at least 2 along each direction");
    }
    if (volume.type.compare(0, 5, "float") != 0) return;
    with_samples(volume, [&](auto samples) {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (std::isfinite(static_cast<double>(samples[i]))) continue;
            const auto nx = static_cast<std::size_t>(n[0]);
            const auto ny = static_cast<std::size_t>(n[1]);
            throw InvalidInput(
                path.string() + ": the sample at (" + std::to_string(i % nx) + ", " +
                std::to_string(i / nx % ny) + ", " + std::to_string(i / nx / ny) + ") is " +
                (std::isnan(static_cast<double>(samples[i])) ? "not a number" : "infinite"));
        }
    });
}

}  // namespace

std::size_t leaf_count(const nestgrid::LatticeBisection<3>& grid) {
    std::size_t leaves = 6;
    for (std::size_t d = 0; d < 3; ++d) leaves *= grid.samples(d) - 1;
    return leaves;
}

std::size_t Volume::sample_count() const {
    return static_cast<std::size_t>(geometry.samples[0]) *
           static_cast<std::size_t>(geometry.samples[1]) *
           static_cast<std::size_t>(geometry.samples[2]);
}

Volume read_volume(const fs::path& path, const std::string& array, const RawFormat& raw) {
    if (!fs::exists(path)) throw IoError(path.string() + " does not exist");
    if (!fs::is_regular_file(path)) throw IoError(path.string() + " is no file");
    if (std::ifstream file(path); !file) throw IoError(path.string() + " cannot be opened");
    if (fs::file_size(path) == 0) throw IoError(path.string() + " is empty");
    const Reading reading{path};
    const std::string name = lower(path.filename().string());
    Volume volume;
    if (ends_with(name, ".vti")) {
        volume = read_vti(reading, array);
    } else if (ends_with(name, ".mhd") || ends_with(name, ".mha")) {
        volume = read_meta(reading);
    } else if (ends_with(name, ".nrrd") || ends_with(name, ".nhdr")) {
        volume = read_nrrd(reading);
    } else if (ends_with(name, ".nii") || ends_with(name, ".nii.gz")) {
        volume = read_nifti(reading, ends_with(name, ".gz"));
    } else if (ends_with(name, ".raw")) {
        volume = read_raw(reading, raw);
    } else {
        throw IoError(path.string() +
                      " is of no known format (.vti, .mhd, .mha, .nrrd, .nii, .nii.gz, .raw)");
    }
    vtkDataArray* scalars = volume.image->GetPointData()->GetScalars();
    if (scalars == nullptr) {
        throw InvalidInput(path.string() + " has no point data that could be contoured");
    }
    if (scalars->GetNumberOfComponents() != 1) {
        throw InvalidInput(path.string() + " has " +
                           std::to_string(scalars->GetNumberOfComponents()) +
                           " numbers per sample, not one");
    }
    volume.type = type_name(scalars->GetDataType());
    if (volume.type.empty()) {
        throw InvalidInput(path.string() + " has samples of a type that is not read");
    }
    if (static_cast<std::size_t>(scalars->GetNumberOfTuples()) != volume.sample_count()) {
        throw IoError(path.string() + " holds fewer samples than its header says");
    }
    check_samples(volume, path);
    return volume;
}
