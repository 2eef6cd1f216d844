// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Colours of a vertex, and sums of squared distances from the colours of triangles around it.
//
// On a triangle a colour is a = slope . x + offset. For a vertex at x with the colour a, the sum
// over triangles, by area, of (slope . x + offset - a)^2 is least for the mean of what they say at
// x. What is left then is a quadric of x alone. Positions are known elsewhere; colours are in units
// of their errors.
#pragma once

#include <vector>

#include <collapses/quadric.hpp>

namespace nestgrid::engine {

using ColourValues = std::vector<double>;  // by component

class Colours {
public:
    Colours() = default;
    /// \param values by component
    explicit Colours(std::span<const double> values);

    const ColourValues& values() const { return value_; }
    void set_values(const ColourValues& values) { value_ = values; }
    /// Adds a triangle of some area with linear colours.
    /// \param corners that the colours belong to, by component
    void add_triangle(const Triangle& x, double area,
                      const std::array<std::span<const double>, 3>& corners);
    /// Adds what another one knows of triangles.
    void add(const Colours& other);
    /// The colours that fit best at x.
    ColourValues best_at(const Point& x) const;
    /// The sum of squared distances for the best colours.
    const Quadric& quadric() const { return quadric_; }
    /// By how much the sum is greater for other colours at x.
    double excess(const Point& x, const ColourValues& values) const;

private:
    /// Sums over triangles of area * slope and area * offset.
    struct Sum {
        Point slope{};
        double offset = 0;
    };

    void take_off_means(double sign);
    double best_at(const Point& x, const Sum& sum) const {
        return (dot(sum.slope, x) + sum.offset) / weight_;
    }

    ColourValues value_;
    double weight_ = 0;
    std::vector<Sum> sum_;  // by component
    Quadric quadric_;
};

}  // namespace nestgrid::engine
