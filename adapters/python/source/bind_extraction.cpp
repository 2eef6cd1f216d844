// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/indicators.hpp>
#include <nestgrid/error.hpp>

#include "bind.hpp"
#include "extract.hpp"
#include "interruptible.hpp"

namespace nestgrid::python {

namespace {

/// A domain of lenses and regions, for Python opaque.
struct Domain {
    Distance distance;
};

void bind_domains(py::module_& m) {
    py::class_<Domain>(m, "Domain")
        .def(
            "union_with",
            [](const Domain& a, const Domain& b) {
                return Domain{union_of(a.distance, b.distance)};
            },
            py::arg("other"))
        .def(
            "intersection",
            [](const Domain& a, const Domain& b) {
                return Domain{nestgrid::intersection(a.distance, b.distance)};
            },
            py::arg("other"));
    m.def(
        "ball",
        [](const Numbers& centre, double radius) {
            if (!(radius >= 0)) throw InvalidInput("the radius of a ball is not a number >= 0");
            return Domain{Ball{point_of(centre, "the centre"), radius}};
        },
        py::arg("centre"), py::arg("radius"));
    m.def(
        "box",
        [](const Numbers& low, const Numbers& high) {
            const Box box{point_of(low, "the low corner"), point_of(high, "the high corner")};
            for (std::size_t d = 0; d < 3; ++d) {
                if (!(box.low[d] <= box.high[d])) throw InvalidInput("the box is empty");
            }
            return Domain{box};
        },
        py::arg("low"), py::arg("high"));
    m.def(
        "half_space",
        [](const Numbers& through, const Numbers& normal) {
            return Domain{
                HalfSpace(point_of(through, "the point"), point_of(normal, "the normal"))};
        },
        py::arg("through"), py::arg("normal"));
    m.def(
        "cone",
        [](const Numbers& apex, const Numbers& towards, double angle) {
            return Domain{
                Cone(point_of(apex, "the apex"), point_of(towards, "the direction"), angle)};
        },
        py::arg("apex"), py::arg("towards"), py::arg("angle"));
    m.def(
        "polygon", [](const std::vector<ImagePoint>& corners) { return Domain{Polygon(corners)}; },
        py::arg("corners"));
    m.def(
        "frustum",
        [](const Numbers& eye, const Numbers& towards, const Numbers& up, double angle,
           double aspect, double nearest, double farthest) {
            return Domain{view_frustum({.eye = point_of(eye, "the eye"),
                                        .towards = point_of(towards, "the direction"),
                                        .up = point_of(up, "up"),
                                        .angle = angle,
                                        .aspect = aspect},
                                       nearest, farthest)};
        },
        py::arg("eye"), py::arg("towards"), py::arg("up"), py::arg("angle"), py::arg("aspect"),
        py::arg("nearest"), py::arg("farthest"));
}

/// A function of Python, which any thread calls with Python's lock.
class CalledFunction final : public LevelFunction {
public:
    CalledFunction(py::function function, double steepness)
        : function_{keep(std::move(function))}, steepness_{steepness} {}
    /// \throw py::error_already_set where the function raises, or gives no number
    double value(const Point& x) const override {
        const py::gil_scoped_acquire locked;
        const py::handle function(
            const_cast<PyObject*>(static_cast<const PyObject*>(function_.get())));
        const double value = PyFloat_AsDouble(function(x[0], x[1], x[2]).ptr());
        if (value == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
        return value;
    }
    double variation(const Point& /*centre*/, double radius) const override {
        return steepness_ * radius;
    }

private:
    std::shared_ptr<const void> function_;
    double steepness_;
};

void bind_requests(py::module_& m) {
    py::class_<LensRequest>(m, "Lens").def(
        py::init([](const Domain& domain, double finest, double coarsest, double slope) {
            return LensRequest{domain.distance, finest, coarsest, slope};
        }),
        py::arg("domain"), py::arg("finest"), py::arg("coarsest"), py::arg("slope"));
    py::class_<RegionRequest>(m, "Region")
        .def(py::init([](const Domain& domain, double threshold) {
                 return RegionRequest{domain.distance, threshold};
             }),
             py::arg("domain"), py::arg("threshold"));
    py::class_<Projection>(m, "Projection")
        .def(py::init([](std::optional<double> threshold, std::optional<std::uint64_t> triangles,
                         std::string indicator, double blend, std::optional<LensRequest> lens,
                         std::optional<RegionRequest> region, double colour_tolerance,
                         std::optional<double> position_error) {
                 if (triangles == std::uint64_t{0}) throw InvalidInput("max_triangles is 0");
                 return Projection{.threshold = threshold,
                                   .max_triangles = triangles.value_or(0),
                                   .indicator = std::move(indicator),
                                   .blend = blend,
                                   .lens = std::move(lens),
                                   .region = std::move(region),
                                   .colour_tolerance = colour_tolerance,
                                   .position_error = position_error.value_or(0)};
             }),
             py::arg("threshold"), py::arg("max_triangles"), py::arg("indicator"), py::arg("blend"),
             py::arg("lens"), py::arg("region"), py::arg("colour_tolerance"),
             py::arg("position_error"));
    m.def("indicators", [] {
        std::vector<std::tuple<std::string, std::string, std::string, bool>> all;
        for (const IndicatorKind& kind : indicators()) {
            all.emplace_back(kind.name, kind.measures, unit_name(kind.unit), kind.of_level_sets);
        }
        return all;
    });
    const py::class_<LevelFunction, std::shared_ptr<LevelFunction>> opaque(m, "LevelFunction");
    m.def(
        "plane",
        [](const Numbers& through, const Numbers& normal) {
            return std::shared_ptr<LevelFunction>(std::make_shared<Plane>(
                point_of(through, "the point"), point_of(normal, "the normal")));
        },
        py::arg("through"), py::arg("normal"));
    m.def(
        "sphere",
        [](const Numbers& centre, double radius) {
            return std::shared_ptr<LevelFunction>(
                std::make_shared<Sphere>(point_of(centre, "the centre"), radius));
        },
        py::arg("centre"), py::arg("radius"));
    m.def(
        "cylinder",
        [](const Numbers& through, const Numbers& axis, double radius) {
            return std::shared_ptr<LevelFunction>(std::make_shared<Cylinder>(
                point_of(through, "the point"), point_of(axis, "the axis"), radius));
        },
        py::arg("through"), py::arg("axis"), py::arg("radius"));
    m.def(
        "function",
        [](py::function call, double steepness) {
            return std::shared_ptr<LevelFunction>(
                std::make_shared<CalledFunction>(std::move(call), steepness));
        },
        py::arg("call"), py::arg("steepness"));
}

using SourcePointer = std::shared_ptr<Source>;

/// Draws in the background.
/// \param draw called with a Call, gives a result
template <class Draw>
auto drawn(int threads, const Draw& draw) {
    return interruptible(threads, [draw](const Call& call) {
        auto result = std::make_shared<std::invoke_result_t<const Draw&, const Call&>>(draw(call));
        if (call.stopped()) throw Stopped();
        return result;
    });
}

py::array_t<double> probe_array(const SourcePointer& source, const Numbers& points,
                                const Projection& projection, int threads) {
    std::vector<Point> at(static_cast<std::size_t>(points.size()) / 3);
    std::copy_n(points.data(), 3 * at.size(), at.empty() ? nullptr : at.front().data());
    const auto result = drawn(threads, [source, at, projection](const Call& call) {
        return probe_points(*source, at, projection, call);
    });
    return py::array_t<double>(static_cast<py::ssize_t>(result->values.size()),
                               result->values.data());
}

void bind_draws(py::module_& m) {
    m.def(
        "isosurface",
        [](const SourcePointer& source, double level, bool normals, bool cap, bool elements,
           bool at_nodes, bool finest_cuts, bool collapses, bool keeps_distance,
           const Projection& projection, int threads) {
            const SurfaceRequest request{normals,     cap,       elements,      at_nodes,
                                         finest_cuts, collapses, keeps_distance};
            return drawn(threads, [source, level, request, projection](const Call& call) {
                return draw_isosurface(*source, level, request, projection, call);
            });
        },
        py::arg("source"), py::arg("level"), py::arg("normals"), py::arg("cap"),
        py::arg("elements"), py::arg("at_nodes"), py::arg("finest_cuts"), py::arg("collapses"),
        py::arg("keeps_distance"), py::arg("projection"), py::arg("threads"));
    m.def(
        "isosurfaces",
        [](const SourcePointer& source, const std::vector<double>& levels, bool normals, bool cap,
           bool elements, bool at_nodes, bool finest_cuts, const Projection& projection,
           int threads) {
            const SurfaceRequest request{normals, cap, elements, at_nodes, finest_cuts};
            const auto all =
                drawn(threads, [source, levels, request, projection](const Call& call) {
                    return draw_isosurfaces(*source, levels, request, projection, call);
                });
            std::vector<std::shared_ptr<Drawn>> each;
            for (Drawn& d : *all) each.push_back(std::make_shared<Drawn>(std::move(d)));
            return each;
        },
        py::arg("source"), py::arg("levels"), py::arg("normals"), py::arg("cap"),
        py::arg("elements"), py::arg("at_nodes"), py::arg("finest_cuts"), py::arg("projection"),
        py::arg("threads"));
    m.def(
        "measure",
        [](const SourcePointer& source, const std::shared_ptr<Drawn>& surface, double level,
           std::size_t points, int threads) {
            const auto measured =
                drawn(threads, [source, surface, level, points](const Call& call) {
                    return measure_error(source->prerolls(), surface->surface, level, points,
                                         call.work());
                });
            py::dict result;
            const auto add = [&](const char* name, const Measured& each) {
                result[name] = each.greatest;
                result[(std::string(name) + "_mean").c_str()] = each.mean;
                result[(std::string(name) + "_rms").c_str()] = each.rms;
            };
            add("error", measured->value);
            add("distance", measured->distance);
            add("distance_back", measured->back);
            result["reach"] = measured->reach;
            result["points"] = measured->points;
            return result;
        },
        py::arg("source"), py::arg("surface"), py::arg("level"), py::arg("points"),
        py::arg("threads"));
    m.def(
        "isoband",
        [](const SourcePointer& source, double low, double high, bool normals, bool elements,
           const Projection& projection, int threads) {
            const SurfaceRequest request{.normals = normals, .elements = elements};
            return drawn(threads, [source, low, high, request, projection](const Call& call) {
                return draw_isoband(*source, low, high, request, projection, call);
            });
        },
        py::arg("source"), py::arg("low"), py::arg("high"), py::arg("normals"), py::arg("elements"),
        py::arg("projection"), py::arg("threads"));
    m.def(
        "boundary",
        [](const SourcePointer& source, bool elements, bool collapses, const Projection& projection,
           int threads) {
            const SurfaceRequest request{
                .normals = false, .elements = elements, .collapses = collapses};
            return drawn(threads, [source, request, projection](const Call& call) {
                return draw_boundary(*source, request, projection, call);
            });
        },
        py::arg("source"), py::arg("elements"), py::arg("collapses"), py::arg("projection"),
        py::arg("threads"));
    m.def(
        "slice",
        [](const SourcePointer& source, const std::shared_ptr<LevelFunction>& function,
           bool normals, bool elements, bool collapses, double distance,
           const Projection& projection, int threads) {
            const SurfaceRequest request{.normals = normals,
                                         .elements = elements,
                                         .collapses = collapses,
                                         .slice_distance = distance};
            return drawn(threads, [source, function, request, projection](const Call& call) {
                return draw_slice(*source, *function, request, projection, call);
            });
        },
        py::arg("source"), py::arg("function"), py::arg("normals"), py::arg("elements"),
        py::arg("collapses"), py::arg("distance"), py::arg("projection"), py::arg("threads"));
    m.def(
        "isolines",
        [](const SourcePointer& source, const std::vector<double>& values,
           const Projection& projection, int threads) {
            return drawn(threads, [source, values, projection](const Call& call) {
                return draw_isolines(*source, values, projection, call);
            });
        },
        py::arg("source"), py::arg("values"), py::arg("projection"), py::arg("threads"));
    m.def(
        "height_field",
        [](const SourcePointer& source, std::optional<double> scale, double flatness, bool elements,
           bool collapses, const Projection& projection, int threads) {
            const SurfaceRequest request{.elements = elements, .collapses = collapses};
            return drawn(threads, [source, scale, flatness, request, projection](const Call& call) {
                return draw_height_field(*source, scale, flatness, request, projection, call);
            });
        },
        py::arg("source"), py::arg("scale"), py::arg("flatness"), py::arg("elements"),
        py::arg("collapses"), py::arg("projection"), py::arg("threads"));
    m.def("probe", &probe_array, py::arg("source"), py::arg("points"), py::arg("projection"),
          py::arg("threads"));
}

}  // namespace

void bind_extraction(py::module_& m) {
    bind_domains(m);
    bind_requests(m);
    bind_draws(m);
}

}  // namespace nestgrid::python
