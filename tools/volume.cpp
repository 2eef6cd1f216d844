// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "volume.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLImageDataReader.h>

#include <nestgrid/error.hpp>

#include "child_process.hpp"
#include "end_checks.hpp"
#include "input_file.hpp"
#include "sample_layout.hpp"
#include "suggestion.hpp"
#include "text_header.hpp"
#include "vtk_errors.hpp"

namespace {

using nestgrid::InvalidInput;
using nestgrid::IoError;
namespace fs = std::filesystem;

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

/// A large whole number without an exponent.
std::string whole(double number) {
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(), "%.0f", number);
    return text.data();
}

/// A volume as VTK reads it, and where it is in space.
struct VtkVolume {
    vtkSmartPointer<vtkImageData> image;
    nestgrid::LatticeGeometry<3> geometry;
    std::string name{};
    std::string length_unit{};
};

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
    /// Reads the header; what it asks for must be plausible for the size of the file.
    /// \return the number of samples
    std::uintmax_t read_header(vtkAlgorithm* reader) const {
        reader->UpdateInformation();
        check();
        std::array<int, 6> extent{0, -1, 0, -1, 0, -1};
        vtkInformation* info = reader->GetOutputInformation(0);
        info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
        double samples = 1;
        for (std::size_t d = 0; d < 3; ++d) {
            samples *= std::max(0.0, extent[2 * d + 1] - extent[2 * d] + 1.0);
        }
        const std::uintmax_t found = fs::file_size(path);
        // Deflate packs at most 1032 to 1.
        if (samples > 1032 * static_cast<double>(found)) {
            throw IoError(path.string() + " is truncated: " + std::to_string(found) +
                          " bytes cannot hold " + whole(samples) + " samples");
        }
        return static_cast<std::uintmax_t>(samples);
    }
    vtkSmartPointer<vtkImageData> read_samples(vtkAlgorithm* reader) const {
        reader->Update();
        check();
        auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
        if (image == nullptr) throw IoError(path.string() + " holds no image data");
        return image;
    }
};

void set_direction(VtkVolume& volume, const vtkMatrix4x4* matrix) {
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            volume.geometry.direction[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] =
                matrix->GetElement(r, c);
        }
        volume.geometry.origin[static_cast<std::size_t>(r)] = matrix->GetElement(r, 3);
    }
}

void set_geometry(VtkVolume& volume) {
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

std::string text_of(const char* text) { return text == nullptr ? "" : text; }

/// The unit of length that xyzt_units of a NIfTI header has.
std::string nifti_length_unit(int units) {
    constexpr std::array<const char*, 4> names{"", "m", "mm", "µm"};
    const auto code = static_cast<std::size_t>(units) & 7U;
    return code < names.size() ? names[code] : "";
}

VtkVolume read_nifti(const Reading& reading) {
    const vtkNew<vtkNIFTIImageReader> reader;
    reading.listen(reader);
    if (reader->CanReadFile(reading.path.c_str()) == 0) {
        throw IoError(reading.path.string() + " is no NIfTI file, or truncated in its header");
    }
    reader->SetFileName(reading.path.c_str());
    const std::uintmax_t samples = reading.read_header(reader);
    if (reader->GetTimeDimension() > 1) {
        throw IoError(reading.path.string() + " has " + std::to_string(reader->GetTimeDimension()) +
                      " volumes, one after the other: give each in a file of its own");
    }
    const int bytes = vtkDataArray::GetDataTypeSize(reader->GetDataScalarType());
    check_nifti_size(reading.path, samples * static_cast<std::uintmax_t>(bytes));
    VtkVolume volume;
    volume.image = reading.read_samples(reader);
    set_geometry(volume);
    const vtkMatrix4x4* matrix =
        reader->GetSFormMatrix() != nullptr ? reader->GetSFormMatrix() : reader->GetQFormMatrix();
    if (matrix != nullptr) set_direction(volume, matrix);
    volume.name = text_of(reader->GetNIFTIHeader()->GetIntentName());
    volume.length_unit = nifti_length_unit(reader->GetNIFTIHeader()->GetXYZTUnits());
    return volume;
}

std::vector<std::string> names_of_arrays(vtkPointData* data) {
    std::vector<std::string> names;
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        const char* name = data->GetArrayName(i);
        if (name != nullptr && data->GetArray(i) != nullptr) names.emplace_back(name);
    }
    return names;
}

/// Makes an array the active one: the named one, else the active one of the file, else the only
/// one.
void choose_array(const fs::path& path, const std::string& array, vtkPointData* data) {
    const std::vector<std::string> names = names_of_arrays(data);
    if (!array.empty() && data->SetActiveScalars(array.c_str()) < 0) {
        throw InvalidInput(path.string() + " has no point data array '" + array + "', " +
                           (names.empty() ? "and no other" : "only " + listed(names)) +
                           did_you_mean(array, names));
    }
    if (data->GetScalars() != nullptr) return;
    if (names.size() == 1) data->SetActiveScalars(names.front().c_str());
    if (names.size() > 1) {
        throw InvalidInput(path.string() +
                           " has several arrays, choose one by --array: " + listed(names));
    }
}

VtkVolume read_vti(const Reading& reading, const std::string& array) {
    const vtkNew<vtkXMLImageDataReader> reader;
    reading.listen(reader);
    if (reader->CanReadFile(reading.path.c_str()) == 0) {
        throw IoError(reading.path.string() + " is no VTK image data file");
    }
    check_xml_end(reading.path);
    reader->SetFileName(reading.path.c_str());
    reading.read_header(reader);
    VtkVolume volume;
    volume.image = reading.read_samples(reader);
    vtkPointData* data = volume.image->GetPointData();
    choose_array(reading.path, array, data);
    set_geometry(volume);
    if (data->GetScalars() != nullptr) volume.name = text_of(data->GetScalars()->GetName());
    // VTK's own name for what nobody has named.
    if (volume.name == "ImageScalars") volume.name.clear();
    return volume;
}

SampleLayout raw_layout(const fs::path& path, const RawFormat& raw) {
    const std::size_t size = bytes_of(raw.type);
    if (size == 0 || *std::min_element(raw.dims.begin(), raw.dims.end()) < 1) {
        throw InvalidInput(path.string() +
                           " does not describe itself: give --dims NX,NY,NZ and --type");
    }
    SampleLayout layout{.path = path, .type = raw.type};
    layout.files = {path};
    layout.geometry.samples = raw.dims;
    std::copy(raw.spacing.begin(), raw.spacing.end(), layout.geometry.spacing.begin());
    layout.big_endian = raw.big_endian;
    auto expected = static_cast<double>(size);
    for (const int n : raw.dims) expected *= n;
    const std::uintmax_t found = fs::file_size(path);
    if (static_cast<double>(found) != expected) {
        throw IoError(path.string() + " has " + std::to_string(found) +
                      " bytes, but --dims and --type ask for " + whole(expected));
    }
    return layout;
}

/// What precedes the samples in a parcel.
struct Description {
    std::array<char, 8> type{};
    std::array<char, 64> name{};
    std::array<char, 16> length_unit{};
    nestgrid::LatticeGeometry<3> geometry;

    Description(const std::string& type_name, const nestgrid::LatticeGeometry<3>& g) : geometry{g} {
        put(type_name, type);
    }
    /// Puts a text that a file gives, cut short, without what a terminal obeys.
    template <std::size_t size>
    static void put(const std::string& text, std::array<char, size>& to) {
        const std::size_t count = std::min(size - 1, text.size());
        std::transform(
            text.begin(), text.begin() + static_cast<std::ptrdiff_t>(count), to.begin(),
            [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127 ? '?' : c; });
    }
    std::size_t sample_count() const {
        std::size_t count = 1;
        for (const int n : geometry.samples) count *= static_cast<std::size_t>(n);
        return count;
    }
};

void check_samples(const fs::path& path, const Description& volume, const std::byte* data) {
    const auto n = volume.geometry.samples;
    if (*std::min_element(n.begin(), n.end()) < 2) {
        throw InvalidInput(path.string() + " has " + std::to_string(n[0]) + " x " +
                           std::to_string(n[1]) + " x " + std::to_string(n[2]) +
                           " samples; an isosurface needs at least 2 along each direction");
    }
    with_samples(volume.type.data(), data, volume.sample_count(), [&](auto samples) {
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

void read_layout(const SampleLayout& layout, std::size_t bytes, Parcel& parcel) {
    Description description(layout.type, layout.geometry);
    Description::put(layout.name, description.name);
    Description::put(layout.unit, description.length_unit);
    parcel.put(std::span<const Description>(&description, 1));
    const std::span<std::byte> samples = parcel.append(bytes);
    read_samples(layout, samples);
    check_samples(layout.path, description, samples.data());
}

void read_with_vtk(const fs::path& path, const std::string& array, Parcel& parcel) {
    const Reading reading{path};
    const bool is_vti = lower(path.filename().string()).ends_with(".vti");
    const VtkVolume volume = is_vti ? read_vti(reading, array) : read_nifti(reading);
    vtkDataArray* scalars = volume.image->GetPointData()->GetScalars();
    if (scalars == nullptr) {
        throw InvalidInput(path.string() + " has no point data that could be contoured");
    }
    if (scalars->GetNumberOfComponents() != 1) {
        throw InvalidInput(path.string() + " has " +
                           std::to_string(scalars->GetNumberOfComponents()) +
                           " numbers per sample, not one");
    }
    const std::string type = type_name(scalars->GetDataType());
    if (type.empty()) {
        throw InvalidInput(path.string() + " has samples of a type that is not read");
    }
    Description description(type, volume.geometry);
    Description::put(volume.name, description.name);
    Description::put(volume.length_unit, description.length_unit);
    const std::size_t count = description.sample_count();
    if (static_cast<std::size_t>(scalars->GetNumberOfTuples()) != count) {
        throw IoError(path.string() + " holds fewer samples than its header says");
    }
    auto* data = static_cast<std::byte*>(scalars->GetVoidPointer(0));
    check_samples(path, description, data);
    parcel.put(std::span<const Description>(&description, 1));
    parcel.put_last_use({data, count * bytes_of(type)});
}

/// The volume in a parcel, whose samples stay there.
Volume open_volume(std::shared_ptr<const Parcel> parcel) {
    const Description& description = parcel->block<Description>(0).front();
    const std::span<const std::byte> samples = parcel->block<std::byte>(1);
    Volume volume;
    volume.type = description.type.data();
    volume.name = description.name.data();
    volume.length_unit = description.length_unit.data();
    volume.geometry = description.geometry;
    const auto type = std::find_if(types.begin(), types.end(),
                                   [&](const NamedType& t) { return volume.type == t.name; });
    const auto array =
        vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type->vtk));
    // VTK takes no const pointer, and does not write to what it borrows.
    array->SetVoidArray(const_cast<std::byte*>(samples.data()),
                        static_cast<vtkIdType>(description.sample_count()), 1);
    volume.image = vtkSmartPointer<vtkImageData>::New();
    volume.image->SetDimensions(volume.geometry.samples.data());
    volume.image->SetSpacing(volume.geometry.spacing.data());
    volume.image->GetPointData()->SetScalars(array);
    volume.memory = std::move(parcel);
    return volume;
}

/// Says what could be done with a file that is no volume.
std::string unknown_format(const fs::path& path) {
    const std::string ending = ending_of(path);
    for (const char* mesh : {".off", ".obj", ".ply", ".stl", ".node", ".ele", ".poly", ".smesh"}) {
        if (ending == mesh)
            return " is a mesh without data: 'nestgrid mesh' makes a hierarchy of it";
    }
    const std::vector<std::string> known{".vti", ".mhd", ".mha", ".nrrd", ".nhdr",
                                         ".nii", ".gz",  ".raw", ".png",  ".nestgrid"};
    return " is of no known format (.vti, .mhd, .mha, .nrrd, .nhdr, .nii, .nii.gz, .raw, "
           ".nestgrid, or a picture)" +
           did_you_mean(ending, known);
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

Volume read_volume(const fs::path& path, const std::string& array, const RawFormat& raw,
                   double seconds) {
    require_file(path);
    const std::string name = lower(path.filename().string());
    const auto is = [&](std::initializer_list<const char*> endings) {
        return std::any_of(endings.begin(), endings.end(),
                           [&](const char* ending) { return name.ends_with(ending); });
    };
    std::optional<SampleLayout> layout;
    if (is({".mhd", ".mha"})) layout = meta_layout(path);
    if (is({".nrrd", ".nhdr"})) layout = nrrd_layout(path);
    if (is({".raw"})) layout = raw_layout(path, raw);
    if (!layout && !is({".vti", ".nii", ".nii.gz"})) {
        throw IoError(path.string() + unknown_format(path));
    }
    const std::size_t bytes = layout ? checked_size(*layout) : fs::file_size(path);
    if (!(seconds > 0)) seconds = reading_time(bytes);
    return open_volume(run_apart(path.string(), seconds, [&](Parcel& parcel) {
        layout ? read_layout(*layout, bytes, parcel) : read_with_vtk(path, array, parcel);
    }));
}
