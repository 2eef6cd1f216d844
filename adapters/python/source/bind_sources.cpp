// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>

#include <pybind11/stl.h>

#include <nestgrid/algorithms/frame_weights.hpp>
#include <nestgrid/error.hpp>

#include "bind.hpp"
#include "interruptible.hpp"
#include "source.hpp"

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

/// The axes of an array in space.
/// \param columns the axis of each index, with 3 numbers or as many as there are indices
/// \throw InvalidInput where it is no matrix of that size
std::array<Point, 3> axes_of(const Numbers& columns, std::size_t indices) {
    const auto size = static_cast<py::ssize_t>(indices);
    const bool fits = columns.ndim() == 2 && columns.shape(1) == size &&
                      (columns.shape(0) == size || columns.shape(0) == 3);
    if (!fits) {
        throw InvalidInput("direction is no matrix of " + std::to_string(indices) + " x " +
                           std::to_string(indices) + " numbers");
    }
    std::array<Point, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (std::size_t r = 0; r < static_cast<std::size_t>(columns.shape(0)); ++r) {
        for (std::size_t d = 0; d < indices; ++d) rows[r][d] = columns.data()[indices * r + d];
    }
    return rows;
}

/// The samples of an array, borrowed.
/// \throw InvalidInput where they have gaps, and where the array is no volume
Samples samples_of(const py::array& array, const Numbers& spacing, const Numbers& origin,
                   const Numbers& direction) {
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
    samples.origin = along_indices(origin, origin.size() == 3 ? 3 : indices, 0, "origin");
    samples.direction = axes_of(direction, indices);
    samples.data = array.data();
    samples.memory = keep(array);
    return samples;
}

std::shared_ptr<Frames> frames_of(const std::vector<py::array>& arrays,
                                  const std::vector<double>& times, const Numbers& spacing,
                                  const Numbers& origin, const Numbers& direction) {
    if (arrays.size() != times.size()) {
        throw InvalidInput("there are " + std::to_string(times.size()) + " times, but " +
                           std::to_string(arrays.size()) + " frames");
    }
    std::vector<Samples> samples;
    for (const py::array& array : arrays) {
        samples.push_back(samples_of(array, spacing, origin, direction));
    }
    linear_weights(times, times.front());
    return interruptible(1, [samples, times](const Call& call) {
        return std::make_shared<Frames>(make_frames(samples, times, call));
    });
}

CellRule rule_named(const std::string& name) {
    if (name == "smooth") return CellRule::smooth;
    return name == "means" ? CellRule::sharp_means : CellRule::sharp_centres;
}

/// Level, lowest cell and array of each box, of one type.
using Boxes = std::vector<std::tuple<int, std::vector<int>, py::array>>;

/// \param origin by index, or in space where it has three numbers
/// \param axes as many as there are indices
BoxArrays box_arrays(const Boxes& boxes, const std::vector<int>& ratios, const Numbers& spacing,
                     const Numbers& origin, const std::vector<int>& axes, const std::string& rule) {
    BoxArrays arrays;
    std::vector<std::shared_ptr<const void>> memory;
    const py::array& first = std::get<2>(boxes.front());
    const auto indices = static_cast<std::size_t>(first.ndim());
    arrays.dimension = static_cast<int>(indices);
    arrays.is_double = first.itemsize() == sizeof(double);
    for (const auto& [level, lower, array] : boxes) {
        BoxOfNumbers& box = arrays.boxes.emplace_back();
        box.level = level;
        box.data = array.data();
        for (std::size_t d = 0; d < indices; ++d) {
            box.lower[d] = lower[d];
            box.shape[d] = static_cast<int>(array.shape(static_cast<py::ssize_t>(d)));
            box.stride[d] = array.strides(static_cast<py::ssize_t>(d));
        }
        memory.push_back(keep(array));
    }
    arrays.ratios = ratios;
    arrays.spacing = along_indices(spacing, indices, 1, "spacing");
    const bool is_in_space = origin.size() == 3;
    const Point begin = along_indices(origin, is_in_space ? 3 : indices, 0, "origin");
    for (std::size_t d = 0; d < (is_in_space ? 3 : indices); ++d) {
        arrays.origin[is_in_space ? d : static_cast<std::size_t>(axes[d])] = begin[d];
    }
    arrays.axes = axes;
    arrays.rule = rule_named(rule);
    arrays.memory = std::make_shared<const std::vector<std::shared_ptr<const void>>>(memory);
    return arrays;
}

std::shared_ptr<Source> blocks_of(const Boxes& boxes, const std::vector<int>& ratios,
                                  const Numbers& spacing, const Numbers& origin,
                                  const std::vector<int>& axes, const std::string& rule) {
    const BoxArrays arrays = box_arrays(boxes, ratios, spacing, origin, axes, rule);
    return interruptible(1, [arrays](const Call& call) {
        return std::make_shared<Source>(make_blocks({arrays}, {0}, {"it"}, call)[0]);
    });
}

using BlockFrame =
    std::tuple<Boxes, std::vector<int>, Numbers, Numbers, std::vector<int>, std::string>;

/// \param names of the frames, for sentences
std::shared_ptr<Frames> block_frames_of(const std::vector<BlockFrame>& frames,
                                        const std::vector<double>& times,
                                        const std::vector<std::string>& names) {
    std::vector<BoxArrays> all;
    for (const BlockFrame& each : frames) all.push_back(std::apply(box_arrays, each));
    return interruptible(1, [all, times, names](const Call& call) {
        return std::make_shared<Frames>(make_blocks(all, times, names, call));
    });
}

using Leaves = py::array_t<std::int64_t, py::array::c_style>;
using Masks = py::array_t<std::uint8_t, py::array::c_style>;

/// \param values in each frame
/// \param names of the frames, for sentences, or nothing
std::shared_ptr<OctreeFrames> octree_of(const Leaves& leaves, const std::vector<Numbers>& values,
                                        const std::vector<double>& times, const Masks& masked,
                                        int max_level, int factor,
                                        const std::array<std::vector<double>, 3>& coordinates,
                                        const std::vector<std::string>& names,
                                        const std::string& rule) {
    OctreeArrays arrays;
    arrays.dimension = static_cast<int>(leaves.shape(1)) - 1;
    arrays.factor = factor;
    arrays.max_level = max_level;
    arrays.names = names;
    arrays.rule = rule_named(rule);
    const auto span_of = [](const auto& array) {
        return std::span(array.data(), static_cast<std::size_t>(array.size()));
    };
    arrays.leaves = span_of(leaves);
    arrays.masked = span_of(masked);
    arrays.coordinates = coordinates;
    std::vector memory{keep(leaves), keep(masked)};
    for (const Numbers& each : values) {
        arrays.values.push_back(span_of(each));
        memory.push_back(keep(each));
    }
    return interruptible(
        1, [arrays, times, memory](const Call& call) { return make_octree(arrays, times, call); });
}

py::tuple leaves_of(const OctreeFrames& octree) {
    const OctreeLeaves all = octree.leaves();
    const int dimension = octree[0]->field().dimension();
    const auto columns = dimension + py::ssize_t{1};
    const auto count = static_cast<py::ssize_t>(all.leaves.size()) / columns;
    const auto corners = py::ssize_t{1} << dimension;
    py::list values;
    for (const auto& frame : all.values) values.append(Numbers({count, corners}, frame.data()));
    return py::make_tuple(Leaves({count, columns}, all.leaves.data()), values,
                          Masks(static_cast<py::ssize_t>(all.masked.size()), all.masked.data()));
}

using Types = py::array_t<std::uint8_t, py::array::c_style>;

std::shared_ptr<CellSource> cell_source_of(const Numbers& points, const Types& types,
                                           const Leaves& offsets, const Leaves& connectivity,
                                           const Numbers& values, const Numbers& degrees) {
    const auto span_of = [](const auto& array) {
        return std::span(array.data(), static_cast<std::size_t>(array.size()));
    };
    const CellArrays cells{.coordinates = span_of(points),
                           .types = span_of(types),
                           .first = span_of(offsets),
                           .points = span_of(connectivity),
                           .degrees = span_of(degrees)};
    const std::span<const double> numbers = span_of(values);
    const std::array memory{keep(points), keep(types),   keep(offsets),
                            keep(values), keep(degrees), keep(connectivity)};
    return interruptible(
        1, [cells, numbers, memory](const Call&) { return make_cells(cells, numbers); });
}

std::shared_ptr<Source> field_at(const Frames& frames, double t, bool cubic, int threads) {
    const auto weights =
        cubic ? catmull_rom_weights(frames.times(), t) : linear_weights(frames.times(), t);
    return interruptible(threads, [frames, weights](const Call& call) {
        auto field = std::make_shared<Source>(frames.at(weights));
        field->range(call);
        return field;
    });
}

/// The field, or its frames, and its name.
py::tuple with_name(const LoadedField& field) {
    if (field.frames.count() == 1) {
        return py::make_tuple(std::make_shared<Source>(field.frames[0]), field.name);
    }
    return py::make_tuple(std::make_shared<Frames>(field.frames), field.name);
}

py::tuple loaded(const std::string& path, const std::string& array) {
    return with_name(*interruptible(1, [path, array](const Call& call) {
        return std::make_shared<LoadedField>(load_hierarchy(path, array, call));
    }));
}

/// \param rule of the values at nodes
/// \param times none for those that the files tell
py::tuple plotfiles(const std::vector<std::string>& paths, const std::string& array,
                    const std::string& rule, const std::vector<double>& times) {
    return with_name(
        *interruptible(1, [paths, array, times, rule = rule_named(rule)](const Call& call) {
            return std::make_shared<LoadedField>(load_plotfiles(paths, array, rule, times, call));
        }));
}

}  // namespace

void bind_sources(py::module_& m) {
    py::class_<Source, std::shared_ptr<Source>>(m, "Source")
        .def_property_readonly("dimension", &Source::dimension)
        .def(
            "range",
            [](const std::shared_ptr<Source>& source, int threads) {
                return interruptible(threads,
                                     [source](const Call& call) { return source->range(call); });
            },
            py::arg("threads"))
        .def("clear", &Source::clear);
    m.def(
        "volume",
        [](const py::array& array, const Numbers& spacing, const Numbers& origin,
           const Numbers& direction) {
            const Samples samples = samples_of(array, spacing, origin, direction);
            return interruptible(
                1, [samples](const Call& call) { return make_volume(samples, call); });
        },
        py::arg("array"), py::arg("spacing"), py::arg("origin"), py::arg("direction"));
    m.def("blocks", &blocks_of, py::arg("boxes"), py::arg("ratios"), py::arg("spacing"),
          py::arg("origin"), py::arg("axes"), py::arg("rule"));
    m.def("block_frames", &block_frames_of, py::arg("frames"), py::arg("times"), py::arg("names"));
    m.def("octree", &octree_of, py::arg("leaves"), py::arg("values"), py::arg("times"),
          py::arg("masked"), py::arg("max_level"), py::arg("factor"), py::arg("coordinates"),
          py::arg("names"), py::arg("rule"));
    py::class_<CellSource, Source, std::shared_ptr<CellSource>>(m, "CellSource")
        .def_property_readonly("degree", &CellSource::degree);
    m.def("cells", &cell_source_of, py::arg("points"), py::arg("types"), py::arg("offsets"),
          py::arg("connectivity"), py::arg("values"), py::arg("degrees"));
    py::class_<Frames, std::shared_ptr<Frames>>(m, "Frames")
        .def(py::init(&frames_of), py::arg("arrays"), py::arg("times"), py::arg("spacing"),
             py::arg("origin"), py::arg("direction"))
        .def_property_readonly("times", &Frames::times)
        .def("clear", &Frames::clear)
        .def("at", &field_at, py::arg("t"), py::arg("cubic"), py::arg("threads"));
    py::class_<OctreeFrames, Frames, std::shared_ptr<OctreeFrames>>(m, "OctreeFrames")
        .def("leaves", &leaves_of)
        .def("first",
             [](const OctreeFrames& frames) { return std::make_shared<Source>(frames[0]); });
    m.def("load", &loaded, py::arg("path"), py::arg("array"));
    m.def("plotfiles", &plotfiles, py::arg("paths"), py::arg("array"), py::arg("rule"),
          py::arg("times"));
}

}  // namespace nestgrid::python
