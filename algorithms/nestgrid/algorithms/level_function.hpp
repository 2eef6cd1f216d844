// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Functions of position whose zero is a slice.
#pragma once

#include <limits>

#include <nestgrid/shape.hpp>

namespace nestgrid {

/// A continuous function of position. The slice is oriented towards where it is negative.
class LevelFunction {
public:
    virtual ~LevelFunction() = default;
    /// The value at x; finite within the domain.
    virtual double value(const Point& x) const = 0;
    /// A bound of |value(x) - value(centre)| for all x no farther than `radius` from `centre`.
    /// Elements are searched where values at their corners and this bound allow a zero; infinity,
    /// the default, searches all of them.
    virtual double variation(const Point& /*centre*/, double /*radius*/) const {
        return std::numeric_limits<double>::infinity();
    }
    /// Whether the function is affine.
    virtual bool affine() const { return false; }

protected:
    LevelFunction() = default;
    LevelFunction(const LevelFunction&) = default;
    LevelFunction& operator=(const LevelFunction&) = default;
    LevelFunction(LevelFunction&&) noexcept = default;
    LevelFunction& operator=(LevelFunction&&) noexcept = default;
};

/// The plane through a point, across a normal of any length. The function is the distance from it,
/// positive on the side that the normal points to.
class Plane final : public LevelFunction {
public:
    /// \throw InvalidInput where the normal is 0, or a number is not finite
    Plane(const Point& through, const Point& normal);
    double value(const Point& x) const override;
    double variation(const Point& centre, double radius) const override;
    bool affine() const override { return true; }

private:
    Point normal_;  // of length 1
    double offset_;
};

/// A sphere. The function is the distance from it, positive outside.
class Sphere final : public LevelFunction {
public:
    /// \throw InvalidInput where the radius is not positive, or a number is not finite
    Sphere(const Point& centre, double radius);
    double value(const Point& x) const override;
    double variation(const Point& centre, double radius) const override;

private:
    Point centre_;
    double radius_;
};

/// An infinite circular cylinder. The function is the distance from it, positive outside.
class Cylinder final : public LevelFunction {
public:
    /// \param through a point on the axis
    /// \param axis its direction, of any length
    /// \throw InvalidInput for an axis 0, a radius of 0 or less, a number that is not finite
    Cylinder(const Point& through, const Point& axis, double radius);
    double value(const Point& x) const override;
    double variation(const Point& centre, double radius) const override;

private:
    Point through_;
    Point axis_;  // of length 1
    double radius_;
};

}  // namespace nestgrid
