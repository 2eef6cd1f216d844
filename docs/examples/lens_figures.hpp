// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace figures {

/// A slice of the bucky ball in a lens at three places.
void lens_figure(const std::string& file);
/// Plots the distances of surfaces against steps of the threshold; prints these, and moduli of
/// continuity beside C^2 / (C - 1).
void blended_figure(const std::string& file);

}  // namespace figures
