// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface_arrays.hpp"

#include <algorithm>
#include <cmath>

#include <nestgrid/algorithms/outlines.hpp>
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
    const Surface<2> lines = outlines(surface);
    JsonText& text = reply.header;
    text.open('{').key("kind").string("outlines");
    text.key("segments").number(static_cast<double>(lines.simplices.size()));
    write_mesh(reply, lines);
    text.close('}');
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
