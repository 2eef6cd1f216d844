// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>

#include <pybind11/stl.h>

#include <nestgrid/algorithms/frame_weights.hpp>
#include <nestgrid/error.hpp>

#include "bind.hpp"
#include "source.hpp"
#include "thread_executor.hpp"

namespace nestgrid::python {

namespace {

/// \throw InvalidInput where there is not one number for each index
Point along_indices(const Numbers& numbers, std::size_t indices, double rest, const char* name) {
    if (static_cast<std::size_t>(numbers.size()) != indices) {
        throw InvalidInput(std::string(name) + " has " + std::to_string(numbers.size()) +
                           " numbers, but the array " + std::to_string(indices) + " indices");
    }
    Point x{rest, rest, rest};
    std::copy_n(numbers.data(), indices, x.begin());
    return x;
}

/// The samples of an array, borrowed.
/// \throw InvalidInput where they have gaps, and where the array is no volume
Samples samples_of(const py::array& array, const Numbers& spacing, const Numbers& origin) {
    Samples samples;
    const auto indices = static_cast<std::size_t>(array.ndim());
    if (indices != 2 && indices != 3) {
        throw InvalidInput("an array with " + std::to_string(indices) +
                           " indices is no volume: it needs 2 or 3");
    }
    samples.type = py::str(array.dtype());
    for (std::size_t d = 0; d < indices; ++d) {
        const py::ssize_t count = array.shape(static_cast<py::ssize_t>(d));
        if (count < 2 || count > 1 << 20) {
            throw InvalidInput("a volume needs 2 to 2^20 samples along each index, not " +
                               std::to_string(count));
        }
        samples.shape.push_back(static_cast<int>(count));
    }
    samples.order.resize(indices);
    std::iota(samples.order.begin(), samples.order.end(), 0);
    std::stable_sort(samples.order.begin(), samples.order.end(),
                     [&](int a, int b) { return array.strides(a) < array.strides(b); });
    py::ssize_t stride = array.itemsize();
    for (const int d : samples.order) {
        if (array.strides(d) != stride) {
            throw InvalidInput(
                "the array has gaps or runs backwards in memory: numpy.ascontiguousarray(array) "
                "makes a copy without");
        }
        stride *= array.shape(d);
    }
    samples.spacing = along_indices(spacing, indices, 1, "spacing");
    samples.origin = along_indices(origin, indices, 0, "origin");
    samples.data = array.data();
    return samples;
}

/// Frames with the arrays that they borrow and the times.
struct Frames {
    std::vector<py::array> arrays;
    std::vector<double> times;
    std::shared_ptr<FrameSource> source;
};

std::shared_ptr<Frames> frames_of(const std::vector<py::array>& arrays,
                                  const std::vector<double>& times, const Numbers& spacing,
                                  const Numbers& origin) {
    if (arrays.size() != times.size()) {
        throw InvalidInput("there are " + std::to_string(times.size()) + " times, but " +
                           std::to_string(arrays.size()) + " frames");
    }
    std::vector<Samples> samples;
    for (const py::array& array : arrays) samples.push_back(samples_of(array, spacing, origin));
    auto source = make_frames(samples);
    linear_weights(times, times.front());
    return std::make_shared<Frames>(Frames{arrays, times, std::move(source)});
}

std::shared_ptr<Source> octree_of(const py::array_t<std::int64_t, py::array::c_style>& leaves,
                                  const Numbers& values,
                                  const py::array_t<std::uint8_t, py::array::c_style>& masked,
                                  int max_level,
                                  const std::array<std::vector<double>, 3>& coordinates) {
    OctreeArrays arrays;
    arrays.dimension = static_cast<int>(leaves.shape(1)) - 1;
    arrays.max_level = max_level;
    const auto span_of = [](const auto& array) {
        return std::span(array.data(), static_cast<std::size_t>(array.size()));
    };
    arrays.leaves = span_of(leaves);
    arrays.values = span_of(values);
    arrays.masked = span_of(masked);
    arrays.coordinates = coordinates;
    const py::gil_scoped_release unlocked;
    return make_octree(arrays);
}

}  // namespace

void bind_sources(py::module_& m) {
    py::class_<Source, std::shared_ptr<Source>>(m, "Source")
        .def_property_readonly("dimension", &Source::dimension)
        .def(
            "range",
            [](const Source& source, int threads) {
                return Interruptible().run(
                    [&](const auto&) { return source.range(ThreadExecutor(threads)); });
            },
            py::arg("threads"))
        .def("clear", &Source::clear);
    m.def(
        "volume",
        [](const py::array& array, const Numbers& spacing, const Numbers& origin) {
            return std::shared_ptr<Source>(make_volume(samples_of(array, spacing, origin)));
        },
        py::keep_alive<0, 1>());
    m.def("octree", &octree_of);
    py::class_<Frames, std::shared_ptr<Frames>>(m, "Frames")
        .def(py::init(&frames_of))
        .def_readonly("times", &Frames::times)
        .def("clear", [](const Frames& frames) { frames.source->clear(); })
        .def(
            "at",
            [](const Frames& frames, double t, bool cubic, int threads) {
                const auto weights =
                    cubic ? catmull_rom_weights(frames.times, t) : linear_weights(frames.times, t);
                const py::gil_scoped_release unlocked;
                auto source = std::shared_ptr<Source>(frames.source->at(weights));
                source->choose("offset", 1, ThreadExecutor(threads));
                return source;
            },
            py::keep_alive<0, 1>());
    m.def("load", [](const std::string& path, const std::string& array) -> py::object {
        LoadedField loaded;
        {
            const py::gil_scoped_release unlocked;
            loaded = load_hierarchy(path, array);
        }
        if (loaded.alone) return py::cast(std::shared_ptr<Source>(std::move(loaded.alone)));
        return py::cast(std::make_shared<Frames>(
            Frames{{}, std::move(loaded.times), std::move(loaded.frames)}));
    });
}

}  // namespace nestgrid::python
