// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace figures {

/// Surfaces of three errors, drawn and collapsed.
void error_asked_figure(const std::string& file);
/// An isoline in the band of the data within its error.
void error_kept_figure(const std::string& file);
/// A collapsed surface, coloured by the error that is found on it.
void error_told_figure(const std::string& file);

}  // namespace figures
