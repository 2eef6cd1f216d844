// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The text in which Enzo lists its grids.
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// A grid with its box, before it is known which level that is of.
struct PlacedGrid {
    std::vector<double> low;  ///< one number a direction, as in what follows
    std::vector<double> spacing;
    std::vector<hsize_t> cells;
    std::filesystem::path file;  ///< that has its numbers
    std::string group;           ///< of that file
    std::optional<double> time;
};

/// \throw nestgrid::InvalidInput where there is none, or one has no box in 2 or 3 dimensions
std::vector<PlacedGrid> enzo_grids(const std::filesystem::path& path);
