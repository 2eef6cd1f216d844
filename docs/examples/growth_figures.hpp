// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace figures {

/// Elements that an isosurface visits, against all there are, at four thresholds.
void isosurface_growth_figure(const std::string& file);
/// Elements that a plane visits, against all there are.
void slice_growth_figure(const std::string& file);

}  // namespace figures
