// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points in vectors of the machine. A processor that reads a vector, after a program has written
// its numbers one by one or as vectors that begin elsewhere, waits until they have reached the
// cache. A WidePoint is written and read as the same two vectors.
#pragma once

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/detail/inlining.hpp>

namespace nestgrid::engine {

/// Operations have the results of those on a Point, to the last bit, where the compiler does not
/// fuse products and sums (-ffp-contract=off, or a machine that cannot).
class WidePoint {
public:
    WidePoint() = default;
#if defined(__GNUC__)
    NESTGRID_INLINE explicit WidePoint(const Point& x) : xy_{x[0], x[1]}, z_{x[2], 0} {}
    NESTGRID_INLINE explicit operator Point() const { return {xy_[0], xy_[1], z_[0]}; }

    NESTGRID_INLINE friend WidePoint operator-(const WidePoint& a, const WidePoint& b) {
        return {a.xy_ - b.xy_, a.z_ - b.z_};
    }
    NESTGRID_INLINE friend WidePoint operator+(const WidePoint& a, const WidePoint& b) {
        return {a.xy_ + b.xy_, a.z_ + b.z_};
    }
    NESTGRID_INLINE friend WidePoint operator*(double s, const WidePoint& a) {
        return {s * a.xy_, s * a.z_};
    }
    NESTGRID_INLINE friend double dot(const WidePoint& a, const WidePoint& b) {
        const Pair xy = a.xy_ * b.xy_;
        return xy[0] + xy[1] + a.z_[0] * b.z_[0];
    }

private:
    using Pair [[gnu::vector_size(16)]] = double;

    NESTGRID_INLINE WidePoint(const Pair& xy, const Pair& z) : xy_{xy}, z_{z} {}

    Pair xy_;
    Pair z_;
#else
    explicit WidePoint(const Point& x) : x_{x} {}
    explicit operator Point() const { return x_; }

    friend WidePoint operator-(const WidePoint& a, const WidePoint& b) {
        return WidePoint(a.x_ - b.x_);
    }
    friend WidePoint operator+(const WidePoint& a, const WidePoint& b) {
        return WidePoint(a.x_ + b.x_);
    }
    friend WidePoint operator*(double s, const WidePoint& a) { return WidePoint(s * a.x_); }
    friend double dot(const WidePoint& a, const WidePoint& b) { return dot(a.x_, b.x_); }

private:
    Point x_;
#endif
};

}  // namespace nestgrid::engine
