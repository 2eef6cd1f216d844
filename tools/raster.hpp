// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include <nestgrid/adapters/bisection.hpp>

/// A picture of grey values, as samples on a rectangle.
struct Raster {
    std::shared_ptr<const void> memory;  ///< where the samples are
    nestgrid::LatticeGeometry<2> geometry;
    std::span<const float> samples;
};

/// Whether a file is called like a picture: .png, .tif, .tiff, .jpg, .jpeg, .bmp, .pgm or .pnm.
bool is_raster(const std::filesystem::path& path);

/// Reads a picture in a child process. To be called before there are threads.
/// \param seconds that the child may take; 0 for reading_time(path)
/// \throw nestgrid::IoError for a file that is missing, damaged, or cut off
/// \throw nestgrid::InvalidInput for a picture with colours, or with fewer than 2 x 2 pixels
Raster read_raster(const std::filesystem::path& path, double seconds);
