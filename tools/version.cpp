// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "version.hpp"

#include <oneapi/tbb/version.h>
#include <vtkVersion.h>
#ifdef NESTGRID_HAS_CGAL
#include <CGAL/version.h>
#else
#define CGAL_VERSION_STR "no"
#endif

std::string version_text() {
    return "nestgrid " NESTGRID_VERSION "\nbuilt with VTK " +
           std::string(vtkVersion::GetVTKVersion()) +
           ", TBB " TBB_VERSION_STRING ", TetGen " NESTGRID_TETGEN ", CGAL " CGAL_VERSION_STR
           ", muParser " NESTGRID_MUPARSER ", " NESTGRID_COMPILER "; page: " NESTGRID_PAGE;
}
