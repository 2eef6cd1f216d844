// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <nestgrid/algorithms/domains.hpp>

/// The distance from the solid within the closed surface of a file of any format for meshes, of
/// triangles and quadrilaterals, which are cut in two. Where faces do not share the points that
/// they name, points with equal coordinates are one; orientation has no meaning. To be called
/// before there are threads.
/// \throw nestgrid::IoError where the file cannot be read
/// \throw nestgrid::InvalidInput where the surface is empty or open, or goes through itself
/// by more than rounding to single precision does
nestgrid::Distance read_solid(const std::filesystem::path& path);
