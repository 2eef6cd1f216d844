// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where a slice runs, on the command line.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <nestgrid/algorithms/level_function.hpp>

struct SliceOptions {
    std::vector<double> plane;  ///< a point and the normal
    std::string axis;
    std::optional<double> at{};
    std::vector<double> sphere;    ///< centre and radius
    std::vector<double> cylinder;  ///< a point on the axis, its direction, the radius
    std::string function;          ///< an expression
};
void add_slice_options(CLI::App& command, SliceOptions& options);

/// Whether any slice is asked for.
bool is_sliced(const SliceOptions& options);

struct SliceFunction {
    std::unique_ptr<const nestgrid::LevelFunction> function;
    bool flat = false;
    nestgrid::Point normal{};  ///< of a flat slice
};

/// \throw nestgrid::InvalidInput where there is not one slice, or it makes no sense
SliceFunction slice_function(const SliceOptions& options);
