// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace figures {

/// A slice through large hexahedra, with colours at its vertices and with refined ones.
void refine_colours_figure(const std::string& file);

}  // namespace figures
