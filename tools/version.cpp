// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "version.hpp"

#include <CGAL/version.h>
#include <oneapi/tbb/version.h>
#include <vtkVersion.h>

std::string version_text() {
    return "nestgrid " NESTGRID_VERSION "\nbuilt with VTK " +
           std::string(vtkVersion::GetVTKVersion()) +
           ", TBB " TBB_VERSION_STRING ", TetGen " NESTGRID_TETGEN ", CGAL " CGAL_VERSION_STR
           ", muParser " NESTGRID_MUPARSER ", " NESTGRID_COMPILER "; page: " NESTGRID_PAGE;
}
