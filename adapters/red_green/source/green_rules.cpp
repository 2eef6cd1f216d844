// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/adapters/green_rules.hpp>

#include <algorithm>
#include <bit>
#include <optional>

namespace nestgrid {

namespace {

/// A polygon of a subdivided face, three or four nodes in a loop.
using Loop = std::vector<std::uint8_t>;

class GreenBuilder {
public:
    explicit GreenBuilder(const GreenState& state)
        : state_{state}, topology_{topology(state.shape)} {
        next_ = topology_.corners;
        for (std::size_t e = 0; e < topology_.edges; ++e) {
            if ((state.edges >> e & 1U) == 0) continue;
            middle_[e] = add(mean_of({topology_.edge[e][0], topology_.edge[e][1]}));
        }
        for (std::size_t f = 0; f < topology_.faces; ++f) {
            if ((state.faces >> f & 1U) == 0) continue;
            const FaceTopology& face = topology_.face[f];
            centre_[f] = add(mean_of({face.tensor_corner(0), face.tensor_corner(1),
                                      face.tensor_corner(2), face.tensor_corner(3)}));
        }
    }

    std::shared_ptr<const Rule> build() {
        if (state_.edges == 0) throw InvalidInput("nothing to close");
        if (state_.shape == Shape::hexahedron) {
            if (!extruded()) cone();
        } else if (state_.shape == Shape::tetrahedron) {
            tetrahedron();
        } else {
            const Loop loop = state_.shape == Shape::triangle ? Loop{0, 1, 2} : Loop{0, 1, 3, 2};
            for (const Loop& l : subdivided(loop, 0)) add_child(l);
        }
        return std::make_shared<const Rule>(
            make_rule("closure of a " + std::string(topology_.name) + ", edges " +
                          std::to_string(state_.edges) + ", faces " + std::to_string(state_.faces),
                      state_.shape, nodes_, children_));
    }

private:
    std::uint8_t add(const Stencil& stencil) {
        nodes_.push_back(stencil);
        return next_++;
    }

    std::uint8_t middle(std::uint8_t a, std::uint8_t b) const {
        for (std::size_t e = 0; e < topology_.edges; ++e) {
            if (std::minmax(topology_.edge[e][0], topology_.edge[e][1]) == std::minmax(a, b)) {
                return middle_[e];
            }
        }
        return 0;
    }

    /// A face, subdivided as its edges and its centre demand. Every pattern is symmetric.
    std::vector<Loop> subdivided(const Loop& corner, std::uint8_t centre) const {
        const std::size_t n = corner.size();
        Loop m(n);
        unsigned split = 0;
        for (std::size_t i = 0; i < n; ++i) {
            m[i] = middle(corner[i], corner[(i + 1) % n]);
            if (m[i] != 0) ++split;
        }
        if (split == 0) return {corner};
        // Turn the loop so that the pattern starts at the first edge.
        std::size_t first = 0;
        const auto at = [&](std::size_t i) { return m[(first + i) % n]; };
        const auto c = [&](std::size_t i) { return corner[(first + i) % n]; };
        if (split == 1) {
            while (at(0) == 0) ++first;
            if (n == 3) return {{c(0), at(0), c(2)}, {at(0), c(1), c(2)}};
            return {{c(0), at(0), c(3)}, {at(0), c(2), c(3)}, {at(0), c(1), c(2)}};
        }
        if (n == 3) throw InvalidInput("a triangle with more than one split edge is refined red");
        if (split == 2) {
            while (at(0) == 0 || (at(1) == 0 && at(2) == 0)) ++first;
            if (at(1) == 0) {
                return {{c(0), at(0), at(2), c(3)}, {at(0), c(1), c(2), at(2)}};
            }
            return {{at(0), c(1), at(1)},
                    {at(0), at(1), c(3)},
                    {c(0), at(0), c(3)},
                    {at(1), c(2), c(3)}};
        }
        if (split == 3) {
            while (at(3) != 0) ++first;
            return {{c(0), at(0), at(2), c(3)},
                    {at(0), c(1), at(1)},
                    {at(1), c(2), at(2)},
                    {at(0), at(1), at(2)}};
        }
        std::vector<Loop> result;
        for (std::size_t i = 0; i < 4; ++i) {
            if (centre != 0) {
                result.push_back({c(i), at(i), centre, at(i + 3)});
            } else {
                result.push_back({c(i), at(i), at(i + 3)});
            }
        }
        if (centre == 0) result.push_back({at(0), at(1), at(2), at(3)});
        return result;
    }

    /// A child on a polygon: itself, a cone over it, or, with a second polygon, a prism over it.
    void add_child(const Loop& loop, const Loop& above = {}) {
        Child child;
        std::size_t at = 0;
        const auto put = [&](const Loop& l) {
            for (std::size_t i = 0; i < l.size(); ++i) {
                child.corner[at++] = l[l.size() == 4 && i >= 2 ? 5 - i : i];
            }
        };
        put(loop);
        put(above);
        const bool triangle = loop.size() == 3;
        child.shape = above.empty()       ? triangle ? Shape::triangle : Shape::quadrilateral
                      : above.size() == 1 ? triangle ? Shape::tetrahedron : Shape::pyramid
                      : triangle          ? Shape::prism
                                          : Shape::hexahedron;
        orient(child);
        children_.push_back(child);
    }

    /// Children are numbered so that their volume is positive.
    void orient(Child& child) const {
        std::array<Point, max_corners> x;
        for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
            x[i] = place(child.corner[i]);
        }
        if (measure_vector(child.shape, x)[2] > 0) return;
        auto& c = child.corner;
        std::swap(c[1], c[2]);
        if (child.shape == Shape::prism) std::swap(c[4], c[5]);
        if (child.shape == Shape::hexahedron) std::swap(c[5], c[6]);
    }
    Point place(std::uint8_t node) const {
        if (node < topology_.corners) return topology_.reference[node];
        const Stencil& s = nodes_[static_cast<std::size_t>(node - topology_.corners)];
        Point x{0, 0, 0};
        for (std::size_t i = 0; i < s.count; ++i) x = x + s.weight[i] * place(s.parent[i]);
        return x;
    }

    void tetrahedron() {
        const int count = std::popcount(state_.edges);
        std::vector<std::array<std::uint8_t, 2>> edge;
        Loop middle;
        for (std::size_t e = 0; e < topology_.edges; ++e) {
            if (middle_[e] == 0) continue;
            edge.push_back(topology_.edge[e]);
            middle.push_back(middle_[e]);
        }
        const auto others = [](std::initializer_list<std::uint8_t> used) {
            Loop rest;
            for (std::uint8_t i = 0; i < 4; ++i) {
                if (std::find(used.begin(), used.end(), i) == used.end()) rest.push_back(i);
            }
            return rest;
        };
        const auto [a, b] = edge[0];
        if (count == 1) {
            const Loop r = others({a, b});
            add_child({a, middle[0], r[0]}, {r[1]});
            add_child({middle[0], b, r[0]}, {r[1]});
        } else if (count == 2) {
            const auto [c, d] = edge[1];
            if (c != a && c != b && d != a && d != b) {
                for (const std::uint8_t p : {a, b}) {
                    for (const std::uint8_t q : {c, d}) {
                        add_child({p, middle[0], q}, {middle[1]});
                    }
                }
                return;
            }
            const std::uint8_t tip = c == a || c == b ? c : d;
            const std::uint8_t p = a == tip ? b : a;
            const std::uint8_t q = c == tip ? d : c;
            const std::uint8_t apex = others({tip, p, q})[0];
            add_child({tip, middle[0], middle[1]}, {apex});
            if (!state_.other_diagonal) {  // from p
                add_child({p, middle[0], middle[1]}, {apex});
                add_child({p, middle[1], q}, {apex});
            } else {
                add_child({q, middle[0], middle[1]}, {apex});
                add_child({q, middle[0], p}, {apex});
            }
        } else {
            if (!has_green_rule(Shape::tetrahedron, state_.edges)) {
                throw InvalidInput("a tetrahedron with these split edges is refined red");
            }
            Loop face;
            for (const auto& e : edge) {
                for (const std::uint8_t i : e) {
                    if (std::find(face.begin(), face.end(), i) == face.end()) face.push_back(i);
                }
            }
            const std::uint8_t apex = others({face[0], face[1], face[2]})[0];
            for (const std::uint8_t i : face) {
                Loop tip{i};
                for (std::size_t e = 0; e < 3; ++e) {
                    if (edge[e][0] == i || edge[e][1] == i) tip.push_back(middle[e]);
                }
                add_child(tip, {apex});
            }
            add_child(middle, {apex});
        }
    }

    Loop face_loop(std::size_t f) const {
        const FaceTopology& face = topology_.face[f];
        return {face.corner.begin(), face.corner.begin() + face.corners};
    }

    /// Hexahedra: cones over all faces.
    void cone() {
        const std::uint8_t apex = add(mean_of({0, 1, 2, 3, 4, 5, 6, 7}));
        for (std::size_t f = 0; f < topology_.faces; ++f) {
            for (const Loop& l : subdivided(face_loop(f), centre_[f])) add_child(l, {apex});
        }
    }

    /// Hexahedra whose lower and upper face, in some direction, are subdivided alike and whose
    /// edges along it are whole: everything is extruded. \return whether there is such a direction
    bool extruded() {
        for (std::size_t d = 0; d < 3; ++d) {
            const std::size_t lower = 2 * d;
            bool alike = (centre_[lower] != 0) == (centre_[lower + 1] != 0);
            for (std::size_t f = 0; f < topology_.faces; ++f) {
                alike = alike && (f / 2 == d || centre_[f] == 0);
            }
            const auto up = [&](std::uint8_t corner) {
                return static_cast<std::uint8_t>(corner | 1U << d);
            };
            const Loop loop = face_loop(lower);
            for (std::size_t i = 0; i < 4 && alike; ++i) {
                const std::uint8_t a = loop[i];
                const std::uint8_t b = loop[(i + 1) % 4];
                alike = middle(a, up(a)) == 0 && (middle(a, b) != 0) == (middle(up(a), up(b)) != 0);
            }
            if (!alike) continue;
            for (const Loop& l : subdivided(loop, centre_[lower])) {
                Loop above;
                for (const std::uint8_t node : l) above.push_back(lifted(node, d));
                add_child(l, above);
            }
            return true;
        }
        return false;
    }
    /// The node of the upper face over one of the lower face.
    std::uint8_t lifted(std::uint8_t node, std::size_t d) const {
        const auto up = [&](std::uint8_t corner) {
            return static_cast<std::uint8_t>(corner | 1U << d);
        };
        if (node < topology_.corners) return up(node);
        if (node == centre_[2 * d]) return centre_[2 * d + 1];
        const Stencil& s = nodes_[static_cast<std::size_t>(node - topology_.corners)];
        return middle(up(s.parent[0]), up(s.parent[1]));
    }

    const GreenState state_;
    const Topology& topology_;
    std::uint8_t next_ = 0;
    std::array<std::uint8_t, 12> middle_{};  // node of each edge, 0 where it is whole
    std::array<std::uint8_t, max_faces> centre_{};
    std::vector<Stencil> nodes_;
    std::vector<Child> children_;
};

}  // namespace

bool has_green_rule(Shape shape, std::uint32_t edges) {
    const int count = std::popcount(edges);
    if (shape == Shape::triangle) return count == 1;
    if (shape == Shape::quadrilateral) return count < 4;
    if (shape != Shape::tetrahedron) return true;
    if (count < 3) return true;
    // Three edges around a face: 01 02 03 12 13 23 are bits 0 to 5.
    return edges == 0b001011U || edges == 0b010101U || edges == 0b100110U || edges == 0b111000U;
}

std::shared_ptr<const Rule> green_rule(const GreenState& state) {
    return GreenBuilder(state).build();
}

}  // namespace nestgrid
