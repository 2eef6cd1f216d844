// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace figures {

/// Data in the cells of a quadtree: every cell, cells that stop, and a continuous field of them.
void discontinuous_figure(const std::string& file);

}  // namespace figures
