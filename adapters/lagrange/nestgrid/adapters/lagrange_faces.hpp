// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the cells of a mesh meet in whole faces. Included by lagrange.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include <nestgrid/adapters/coarse_graph.hpp>

namespace nestgrid::detail {

/// An edge, a triangle or a quadrilateral as the image of a reference element.
struct FaceMap {
    std::array<Point, 4> x{};  ///< in tensor order
    std::size_t corners = 0;

    Point at(double s, double t) const {
        if (corners == 4) {
            return (1 - s) * (1 - t) * x[0] + s * (1 - t) * x[1] + (1 - s) * t * x[2] +
                   s * t * x[3];
        }
        return (1 - s - t) * x[0] + s * x[1] + t * x[2];
    }
    /// Whether a point lies on it within a distance.
    bool contains(const Point& point, double distance) const {
        double s = 0.4;
        double t = corners == 2 ? 0 : 0.3;
        // Least squares; the map is linear in each of s and t.
        for (int step = 0; step < 8; ++step) {
            const Point off = point - at(s, t);
            const Point along = at(s + 1, t) - at(s, t);
            const Point across = at(s, t + 1) - at(s, t);
            const double a = dot(along, along);
            const double b = corners == 2 ? 0 : dot(along, across);
            const double c = corners == 2 ? 1 : dot(across, across);
            const double determinant = a * c - b * b;
            if (!(determinant > 0)) return false;
            const double u = dot(along, off);
            const double v = corners == 2 ? 0 : dot(across, off);
            s += (u * c - v * b) / determinant;
            t += (v * a - u * b) / determinant;
        }
        const double most = corners == 3 ? 1 - t : 1;
        return s >= 0 && s <= most && t >= 0 && t <= 1 && norm(point - at(s, t)) <= distance;
    }
};

/// Looks for nodes of other cells on a face that has one cell.
class HangingFaces {
public:
    /// \param numbers of the cells, in sentences
    /// \param distance within which a node lies on a face
    HangingFaces(const CoarseGrid& grid, std::span<const std::size_t> numbers, double distance)
        : grid_{&grid}, numbers_{numbers}, distance_{distance} {}

    /// \throw InvalidInput with the first face that is divided on its other side, or that more than
    ///        two cells have
    void check() {
        find_lonely();
        std::vector<std::uint32_t> nodes;
        for (const CoarseFace& face : lonely_) {
            for (std::size_t i = 0; i < corners(face); ++i) nodes.push_back(face.nodes[i]);
        }
        std::ranges::sort(nodes);
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        std::ranges::sort(nodes, {}, [&](std::uint32_t n) { return grid_->nodes[n][0]; });
        std::ranges::sort(lonely_, {}, [](const CoarseFace& f) { return f.element; });
        for (const CoarseFace& face : lonely_) require_whole(face, nodes);
    }

private:
    static std::size_t corners(const CoarseFace& face) {
        const auto end = std::ranges::find(face.nodes, 0xFFFFFFFFU);
        return static_cast<std::size_t>(end - face.nodes.begin());
    }
    std::string name(const CoarseFace& face) const {
        return std::to_string(numbers_[face.element]);
    }
    void find_lonely() {
        const std::vector<CoarseFace> faces = sorted_faces(*grid_);
        for (std::size_t i = 0, next = 0; i < faces.size(); i = next) {
            while (next < faces.size() && faces[next].nodes == faces[i].nodes) ++next;
            if (next - i > 2) {
                throw InvalidInput("the cells " + name(faces[i]) + ", " + name(faces[i + 1]) +
                                   " and " + name(faces[i + 2]) + " share one face");
            }
            if (next - i == 1) lonely_.push_back(faces[i]);
        }
    }
    FaceMap map_of(const CoarseFace& face) const {
        const FaceTopology& of = topology(grid_->shapes[face.element]).face[face.face];
        FaceMap map;
        map.corners = of.corners;
        for (std::size_t i = 0; i < map.corners; ++i) {
            const std::uint8_t corner = of.tensor_corner(static_cast<int>(i));
            map.x[i] = grid_->nodes[grid_->element(face.element)[corner]];
        }
        return map;
    }
    /// \param nodes of faces that have one cell, by their first coordinate
    void require_whole(const CoarseFace& face, const std::vector<std::uint32_t>& nodes) const {
        const FaceMap map = map_of(face);
        Point low = map.x[0];
        Point high = low;
        for (std::size_t i = 1; i < map.corners; ++i) {
            for (std::size_t d = 0; d < 3; ++d) {
                low[d] = std::min(low[d], map.x[i][d]);
                high[d] = std::max(high[d], map.x[i][d]);
            }
        }
        const auto x_of = [&](std::uint32_t n) { return grid_->nodes[n][0]; };
        auto at = std::ranges::lower_bound(nodes, low[0] - distance_, {}, x_of);
        for (; at != nodes.end() && x_of(*at) <= high[0] + distance_; ++at) {
            const Point x = grid_->nodes[*at];
            const bool near = x[1] >= low[1] - distance_ && x[1] <= high[1] + distance_ &&
                              x[2] >= low[2] - distance_ && x[2] <= high[2] + distance_;
            const bool own = std::ranges::find(face.nodes, *at) != face.nodes.end();
            if (!near || own || !map.contains(x, distance_)) continue;
            throw InvalidInput(
                "a face of cell " + name(face) +
                " is divided on its other side: cells of different size meet there, and their "
                "hierarchy is not in the file; draw it in the solver");
        }
    }

    const CoarseGrid* grid_;
    std::span<const std::size_t> numbers_;
    double distance_;
    std::vector<CoarseFace> lonely_;
};

}  // namespace nestgrid::detail
