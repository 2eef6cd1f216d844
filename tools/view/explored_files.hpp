// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files as fields to explore: volumes or hierarchies, frames where there are several.
#pragma once

#include "../command_line.hpp"
#include "../frame_files.hpp"
#include "explored_field.hpp"

namespace nestgrid::view {

/// Reads one or more files of one layout. To be called before there are threads.
/// \param paths of volumes, or of hierarchies of dimension 3
/// \param times one for each
/// \throw IoError, InvalidInput as with_frames()
ExploredField read_explored(Input& input, const Paths& paths, std::vector<double> times);

/// The same for volumes.
ExploredField read_explored_volumes(Input& input, const Paths& paths, std::vector<double> times);

/// The same for hierarchies.
/// \param array the name of the field; may be empty where there is only one
ExploredField read_explored_hierarchies(const Paths& paths, const std::string& array,
                                        std::vector<double> times);

}  // namespace nestgrid::view
