// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Building the contour tables; included by contour_table.hpp.
#pragma once

#include <nestgrid/algorithms/contour_table.hpp>

namespace nestgrid {

inline const ContourTable& ContourTable::of(Shape shape) {
    static const ContourTable triangle(Shape::triangle);
    static const ContourTable tetrahedron(Shape::tetrahedron);
    if (shape == Shape::triangle) return triangle;
    if (shape == Shape::tetrahedron) return tetrahedron;
    static const ContourTable quadrilateral(Shape::quadrilateral);
    static const ContourTable pyramid(Shape::pyramid);
    static const ContourTable prism(Shape::prism);
    static const ContourTable hexahedron(Shape::hexahedron);
    return shape == Shape::quadrilateral ? quadrilateral
           : shape == Shape::pyramid     ? pyramid
           : shape == Shape::prism       ? prism
                                         : hexahedron;
}

inline FaceTopology ContourTable::face(std::size_t f) const {
    if (topology_->dimension == 3) return topology_->face[f];
    FaceTopology loop{
        topology_->corners == 3 ? Shape::triangle : Shape::quadrilateral, topology_->corners, {}};
    for (std::size_t i = 1; i < loop.corners; ++i) {  // counterclockwise, from corner 0 on
        for (std::size_t side = 0; side < topology_->faces; ++side) {
            const auto& ends = topology_->face[side].corner;
            if (ends[0] == loop.corner[i - 1]) loop.corner[i] = ends[1];
        }
    }
    return loop;
}

inline ContourTable::ContourTable(Shape shape) : shape_{shape}, topology_{&topology(shape)} {
    const unsigned patterns = 1U << topology_->corners;
    for (unsigned pattern = 0; pattern < patterns; ++pattern) {
        std::uint16_t cut_edges = 0;
        for (std::size_t e = 0; e < topology_->edges; ++e) {
            const auto& [a, b] = topology_->edge[e];
            cut_edges |= static_cast<std::uint16_t>(((pattern >> a ^ pattern >> b) & 1U) << e);
        }
        cut_edges_.push_back(cut_edges);
        std::uint8_t alternating = 0;
        std::uint8_t cut_faces = 0;
        for (std::size_t f = 0; f < face_count(); ++f) {
            const FaceTopology loop = face(f);
            unsigned signs = 0;
            for (std::size_t i = 0; i < loop.corners; ++i) {
                signs |= (pattern >> loop.corner[i] & 1U) << i;
            }
            const bool cut = signs != 0 && signs != (1U << loop.corners) - 1;
            cut_faces |= static_cast<std::uint8_t>(unsigned{cut} << f);
            if (loop.corners != 4) continue;
            if (signs == 5 || signs == 10) alternating |= static_cast<std::uint8_t>(1U << f);
        }
        alternating_.push_back(alternating);
        cut_faces_.push_back(cut_faces);
        first_.push_back(static_cast<std::uint32_t>(contours_.size()));
        const unsigned choices = 1U << std::popcount(alternating);
        for (unsigned choice = 0; choice < choices; ++choice) {
            unsigned joined = 0;
            unsigned place = 0;
            for (unsigned left = alternating; left != 0; left &= left - 1) {
                joined |= (choice >> place++ & 1U) << std::countr_zero(left);
            }
            contours_.push_back(make_contour(pattern, joined));
        }
        const Contour& contour = contours_[first_.back()];
        const std::span<const ContourLoop> loops(contour.loop.data(), contour.loop_count);
        const bool tunnel = shape == Shape::hexahedron && loops.size() > 1;
        plain_.push_back(alternating == 0 && !tunnel && !loops.empty() &&
                         std::ranges::all_of(loops, [](const ContourLoop& loop) {
                             return loop.count <= 3 || loop.any_diagonal || loop.triangle_count > 0;
                         }));
    }
}

inline Contour ContourTable::make_contour(unsigned pattern, unsigned joined) const {
    Contour contour;
    find_regions(contour, pattern, joined);
    constexpr std::uint8_t none = 0xFF;
    std::array<std::uint8_t, max_edges> next;
    std::array<std::uint8_t, max_edges> face_of{};
    next.fill(none);
    const auto add_loop = [&](ContourLoop loop) {
        const auto& ends = topology_->edge[loop.edge[0]];
        const bool first = (pattern >> ends[0] & 1U) != 0;
        loop.positive = contour.region[ends[first ? 0 : 1]];
        loop.negative = contour.region[ends[first ? 1 : 0]];
        fill(loop);
        contour.loop[contour.loop_count++] = loop;
    };
    const auto faces = static_cast<std::uint8_t>(face_count());
    for (std::uint8_t f = 0; f < faces; ++f) {
        const FaceTopology corners = face(f);
        unsigned signs = 0;
        for (std::size_t i = 0; i < corners.corners; ++i) {
            signs |= (pattern >> corners.corner[i] & 1U) << i;
        }
        const auto edge = [&](std::size_t i) {
            return edge_between(shape_, corners.corner[i],
                                corners.corner[(i + 1) % corners.corners]);
        };
        const FaceContour on_face = face_contour(corners.corners, signs, (joined >> f & 1U) != 0);
        for (std::size_t k = 0; k < on_face.count; ++k) {
            const std::uint8_t falls = edge(on_face.segment[k].falls);
            const std::uint8_t rises = edge(on_face.segment[k].rises);
            if (topology_->dimension == 2) {
                ContourLoop segment;
                segment.count = 2;
                segment.edge = {falls, rises};
                for (std::size_t i = 0; i < 2; ++i) {
                    for (std::uint8_t side = 0; side < topology_->faces; ++side) {
                        const auto& ends = topology_->face[side].corner;
                        if (edge_between(shape_, ends[0], ends[1]) == segment.edge[i]) {
                            segment.face[i] = side;
                        }
                    }
                }
                add_loop(segment);
            } else {
                next[rises] = falls;
                face_of[rises] = f;
            }
        }
    }
    for (std::uint8_t start = 0; start < max_edges; ++start) {
        ContourLoop loop;
        for (std::uint8_t e = start; next[e] != none;) {
            loop.edge[loop.count] = e;
            loop.face[loop.count++] = face_of[e];
            e = std::exchange(next[e], none);
        }
        if (loop.count > 0) add_loop(loop);
    }
    return contour;
}

inline void ContourTable::find_regions(Contour& contour, unsigned pattern, unsigned joined) const {
    std::iota(contour.region.begin(), contour.region.end(), std::uint8_t{0});
    const auto positive = [&](std::uint8_t c) { return (pattern >> c & 1U) != 0; };
    const auto join = [&](std::uint8_t a, std::uint8_t b) {
        const std::uint8_t from = contour.region[a];
        const std::uint8_t to = contour.region[b];
        std::replace(contour.region.begin(), contour.region.end(), from, to);
    };
    for (std::size_t e = 0; e < topology_->edges; ++e) {
        const auto& [a, b] = topology_->edge[e];
        if (positive(a) == positive(b)) join(a, b);
    }
    for (std::size_t f = 0; f < face_count(); ++f) {
        if ((alternating_[pattern] >> f & 1U) == 0) continue;
        const FaceTopology loop = face(f);
        const std::size_t first = positive(loop.corner[0]) == ((joined >> f & 1U) != 0) ? 0 : 1;
        join(loop.corner[first], loop.corner[first + 2]);
    }
}

inline bool ContourTable::on_one_face(std::uint8_t edge_a, std::uint8_t edge_b) const {
    for (std::size_t f = 0; f < topology_->faces; ++f) {
        const auto corners = std::span(topology_->face[f].corner).first(topology_->face[f].corners);
        const auto holds = [&](std::uint8_t e) {
            return std::count(corners.begin(), corners.end(), topology_->edge[e][0]) +
                       std::count(corners.begin(), corners.end(), topology_->edge[e][1]) ==
                   2;
        };
        if (holds(edge_a) && holds(edge_b)) return true;
    }
    return false;
}

inline Point ContourTable::middle(std::uint8_t edge) const {
    const auto& [a, b] = topology_->edge[edge];
    return 0.5 * (topology_->reference[a] + topology_->reference[b]);
}

/// The triangulation without edges inside a face whose edges are shortest, if there is one: of all
/// triangles over the side from place i to place j the best, for growing j - i (Klincsek 1980).
inline void ContourTable::fill(ContourLoop& loop) const {
    if (topology_->dimension == 2) return;
    const std::size_t n = loop.count;
    constexpr double never = std::numeric_limits<double>::infinity();
    std::array<std::array<double, max_edges>, max_edges> cost{};
    std::array<std::array<std::uint8_t, max_edges>, max_edges> apex{};
    const auto allowed = [&](std::size_t i, std::size_t j) {
        return j == i + 1 || (i == 0 && j == n - 1) || !on_one_face(loop.edge[i], loop.edge[j]);
    };
    for (std::size_t length = 2; length < n; ++length) {
        for (std::size_t i = 0; i + length < n; ++i) {
            const std::size_t j = i + length;
            cost[i][j] = never;
            if (!allowed(i, j)) continue;
            for (std::size_t k = i + 1; k < j; ++k) {
                const double c =
                    cost[i][k] + cost[k][j] + norm(middle(loop.edge[i]) - middle(loop.edge[j]));
                if (c < cost[i][j]) {
                    cost[i][j] = c;
                    apex[i][j] = static_cast<std::uint8_t>(k);
                }
            }
        }
    }
    if (cost[0][n - 1] == never) return;
    loop.any_diagonal = n == 4 && allowed(0, 2) && allowed(1, 3);
    std::vector<std::array<std::size_t, 2>> open{{0, n - 1}};
    while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        if (j == i + 1) continue;
        const std::uint8_t k = apex[i][j];
        loop.triangle[loop.triangle_count++] = {static_cast<std::uint8_t>(i), k,
                                                static_cast<std::uint8_t>(j)};
        open.push_back({i, k});
        open.push_back({k, j});
    }
}

}  // namespace nestgrid
