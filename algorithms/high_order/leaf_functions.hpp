// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is a polynomial in each leaf of a hierarchy: the field, and the position.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// What LeafRecords makes coefficients of.
class LeafFunction {
public:
    virtual ~LeafFunction() = default;
    virtual std::size_t components() const = 0;
    /// How many of the components are within a tolerance, together: those in front.
    virtual std::size_t drawn() const = 0;
    virtual int degree(Task* task, const Handle& leaf) const = 0;
    /// \param out component c of point n at out[n * components() + c]
    virtual void evaluate(Task* task, const Handle& leaf, std::span<const Point> points,
                          std::span<double> out) const = 0;
    /// As in "evaluate()" and "degree".
    virtual std::string operation() const = 0;
    virtual std::string degree_name() const = 0;
};

/// Component 0 is drawn.
class LeafField final : public LeafFunction {
public:
    explicit LeafField(const Hierarchy<double>& base) : base_{&base} {}
    std::size_t components() const override {
        return static_cast<std::size_t>(base_->facts().components);
    }
    std::size_t drawn() const override { return 1; }
    int degree(Task* task, const Handle& leaf) const override { return base_->degree(task, leaf); }
    void evaluate(Task* task, const Handle& leaf, std::span<const Point> points,
                  std::span<double> out) const override {
        base_->evaluate(task, leaf, points, out.data());
    }
    std::string operation() const override { return "evaluate()"; }
    std::string degree_name() const override { return "degree"; }

private:
    const Hierarchy<double>* base_;
};

/// The three coordinates.
class LeafPlaces final : public LeafFunction {
public:
    explicit LeafPlaces(const Hierarchy<double>& base) : base_{&base} {}
    std::size_t components() const override { return 3; }
    std::size_t drawn() const override { return 3; }
    int degree(Task* task, const Handle& leaf) const override {
        return base_->geometry_degree(task, leaf);
    }
    void evaluate(Task* task, const Handle& leaf, std::span<const Point> points,
                  std::span<double> out) const override {
        std::vector<Point> x(points.size());
        base_->map(task, leaf, points, x);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = x[i / 3][i % 3];
    }
    std::string operation() const override { return "map()"; }
    std::string degree_name() const override { return "geometry degree"; }

private:
    const Hierarchy<double>* base_;
};

/// The Euclidean norm of some numbers, of one its magnitude. It grows with each of them, whatever
/// is rounded.
/// \param number called with 0 to count - 1
template <class Number>
double norm_of(std::size_t count, const Number& number) {
    if (count == 1) return std::abs(number(std::size_t{0}));
    double sum = 0;
    for (std::size_t c = 0; c < count; ++c) {
        const double one = number(c);
        sum += one * one;
    }
    return std::sqrt(sum);
}

}  // namespace nestgrid::engine
