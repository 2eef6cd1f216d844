// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a piecewise linear complex must be before TetGen sees it, which would stop the program;
// included by tetgen_mesher.hpp.
#pragma once

#include <algorithm>
#include <set>

#include <tetgen.h>

#include <nestgrid/adapters/coarse.hpp>

namespace nestgrid::detail {

/// How far points lie from a plane through three of them that are far apart, over how far they lie
/// from the first.
inline double thickness(std::span<const Point> points) {
    const auto greatest = [&](auto&& function) {
        Point best{};
        for (const Point& p : points) {
            const Point x = function(p - points[0]);
            if (norm(x) > norm(best)) best = x;
        }
        return best;
    };
    const Point along = greatest([](const Point& x) { return x; });
    const Point normal = greatest([&](const Point& x) { return cross(along, x); });
    const Point above = greatest([&](const Point& x) { return Point{dot(normal, x), 0, 0}; });
    const double size = norm(normal) * norm(along);
    return size > 0 ? norm(above) / size : 0;
}

inline void check_facet(const tetgenio& plc, int i, std::span<const Point> points) {
    const tetgenio::facet& facet = plc.facetlist[i];
    const std::string name = "facet " + std::to_string(i + 1);
    std::vector<Point> corners;
    for (int k = 0; k < facet.numberofpolygons; ++k) {
        const tetgenio::polygon& polygon = facet.polygonlist[k];
        std::set<int> seen;
        for (int c = 0; c < polygon.numberofvertices; ++c) {
            const int node = polygon.vertexlist[c];
            if (!seen.insert(node).second) {
                throw InvalidInput(name + " has the point " + std::to_string(node) + " twice");
            }
            corners.push_back(points[static_cast<std::size_t>(node - plc.firstnumber)]);
        }
    }
    if (corners.empty()) throw InvalidInput(name + " has no corners");
    if (thickness(corners) > 1e-4) throw InvalidInput(name + " is not plane");
}

/// \throw InvalidInput for less than four points, points in one plane, duplicate ones, and for
///        facets that are not plane or name a point twice
inline void check_complex(const tetgenio& plc) {
    if (plc.numberofpoints < 4) throw InvalidInput("the complex has less than four points");
    std::vector<Point> points;
    std::vector<std::pair<Point, int>> places;
    for (int i = 0; i < plc.numberofpoints; ++i) {
        const double* x = plc.pointlist + 3 * static_cast<std::ptrdiff_t>(i);
        points.push_back({x[0], x[1], x[2]});
        places.emplace_back(points.back(), i + plc.firstnumber);
    }
    if (thickness(points) <= 1e-7) throw InvalidInput("the complex is flat");
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        if (places[i].first == places[i + 1].first) {
            throw InvalidInput("duplicate vertex: the points " + std::to_string(places[i].second) +
                               " and " + std::to_string(places[i + 1].second) +
                               " are at the same place");
        }
    }
    for (int i = 0; i < plc.numberoffacets; ++i) check_facet(plc, i, points);
}

}  // namespace nestgrid::detail
