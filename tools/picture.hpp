// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

struct Panel {
    vtkSmartPointer<vtkPolyData> surface;
    std::string caption;
};

/// Writes a PNG with the surfaces side by side, each whole above and magnified with its triangles
/// below. Debian's VTK draws through an X display; where none can be used, an Xvfb is started for
/// the time of drawing. The drawing happens in a process of its own, so its failure is an error.
/// \throw nestgrid::IoError
void write_picture(const std::vector<Panel>& panels, const std::filesystem::path& path);
