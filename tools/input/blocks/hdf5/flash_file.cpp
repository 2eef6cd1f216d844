// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 files of FLASH, whose blocks VTK reads; the time, which it does not tell, is read here.
#include <vtkAMRFlashReader.h>
#include <vtkNew.h>

#include <array>

#include "input/blocks/hdf5/hdf5_reading.hpp"
#include "input/blocks/read_blocks.hpp"
#include "input/blocks/vtk_blocks.hpp"

namespace {

namespace fs = std::filesystem;

/// Scalars are rows of a name and a value.
struct Scalar {
    std::array<char, 80> name;
    double value;
};

std::optional<double> time_of(const Hdf5& file) {
    if (!file.has("real scalars")) return std::nullopt;
    const Hdf5 scalars = file.at("real scalars");
    const Hdf5 text(H5Tcopy(H5T_C_S1), "texts");
    H5Tset_size(text.id(), sizeof(Scalar::name));
    const Hdf5 row(H5Tcreate(H5T_COMPOUND, sizeof(Scalar)), "rows");
    H5Tinsert(row.id(), "name", HOFFSET(Scalar, name), text.id());
    H5Tinsert(row.id(), "value", HOFFSET(Scalar, value), H5T_NATIVE_DOUBLE);
    const std::vector<hsize_t> shape = scalars.shape();
    if (shape.size() != 1 || shape[0] > 100000) return std::nullopt;
    std::vector<Scalar> rows(shape[0]);
    if (H5Dread(scalars.id(), row.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0) {
        return std::nullopt;
    }
    for (const Scalar& each : rows) {
        const std::string name(each.name.data(), each.name.size());
        if (name.substr(0, name.find_first_of(std::string(" \0", 2))) == "time") return each.value;
    }
    return std::nullopt;
}

BlockFile open_flash(const fs::path& path) {
    const std::optional<double> time = time_of(open_hdf5(path));
    const vtkNew<vtkAMRFlashReader> reader;
    BlockFile file = blocks_of_vtk(*reader, path);
    file.time = time;
    return file;
}

const RegisteredFormat flash(
    {.name = "FLASH",
     .endings = {},
     .holds = "HDF5: blocks of cells on levels, several fields",
     .options = {"--array", "--cells", "--read-limit"},
     .recognises = [](const fs::path& path) { return hdf5_kind(path) == Hdf5Kind::flash; },
     .read_field = read_blocks<open_flash>,
     .describe = describe_blocks<open_flash>});

}  // namespace
