// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/measured_error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <distances/closest_points.hpp>
#include <distances/surface_points.hpp>
#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/polynomial_values.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

constexpr std::size_t most_of_a_task = 4096;       // triangles, or vertices, of one task
constexpr std::size_t points_at_once = 1U << 20U;  // of one walk

/// The greatest number, and sums over an area.
struct Sums {
    double greatest = 0;
    double area = 0;
    double sum = 0;
    double squares = 0;

    void add(double number, double of) {
        greatest = std::max(greatest, number);
        area += of;
        sum += of * number;
        squares += of * number * number;
    }
    void add(const Sums& other) {
        greatest = std::max(greatest, other.greatest);
        area += other.area;
        sum += other.sum;
        squares += other.squares;
    }
    Measured measured() const {
        if (!(area > 0)) return {greatest, greatest, greatest};
        return {greatest, sum / area, std::sqrt(squares / area)};
    }
};

double area_of(const Surface<3>& surface) {
    double sum = 0;
    for (const auto& v : surface.simplices) {
        const Point& a = surface.vertices[v[0]];
        sum += 0.5 * norm(cross(surface.vertices[v[1]] - a, surface.vertices[v[2]] - a));
    }
    return sum;
}

/// Calls measure(points, result) for points on all triangles of a surface and for its vertices,
/// which stand for no area, in tasks; and consume(result) in their order.
template <class Result, class MeasurePoints, class Consume>
void measure_surface(const Surface<3>& surface, std::size_t points, const Executor& executor,
                     const MeasurePoints& measure, const Consume& consume) {
    const std::size_t triangles = surface.simplices.size();
    const std::size_t vertices = surface.vertices.size();
    const auto task_count = [](std::size_t n) { return (n + most_of_a_task - 1) / most_of_a_task; };
    // As many squares of this length have twice the area.
    const double length = std::sqrt(2 * area_of(surface) / static_cast<double>(points));
    const std::size_t of_triangles = task_count(triangles);
    std::vector<Result> results(of_triangles + task_count(vertices));
    executor.run(
        results.size(),
        [&](std::size_t i) {
            const std::size_t first = (i < of_triangles ? i : i - of_triangles) * most_of_a_task;
            if (i < of_triangles) {
                const std::size_t last = std::min(triangles, first + most_of_a_task);
                measure(engine::points_of(surface, first, last, length), results[i]);
            } else {
                const auto all = std::span(surface.vertices).subspan(first);
                const auto some = all.first(std::min(all.size(), most_of_a_task));
                measure({{some.begin(), some.end()}, std::vector<double>(some.size(), 0), 0},
                        results[i]);
            }
        },
        [&](std::size_t i) {
            consume(results[i]);
            results[i] = {};
        });
}

/// Distances of the points of one surface from another one.
Measured measure_distance(const Surface<3>& from, const Surface<3>& to, std::size_t points,
                          const Executor& executor, MeasuredError& all) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (from.simplices.empty()) return {};
    if (to.simplices.empty()) return {infinity, infinity, infinity};
    struct Part {
        Sums sums;
        double reach = 0;
        std::size_t points = 0;
    };
    const engine::ClosestPoints closest(to);
    Sums sums;
    measure_surface<Part>(
        from, points, executor,
        [&](const engine::SurfacePoints& at, Part& part) {
            double bound = infinity;
            for (std::size_t i = 0; i < at.x.size(); ++i) {
                if (i > 0) bound += norm(at.x[i] - at.x[i - 1]);
                bound = closest.distance(at.x[i], bound);
                part.sums.add(bound, at.area[i]);
            }
            part.reach = at.reach;
            part.points = at.x.size();
        },
        [&](const Part& part) {
            sums.add(part.sums);
            all.reach = std::max(all.reach, part.reach);
            all.points += part.points;
        });
    return sums.measured();
}

/// |U - C| at the points of a surface. Points that rounding has put outside the grid do not count.
Measured measure_values(const Surface<3>& surface, const Prerolls& prerolls, double isovalue,
                        std::size_t points, const Work& work) {
    Sums sums;
    engine::SurfacePoints some;  // so many that a walk is worth it
    const std::shared_ptr<const HighOrder> data = prerolls.high_order(work);
    const auto look = [&] {
        const ProbeResult probed =
            data != nullptr ? probe(*data, some.x) : probe(prerolls, some.x, {}, work);
        for (std::size_t i = 0; i < some.x.size(); ++i) {
            if (!probed.found(i)) continue;
            sums.add(std::abs(probed.values[i * probed.components] - isovalue), some.area[i]);
        }
        some = {};
    };
    measure_surface<engine::SurfacePoints>(
        surface, points, work.executor,
        [](engine::SurfacePoints at, engine::SurfacePoints& result) { result = std::move(at); },
        [&](const engine::SurfacePoints& at) {
            some.x.insert(some.x.end(), at.x.begin(), at.x.end());
            some.area.insert(some.area.end(), at.area.begin(), at.area.end());
            if (some.x.size() >= points_at_once) look();
        });
    if (!some.x.empty()) look();
    return sums.measured();
}

/// Measures how far two surfaces are from each other, there and back.
void measure_distances(const Surface<3>& drawn, const Surface<3>& whole, std::size_t points,
                       const Executor& executor, MeasuredError& error) {
    error.distance = measure_distance(drawn, whole, points, executor, error);
    error.back = measure_distance(whole, drawn, points, executor, error);
}

void require_measurable(const Prerolls& prerolls, double isovalue, std::size_t points) {
    prerolls.field().facts().require_dimension(3);
    if (!std::isfinite(isovalue)) throw InvalidInput("the isovalue is not a finite number");
    if (points == 0) throw InvalidInput("an error cannot be measured at no point");
}

}  // namespace

MeasuredError measure_error(const Prerolls& prerolls, const Surface<3>& drawn,
                            const Surface<3>& whole, double isovalue, std::size_t points,
                            const Work& work) {
    require_measurable(prerolls, isovalue, points);
    MeasuredError error;
    error.value = measure_values(drawn, prerolls, isovalue, points, work);
    measure_distances(drawn, whole, points, work.executor, error);
    return error;
}

MeasuredError measure_error(const Prerolls& prerolls, const Surface<3>& drawn, double isovalue,
                            std::size_t points, const Work& work) {
    const auto whole = [&](const Projection& how) {
        return isosurface<3>(prerolls, isovalue, how, {.elements = false}, work).surface;
    };
    const std::shared_ptr<const HighOrder> data = prerolls.high_order(work);
    if (data == nullptr) {
        return measure_error(prerolls, drawn, whole({.threshold = 0}), isovalue, points, work);
    }
    require_measurable(prerolls, isovalue, points);
    MeasuredError error;
    error.value = measure_values(drawn, prerolls, isovalue, points, work);
    const double found = error.value.greatest;
    const double tenth = found > 0 ? found / 10 : default_error(*data);
    const double within = std::max(tenth, data->least_tolerance());
    measure_distances(drawn, whole({.threshold = within, .indicator = "error"}), points,
                      work.executor, error);
    return error;
}

}  // namespace nestgrid
