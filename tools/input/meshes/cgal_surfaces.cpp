// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of triangles and quadrilaterals, read by CGAL.
#include <nestgrid/adapters/cgal_files.hpp>

#include "formats.hpp"
#include "input/meshes/mesh_file.hpp"

namespace {

nestgrid::CoarseGrid read_with_cgal(const std::filesystem::path& path,
                                    const WantedMesh& /*wanted*/) {
    return nestgrid::read_surface(path.string());
}

const RegisteredFormat off({.name = "OFF",
                            .endings = {".off"},
                            .holds = "triangles and quadrilaterals",
                            .read_mesh = read_with_cgal});
const RegisteredFormat obj_mesh({.name = "Wavefront",
                                 .endings = {".obj"},
                                 .read_mesh = read_with_cgal});
const RegisteredFormat ply_mesh({.name = "PLY", .endings = {".ply"}, .read_mesh = read_with_cgal});
const RegisteredFormat stl_mesh({.name = "STL", .endings = {".stl"}, .read_mesh = read_with_cgal});

}  // namespace
