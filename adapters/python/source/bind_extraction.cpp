// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <nestgrid/error.hpp>

#include "bind.hpp"
#include "extract.hpp"
#include "thread_executor.hpp"

namespace nestgrid::python {

namespace {

/// A domain of lenses, for Python opaque.
struct Domain {
    Distance distance;
};

void bind_domains(py::module_& m) {
    py::class_<Domain>(m, "Domain",
                       "Where a lens is fine. a | b is the union of two domains, a & b what they "
                       "share.")
        .def("__or__", [](const Domain& a,
                          const Domain& b) { return Domain{union_of(a.distance, b.distance)}; })
        .def("__and__", [](const Domain& a, const Domain& b) {
            return Domain{intersection(a.distance, b.distance)};
        });
    m.def("ball", [](const Numbers& centre, double radius) {
        if (!(radius >= 0)) throw InvalidInput("the radius of a ball is not a number >= 0");
        return Domain{Ball{point_of(centre, "the centre"), radius}};
    });
    m.def("box", [](const Numbers& low, const Numbers& high) {
        const Box box{point_of(low, "the low corner"), point_of(high, "the high corner")};
        for (std::size_t d = 0; d < 3; ++d) {
            if (!(box.low[d] <= box.high[d])) throw InvalidInput("the box is empty");
        }
        return Domain{box};
    });
    m.def("half_space", [](const Numbers& through, const Numbers& normal) {
        return Domain{HalfSpace(point_of(through, "the point"), point_of(normal, "the normal"))};
    });
    m.def("cone", [](const Numbers& apex, const Numbers& towards, double angle) {
        return Domain{Cone(point_of(apex, "the apex"), point_of(towards, "the direction"), angle)};
    });
    m.def("polygon",
          [](const std::vector<ImagePoint>& corners) { return Domain{Polygon(corners)}; });
    m.def("frustum", [](const Numbers& eye, const Numbers& towards, const Numbers& up, double angle,
                        double aspect, double nearest, double farthest) {
        return Domain{view_frustum({.eye = point_of(eye, "the eye"),
                                    .towards = point_of(towards, "the direction"),
                                    .up = point_of(up, "up"),
                                    .angle = angle,
                                    .aspect = aspect},
                                   nearest, farthest)};
    });
}

void bind_requests(py::module_& m) {
    py::class_<LensRequest>(m, "Lens").def(
        py::init([](const Domain& domain, double finest, double coarsest, double slope) {
            return LensRequest{domain.distance, finest, coarsest, slope};
        }));
    py::class_<Projection>(m, "Projection")
        .def(py::init([](std::optional<double> threshold, std::optional<std::uint64_t> triangles,
                         std::string indicator, double blend, std::optional<LensRequest> lens) {
            if (triangles == std::uint64_t{0}) throw InvalidInput("max_triangles is 0");
            return Projection{threshold, triangles.value_or(0), std::move(indicator), blend,
                              std::move(lens)};
        }));
    const py::class_<LevelFunction, std::shared_ptr<LevelFunction>> opaque(m, "LevelFunction");
    m.def("plane", [](const Numbers& through, const Numbers& normal) {
        return std::shared_ptr<LevelFunction>(std::make_shared<Plane>(
            point_of(through, "the point"), point_of(normal, "the normal")));
    });
    m.def("sphere", [](const Numbers& centre, double radius) {
        return std::shared_ptr<LevelFunction>(
            std::make_shared<Sphere>(point_of(centre, "the centre"), radius));
    });
    m.def("cylinder", [](const Numbers& through, const Numbers& axis, double radius) {
        return std::shared_ptr<LevelFunction>(std::make_shared<Cylinder>(
            point_of(through, "the point"), point_of(axis, "the axis"), radius));
    });
}

template <class Result>
std::shared_ptr<Result> shared(Result result) {
    return std::make_shared<Result>(std::move(result));
}

py::array_t<double> probe_array(const Source& source, const Numbers& points,
                                const Projection& projection, int threads) {
    std::vector<Point> at(static_cast<std::size_t>(points.size()) / 3);
    std::copy_n(points.data(), 3 * at.size(), at.empty() ? nullptr : at.front().data());
    const ProbeResult result = Interruptible().run(
        [&](const auto&) { return probe_points(source, at, projection, ThreadExecutor(threads)); });
    return py::array_t<double>(static_cast<py::ssize_t>(result.values.size()),
                               result.values.data());
}

void bind_draws(py::module_& m) {
    m.def("isosurface",
          [](const Source& source, double level, bool normals, bool cap, bool elements,
             bool at_nodes, const Projection& projection, int threads) {
              return shared(Interruptible().run([&](const Progress& progress) {
                  return draw_isosurface(source, level, {normals, cap, elements, at_nodes},
                                         projection, ThreadExecutor(threads), progress);
              }));
          });
    m.def("slice", [](const Source& source, const LevelFunction& function, bool normals,
                      bool elements, const Projection& projection, int threads) {
        return shared(Interruptible().run([&](const Progress& progress) {
            return draw_slice(source, function, {.normals = normals, .elements = elements},
                              projection, ThreadExecutor(threads), progress);
        }));
    });
    m.def("isolines", [](const Source& source, const std::vector<double>& values,
                         const Projection& projection, int threads) {
        return shared(Interruptible().run([&](const Progress& progress) {
            return draw_isolines(source, values, projection, ThreadExecutor(threads), progress);
        }));
    });
    m.def("height_field", [](const Source& source, std::optional<double> scale, double flatness,
                             bool elements, const Projection& projection, int threads) {
        return shared(Interruptible().run([&](const Progress& progress) {
            return draw_height_field(source, scale, flatness, elements, projection,
                                     ThreadExecutor(threads), progress);
        }));
    });
    m.def("probe", &probe_array);
}

}  // namespace

void bind_extraction(py::module_& m) {
    bind_domains(m);
    bind_requests(m);
    bind_draws(m);
}

}  // namespace nestgrid::python
