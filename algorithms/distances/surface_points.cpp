// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <distances/surface_points.hpp>

#include <algorithm>
#include <cmath>

namespace nestgrid::engine {

namespace {

constexpr double most_parts = 1024;  // along each side

}  // namespace

SurfacePoints points_of(const Surface<3>& surface, std::size_t first, std::size_t last,
                        double length) {
    SurfacePoints points;
    for (std::size_t t = first; t < last; ++t) {
        const auto& v = surface.simplices[t];
        const Point a = surface.vertices[v[0]];
        const Point ab = surface.vertices[v[1]] - a;
        const Point ac = surface.vertices[v[2]] - a;
        const double side = std::max({norm(ab), norm(ac), norm(ac - ab)});
        const double parts = std::clamp(std::ceil(side / length), 1.0, most_parts);
        const double area = 0.5 * norm(cross(ab, ac)) / (parts * parts);
        const auto add = [&](double i, double j) {
            points.x.push_back(a + (i / parts) * ab + (j / parts) * ac);
            points.area.push_back(area);
        };
        for (double i = 0; i < parts; ++i) {
            for (double j = 0; i + j < parts; ++j) {
                add(i + 1.0 / 3, j + 1.0 / 3);
                if (i + j + 1 < parts) add(i + 2.0 / 3, j + 2.0 / 3);
            }
        }
        // From its middle no corner of a triangle is farther than two thirds of the longest side.
        points.reach = std::max(points.reach, 2.0 / 3 * side / parts);
    }
    return points;
}

}  // namespace nestgrid::engine
