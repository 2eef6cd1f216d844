// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files as fields to explore: volumes or hierarchies, frames where there are several.
#pragma once

#include "explored_field.hpp"
#include "input/input_field.hpp"

namespace nestgrid::view {

/// Reads one or more files of one layout. To be called before there are threads.
/// \param input of dimension 3
/// \param more files with later frames
/// \param times of all frames; empty for those of the file, or 0, 1, 2, ...
/// \throw IoError, InvalidInput as read_field()
ExploredField read_explored(Input& input, const Paths& more, const std::vector<double>& times);

}  // namespace nestgrid::view
