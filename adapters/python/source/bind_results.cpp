// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Results as Python sees them: arrays on the memory of the surface or the lines.
#include <pybind11/stl.h>

#include <nestgrid/algorithms/outlines.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "bind.hpp"
#include "extract.hpp"

namespace nestgrid::python {

namespace {

static_assert(sizeof(Point) == 3 * sizeof(double));

template <class T>
py::ssize_t size_of(const std::vector<T>& all) {
    return static_cast<py::ssize_t>(all.size());
}

py::array points_on(const py::object& self, const std::vector<Point>& points) {
    return array_on<double>(self, points.data(), {size_of(points), 3});
}

py::array attributes_on(const py::object& self, const std::vector<double>& attributes,
                        std::size_t vertices) {
    const auto rows = static_cast<py::ssize_t>(vertices);
    const py::ssize_t columns = rows == 0 ? 0 : size_of(attributes) / rows;
    return array_on<double>(self, attributes.data(), {rows, columns});
}

/// How many elements a traversal met, by name.
py::dict counts_of(const TraversalCounts& counts) {
    using namespace py::literals;
    return py::dict("calls"_a = counts.calls, "visited"_a = counts.visited,
                    "extracted"_a = counts.extracted);
}

py::dict report_of(const Drawn& drawn) {
    using namespace py::literals;
    SurfaceReport r;
    {
        const py::gil_scoped_release unlocked;
        r = surface_report(drawn.surface);
    }
    return py::dict("vertices"_a = r.vertices, "edges"_a = r.edges, "triangles"_a = r.triangles,
                    "open_edges"_a = r.open_edges, "boundary_edges"_a = r.boundary_edges,
                    "nonmanifold_edges"_a = r.nonmanifold_edges,
                    "misoriented_edges"_a = r.misoriented_edges,
                    "nonmanifold_vertices"_a = r.nonmanifold_vertices,
                    "degenerate_triangles"_a = r.degenerate_triangles,
                    "components"_a = r.components, "euler"_a = r.euler, "area"_a = r.area,
                    "volume"_a = r.volume, "closed"_a = r.closed(), "manifold"_a = r.manifold());
}

template <class Result>
void bind_numbers(py::class_<Result, std::shared_ptr<Result>>& c) {
    c.def_readonly("error_bound", &Result::error_bound)
        .def_readonly("threshold", &Result::threshold)
        .def_property_readonly("counts", [](const Result& r) { return counts_of(r.counts); });
}

/// A property that makes an array of the object that keeps its memory.
template <class Result, class Function>
auto on(const Function& function) {
    return [function](const py::object& self) { return function(self, self.cast<Result&>()); };
}

void bind_surface(py::module_& m) {
    py::class_<Drawn, std::shared_ptr<Drawn>> c(m, "Surface");
    bind_numbers(c);
    c.def_property_readonly("vertices", on<Drawn>([](const py::object& self, const Drawn& d) {
                                return points_on(self, d.surface.vertices);
                            }))
        .def_property_readonly("normals", on<Drawn>([](const py::object& self, const Drawn& d) {
                                   return points_on(self, d.surface.normals);
                               }))
        .def_property_readonly("triangles", on<Drawn>([](const py::object& self, const Drawn& d) {
                                   return array_on<std::uint32_t>(
                                       self, d.surface.simplices.data(),
                                       {size_of(d.surface.simplices), 3});
                               }))
        .def_property_readonly("attributes", on<Drawn>([](const py::object& self, const Drawn& d) {
                                   return attributes_on(self, d.surface.attributes,
                                                        d.surface.vertices.size());
                               }))
        .def("report", &report_of)
        .def("outlines",
             [](const Drawn& d) {
                 const py::gil_scoped_release unlocked;
                 return std::make_shared<Surface<2>>(outlines(d.surface));
             })
        .def("isolines", [](const Drawn& d, const std::vector<double>& values, std::size_t column) {
            const py::gil_scoped_release unlocked;
            return std::make_shared<DrawnLines>(DrawnLines{
                isolines(d.surface, column, values), d.counts, d.error_bound, d.threshold, false});
        });
}

void bind_lines(py::module_& m) {
    py::class_<DrawnLines, std::shared_ptr<DrawnLines>> c(m, "Lines");
    bind_numbers(c);
    c.def_property_readonly("vertices",
                            on<DrawnLines>([](const py::object& self, const DrawnLines& d) {
                                return points_on(self, d.lines.vertices);
                            }))
        .def_property_readonly(
            "attributes", on<DrawnLines>([](const py::object& self, const DrawnLines& d) {
                return attributes_on(self, d.lines.attributes, d.lines.vertices.size());
            }))
        .def_property_readonly("points",
                               on<DrawnLines>([](const py::object& self, const DrawnLines& d) {
                                   return array_on<std::uint32_t>(self, d.lines.points.data(),
                                                                  {size_of(d.lines.points)});
                               }))
        .def_property_readonly(
            "first", on<DrawnLines>([](const py::object& self, const DrawnLines& d) {
                return array_on<std::size_t>(self, d.lines.first.data(), {size_of(d.lines.first)});
            }))
        .def_property_readonly(
            "values", on<DrawnLines>([](const py::object& self, const DrawnLines& d) {
                return array_on<double>(self, d.lines.value.data(), {size_of(d.lines.value)});
            }));
}

void bind_segments(py::module_& m) {
    using Segments = Surface<2>;
    py::class_<Segments, std::shared_ptr<Segments>>(m, "Segments")
        .def_property_readonly("vertices",
                               on<Segments>([](const py::object& self, const Segments& s) {
                                   return points_on(self, s.vertices);
                               }))
        .def_property_readonly(
            "segments", on<Segments>([](const py::object& self, const Segments& s) {
                return array_on<std::uint32_t>(self, s.simplices.data(), {size_of(s.simplices), 2});
            }));
}

}  // namespace

void bind_results(py::module_& m) {
    bind_surface(m);
    bind_lines(m);
    bind_segments(m);
}

}  // namespace nestgrid::python
