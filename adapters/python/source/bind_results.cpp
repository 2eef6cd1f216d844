// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Results as Python sees them: arrays on the memory of the surface or the lines.
#include <cstring>

#include <pybind11/stl.h>

#include <nestgrid/algorithms/outlines.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/error.hpp>

#include "bind.hpp"
#include "extract.hpp"
#include "interruptible.hpp"

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

py::dict report_of(const std::shared_ptr<Drawn>& drawn) {
    using namespace py::literals;
    const SurfaceReport r =
        interruptible(1, [drawn](const Call&) { return surface_report(drawn->surface); });
    return py::dict(
        "vertices"_a = r.vertices, "edges"_a = r.edges, "triangles"_a = r.triangles,
        "open_edges"_a = r.open_edges, "boundary_edges"_a = r.boundary_edges,
        "nonmanifold_edges"_a = r.nonmanifold_edges, "misoriented_edges"_a = r.misoriented_edges,
        "nonmanifold_vertices"_a = r.nonmanifold_vertices,
        "degenerate_triangles"_a = r.degenerate_triangles, "components"_a = r.components,
        "euler"_a = r.euler, "area"_a = r.area, "area_behind"_a = r.area_behind,
        "volume"_a = r.volume, "closed"_a = r.closed(), "manifold"_a = r.manifold());
}

/// The numbers of a result, for pickling.
template <class Result>
py::tuple numbers_of(const Result& r) {
    return py::make_tuple(r.error_bound, r.range_bound, r.threshold, r.counts.calls,
                          r.counts.visited, r.counts.extracted, r.position_bound);
}
template <class Result>
void set_numbers(Result& r, const py::tuple& numbers) {
    r.error_bound = numbers[0].cast<double>();
    r.range_bound = numbers[1].cast<double>();
    r.threshold = numbers[2].cast<double>();
    r.counts = {numbers[3].cast<std::uint64_t>(), numbers[4].cast<std::uint64_t>(),
                numbers[5].cast<std::uint64_t>()};
    r.position_bound = numbers[6].cast<double>();
}

/// A copy of the memory of an array as values of another type with the same bytes.
/// \throw InvalidInput where the array does not hold whole values
template <class Value, class Number>
std::vector<Value> values_in(const py::object& array) {
    const auto numbers = array.cast<py::array_t<Number, py::array::c_style>>();
    const auto bytes = static_cast<std::size_t>(numbers.nbytes());
    if (bytes % sizeof(Value) != 0) throw InvalidInput("the pickled result is damaged");
    std::vector<Value> values(bytes / sizeof(Value));
    if (bytes > 0) std::memcpy(values.data(), numbers.data(), bytes);
    return values;
}

/// \throw InvalidInput where a name of a vertex is none
void require_vertices(std::span<const std::uint32_t> names, std::size_t vertices) {
    for (const std::uint32_t name : names) {
        if (name >= vertices) throw InvalidInput("the pickled result is damaged");
    }
}

py::tuple state_of_surface(const py::object& self, const Drawn& d) {
    const Surface<3>& s = d.surface;
    const auto array = [&]<class Number>(Number, const auto& values) {
        const std::size_t count = values.size() * sizeof(values[0]) / sizeof(Number);
        return array_on<Number>(self, values.data(), {static_cast<py::ssize_t>(count)});
    };
    return py::make_tuple(numbers_of(d), array(0.0, s.vertices), array(0.0, s.normals),
                          array(0.0, s.attributes), array(std::uint32_t{}, s.simplices),
                          array(std::uint32_t{}, s.element_of), array(std::uint32_t{}, s.boundary),
                          d.budget_reason, d.surface_error);
}
std::shared_ptr<Drawn> surface_of_state(const py::tuple& state) {
    auto drawn = std::make_shared<Drawn>();
    set_numbers(*drawn, state[0]);
    Surface<3>& s = drawn->surface;
    s.vertices = values_in<Point, double>(state[1]);
    s.normals = values_in<Point, double>(state[2]);
    s.attributes = values_in<double, double>(state[3]);
    require_vertices(values_in<std::uint32_t, std::uint32_t>(state[4]), s.vertices.size());
    require_vertices(values_in<std::uint32_t, std::uint32_t>(state[6]), s.vertices.size());
    s.simplices = values_in<Surface<3>::Simplex, std::uint32_t>(state[4]);
    s.element_of = values_in<std::uint32_t, std::uint32_t>(state[5]);
    s.boundary = values_in<Surface<3>::Ridge, std::uint32_t>(state[6]);
    drawn->budget_reason = state[7].cast<std::string>();
    drawn->surface_error = state[8].cast<double>();
    return drawn;
}

py::tuple state_of_lines(const py::object& self, const DrawnLines& d) {
    return py::make_tuple(numbers_of(d), points_on(self, d.lines.vertices), d.lines.attribute_count,
                          self.attr("attributes"), self.attr("points"), self.attr("first"),
                          self.attr("values"));
}
std::shared_ptr<DrawnLines> lines_of_state(const py::tuple& state) {
    auto drawn = std::make_shared<DrawnLines>();
    set_numbers(*drawn, state[0]);
    Polylines& lines = drawn->lines;
    lines.vertices = values_in<Point, double>(state[1]);
    lines.attribute_count = state[2].cast<std::size_t>();
    lines.attributes = values_in<double, double>(state[3]);
    lines.points = values_in<std::uint32_t, std::uint32_t>(state[4]);
    lines.first = values_in<std::size_t, std::size_t>(state[5]);
    lines.value = values_in<double, double>(state[6]);
    require_vertices(lines.points, lines.vertices.size());
    return drawn;
}

py::tuple state_of_segments(const py::object& self, const Surface<2>& s) {
    return py::make_tuple(points_on(self, s.vertices), self.attr("segments"));
}
std::shared_ptr<Surface<2>> segments_of_state(const py::tuple& state) {
    auto s = std::make_shared<Surface<2>>();
    s->vertices = values_in<Point, double>(state[0]);
    s->simplices = values_in<Surface<2>::Simplex, std::uint32_t>(state[1]);
    require_vertices(values_in<std::uint32_t, std::uint32_t>(state[1]), s->vertices.size());
    return s;
}

template <class Result>
void bind_numbers(py::class_<Result, std::shared_ptr<Result>>& c) {
    c.def_property_readonly("error_bound", [](const Result& r) { return r.error_bound; })
        .def_property_readonly("range_bound", [](const Result& r) { return r.range_bound; })
        .def_property_readonly("bound_says_nothing",
                               [](const Result& r) { return r.bound_says_nothing(); })
        .def_readonly("threshold", &Result::threshold)
        .def_readonly("position_bound", &Result::position_bound)
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
    c.def_readonly("budget_reason", &Drawn::budget_reason);
    c.def_readonly("surface_error", &Drawn::surface_error);
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
        .def("state", on<Drawn>(&state_of_surface))
        .def_static("restored", &surface_of_state, py::arg("state"))
        .def("outlines",
             [](const std::shared_ptr<Drawn>& d) {
                 return interruptible(1, [d](const Call&) {
                     return std::make_shared<Surface<2>>(outlines(d->surface));
                 });
             })
        .def(
            "isolines",
            [](const std::shared_ptr<Drawn>& d, const std::vector<double>& values,
               std::size_t attribute) {
                return interruptible(1, [d, values, attribute](const Call&) {
                    return std::make_shared<DrawnLines>(
                        DrawnLines{static_cast<const ErrorBounds&>(*d),
                                   isolines(d->surface, attribute, values), d->counts, d->threshold,
                                   d->position_bound, false});
                });
            },
            py::arg("values"), py::arg("attribute"));
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
            }))
        .def("state", on<DrawnLines>(&state_of_lines))
        .def_static("restored", &lines_of_state, py::arg("state"));
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
            }))
        .def("state", on<Segments>(&state_of_segments))
        .def_static("restored", &segments_of_state, py::arg("state"));
}

}  // namespace

void bind_results(py::module_& m) {
    bind_surface(m);
    bind_lines(m);
    bind_segments(m);
}

}  // namespace nestgrid::python
