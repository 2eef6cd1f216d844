// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What commands report of surfaces, volumes and hierarchies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drawing/extract.hpp"
#include "input/hierarchy.hpp"
#include "output/report.hpp"

struct Seconds {
    double read = 0;
    double write = 0;
    double draw = 0;
};

/// Facts about the field, one row of the table "surfaces" for each surface, and a row of "vtk" for
/// VTK's contour.
void report_surfaces(const ExtractionRun& run, double isovalue, const Seconds& seconds,
                     const std::optional<Contour>& contour, Report& report);

/// The beginning of a row about one surface: its time between frames, its budget, its threshold.
/// \param budget 0 for none
Row begin_row(const std::optional<double>& time, std::uint64_t budget, double threshold);
/// The bound of a result, or nothing where it promises no more than any drawing keeps.
Cell bound_of(const nestgrid::ErrorBounds& bounds);
/// Why a value has no isosurface, or nothing where it lies within the range of the data.
std::string outside_range(double isovalue, double least, double greatest);
/// The sentence for results whose bound promises nothing.
void say_nothing_bounded(Report& report);
/// Why there are fewer triangles than the budgets allow, as a sentence about the first of several.
/// \param searches whose max_triangles is 0 where there was none
void say_why_not_filled(const std::vector<nestgrid::TriangleBudget>& searches, Report& report);
/// How many of the first cells of such a row tell it from the others.
std::size_t keys_of(const std::optional<double>& time, std::uint64_t budget);

/// Sums of several surfaces, as a sentence; nothing for one.
void report_sum(std::size_t surfaces, std::uint64_t simplices, const std::string& what,
                double seconds, Report& report);

/// The name of a field and, where it is known, the unit of its coordinates.
void report_field(const std::string& name, const std::string& unit, Report& report);

/// The least and the greatest value, with as many digits as tell them apart.
void report_range(std::pair<double, double> range, Report& report);

void report_info(const Volume& volume, Report& report);
void report_info(const HierarchyInfo& info, Report& report);

/// What stands above a surface in a picture.
std::string caption(const Extraction& extraction);
