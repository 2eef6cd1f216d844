// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/shape_parts.hpp>

#include <algorithm>
#include <cmath>

namespace nestgrid::engine {

namespace {

Place minus(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Place whole(const Point& x) { return {std::llround(x[0]), std::llround(x[1]), std::llround(x[2])}; }

ShapePart part_with(Shape shape, std::span<const std::uint8_t> corners) {
    ShapePart part{
        factors_of(shape), static_cast<std::uint8_t>(corners.size()), {}, 0, no_new_node};
    std::copy(corners.begin(), corners.end(), part.corner.begin());
    // Ascending numbers of corners are in the order of a tensor product.
    std::sort(part.corner.begin(), part.corner.begin() + part.count);
    for (const std::uint8_t k : corners) part.corners |= 1U << k;
    return part;
}

CornerMask parents_of(const Stencil& stencil) {
    CornerMask parents = 0;
    for (std::size_t i = 0; i < stencil.count; ++i) parents |= 1U << stencil.parent[i];
    return parents;
}

/// What means of corners a rule makes, sorted.
std::vector<CornerMask> means_of(const Rule& rule) {
    std::vector<CornerMask> means;
    for (const Stencil& stencil : rule.new_nodes) means.push_back(parents_of(stencil));
    std::sort(means.begin(), means.end());
    return means;
}

}  // namespace

ShapeParts make_parts(Shape shape) {
    const Topology& t = topology(shape);
    ShapeParts made;
    made.shape = shape;
    made.factors = factors_of(shape);
    made.dimension = t.dimension;
    made.corners = t.corners;
    made.is_box = made.factors.all_segments() && shape != Shape::pyramid;
    made.rule = &red_rule(shape);
    for (std::size_t e = 0; e < t.edges; ++e) {
        made.parts.push_back(part_with(Shape::segment, t.edge[e]));
    }
    std::array<CornerMask, max_faces> corners_of{};
    for (std::size_t f = 0; f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        const ShapePart part = part_with(face.shape, std::span(face.corner).first(face.corners));
        corners_of[f] = part.corners;
        if (t.dimension == 3) made.parts.push_back(part);
        const Place at = whole(t.reference[face.corner[0]]);
        const Place a = minus(whole(t.reference[face.corner[1]]), at);
        const Place b = t.dimension == 2
                            ? Place{0, 0, 1}
                            : minus(whole(t.reference[face.corner[face.corners - 1]]), at);
        ShapeParts::Plane plane;
        for (std::size_t d = 0; d < 3; ++d) {
            const std::size_t e = (d + 1) % 3;
            const std::size_t g = (d + 2) % 3;
            plane.normal[d] = static_cast<int>(a[e] * b[g] - a[g] * b[e]);
            plane.offset += plane.normal[d] * static_cast<int>(at[d]);
        }
        made.planes_.push_back(plane);
    }
    for (FaceMask faces = 0; faces < made.part_in_.size(); ++faces) {
        CornerMask common = (1U << t.corners) - 1;
        for (std::size_t f = 0; f < t.faces; ++f) {
            if ((faces >> f & 1U) != 0) common &= corners_of[f];
        }
        int part = faces == 0 ? ShapeParts::inside : ShapeParts::at_corner;
        for (std::size_t p = 0; p < made.parts.size(); ++p) {
            if (made.parts[p].corners == common) part = static_cast<int>(p);
        }
        made.part_in_[faces] = static_cast<std::int8_t>(part);
    }
    for (const Point& x : reference_nodes(*made.rule)) {
        made.node.push_back(whole({2 * x[0], 2 * x[1], 2 * x[2]}));
    }
    for (ShapePart& part : made.parts) part.node = node_halving(*made.rule, part);
    for (std::uint8_t k = 0; k < t.corners; ++k) {
        for (std::size_t d = 0; d < t.dimension; ++d) {
            Place end{};
            end[d] = 1;
            if (whole(t.reference[k]) == end) made.axis[d] = k;
        }
    }
    return made;
}

const ShapeParts& parts_of(Shape shape) {
    static const auto all = [] {
        std::array<ShapeParts, shape_count> made;
        for (const Shape s : {Shape::triangle, Shape::quadrilateral, Shape::tetrahedron,
                              Shape::pyramid, Shape::prism, Shape::hexahedron}) {
            made[static_cast<std::size_t>(s)] = make_parts(s);
        }
        return made;
    }();
    return all[static_cast<std::size_t>(shape)];
}

FaceMask ShapeParts::faces_at(const Place& at, int level) const {
    FaceMask faces = 0;
    for (std::size_t f = 0; f < planes_.size(); ++f) {
        const auto& [n, offset] = planes_[f];
        const std::int64_t there = n[0] * at[0] + n[1] * at[1] + n[2] * at[2];
        faces |= FaceMask{there == offset * (std::int64_t{1} << level)} << f;
    }
    return faces;
}

std::vector<InFather> children_in_father(const Rule& rule) {
    const ShapeParts& father = parts_of(rule.parent);
    // A node of the rule, in units of 1 / 2.
    const auto node = [&](std::size_t number) {
        if (number < father.corners) return father.node[number];
        const Stencil& stencil = rule.new_nodes[number - father.corners];
        Place sum{};
        for (std::size_t i = 0; i < stencil.count; ++i) {
            for (std::size_t d = 0; d < 3; ++d) sum[d] += father.node[stencil.parent[i]][d];
        }
        for (std::int64_t& x : sum) x /= stencil.count;
        return sum;
    };
    std::vector<InFather> all;
    for (const Child& child : rule.children) {
        const ShapeParts& own = parts_of(child.shape);
        InFather& in = all.emplace_back();
        in.origin = node(child.corner[0]);
        for (std::size_t d = 0; d < father.dimension; ++d) {
            in.axis[d] = minus(node(child.corner[own.axis[d]]), in.origin);
        }
        for (const ShapePart& part : own.parts) {
            FaceMask faces = ~FaceMask{0};
            for (std::size_t i = 0; i < part.count; ++i) {
                faces &= father.faces_at(node(child.corner[part.corner[i]]), 1);
            }
            in.around.push_back(static_cast<std::int8_t>(father.part_in(faces)));
        }
        for (std::size_t k = 0; k < own.corners; ++k) {
            const std::size_t number = child.corner[k];
            in.around.push_back(static_cast<std::int8_t>(
                number < father.corners ? static_cast<int>(father.parts.size() + number)
                                        : father.part_in(father.faces_at(node(number), 1))));
        }
    }
    return all;
}

bool divides_red(const Rule& rule) {
    const Rule& red = red_rule(rule.parent);
    if (rule.children.size() != red.children.size() || means_of(rule) != means_of(red))
        return false;
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        if (rule.new_nodes[n].mean == Mean::weighted) return false;
        for (std::size_t i = 0; i < rule.new_nodes[n].count; ++i) {
            if (rule.new_nodes[n].parent[i] >= rule.corner_count()) return false;
        }
    }
    std::array<int, shape_count> shapes{};
    for (const Child& child : rule.children) ++shapes[static_cast<std::size_t>(child.shape)];
    for (const Child& child : red.children) --shapes[static_cast<std::size_t>(child.shape)];
    return std::all_of(shapes.begin(), shapes.end(), [](int more) { return more == 0; });
}

std::uint8_t node_halving(const Rule& rule, const ShapePart& part) {
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        if (parents_of(rule.new_nodes[n]) == part.corners) return static_cast<std::uint8_t>(n);
    }
    return no_new_node;
}

Place PartFrame::operator()(const Place& at, int level) const {
    Place x;
    for (std::size_t d = 0; d < 3; ++d) x[d] = at[d] - origin[d] * (std::int64_t{1} << level);
    Place t{};
    for (std::size_t i = 0; i < 2; ++i) {
        t[i] = row[i][0] * x[0] + row[i][1] * x[1] + row[i][2] * x[2];
    }
    return t;
}

PartFrame frame_between(std::span<const Place> corners) {
    PartFrame frame{corners[0], {}};
    const Place first = minus(corners[1], corners[0]);
    if (corners.size() == 2) {
        for (std::size_t a = 0; a < 3; ++a) {
            if (first[a] == 0) continue;
            frame.row[0][a] = first[a];  // 1 or -1
            break;
        }
        return frame;
    }
    const Place second = minus(corners[2], corners[0]);
    for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3;
        const std::int64_t det = first[a] * second[b] - first[b] * second[a];  // 1, -1 or 0
        if (det == 0) continue;
        frame.row[0] = {};
        frame.row[1] = {};
        frame.row[0][a] = det * second[b];
        frame.row[0][b] = -det * second[a];
        frame.row[1][a] = -det * first[b];
        frame.row[1][b] = det * first[a];
        break;
    }
    return frame;
}

}  // namespace nestgrid::engine
