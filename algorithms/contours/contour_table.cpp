// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Generates the contour tables from the topology of the shapes.
#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <contours/contour_table.hpp>

namespace nestgrid::engine {

namespace {

/// Makes the contours of one shape. In two dimensions the element itself stands for its only face.
class ContourMaker {
public:
    explicit ContourMaker(Shape shape);

    std::uint16_t cut_edges(unsigned pattern) const;
    std::uint8_t cut_faces(unsigned pattern) const;
    std::uint8_t alternating(unsigned pattern) const;
    Contour make(unsigned pattern, unsigned joined) const;

private:
    void find_regions(Contour& contour, unsigned pattern, unsigned joined) const;
    std::vector<std::array<std::uint8_t, 2>> segments(std::size_t face, unsigned pattern,
                                                      unsigned joined) const;
    void add_segments(Contour& contour, unsigned pattern, unsigned joined) const;
    void add_loops(Contour& contour, unsigned pattern, unsigned joined) const;
    void add(Contour& contour, unsigned pattern, ContourLoop loop) const;
    std::uint8_t side_with(std::uint8_t edge) const;

    Shape shape_;
    const Topology* topology_;
    std::vector<FaceTopology> faces_;
};

/// The loop of corners around a two-dimensional shape, counterclockwise, from corner 0 on.
FaceTopology loop_around(const Topology& t) {
    FaceTopology loop{t.corners == 3 ? Shape::triangle : Shape::quadrilateral, t.corners, {}};
    for (std::size_t i = 1; i < loop.corners; ++i) {
        for (std::size_t side = 0; side < t.faces; ++side) {
            const auto& ends = t.face[side].corner;
            if (ends[0] == loop.corner[i - 1]) loop.corner[i] = ends[1];
        }
    }
    return loop;
}

/// Moves the low bits of `bits` to the places of the bits of `mask`, in ascending order.
unsigned spread(unsigned bits, unsigned mask) {
    unsigned result = 0;
    unsigned place = 0;
    for (unsigned left = mask; left != 0; left &= left - 1) {
        result |= (bits >> place++ & 1U) << std::countr_zero(left);
    }
    return result;
}

ContourMaker::ContourMaker(Shape shape) : shape_{shape}, topology_{&topology(shape)} {
    if (topology_->dimension == 2) {
        faces_.push_back(loop_around(*topology_));
    } else {
        faces_.assign(topology_->face.begin(), topology_->face.begin() + topology_->faces);
    }
}

std::uint16_t ContourMaker::cut_edges(unsigned pattern) const {
    std::uint16_t cut = 0;
    for (std::size_t e = 0; e < topology_->edges; ++e) {
        const auto& [a, b] = topology_->edge[e];
        cut |= static_cast<std::uint16_t>(((pattern >> a ^ pattern >> b) & 1U) << e);
    }
    return cut;
}

std::uint8_t ContourMaker::cut_faces(unsigned pattern) const {
    std::uint8_t cut = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        const unsigned signs = signs_of(faces_[f], pattern);
        const bool is_cut = signs != 0 && signs != (1U << faces_[f].corners) - 1;
        cut |= static_cast<std::uint8_t>(unsigned{is_cut} << f);
    }
    return cut;
}

std::uint8_t ContourMaker::alternating(unsigned pattern) const {
    std::uint8_t alternating = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        if (alternate(faces_[f].corners, signs_of(faces_[f], pattern))) {
            alternating |= static_cast<std::uint8_t>(1U << f);
        }
    }
    return alternating;
}

/// Whether some face holds both edges.
bool on_one_face(const Topology& t, std::uint8_t edge_a, std::uint8_t edge_b) {
    for (std::size_t f = 0; f < t.faces; ++f) {
        const auto corners = std::span(t.face[f].corner).first(t.face[f].corners);
        const auto holds = [&](std::uint8_t e) {
            return std::count(corners.begin(), corners.end(), t.edge[e][0]) +
                       std::count(corners.begin(), corners.end(), t.edge[e][1]) ==
                   2;
        };
        if (holds(edge_a) && holds(edge_b)) return true;
    }
    return false;
}

/// Finds the triangulation of a loop that has no edge inside a face and whose edges are shortest in
/// sum. For growing j - i it chooses the best of all triangles over the side from place i to place
/// j (Klincsek 1980).
class LoopFilling {
public:
    LoopFilling(const Topology& t, const ContourLoop& loop) : topology_{&t}, loop_{&loop} {
        for (std::size_t length = 2; length < loop.count; ++length) {
            for (std::size_t i = 0; i + length < loop.count; ++i) choose_apex(i, i + length);
        }
    }

    bool exists() const { return cost_[0][loop_->count - 1] != never_; }

    /// Whether places i and j may be joined.
    bool allowed(std::size_t i, std::size_t j) const {
        return j == i + 1 || (i == 0 && j == loop_->count - 1U) ||
               !on_one_face(*topology_, loop_->edge[i], loop_->edge[j]);
    }

    /// Puts the triangles into a loop. Requires that the triangulation exists.
    void put(ContourLoop& loop) const {
        std::vector<std::array<std::size_t, 2>> open{{0, loop_->count - 1U}};
        while (!open.empty()) {
            const auto [i, j] = open.back();
            open.pop_back();
            if (j == i + 1) continue;
            const std::uint8_t k = apex_[i][j];
            loop.triangle[loop.triangle_count++] = {static_cast<std::uint8_t>(i), k,
                                                    static_cast<std::uint8_t>(j)};
            open.push_back({i, k});
            open.push_back({k, j});
        }
    }

private:
    static constexpr double never_ = std::numeric_limits<double>::infinity();

    Point middle(std::size_t place) const {
        const auto& [a, b] = topology_->edge[loop_->edge[place]];
        return 0.5 * (topology_->reference[a] + topology_->reference[b]);
    }

    void choose_apex(std::size_t i, std::size_t j) {
        cost_[i][j] = never_;
        if (!allowed(i, j)) return;
        for (std::size_t k = i + 1; k < j; ++k) {
            const double c = cost_[i][k] + cost_[k][j] + norm(middle(i) - middle(j));
            if (c < cost_[i][j]) {
                cost_[i][j] = c;
                apex_[i][j] = static_cast<std::uint8_t>(k);
            }
        }
    }

    const Topology* topology_;
    const ContourLoop* loop_;
    std::array<std::array<double, max_edges>, max_edges> cost_{};
    std::array<std::array<std::uint8_t, max_edges>, max_edges> apex_{};
};

void fill(const Topology& t, ContourLoop& loop) {
    const LoopFilling filling(t, loop);
    if (!filling.exists()) return;
    loop.any_diagonal = loop.count == 4 && filling.allowed(0, 2) && filling.allowed(1, 3);
    filling.put(loop);
}

/// Names the regions on both sides of a loop, fills it and adds it to the contour.
void ContourMaker::add(Contour& contour, unsigned pattern, ContourLoop loop) const {
    const auto& ends = topology_->edge[loop.edge[0]];
    const bool first = (pattern >> ends[0] & 1U) != 0;
    loop.positive = contour.region[ends[first ? 0 : 1]];
    loop.negative = contour.region[ends[first ? 1 : 0]];
    if (topology_->dimension == 3) fill(*topology_, loop);
    contour.loop[contour.loop_count++] = loop;
}

/// The side of a two-dimensional shape that an edge is.
std::uint8_t ContourMaker::side_with(std::uint8_t edge) const {
    std::uint8_t side = 0;
    for (std::uint8_t s = 0; s < topology_->faces; ++s) {
        const auto& ends = topology_->face[s].corner;
        if (edge_between(shape_, ends[0], ends[1]) == edge) side = s;
    }
    return side;
}

/// The segments on a face, each as the edge where it leaves and the one where it comes back.
std::vector<std::array<std::uint8_t, 2>> ContourMaker::segments(std::size_t face, unsigned pattern,
                                                                unsigned joined) const {
    const FaceTopology& loop = faces_[face];
    const auto edge = [&](std::size_t i) { return edge_at(shape_, loop, i); };
    const FaceContour& on_face =
        face_contour(loop.corners, signs_of(loop, pattern), (joined >> face & 1U) != 0);
    std::vector<std::array<std::uint8_t, 2>> result;
    for (std::size_t k = 0; k < on_face.count; ++k) {
        result.push_back({edge(on_face.segment[k].falls), edge(on_face.segment[k].rises)});
    }
    return result;
}

void ContourMaker::add_segments(Contour& contour, unsigned pattern, unsigned joined) const {
    for (const auto& [falls, rises] : segments(0, pattern, joined)) {
        ContourLoop segment;
        segment.count = 2;
        segment.edge = {falls, rises};
        segment.face = {side_with(falls), side_with(rises)};
        add(contour, pattern, segment);
    }
}

void ContourMaker::add_loops(Contour& contour, unsigned pattern, unsigned joined) const {
    constexpr std::uint8_t none = 0xFF;
    std::array<std::uint8_t, max_edges> next;  // the edge that follows this one in its loop
    std::array<std::uint8_t, max_edges> face_of{};
    next.fill(none);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        for (const auto& [falls, rises] : segments(f, pattern, joined)) {
            next[rises] = falls;
            face_of[rises] = static_cast<std::uint8_t>(f);
        }
    }
    for (std::uint8_t start = 0; start < max_edges; ++start) {
        ContourLoop loop;
        for (std::uint8_t e = start; next[e] != none;) {
            loop.edge[loop.count] = e;
            loop.face[loop.count++] = face_of[e];
            e = std::exchange(next[e], none);
        }
        if (loop.count > 0) add(contour, pattern, loop);
    }
}

Contour ContourMaker::make(unsigned pattern, unsigned joined) const {
    Contour contour;
    find_regions(contour, pattern, joined);
    if (topology_->dimension == 2) {
        add_segments(contour, pattern, joined);
    } else {
        add_loops(contour, pattern, joined);
    }
    return contour;
}

void ContourMaker::find_regions(Contour& contour, unsigned pattern, unsigned joined) const {
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
    const unsigned alternate = alternating(pattern);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        if ((alternate >> f & 1U) == 0) continue;
        const FaceTopology& loop = faces_[f];
        const std::size_t first = positive(loop.corner[0]) == ((joined >> f & 1U) != 0) ? 0 : 1;
        join(loop.corner[first], loop.corner[first + 2]);
    }
}

/// Whether nothing in the contour depends on values. Requires a pattern without alternating signs.
bool is_plain(Shape shape, const Contour& contour) {
    const std::span<const ContourLoop> loops(contour.loop.data(), contour.loop_count);
    const bool tunnel = shape == Shape::hexahedron && loops.size() > 1;
    return !tunnel && !loops.empty() && std::ranges::all_of(loops, [](const ContourLoop& loop) {
        return loop.count <= 3 || loop.any_diagonal || loop.triangle_count > 0;
    });
}

}  // namespace

ContourTable::ContourTable(Shape shape) {
    const ContourMaker maker(shape);
    for (unsigned pattern = 0; pattern < 1U << topology(shape).corners; ++pattern) {
        const unsigned alternating = maker.alternating(pattern);
        alternating_.push_back(static_cast<std::uint8_t>(alternating));
        cut_edges_.push_back(maker.cut_edges(pattern));
        cut_faces_.push_back(maker.cut_faces(pattern));
        first_.push_back(static_cast<std::uint32_t>(contours_.size()));
        for (unsigned choice = 0; choice < 1U << std::popcount(alternating); ++choice) {
            contours_.push_back(maker.make(pattern, spread(choice, alternating)));
        }
        plain_.push_back(alternating == 0 && is_plain(shape, contours_[first_.back()]));
    }
}

template <Shape shape>
const ContourTable& ContourTable::table_of() {
    static const ContourTable table(shape);
    return table;
}

const ContourTable& ContourTable::of(Shape shape) {
    switch (shape) {
        case Shape::triangle:
            return table_of<Shape::triangle>();
        case Shape::quadrilateral:
            return table_of<Shape::quadrilateral>();
        case Shape::tetrahedron:
            return table_of<Shape::tetrahedron>();
        case Shape::pyramid:
            return table_of<Shape::pyramid>();
        case Shape::prism:
            return table_of<Shape::prism>();
        default:
            return table_of<Shape::hexahedron>();
    }
}

}  // namespace nestgrid::engine
