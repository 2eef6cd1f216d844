// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A world of leaves (degree_world.hpp, shape_world.hpp) that is bent: each leaf interpolates a map
// of space by polynomials of a degree of its own. A map that is no polynomial of these degrees
// leaves gaps between leaves.
#pragma once

#include "shape_world.hpp"

namespace nestgrid_test {

/// How a world is bent.
struct Bend {
    std::function<Point(const Point&)> map;
    int least_degree = 2;
    int greatest_degree = 2;
};

template <class World>
class CurvedWorld : public World {
public:
    using Element = typename World::Element;

    template <class... Arguments>
    explicit CurvedWorld(Bend bend, Arguments&&... arguments)
        : World(std::forward<Arguments>(arguments)...), bend_{std::move(bend)} {
        for (std::size_t i = 0; i < World::coarse_count(); ++i) grow(World::coarse(i).element);
    }

    auto coarse(std::size_t i) const {
        auto c = World::coarse(i);
        for (std::size_t k = 0; k < nestgrid::topology(c.shape).corners; ++k) {
            c.corners[k] = bend_.map(c.corners[k]);
        }
        return c;
    }
    void new_positions(const Element& e, NodeMask which, std::span<Point> out) const {
        const std::vector<Point> nodes = nestgrid::reference_nodes(*World::split(e));
        const std::size_t first = nestgrid::topology(World::shape(e)).corners;
        for (std::size_t n = 0; n < out.size(); ++n) {
            if ((which >> n & 1U) == 0) continue;
            out[n] = bend_.map(World::position(e, nodes[first + n]));
        }
    }
    int geometry_degree(const Element& leaf) const { return x_.at(leaf.cell)[0].degree(); }
    void map(const Element& leaf, std::span<const Point> reference, std::span<Point> out) const {
        const auto& x = x_.at(leaf.cell);
        for (std::size_t i = 0; i < out.size(); ++i) {
            for (std::size_t d = 0; d < 3; ++d) out[i][d] = x[d](reference[i]);
        }
    }
    /// Where the map puts a point.
    Point bent(const Point& straight) const { return bend_.map(straight); }
    /// The point that the map puts there, if it does not move points far.
    Point straight(const Point& bent) const {
        Point x = bent;
        for (int i = 0; i < 60; ++i) x = x + (bent - bend_.map(x));
        return x;
    }

private:
    void grow(const Element& e) {
        if (const nestgrid::Rule* const rule = World::split(e)) {
            std::vector<Element> children(rule->children.size());
            World::children(e, children);
            for (const Element& child : children) grow(child);
            return;
        }
        const auto spread =
            static_cast<std::uint32_t>(bend_.greatest_degree - bend_.least_degree + 1);
        const int degree =
            bend_.least_degree + static_cast<int>(e.cell * 2654435761U % 65521U % spread);
        for (std::size_t d = 0; d < 3; ++d) {
            x_[e.cell][d] = {World::shape(e), degree,
                             [&](const Point& at) { return bend_.map(World::position(e, at))[d]; }};
        }
    }

    Bend bend_;
    std::map<std::uint32_t, std::array<LatticePolynomial, 3>> x_;
};

/// Moves points of [-1, 1] by polynomials of a total degree up to 4.
inline Bend polynomial_bend(int degree, double by, int dim) {
    return {[=](const Point& s) {
                const auto [x, y, z] = s;
                Point to = s;
                to[0] += by * (y * y + (dim == 3 ? x * z : 0));
                to[1] += by * (x * y - (dim == 3 ? z * z : 0));
                if (dim == 3) to[2] += by * (x * x - y * z);
                if (degree > 2) to[0] -= by * x * x * y;
                if (degree > 2) to[1] += by * (dim == 3 ? x * y * z : x * x * x);
                if (degree > 3) to[1] -= by * x * x * y * y;
                return to;
            },
            degree, degree};
}

/// The cube, or square, becomes the ball, or disk (Nowell).
inline Point on_ball(const Point& s) {
    const auto [x, y, z] = s;
    const auto root = [](double a, double b) {
        return std::sqrt(1 - a * a / 2 - b * b / 2 + a * a * b * b / 3);
    };
    return {x * root(y, z), y * root(z, x), z * root(x, y)};
}

}  // namespace nestgrid_test
