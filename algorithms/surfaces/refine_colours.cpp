// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/error.hpp>

#include <surfaces/require_simplices.hpp>
#include <surfaces/vertex_numbers.hpp>

namespace nestgrid {

namespace {

using Triangle = Surface<3>::Simplex;

constexpr int most_halvings = 10;
/// Greatest sum of |cubic Lagrange polynomials| of a triangle, those of its corners left out.
constexpr double lebesgue = 2.2;

/// A point of a triangle or a side: a weighted mean of vertices.
struct Sample {
    std::array<std::uint32_t, 3> vertices;
    std::array<double, 3> weights;
};

/// A side by its vertices, the lower number first.
using Side = std::uint64_t;
Side side_of(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
}
std::uint32_t first(Side side) { return static_cast<std::uint32_t>(side >> 32U); }
std::uint32_t second(Side side) { return static_cast<std::uint32_t>(side); }

class ColourSplitter {
public:
    ColourSplitter(Surface<3>& surface, double tolerance, const detail::ProbePoints& probe)
        : surface_{surface},
          tolerance_{tolerance / lebesgue},
          probe_{probe},
          count_{surface.attributes.size() / surface.vertices.size()},
          is_new_(surface.simplices.size(), true) {}

    ColourRefinement run() {
        for (int i = 0; i < most_halvings; ++i) {
            find_sides();
            if (marked_.empty()) break;
            result_.split += marked_.size();
            add_middles();
            split_triangles();
            split_boundary();
        }
        return result_;
    }

private:
    /// Marks the sides of new triangles that are to be split.
    void find_sides() {
        std::vector<Side> sides;
        std::vector<std::uint32_t> triangles;
        for (std::uint32_t t = 0; t < surface_.simplices.size(); ++t) {
            if (!is_new_[t]) continue;
            triangles.push_back(t);
            const Triangle& v = surface_.simplices[t];
            for (std::size_t i = 0; i < 3; ++i) sides.push_back(side_of(v[i], v[(i + 1) % 3]));
        }
        std::sort(sides.begin(), sides.end());
        sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
        std::vector<Sample> samples;
        for (const Side side : sides) {
            const std::array<std::uint32_t, 3> ends{first(side), second(side), first(side)};
            samples.push_back({ends, {2.0 / 3, 1.0 / 3, 0}});
            samples.push_back({ends, {1.0 / 3, 2.0 / 3, 0}});
        }
        for (const std::uint32_t t : triangles) {
            samples.push_back({surface_.simplices[t], {1.0 / 3, 1.0 / 3, 1.0 / 3}});
        }
        const std::vector<double> misses = misses_at(samples);
        marked_.clear();
        double within = 0;
        const auto mark_where = [&](double miss, Side side) {
            if (miss > tolerance_)
                marked_.push_back(side);
            else
                within = std::max(within, miss);
        };
        for (std::size_t i = 0; i < sides.size(); ++i) {
            mark_where(std::max(misses[2 * i], misses[2 * i + 1]), sides[i]);
        }
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            mark_where(misses[2 * sides.size() + i], longest_side(triangles[i]));
        }
        result_.miss = std::max(result_.miss, within);
        std::sort(marked_.begin(), marked_.end());
        marked_.erase(std::unique(marked_.begin(), marked_.end()), marked_.end());
    }

    Side longest_side(std::uint32_t triangle) const {
        const Triangle& v = surface_.simplices[triangle];
        const auto length = [&](std::size_t i) {
            return norm(surface_.vertices[v[i]] - surface_.vertices[v[(i + 1) % 3]]);
        };
        std::size_t longest = 0;
        for (const std::size_t i : {1U, 2U}) {
            if (length(i) > length(longest)) longest = i;
        }
        return side_of(v[longest], v[(longest + 1) % 3]);
    }

    Point position(const Sample& sample) const {
        Point x{};
        for (std::size_t i = 0; i < 3; ++i) {
            x = x + sample.weights[i] * surface_.vertices[sample.vertices[i]];
        }
        return x;
    }
    double colour(const Sample& sample, std::size_t attribute) const {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            sum += sample.weights[i] * surface_.attributes[sample.vertices[i] * count_ + attribute];
        }
        return sum;
    }

    ProbeResult probe(const std::vector<Point>& points) const {
        ProbeResult probed = probe_(points);
        if (probed.components < count_) {
            throw InvalidInput("the surface has more attributes than the field has components");
        }
        return probed;
    }

    /// The greatest difference between data and colours at each sample; 0 outside the domain.
    std::vector<double> misses_at(const std::vector<Sample>& samples) const {
        std::vector<Point> points;
        points.reserve(samples.size());
        for (const Sample& sample : samples) points.push_back(position(sample));
        const ProbeResult probed = probe(points);
        std::vector<double> misses(samples.size(), 0.0);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (!probed.found(i)) continue;
            const double* values = &probed.values[(i + 1) * probed.components - count_];
            for (std::size_t k = 0; k < count_; ++k) {
                misses[i] = std::max(misses[i], std::abs(values[k] - colour(samples[i], k)));
            }
        }
        return misses;
    }

    /// Adds the middles of the marked sides to the vertices, in order.
    void add_middles() {
        first_middle_ = surface_.vertices.size();
        if (first_middle_ + marked_.size() > UINT32_MAX) engine::throw_too_many_vertices();
        std::vector<Point> points;
        points.reserve(marked_.size());
        for (const Side side : marked_) {
            points.push_back(0.5 *
                             (surface_.vertices[first(side)] + surface_.vertices[second(side)]));
        }
        const ProbeResult probed = probe(points);
        for (std::size_t i = 0; i < marked_.size(); ++i) {
            const Sample middle{{first(marked_[i]), second(marked_[i]), 0}, {0.5, 0.5, 0}};
            const double* values = &probed.values[(i + 1) * probed.components - count_];
            for (std::size_t k = 0; k < count_; ++k) {
                surface_.attributes.push_back(probed.found(i) ? values[k] : colour(middle, k));
            }
            if (surface_.normals.empty()) continue;
            const Point sum =
                surface_.normals[middle.vertices[0]] + surface_.normals[middle.vertices[1]];
            const double length = norm(sum);
            surface_.normals.push_back(length > 0 ? (1 / length) * sum
                                                  : surface_.normals[middle.vertices[0]]);
        }
        surface_.vertices.insert(surface_.vertices.end(), points.begin(), points.end());
    }

    /// The middle of a side that is marked, or the number of vertices.
    std::uint32_t middle_of(std::uint32_t a, std::uint32_t b) const {
        const Side side = side_of(a, b);
        const auto at = std::lower_bound(marked_.begin(), marked_.end(), side);
        if (at == marked_.end() || *at != side) return none();
        return static_cast<std::uint32_t>(first_middle_ +
                                          static_cast<std::size_t>(at - marked_.begin()));
    }
    std::uint32_t none() const { return static_cast<std::uint32_t>(surface_.vertices.size()); }

    void split_triangles() {
        std::vector<Triangle> old;
        old.swap(surface_.simplices);
        std::vector<std::uint32_t> old_element;
        old_element.swap(surface_.element_of);
        std::vector<bool> was_new;
        was_new.swap(is_new_);
        for (std::size_t t = 0; t < old.size(); ++t) {
            const std::size_t begin = surface_.simplices.size();
            add_parts(old[t]);
            const std::size_t parts = surface_.simplices.size() - begin;
            if (!old_element.empty()) {
                surface_.element_of.insert(surface_.element_of.end(), parts, old_element[t]);
            }
            is_new_.insert(is_new_.end(), parts, parts > 1);
        }
    }

    /// Adds the parts of a triangle between the middles of its marked sides.
    void add_parts(Triangle v) {
        std::array<std::uint32_t, 3> m{};  // m[i] between v[i] and v[i + 1]
        std::size_t marked = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            m[i] = middle_of(v[i], v[(i + 1) % 3]);
            marked += m[i] != none() ? 1 : 0;
        }
        // Turns the triangle so that its marked sides come first, and are one behind the other.
        while (marked % 3 != 0 && (m[0] == none() || m[2] != none())) {
            std::rotate(v.begin(), v.begin() + 1, v.end());
            std::rotate(m.begin(), m.begin() + 1, m.end());
        }
        auto& parts = surface_.simplices;
        if (marked == 0) {
            parts.push_back(v);
        } else if (marked == 1) {
            parts.push_back({v[0], m[0], v[2]});
            parts.push_back({m[0], v[1], v[2]});
        } else if (marked == 2) {
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
            if (m == none()) {
                surface_.boundary.push_back({a, b});
            } else {
                surface_.boundary.push_back({a, m});
                surface_.boundary.push_back({m, b});
            }
        }
    }

    Surface<3>& surface_;
    double tolerance_;
    const detail::ProbePoints& probe_;
    std::size_t count_;         // attributes of a vertex
    std::vector<bool> is_new_;  // per triangle: not yet probed
    std::vector<Side> marked_;  // ascending
    std::size_t first_middle_ = 0;
    ColourRefinement result_;
};

}  // namespace

ColourRefinement detail::refine_colours(Surface<3>& surface, double tolerance,
                                        const ProbePoints& probe) {
    if (!(tolerance > 0)) {
        throw InvalidInput("the tolerance of colours is not a positive number");
    }
    engine::require_simplices(surface);
    if (surface.vertices.empty()) return {};
    if (surface.attributes.empty()) throw InvalidInput("the surface has no attributes to refine");
    if (!surface.reference.empty()) {
        throw InvalidInput("reference coordinates are not kept where colours are refined");
    }
    return ColourSplitter(surface, tolerance, probe).run();
}

}  // namespace nestgrid
