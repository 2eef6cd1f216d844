// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sums of squared distances from planes (Garland, Heckbert 1997), and where they are least.
#pragma once

#include <nestgrid/detail/geometry.hpp>

#include <collapses/border_planes.hpp>

namespace nestgrid::engine {

class Quadric {
public:
    /// Adds weight * (normal . x - level)^2.
    void add_plane(const Point& normal, double level, double weight);
    void add(const Quadric& other);
    double at(const Point& x) const;
    /// Half of the derivative.
    Point slope(const Point& x) const;
    /// The second derivative's trace, halved.
    double trace() const { return xx_ + yy_ + zz_; }
    Point times(const Point& d) const;

    /// The point of least value on some planes that `near` lies on. Where the quadric does not say
    /// much, one nearer to it.
    Point least(const Point& near, const Freedom& planes) const;

private:
    double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
    Point linear_{0, 0, 0};
    double constant_ = 0;
};

}  // namespace nestgrid::engine
