// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace figures {

/// The surface in own_grid.obj, which the example own_grid has written to the working folder.
void own_grid_figure(const std::string& file);

}  // namespace figures
