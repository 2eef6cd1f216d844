// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "extract.hpp"
#include "hierarchy.hpp"

struct Seconds {
    double read = 0;
    double write = 0;
    double draw = 0;
};

// A line with the name of a quantity and its value.
void line(const char* name, std::size_t value);
void line(const char* name, double value);
void line(const char* name, const std::string& value);

/// One line per quantity: name and value.
void print_result(const ExtractionRun& run, double isovalue, const Seconds& seconds);

/// One row per surface, the last one VTK's.
void print_table(const ExtractionRun& run, double isovalue, const Seconds& seconds,
                 const std::optional<Contour>& contour);

/// One row per surface between frames.
void print_times(const ExtractionRun& run, double isovalue);

void print_info(const Volume& volume);
void print_info(const HierarchyInfo& info);

/// What stands above a surface in a picture.
std::string caption(const Extraction& extraction);
