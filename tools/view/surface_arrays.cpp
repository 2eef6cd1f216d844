// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface_arrays.hpp"

#include <algorithm>
#include <cmath>

#include <nestgrid/algorithms/outlines.hpp>
#include <nestgrid/algorithms/surface_isolines.hpp>
#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::view {

namespace {

void write_points(FrameReply& reply, std::string_view name, std::span<const Point> points) {
    const auto to = reply.array<float>(name, "float32", 3 * points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t d = 0; d < 3; ++d) to[3 * i + d] = static_cast<float>(points[i][d]);
    }
}

}  // namespace

template <int dimension>
void write_mesh(FrameReply& reply, const Surface<dimension>& surface) {
    write_points(reply, "positions", surface.vertices);
    constexpr auto corners = static_cast<std::size_t>(dimension);
    const auto& simplices = surface.simplices;
    const auto to = reply.array<std::uint32_t>("indices", "uint32", corners * simplices.size());
    for (std::size_t i = 0; i < simplices.size(); ++i) {
        std::ranges::copy(simplices[i], to.subspan(corners * i).begin());
    }
}
template void write_mesh(FrameReply&, const Surface<2>&);
template void write_mesh(FrameReply&, const Surface<3>&);

namespace {

void write_segments(FrameReply& reply, const char* kind, const Surface<2>& lines) {
    JsonText& text = reply.header;
    text.open('{').key("kind").string(kind);
    text.key("segments").number(static_cast<double>(lines.simplices.size()));
    write_mesh(reply, lines);
    text.close('}');
}

}  // namespace

void write_short_normals(FrameReply& reply, std::span<const Point> normals) {
    const auto to = reply.array<std::int8_t>("normals", "int8", 4 * normals.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        for (std::size_t d = 0; d < 3; ++d) {
            const double part = std::clamp(normals[i][d], -1.0, 1.0);
            to[4 * i + d] = static_cast<std::int8_t>(std::lround(127 * part));
        }
    }
}

void write_normals(FrameReply& reply, std::span<const Point> normals) {
    write_points(reply, "normals", normals);
}

void write_values(FrameReply& reply, const Surface<3>& surface, std::size_t component) {
    const std::size_t vertices = surface.vertices.size();
    const std::size_t components = vertices > 0 ? surface.attributes.size() / vertices : 1;
    const auto to = reply.array<float>("values", "float32", vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
        to[i] = static_cast<float>(surface.attributes[i * components + component]);
    }
}

void write_outlines(FrameReply& reply, const Surface<3>& surface) {
    write_segments(reply, "outlines", outlines(surface));
}

void write_isolines(FrameReply& reply, const Surface<3>& surface, std::span<const double> values) {
    if (surface.simplices.empty()) return;
    const Polylines lines = isolines(surface, 0, values);
    Surface<2> segments;
    segments.vertices = lines.vertices;
    for (std::size_t i = 0; i < lines.count(); ++i) {
        const auto line = lines.line(i);
        for (std::size_t k = 1; k < line.size(); ++k) {
            segments.simplices.push_back({line[k - 1], line[k]});
        }
    }
    write_segments(reply, "isolines", segments);
}

Surface<3> with_creases(const Surface<3>& surface) {
    const double least_cosine = std::cos(40 * std::acos(-1.0) / 180);
    using Corner = std::pair<std::uint32_t, std::uint32_t>;  // vertex, place among all corners
    std::vector<Corner> corners;
    std::vector<Point> direction;  // of each triangle, of unit length
    std::vector<double> area;
    for (const auto& [a, b, c] : surface.simplices) {
        const Point& x = surface.vertices[a];
        const Point normal = cross(surface.vertices[b] - x, surface.vertices[c] - x);
        const double length = norm(normal);
        for (const std::uint32_t v : {a, b, c}) {
            corners.emplace_back(v, static_cast<std::uint32_t>(corners.size()));
        }
        direction.push_back(length > 0 ? (1 / length) * normal : normal);
        area.push_back(length);
    }
    std::ranges::sort(corners);
    Surface<3> creased;
    creased.simplices = surface.simplices;
    const std::size_t components =
        surface.attributes.size() / std::max<std::size_t>(surface.vertices.size(), 1);
    for (auto begin = corners.begin(); begin != corners.end();) {
        const auto end = std::find_if(begin, corners.end(), [&](const Corner& corner) {
            return corner.first != begin->first;
        });
        // Triangles whose directions are near are one piece, and so are those near to them.
        while (begin != end) {
            auto piece = begin + 1;
            for (auto seen = begin; seen != piece; ++seen) {
                piece = std::partition(piece, end, [&](const Corner& other) {
                    return dot(direction[seen->second / 3], direction[other.second / 3]) >=
                           least_cosine;
                });
            }
            Point normal{0, 0, 0};
            const auto number = static_cast<std::uint32_t>(creased.vertices.size());
            creased.vertices.push_back(surface.vertices[begin->first]);
            const std::size_t first = begin->first * components;
            for (std::size_t c = 0; c < components; ++c) {
                creased.attributes.push_back(surface.attributes[first + c]);
            }
            for (; begin != piece; ++begin) {
                const std::uint32_t t = begin->second / 3;
                normal = normal + area[t] * direction[t];
                creased.simplices[t][begin->second % 3] = number;
            }
            const double length = norm(normal);
            creased.normals.push_back(length > 0 ? (1 / length) * normal : normal);
        }
    }
    return creased;
}

std::vector<Point> normals_from_triangles(const Surface<3>& surface) {
    std::vector<Point> normals(surface.vertices.size(), Point{0, 0, 0});
    for (const auto& [a, b, c] : surface.simplices) {
        const Point& x = surface.vertices[a];
        const Point normal = cross(surface.vertices[b] - x, surface.vertices[c] - x);
        for (const std::uint32_t v : {a, b, c}) normals[v] = normals[v] + normal;
    }
    for (Point& normal : normals) {
        const double length = std::sqrt(dot(normal, normal));
        if (length > 0) normal = (1 / length) * normal;
    }
    return normals;
}

}  // namespace nestgrid::view
