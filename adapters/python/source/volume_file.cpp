// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Volumes in MetaImage and NRRD files, as arrays.
#include <filesystem>

#include <pybind11/stl.h>

#include <nestgrid/error.hpp>

#include "bind.hpp"
#include "interruptible.hpp"
#include "sample_layout.hpp"

namespace nestgrid::python {

namespace {

struct VolumeFile {
    SampleLayout layout;
    std::unique_ptr<std::byte[]> samples;
};

/// \param is_meta MetaImage; else NRRD
/// \throw IoError where the file cannot be read
std::shared_ptr<VolumeFile> read_file(const std::filesystem::path& path, bool is_meta) {
    auto file = std::make_shared<VolumeFile>();
    file->layout = is_meta ? meta_layout(path) : nrrd_layout(path);
    const std::size_t bytes = checked_size(file->layout);
    file->samples = std::make_unique_for_overwrite<std::byte[]>(bytes);
    read_samples(file->layout, {file->samples.get(), bytes});
    return file;
}

/// The samples, with a number for each component in front of the indices and one for each frame
/// behind them, first index fastest; and what they mean and where they are in space.
py::dict volume_file(const std::string& path, bool is_meta) {
    using namespace py::literals;
    const auto file =
        interruptible(1, [path, is_meta](const Call&) { return read_file(path, is_meta); });
    const SampleLayout& layout = file->layout;
    const LatticeGeometry<3>& geometry = layout.geometry;
    const py::dtype type(layout.type);
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(layout.components)};
    shape.insert(shape.end(), geometry.samples.begin(), geometry.samples.end());
    shape.push_back(static_cast<py::ssize_t>(layout.frames));
    std::vector<py::ssize_t> strides{type.itemsize()};
    for (std::size_t i = 0; i < 4; ++i) strides.push_back(strides[i] * shape[i]);
    const py::capsule memory(new std::shared_ptr<VolumeFile>(file), [](void* owner) {
        delete static_cast<std::shared_ptr<VolumeFile>*>(owner);
    });
    return py::dict("numbers"_a = py::array(type, shape, strides, file->samples.get(), memory),
                    "slope"_a = layout.slope, "intercept"_a = layout.intercept,
                    "spacing"_a = geometry.spacing, "origin"_a = geometry.origin,
                    "direction"_a = geometry.direction, "name"_a = layout.name,
                    "unit"_a = layout.unit);
}

}  // namespace

void bind_volume_files(py::module_& m) {
    m.def("volume_file", &volume_file, py::arg("path"), py::arg("is_meta"));
}

}  // namespace nestgrid::python
