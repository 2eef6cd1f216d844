// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <nestgrid/shape.hpp>

#include "expression/expression_range.hpp"

namespace mu {
class Parser;
}

/// A function of x, y, z and perhaps t: one with a name, or an expression such as sin(3*x)+y*z
/// (muparser).
class Expression {
public:
    enum class Variables { place, place_and_time };

    /// \throw nestgrid::InvalidInput for an expression that cannot be understood
    explicit Expression(const std::string& text, Variables variables = Variables::place);
    ~Expression();
    Expression(const Expression&) = delete;
    Expression& operator=(const Expression&) = delete;

    /// \throw nestgrid::InvalidInput where the value is not a number
    double operator()(const nestgrid::Point& x, double t = 0) const;
    /// Bounds of a function of x, y and z in the box between two corners; perhaps infinite. Several
    /// threads may call this.
    ValueRange range(const nestgrid::Point& low, const nestgrid::Point& high) const {
        return range_in_box(*parser_, x_, low, high);
    }

    /// Names and what they stand for, one per line.
    static std::string names();

private:
    std::unique_ptr<mu::Parser> parser_;
    mutable nestgrid::Point x_{};
    mutable double t_ = 0;
    std::string text_;
};
