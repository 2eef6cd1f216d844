// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// By how much the colours of a surface differ from the data, by brute force over its points.
#pragma once

#include <algorithm>
#include <cmath>
#include <set>

#include <nestgrid/algorithms/probe.hpp>

#include "triangle_samples.hpp"

namespace nestgrid_test {

/// Parts of the corners of a triangle that a point of its plane has.
inline Point weights_of(const std::array<Point, 3>& x, const Point& p) {
    const Point normal = cross(x[1] - x[0], x[2] - x[0]);
    const Point scaled = (1 / dot(normal, normal)) * normal;
    const double b = dot(scaled, cross(p - x[0], x[2] - x[0]));
    const double c = dot(scaled, cross(x[1] - x[0], p - x[0]));
    return {1 - b - c, b, c};
}

/// A point of a triangle, and by how much each attribute differs there from the data.
class Misses {
public:
    Misses(const Surface<3>& s, const std::vector<double>& errors)
        : surface_{s}, errors_{errors}, greatest_(s.simplices.size(), 0) {}

    void add(std::size_t triangle, const Point& weights, const double* data) {
        for (std::size_t c = 0; c < errors_.size(); ++c) {
            double drawn = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                drawn += weights[i] *
                         surface_.attributes[surface_.simplices[triangle][i] * errors_.size() + c];
            }
            greatest_[triangle] =
                std::max(greatest_[triangle], std::abs(drawn - data[c]) / errors_[c]);
        }
    }
    /// Adds points all over the triangles, but those that rounding puts outside the domain.
    template <class Real>
    void look_all_over(const Hierarchy<Real>& h) {
        constexpr int steps = 8;
        std::vector<Point> points;
        for (std::size_t t = 0; t < surface_.simplices.size(); ++t) {
            const auto of = samples_of(corners_of(surface_, t), steps);
            points.insert(points.end(), of.begin(), of.end());
        }
        const ProbeResult probed = probe(h, points);
        const std::size_t each = points.size() / std::max<std::size_t>(greatest_.size(), 1);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point weights = weights_of(corners_of(surface_, i / each), points[i]);
            const bool inside = std::min({weights[0], weights[1], weights[2]}) > 0.01;
            if (probed.found(i))
                add(i / each, weights, &probed.values[i * probed.components]);
            else
                outside_ += inside ? 1 : 0;
        }
    }
    /// Inner points of triangles that lie outside the domain, or in what is hidden.
    std::size_t outside() const { return outside_; }
    /// Triangles that do not keep the errors, but for those that were drawn so.
    std::size_t exceeding_beside(const Surface<3>& drawn) const {
        std::set<Places> before;
        for (std::size_t t = 0; t < drawn.simplices.size(); ++t) before.insert(places(drawn, t));
        std::size_t count = 0;
        for (std::size_t t = 0; t < greatest_.size(); ++t) {
            const bool exceeds = greatest_[t] > 1 + 1e-9;
            count += exceeds && !before.contains(places(surface_, t)) ? 1 : 0;
        }
        return count;
    }

private:
    using Places = std::set<std::array<long, 3>>;

    /// The corners of a triangle, rounded.
    static Places places(const Surface<3>& s, std::size_t t) {
        Places all;
        for (const Point& x : corners_of(s, t)) {
            const auto round = [](double at) { return std::lround(1e6 * at + 0.123); };
            all.insert({round(x[0]), round(x[1]), round(x[2])});
        }
        return all;
    }

    const Surface<3>& surface_;
    const std::vector<double>& errors_;
    std::vector<double> greatest_;
    std::size_t outside_ = 0;
};

}  // namespace nestgrid_test
