// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drawing/request.hpp"

/// Which values have no isosurface, or why a band has no surface; nothing where the range of the
/// data lets all of them have one.
std::string why_empty(const DrawingRequest& request, double least, double greatest);

/// Facts about the field, one row of the table "surfaces" for each surface and one of "isolines"
/// for each of their values, and sentences about what is promised and what is empty.
void report_drawn(const DrawnField& field, const DrawingRequest& request, Report& report);
