// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace figures {

/// The adaptive grid and isolines at five times between two frames on two quadtrees.
void time_figure(const std::string& file);

}  // namespace figures
