// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace figures {

/// The bucky ball at three thresholds of the visual, numerical and wavelet indicators.
void visual_figure(const std::string& file);
void numerical_figure(const std::string& file);
void wavelet_figure(const std::string& file);
/// A bumpy ball of true positions at three bounds on how far they are off.
void geometry_figure(const std::string& file);

}  // namespace figures
