// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "expression_range.hpp"

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
/// products and quotients hold of the values that the parser computes, to the last bit. The bounds
/// of an operation without a result are no numbers.
using Rounding = interval_lib::save_state_nothing<interval_lib::rounded_transc_exact<double>>;
using Interval =
    boost::numeric::interval<double,
                             interval_lib::policies<Rounding, interval_lib::checking_base<double>>>;
using Operands = std::span<const Interval>;
using Bound = Interval (*)(Operands);
using Bounds = std::map<mu::erased_fun_type, Bound>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The function that muparser calls for the sign of -x, which has no name.
mu::erased_fun_type negation() {
    double x = 0;
    mu::Parser parser;
    parser.DefineVar("x", &x);
    parser.SetExpr("-x");
    parser.Eval();
    return parser.GetByteCode().GetBase()[1].Fun.cb._pRawFun;
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
    add("sqrt", [](Operands x) { return sqrt(x[0]); });
    add("exp", [](Operands x) { return exp(x[0]); });
    add("log", [](Operands x) { return log(x[0]); });
    add("ln", [](Operands x) { return log(x[0]); });
    add("sin", [](Operands x) { return sin(x[0]); });
    add("cos", [](Operands x) { return cos(x[0]); });
    add("tan", [](Operands x) { return tan(x[0]); });
    add("asin", [](Operands x) { return asin(x[0]); });
    add("acos", [](Operands x) { return acos(x[0]); });
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

Interval power(const Interval& base, const Interval& exponent) {
    constexpr double most = 64;
    const double n = exponent.lower();
    if (singleton(exponent) && n == std::round(n) && std::abs(n) <= most) {
        return pow(base, static_cast<int>(n));
    }
    if (singleton(exponent) && n > 0 && base.lower() == 0) {  // rises from 0
        return {0, exp(exponent * log(Interval(base.upper()))).upper()};
    }
    return exp(exponent * log(base));
}

/// Evaluates an expression token by token.
class RangeStack {
public:
    /// \return whether the token has a bound
    bool take(const mu::SToken& token, Operands x, const nestgrid::Point& place) {
        switch (token.Cmd) {
            case mu::cmADD:
                return combine([](const auto& a, const auto& b) { return a + b; });
            case mu::cmSUB:
                return combine([](const auto& a, const auto& b) { return a - b; });
            case mu::cmMUL:
                return combine([](const auto& a, const auto& b) { return a * b; });
            case mu::cmDIV:
                return combine([](const auto& a, const auto& b) { return a / b; });
            case mu::cmPOW:
                return combine(power);
            case mu::cmVAL:
                stack_.emplace_back(token.Val.data2);
                return true;
            case mu::cmFUNC:
                return call(token);
            default:
                return take_variable(token, x, place);
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
    template <class Operation>
    bool combine(const Operation& operation) {
        const Interval right = stack_.back();
        stack_.pop_back();
        stack_.back() = operation(stack_.back(), right);
        return true;
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

    /// Takes a variable v, or what muparser makes of v^n and of a v + b.
    bool take_variable(const mu::SToken& token, Operands x, const nestgrid::Point& place) {
        const auto variable = [&] {
            return x[static_cast<std::size_t>(token.Val.ptr - place.data())];
        };
        switch (token.Cmd) {
            case mu::cmVAR:
                stack_.push_back(variable());
                return true;
            case mu::cmVARPOW2:
            case mu::cmVARPOW3:
            case mu::cmVARPOW4:
                stack_.push_back(pow(variable(), token.Cmd - mu::cmVARPOW2 + 2));
                return true;
            case mu::cmVARMUL:
                stack_.push_back(variable() * token.Val.data + token.Val.data2);
                return true;
            default:
                return false;
        }
    }

    boost::container::small_vector<Interval, 16> stack_;
};

}  // namespace

ValueRange range_in_box(const mu::Parser& parser, const nestgrid::Point& x,
                        const nestgrid::Point& low, const nestgrid::Point& high) {
    std::array<Interval, 3> box;
    for (std::size_t d = 0; d < 3; ++d) box[d] = {low[d], high[d]};
    RangeStack stack;
    const mu::SToken* const tokens = parser.GetByteCode().GetBase();
    for (const mu::SToken* token = tokens; token->Cmd != mu::cmEND; ++token) {
        if (!stack.take(*token, box, x)) return {-infinity, infinity};
    }
    return stack.result();
}
