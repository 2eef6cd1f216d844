// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <nestgrid/adapters/bisection.hpp>

/// What a .raw file does not say about itself.
struct RawFormat {
    std::array<int, 3> dims{0, 0, 0};
    std::string type;
    bool big_endian = false;
    std::array<double, 3> spacing{1, 1, 1};
};

/// A volume of scalar samples as a file gave it; the samples stay in VTK's array.
struct Volume {
    vtkSmartPointer<vtkImageData> image;
    nestgrid::LatticeGeometry<3> geometry;
    std::string type;  ///< of the samples, like uint8

    std::size_t sample_count() const;
};

/// Reads .vti, .mhd, .mha, .nrrd, .nii, .nii.gz or .raw.
/// \param array name of the point data array of a .vti file; empty for the active scalars
/// \throw nestgrid::IoError for a file that is missing, truncated or of an unknown format
/// \throw nestgrid::InvalidInput for samples that are not finite scalars on at least 2 x 2 x 2
///        places
Volume read_volume(const std::filesystem::path& path, const std::string& array,
                   const RawFormat& raw);

/// Tetrahedra of the finest grid inside the domain.
std::size_t leaf_count(const nestgrid::LatticeBisection<3>& grid);

/// Calls function(std::span<const Sample>) with the samples in their own type.
template <class Function>
auto with_samples(const Volume& volume, Function&& function) {
    void* data = volume.image->GetScalarPointer();
    const auto call = [&]<class Sample>(Sample) {
        return function(
            std::span<const Sample>(static_cast<const Sample*>(data), volume.sample_count()));
    };
    if (volume.type == "uint8") return call(std::uint8_t{});
    if (volume.type == "int8") return call(std::int8_t{});
    if (volume.type == "uint16") return call(std::uint16_t{});
    if (volume.type == "int16") return call(std::int16_t{});
    if (volume.type == "uint32") return call(std::uint32_t{});
    if (volume.type == "int32") return call(std::int32_t{});
    if (volume.type == "uint64") return call(std::uint64_t{});
    if (volume.type == "int64") return call(std::int64_t{});
    if (volume.type == "float32") return call(float{});
    return call(double{});
}
