// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "expression/expression_range.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <span>

#include <muParser.h>
#include <boost/container/small_vector.hpp>
#include <boost/numeric/interval.hpp>

namespace {

namespace interval_lib = boost::numeric::interval_lib;
/// Its operations are rounded as those of the parser. Rounding is monotone, so the bounds of sums,
/// products and quotients hold of the values that the parser computes, to the last bit.
using Rounding = interval_lib::save_state_nothing<interval_lib::rounded_transc_exact<double>>;
using Interval =
    boost::numeric::interval<double,
                             interval_lib::policies<Rounding, interval_lib::checking_base<double>>>;
using Operands = std::span<const Interval>;
using Bound = Interval (*)(Operands);
using Bounds = std::map<mu::erased_fun_type, Bound>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Where nothing is known: not a number may be among the values. Every operation on it gives it.
Interval unknown() { return Interval::empty(); }

/// An interval, unless its operand leaves the domain of the function.
Interval within(bool domain, const Interval& interval) { return domain ? interval : unknown(); }

/// The values of sine or cosine, whose argument Boost reduces.
Interval reduced(const Interval& values, const Interval& x) {
    const double error = 0x1p-50 * (1 + std::max(std::abs(x.lower()), std::abs(x.upper())));
    return values + Interval(-error, error);
}

/// The function that muparser calls for the sign of -x, which has no name; null where it calls
/// none.
mu::erased_fun_type negation() {
    double x = 0;
    mu::Parser parser;
    parser.DefineVar("x", &x);
    parser.SetExpr("-x");
    parser.Eval();
    const mu::SToken& second = parser.GetByteCode().GetBase()[1];
    return second.Cmd == mu::cmFUNC ? second.Fun.cb._pRawFun : nullptr;
}

/// Bounds of muparser's functions.
Bounds make_bounds() {
    const mu::Parser parser;
    Bounds bounds;
    const auto add = [&](const char* name, Bound bound) {
        void* const address = parser.GetFunDef().at(name).GetAddr();
        bounds[reinterpret_cast<mu::erased_fun_type>(address)] = bound;
    };
    add("abs", [](Operands x) { return abs(x[0]); });
    add("sqrt", [](Operands x) { return within(x[0].lower() >= 0, sqrt(x[0])); });
    add("exp", [](Operands x) { return exp(x[0]); });
    add("log", [](Operands x) { return within(x[0].lower() > 0, log(x[0])); });
    add("ln", [](Operands x) { return within(x[0].lower() > 0, log(x[0])); });
    add("sin", [](Operands x) { return reduced(sin(x[0]), x[0]); });
    add("cos", [](Operands x) { return reduced(cos(x[0]), x[0]); });
    add("asin", [](Operands x) { return within(abs(x[0]).upper() <= 1, asin(x[0])); });
    add("acos", [](Operands x) { return within(abs(x[0]).upper() <= 1, acos(x[0])); });
    add("atan", [](Operands x) { return atan(x[0]); });
    add("sinh", [](Operands x) { return sinh(x[0]); });
    add("cosh", [](Operands x) { return cosh(x[0]); });
    add("tanh", [](Operands x) { return tanh(x[0]); });
    add("min", [](Operands x) {
        return std::reduce(x.begin() + 1, x.end(), x[0], [](auto a, auto b) { return min(a, b); });
    });
    add("max", [](Operands x) {
        return std::reduce(x.begin() + 1, x.end(), x[0], [](auto a, auto b) { return max(a, b); });
    });
    bounds[negation()] = [](Operands x) { return -x[0]; };
    return bounds;
}

Interval quotient(const Interval& a, const Interval& b) { return within(!zero_in(b), a / b); }

/// Where the base is not negative, base^exponent is monotone in each of them, so that its extremes
/// are at their ends; and so are those of whole powers, but for 0 in the base.
Interval power(const Interval& base, const Interval& exponent) {
    if (empty(base) || empty(exponent)) return unknown();
    const double n = exponent.lower();
    const bool is_whole = singleton(exponent) && n == std::round(n);
    if (!is_whole && base.lower() < 0) return unknown();
    if (n < 0 && zero_in(base)) return unknown();
    double least = infinity;
    double greatest = -infinity;
    const auto add = [&](double value) {
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    };
    for (const double x : {base.lower(), base.upper()}) {
        for (const double y : {n, exponent.upper()}) add(std::pow(x, y));
    }
    if (zero_in(base)) add(std::pow(0.0, n));
    return {least, greatest};
}

/// Evaluates an expression token by token.
class RangeStack {
public:
    /// \param x the variables
    /// \param place where the parser finds them
    RangeStack(Operands x, const nestgrid::Point& place) : x_{x}, place_{&place} {}

    /// \return whether the token is one that is understood
    bool take(const mu::SToken& token) {
        switch (token.Cmd) {
            case mu::cmADD:
                combine([](const auto& a, const auto& b) { return a + b; });
                return true;
            case mu::cmSUB:
                combine([](const auto& a, const auto& b) { return a - b; });
                return true;
            case mu::cmMUL:
                combine([](const auto& a, const auto& b) { return a * b; });
                return true;
            case mu::cmDIV:
                combine(quotient);
                return true;
            case mu::cmPOW:
                combine(power);
                return true;
            case mu::cmVAL:
                stack_.emplace_back(token.Val.data2);
                return true;
            case mu::cmVAR:
                stack_.push_back(variable(token));
                return true;
            case mu::cmVARPOW2:
            case mu::cmVARPOW3:
            case mu::cmVARPOW4:
                stack_.push_back(pow(variable(token), token.Cmd - mu::cmVARPOW2 + 2));
                return true;
            case mu::cmVARMUL:
                stack_.push_back(variable(token) * token.Val.data + token.Val.data2);
                return true;
            case mu::cmFUNC:
                return call(token);
            default:
                return false;
        }
    }
    ValueRange result() const {
        const double least = stack_.back().lower();
        const double greatest = stack_.back().upper();
        if (!(least <= greatest)) return {-infinity, infinity};
        const double rounding = 0x1p-48 * std::max(std::abs(least), std::abs(greatest));
        return {least - rounding, greatest + rounding};  // functions may be an ulp off
    }

private:
    /// x, y or z; nothing is known of other variables.
    Interval variable(const mu::SToken& token) const {
        for (std::size_t d = 0; d < 3; ++d) {
            if (token.Val.ptr == &(*place_)[d]) return x_[d];
        }
        return unknown();
    }

    template <class Operation>
    void combine(const Operation& operation) {
        const Interval right = stack_.back();
        stack_.pop_back();
        stack_.back() = operation(stack_.back(), right);
    }

    bool call(const mu::SToken& token) {
        static const Bounds bounds = make_bounds();
        const auto bound = bounds.find(token.Fun.cb._pRawFun);
        if (bound == bounds.end()) return false;
        const auto count = static_cast<std::size_t>(std::abs(token.Fun.argc));
        const std::size_t first = stack_.size() - count;
        const Interval result = bound->second(Operands(stack_.data() + first, count));
        stack_.resize(first);
        stack_.push_back(result);
        return true;
    }

    Operands x_;
    const nestgrid::Point* place_;
    boost::container::small_vector<Interval, 16> stack_;
};

}  // namespace

ValueRange range_in_box(const mu::Parser& parser, const nestgrid::Point& x,
                        const nestgrid::Point& low, const nestgrid::Point& high) {
    std::array<Interval, 3> box;
    for (std::size_t d = 0; d < 3; ++d) box[d] = {low[d], high[d]};
    RangeStack stack(box, x);
    const mu::SToken* const tokens = parser.GetByteCode().GetBase();
    for (const mu::SToken* token = tokens; token->Cmd != mu::cmEND; ++token) {
        if (!stack.take(*token)) return {-infinity, infinity};
    }
    return stack.result();
}
