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

#include "input/volumes/chosen_samples.hpp"
#include "input/volumes/file_samples.hpp"
#include "samples.hpp"

/// Scalar samples in space, or in a plane, as a file gave them.
struct Volume {
    std::shared_ptr<const void> memory;     ///< where the samples are
    vtkSmartPointer<vtkImageData> image;    ///< borrows the samples
    nestgrid::LatticeGeometry<3> geometry;  ///< a plane has one sample along the third axis
    std::string type;                       ///< of the samples, like uint8
    std::string name;         ///< of the samples in the file; empty where it gives none
    std::string length_unit;  ///< such as mm; empty where the file gives none
    std::string space;        ///< such as RAS, where the axes point to; empty where it is not said
    double time = 0;          ///< of one of several frames
    std::string note;         ///< a sentence on what is left out or moved; mostly empty
    std::size_t missing = 0;  ///< samples that are not a number, of all frames of the file

    std::size_t sample_count() const;
    bool is_plane() const { return geometry.samples[2] == 1; }
};

/// Reads a file of samples, or a folder, in a child process. To be called before there are threads.
/// \param choice of the samples where the file has more than one volume
/// \param seconds that the child may take; 0 for a time by the size of the file
/// \return one volume, or all frames where they are chosen
/// \throw nestgrid::IoError for a file that is missing, truncated, damaged or of an unknown format,
///        and for samples that are no scalars, infinite or not on at least 2 x 2 places
/// \throw nestgrid::InvalidInput for a choice that the file does not leave
std::vector<Volume> read_volumes(const std::filesystem::path& path, const VolumeChoice& choice,
                                 const RawFormat& raw, double seconds);

/// A plane as a slab: two layers of its samples, one in the plane and one a fiftieth of its longer
/// side above.
Volume thickened(const Volume& plane);

/// Tetrahedra, or triangles in a plane, of the finest grid inside the domain.
std::size_t leaf_count(const nestgrid::LatticeGeometry<3>& geometry);

/// Calls function(std::span<const Sample>) with the samples in their own type.
template <class Function>
auto with_samples(const Volume& volume, Function&& function) {
    return with_samples(volume.type,
                        static_cast<const std::byte*>(volume.image->GetScalarPointer()),
                        volume.sample_count(), std::forward<Function>(function));
}
