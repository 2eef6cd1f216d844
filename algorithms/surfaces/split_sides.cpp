// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/split_sides.hpp>

#include <nestgrid/detail/geometry.hpp>

#include <surfaces/vertex_numbers.hpp>

namespace nestgrid::engine {

namespace {

using Triangle = Surface<3>::Simplex;
constexpr std::uint32_t no_middle = ~std::uint32_t{0};

/// The mean of two unit vectors, or the first one where there is none.
Point unit_mean(const Point& a, const Point& b) {
    const Point sum = a + b;
    const double length = norm(sum);
    return length > 0 ? (1 / length) * sum : a;
}

class SideSplitter {
public:
    SideSplitter(Surface<3>& surface, std::span<const TriangleSide> sides)
        : surface_{surface}, sides_{sides}, first_middle_{surface.vertices.size()} {}

    std::vector<bool> run() {
        add_middles();
        std::vector<bool> is_part = split_triangles();
        split_boundary();
        return is_part;
    }

private:
    void add_middles() {
        if (first_middle_ + sides_.size() > UINT32_MAX) throw_too_many_vertices();
        if (sides_.empty()) return;
        auto& x = surface_.vertices;
        auto& normals = surface_.normals;
        auto& u = surface_.attributes;
        const std::size_t stride = u.size() / x.size();
        for (const TriangleSide side : sides_) {
            const std::uint32_t a = side.first();
            const std::uint32_t b = side.second();
            x.push_back(0.5 * (x[a] + x[b]));
            for (std::size_t k = 0; k < stride; ++k) {
                u.push_back(0.5 * u[a * stride + k] + 0.5 * u[b * stride + k]);
            }
            if (!normals.empty()) normals.push_back(unit_mean(normals[a], normals[b]));
        }
    }

    /// The middle of a side, or none where it is not to be split.
    std::uint32_t middle_of(std::uint32_t a, std::uint32_t b) const {
        const TriangleSide side(a, b);
        const auto at = std::lower_bound(sides_.begin(), sides_.end(), side);
        if (at == sides_.end() || *at != side) return no_middle;
        return static_cast<std::uint32_t>(first_middle_ +
                                          static_cast<std::size_t>(at - sides_.begin()));
    }

    std::vector<bool> split_triangles() {
        std::vector<bool> is_part;
        std::vector<Triangle> old;
        old.swap(surface_.simplices);
        std::vector<std::uint32_t> old_element;
        old_element.swap(surface_.element_of);
        for (std::size_t t = 0; t < old.size(); ++t) {
            const std::size_t begin = surface_.simplices.size();
            add_parts(old[t]);
            const std::size_t parts = surface_.simplices.size() - begin;
            if (!old_element.empty()) {
                surface_.element_of.insert(surface_.element_of.end(), parts, old_element[t]);
            }
            is_part.insert(is_part.end(), parts, parts > 1);
        }
        return is_part;
    }

    /// Adds the parts of a triangle between the middles of its sides.
    void add_parts(Triangle v) {
        std::array<std::uint32_t, 3> m{};  // m[i] between v[i] and v[i + 1]
        std::size_t split = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            m[i] = middle_of(v[i], v[(i + 1) % 3]);
            split += m[i] != no_middle ? 1 : 0;
        }
        // Turns the triangle so that its split sides come first, and are one behind the other.
        while (split % 3 != 0 && (m[0] == no_middle || m[2] != no_middle)) {
            std::rotate(v.begin(), v.begin() + 1, v.end());
            std::rotate(m.begin(), m.begin() + 1, m.end());
        }
        auto& parts = surface_.simplices;
        if (split == 0) {
            parts.push_back(v);
        } else if (split == 1) {
            parts.push_back({v[0], m[0], v[2]});
            parts.push_back({m[0], v[1], v[2]});
        } else if (split == 2) {
            parts.push_back({m[0], v[1], m[1]});
            const auto& x = surface_.vertices;
            if (norm(x[m[0]] - x[v[2]]) <= norm(x[m[1]] - x[v[0]])) {
                parts.push_back({v[0], m[0], v[2]});
                parts.push_back({m[0], m[1], v[2]});
            } else {
                parts.push_back({v[0], m[0], m[1]});
                parts.push_back({v[0], m[1], v[2]});
            }
        } else {
            parts.push_back({v[0], m[0], m[2]});
            parts.push_back({m[0], v[1], m[1]});
            parts.push_back({m[2], m[1], v[2]});
            parts.push_back(m);
        }
    }

    void split_boundary() {
        std::vector<Surface<3>::Ridge> old;
        old.swap(surface_.boundary);
        for (const auto& [a, b] : old) {
            const std::uint32_t m = middle_of(a, b);
            if (m == no_middle) {
                surface_.boundary.push_back({a, b});
            } else {
                surface_.boundary.push_back({a, m});
                surface_.boundary.push_back({m, b});
            }
        }
    }

    Surface<3>& surface_;
    std::span<const TriangleSide> sides_;  // ascending
    std::size_t first_middle_;
};

}  // namespace

std::vector<bool> split_sides(Surface<3>& surface, std::span<const TriangleSide> sides) {
    return SideSplitter(surface, sides).run();
}

}  // namespace nestgrid::engine
