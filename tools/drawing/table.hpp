// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drawing/request.hpp"

/// Why a value has no isosurface, or nothing where it lies within the range of the data.
std::string outside_range(double isovalue, double least, double greatest);

/// Facts about the field, one row of the table "surfaces" for each surface and one of "isolines"
/// for each of their values, and sentences about what is promised and what is empty.
void report_drawn(const DrawnField& field, const DrawingRequest& request, Report& report);
