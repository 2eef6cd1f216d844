// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What commands report of fields, volumes and hierarchies.
#pragma once

#include <string>
#include <utility>

#include "input/hierarchy.hpp"
#include "input/volume.hpp"
#include "output/report.hpp"

/// The name of a field and, where it is known, the unit of its coordinates.
void report_field(const std::string& name, const std::string& unit, Report& report);

/// The least and the greatest value, with as many digits as tell them apart.
void report_range(std::pair<double, double> range, Report& report);

void report_info(const Volume& volume, Report& report);
void report_info(const HierarchyInfo& info, Report& report);
