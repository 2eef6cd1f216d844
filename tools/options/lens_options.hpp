// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lenses on the command line.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <nestgrid/algorithms/projection.hpp>

struct LensText {
    std::vector<std::string> domains;  ///< such as ball:x,y,z,r
    double finest = 0;
    double coarsest = std::numeric_limits<double>::infinity();
    double slope = 0.5;
};
void add_lens_options(CLI::App& command, LensText& text);

/// Nothing where there is no domain; of several domains the union.
/// \throw nestgrid::InvalidInput for a domain that is none, and a number out of range
/// \throw nestgrid::IoError where a file cannot be read
std::optional<nestgrid::LensRequest> parse(const LensText& text);
