// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <nestgrid/adapters/bisection.hpp>

#include "input/chosen_samples.hpp"
#include "samples.hpp"

/// What a .raw file does not say about itself.
struct RawFormat {
    std::array<int, 3> dims{0, 0, 0};
    std::string type;
    bool big_endian = false;
    std::array<double, 3> spacing{1, 1, 1};
};

/// A volume of scalar samples as a file gave it.
struct Volume {
    std::shared_ptr<const void> memory;   ///< where the samples are
    vtkSmartPointer<vtkImageData> image;  ///< borrows the samples
    nestgrid::LatticeGeometry<3> geometry;
    std::string type;         ///< of the samples, like uint8
    std::string name;         ///< of the samples in the file; empty where it gives none
    std::string length_unit;  ///< such as mm; empty where the file gives none
    std::string space;        ///< such as RAS, where the axes point to; empty where it is not said
    std::string note;         ///< a sentence on what is left out or moved; mostly empty

    std::size_t sample_count() const;
};

/// Reads .vti, .mhd, .mha, .nrrd, .nhdr, .nii, .nii.gz or .raw in a child process. To be called
/// before there are threads.
/// \param choice of the samples where the file has more than one volume
/// \param seconds that the child may take; 0 for reading_time(path)
/// \throw nestgrid::IoError for a file that is missing, truncated, damaged or of an unknown format,
///        and for samples that are not finite scalars on at least 2 x 2 x 2 places
/// \throw nestgrid::InvalidInput for a choice that the file does not leave
Volume read_volume(const std::filesystem::path& path, const VolumeChoice& choice,
                   const RawFormat& raw, double seconds);

/// Tetrahedra of the finest grid inside the domain.
std::size_t leaf_count(const nestgrid::LatticeBisection<3>& grid);

/// Calls function(std::span<const Sample>) with the samples in their own type.
template <class Function>
auto with_samples(const Volume& volume, Function&& function) {
    return with_samples(volume.type,
                        static_cast<const std::byte*>(volume.image->GetScalarPointer()),
                        volume.sample_count(), std::forward<Function>(function));
}
