// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The files of TetGen: tetrahedra, and piecewise linear complexes that it fills with some.
#include <nestgrid/adapters/tetgen.hpp>

#include "formats.hpp"
#include "input/meshes/mesh_file.hpp"

namespace {

nestgrid::CoarseGrid read_with_tetgen(const std::filesystem::path& path, const WantedMesh& wanted) {
    nestgrid::TetgenOptions options;
    if (wanted.maximum_volume) options.switches += "a" + std::to_string(*wanted.maximum_volume);
    return nestgrid::read_tetgen(path.string(), options);
}

const RegisteredFormat tetrahedra({.name = "TetGen",
                                   .endings = {".node", ".ele"},
                                   .holds = "tetrahedra",
                                   .read_mesh = read_with_tetgen});
const RegisteredFormat complexes({.name = "TetGen complex",
                                  .endings = {".poly", ".smesh"},
                                  .holds = "a piecewise linear complex to be filled",
                                  .fills_complexes = true,
                                  .read_mesh = read_with_tetgen});

}  // namespace
