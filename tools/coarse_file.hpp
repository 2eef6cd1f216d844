// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include <nestgrid/adapters/coarse.hpp>

/// Reads a grid in a child process, because its reader is foreign code (child_process.hpp).
/// \param file to be named in sentences
/// \param read called in the child process
/// \throw nestgrid::IoError as run_apart()
nestgrid::CoarseGrid read_grid_apart(const std::string& file, double seconds,
                                     const std::function<nestgrid::CoarseGrid()>& read);
