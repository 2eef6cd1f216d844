// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writing a surface with a writer of VTK.
#pragma once

#include <filesystem>
#include <string>

#include <vtkErrorCode.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

/// Runs a writer.
/// \return why it failed, or nothing
template <class Writer>
std::string written_by(Writer* writer, const std::filesystem::path& path) {
    writer->SetFileName(path.c_str());
    writer->Write();
    const auto code = writer->GetErrorCode();
    return code == 0 ? "" : vtkErrorCode::GetStringFromErrorCode(code);
}
