// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "volume.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <nestgrid/error.hpp>

#include "child_process.hpp"
#include "input_file.hpp"
#include "sample_layout.hpp"
#include "suggestion.hpp"
#include "text_header.hpp"

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

/// A large whole number without an exponent.
std::string whole(double number) {
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(), "%.0f", number);
    return text.data();
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

/// The volume in a parcel, whose samples stay there.
Volume open_volume(std::shared_ptr<const Parcel> parcel) {
    const VolumeDescription& description = parcel->block<VolumeDescription>(0).front();
    const std::span<const std::byte> samples = parcel->block<std::byte>(1);
    Volume volume;
    volume.type = description.type.data();
    volume.name = description.name.data();
    volume.length_unit = description.length_unit.data();
    volume.space = description.space.data();
    volume.note = description.note.data();
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

struct Reader {
    const char* ending;
    FileSamples (*read)(const fs::path& path, const WantedSamples& wanted);
};
constexpr std::array<Reader, 7> readers{{{".vti", read_vti},
                                         {".mhd", read_meta_image},
                                         {".mha", read_meta_image},
                                         {".nrrd", read_nrrd},
                                         {".nhdr", read_nrrd},
                                         {".nii", read_nifti},
                                         {".nii.gz", read_nifti}}};

/// The size of a file, and of those beside it that it may name where it is only a header.
std::uintmax_t bytes_to_read(const fs::path& path) {
    std::error_code none;
    std::uintmax_t bytes = fs::file_size(path);
    const std::string ending = ending_of(path);
    if (ending != ".mhd" && ending != ".nhdr") return bytes;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    for (fs::directory_iterator at(folder, none), end; !none && at != end; at.increment(none)) {
        const std::uintmax_t size = at->is_regular_file(none) ? at->file_size(none) : 0;
        if (!none) bytes += size;
    }
    return bytes;
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

Volume read_volume(const fs::path& path, const VolumeChoice& choice, const RawFormat& raw,
                   double seconds) {
    require_file(path);
    const std::string name = lower(path.filename().string());
    const auto reader = std::ranges::find_if(
        readers, [&](const Reader& each) { return name.ends_with(each.ending); });
    std::optional<SampleLayout> layout;
    if (name.ends_with(".raw")) layout = raw_layout(path, raw);
    if (!layout && reader == readers.end()) throw IoError(path.string() + unknown_format(path));
    if (!(seconds > 0)) seconds = reading_time(bytes_to_read(path));
    const WantedSamples wanted{choice.array, choice.frame.value_or(0) != 0};
    return open_volume(run_apart(path.string(), seconds, [&](Parcel& parcel) {
        FileSamples samples = layout ? read_layout(*layout) : reader->read(path, wanted);
        put_chosen(samples, choice, parcel);
    }));
}
