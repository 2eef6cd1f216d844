// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "expression/expression.hpp"

#include <array>
#include <cmath>

#include <muParser.h>

#include <nestgrid/error.hpp>

namespace {

struct NamedExpression {
    const char* name;
    const char* text;
};

constexpr std::array<NamedExpression, 4> named{
    {{"sphere", "sqrt(x^2+y^2+z^2)"},
     {"gyroid", "sin(6*x)*cos(6*y)+sin(6*y)*cos(6*z)+sin(6*z)*cos(6*x)"},
     {"singularity", "(x^2+y^2+z^2)^(1/3)"},
     {"front", "atan(60*(sqrt((x-0.2)^2+(y-0.3)^2+(z-0.25)^2)-0.5))"}}};

std::string message(const mu::Parser::exception_type& error) {
    const std::string& text = error.GetMsg();
    return text.substr(0, text.find_last_not_of(".\n ") + 1);
}

}  // namespace

Expression::Expression(const std::string& text, Variables variables)
    : parser_{std::make_unique<mu::Parser>()}, text_{text} {
    std::string formula = text;
    for (const NamedExpression& n : named) {
        if (text == n.name) formula = n.text;
    }
    try {
        parser_->DefineVar("x", &x_[0]);
        parser_->DefineVar("y", &x_[1]);
        parser_->DefineVar("z", &x_[2]);
        if (variables == Variables::place_and_time) parser_->DefineVar("t", &t_);
        parser_->DefineConst("pi", 3.14159265358979323846);
        parser_->SetExpr(formula);
        parser_->Eval();
    } catch (const mu::Parser::exception_type& error) {
        throw nestgrid::InvalidInput("the expression '" + text + "' is no expression in x, y" +
                                     (variables == Variables::place ? " and z: " : ", z and t: ") +
                                     message(error));
    }
}

Expression::~Expression() = default;

double Expression::operator()(const nestgrid::Point& x, double t) const {
    x_ = x;
    t_ = t;
    const double value = parser_->Eval();
    if (!std::isfinite(value)) {
        throw nestgrid::InvalidInput("the expression '" + text_ + "' is no finite number at " +
                                     nestgrid::text_of(x));
    }
    return value;
}

std::string Expression::names() {
    std::string text;
    for (const NamedExpression& n : named) {
        text += std::string("  ") + n.name + std::string(14 - std::string(n.name).size(), ' ') +
                n.text + "\n";
    }
    return text;
}
