// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/volume.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <nestgrid/error.hpp>

#include "formats.hpp"
#include "input/child_process.hpp"
#include "input/input_file.hpp"
#include "input/mapped_file.hpp"
#include "suggestion.hpp"

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

/// Lets an image of VTK borrow the samples of a volume.
void set_image(Volume& volume, const std::byte* samples) {
    const auto type = std::ranges::find(types, volume.type, &NamedType::name);
    const auto array =
        vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type->vtk));
    // VTK takes no const pointer, and does not write to what it borrows.
    array->SetVoidArray(const_cast<std::byte*>(samples),
                        static_cast<vtkIdType>(volume.sample_count()), 1);
    volume.image = vtkSmartPointer<vtkImageData>::New();
    volume.image->SetDimensions(volume.geometry.samples.data());
    volume.image->SetSpacing(volume.geometry.spacing.data());
    volume.image->GetPointData()->SetScalars(array);
}

/// The samples of all frames that were chosen, in a parcel or in a file.
struct OpenedSamples {
    explicit OpenedSamples(std::shared_ptr<const Parcel> from)
        : parcel{std::move(from)},
          description{parcel->block<VolumeDescription>(0).front()},
          bytes{parcel->block<std::byte>(1)} {
        if (description.mapped_from < 0) return;
        const std::span<const char> path = parcel->block<char>(1);
        file.emplace(
            std::string(path.begin(), path.end()),
            static_cast<std::uintmax_t>(description.mapped_from),
            description.frames * description.sample_count() * bytes_of(description.type.data()));
        bytes = file->bytes();
    }

    std::shared_ptr<const Parcel> parcel;
    const VolumeDescription& description;
    std::optional<MappedFile> file;
    std::span<const std::byte> bytes;
};

/// A volume whose samples stay where they are.
/// \param frame of those that were chosen
Volume open_volume(const std::shared_ptr<const OpenedSamples>& kept, std::size_t frame) {
    const VolumeDescription& description = kept->description;
    const std::span<const std::byte> all = kept->bytes;
    const std::size_t bytes = all.size() / description.frames;
    const std::span<const std::byte> samples = all.subspan(frame * bytes, bytes);
    Volume volume;
    volume.type = description.type.data();
    volume.name = description.name.data();
    volume.length_unit = description.length_unit.data();
    volume.space = description.space.data();
    volume.note = description.note.data();
    volume.missing = description.missing;
    volume.geometry = description.geometry;
    volume.time = description.first_time + static_cast<double>(frame) * description.time_step;
    set_image(volume, samples.data());
    volume.memory = kept;
    return volume;
}

/// Says what could be done with a file that holds no samples.
std::string unknown_format(const fs::path& path) {
    const Format* const format = format_of(path);
    if (format != nullptr && format->read_mesh != nullptr) {
        return " is a mesh without data: 'nestgrid mesh' makes a hierarchy of it";
    }
    const std::vector<std::string> known = endings_of_fields();
    return " is of no known format (" + listed(known) + ")" + did_you_mean(ending_of(path), known);
}

/// \throw nestgrid::IoError for a file that is missing or of no format for samples
const Format& format_of_samples(const fs::path& path) {
    const Format* const format = format_of(path);
    const bool may_be_folder = format != nullptr && format->recognises != nullptr;
    if (!may_be_folder || !fs::is_directory(path)) require_file(path);
    if (format == nullptr || format->read_samples == nullptr) {
        throw IoError(path.string() + unknown_format(path));
    }
    return *format;
}

}  // namespace

Volume thickened(const Volume& plane) {
    const auto* const samples = static_cast<const std::byte*>(plane.image->GetScalarPointer());
    const std::size_t bytes = plane.sample_count() * bytes_of(plane.type);
    const auto layers = std::make_shared<std::vector<std::byte>>(samples, samples + bytes);
    layers->insert(layers->end(), samples, samples + bytes);
    Volume slab = plane;
    slab.geometry.samples[2] = 2;
    slab.geometry.spacing[2] = std::max(plane.geometry.samples[0] * plane.geometry.spacing[0],
                                        plane.geometry.samples[1] * plane.geometry.spacing[1]) /
                               50;
    slab.missing *= 2;
    if (slab.note.empty()) slab.note = "the plane is shown as a slab of two equal layers";
    set_image(slab, layers->data());
    slab.memory = layers;
    return slab;
}

std::size_t leaf_count(const nestgrid::LatticeGeometry<3>& geometry) {
    const bool plane = geometry.samples[2] == 1;
    std::size_t leaves = plane ? 2 : 6;
    for (std::size_t d = 0; d < (plane ? 2U : 3U); ++d) {
        leaves *= static_cast<std::size_t>(geometry.samples[d] - 1);
    }
    return leaves;
}

std::size_t Volume::sample_count() const {
    return static_cast<std::size_t>(geometry.samples[0]) *
           static_cast<std::size_t>(geometry.samples[1]) *
           static_cast<std::size_t>(geometry.samples[2]);
}

std::vector<Volume> read_volumes(const fs::path& path, const VolumeChoice& choice,
                                 const RawFormat& raw, double seconds) {
    const Format& format = format_of_samples(path);
    if (!(seconds > 0)) {
        std::uintmax_t bytes = bytes_to_read(path, format);
        if (!choice.mask.empty()) {
            bytes += bytes_to_read(choice.mask, format_of_samples(choice.mask));
        }
        seconds = reading_time(bytes);
    }
    const WantedSamples wanted{choice.array, choice.all_frames || choice.frame.value_or(0) != 0,
                               raw};
    const auto parcel = run_apart(path.string(), seconds, [&](Parcel& to) {
        FileSamples samples = format.read_samples(path, wanted);
        std::optional<FileSamples> mask;
        if (!choice.mask.empty())
            mask = format_of_samples(choice.mask).read_samples(choice.mask, {});
        put_chosen(samples, choice, mask ? &*mask : nullptr, to);
    });
    const auto kept = std::make_shared<const OpenedSamples>(parcel);
    std::vector<Volume> volumes;
    for (std::size_t i = 0; i < kept->description.frames; ++i) {
        volumes.push_back(open_volume(kept, i));
    }
    return volumes;
}
