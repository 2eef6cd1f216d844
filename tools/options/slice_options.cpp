// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "options/slice_options.hpp"

#include <algorithm>
#include <limits>
#include <mutex>

#include <nestgrid/error.hpp>

#include "expression/expression.hpp"
#include "options/command_line.hpp"
#include "options/number_list.hpp"

namespace {

/// The zero of an expression.
class ExpressionFunction final : public nestgrid::LevelFunction {
public:
    explicit ExpressionFunction(const std::string& text) : expression_{text} {}
    double value(const nestgrid::Point& x) const override {
        const std::scoped_lock lock(mutex_);
        return expression_(x);
    }
    double variation(const nestgrid::Point& centre, double radius) const override {
        nestgrid::Point low = centre;
        nestgrid::Point high = centre;
        for (std::size_t d = 0; d < 3; ++d) {
            low[d] -= radius;
            high[d] += radius;
        }
        const ValueRange here = expression_.range(centre, centre);
        const ValueRange around = expression_.range(low, high);
        // Above 0, so that elements in which the function is 0 are looked at.
        return std::max({around.greatest - here.least, here.greatest - around.least,
                         std::numeric_limits<double>::denorm_min()});
    }

private:
    Expression expression_;
    mutable std::mutex mutex_;  // of values: the parser has one place for x, y and z
};

int count_slices(const SliceOptions& o) {
    return int(!o.plane.empty()) + int(!o.axis.empty()) + int(!o.sphere.empty()) +
           int(!o.cylinder.empty()) + int(!o.function.empty());
}

}  // namespace

void add_slice_options(CLI::App& command, SliceOptions& options) {
    CLI::Option* axis =
        command.add_option("--axis", options.axis, "a plane across the x, y or z axis, at --at")
            ->type_name("AXIS")
            ->check(one_of({"x", "y", "z"}));
    command.add_option("--at", options.at, "the coordinate of that plane")
        ->type_name("NUMBER")
        ->needs(axis);
    command.add_option("--plane", options.plane, "a plane by a point and its normal")
        ->type_name("X,Y,Z,NX,NY,NZ")
        ->delimiter(',')
        ->expected(6);
    command.add_option("--sphere", options.sphere, "a sphere by its centre and radius")
        ->type_name("X,Y,Z,R")
        ->delimiter(',')
        ->expected(4);
    command
        .add_option("--cylinder", options.cylinder,
                    "a cylinder by a point on its axis, the axis and its radius")
        ->type_name("X,Y,Z,AX,AY,AZ,R")
        ->delimiter(',')
        ->expected(7);
    command
        .add_option("--function", options.function,
                    "the zero of an expression in x, y and z, like \"x*x+y*y-4\"")
        ->type_name("TEXT");
}

bool is_sliced(const SliceOptions& options) { return count_slices(options) > 0; }

SliceFunction slice_function(const SliceOptions& o) {
    if (count_slices(o) != 1) {
        throw nestgrid::InvalidInput(
            "a slice needs one of --plane, --axis, --sphere, --cylinder and --function");
    }
    if (!o.axis.empty() && !o.at) {
        throw nestgrid::InvalidInput("the plane across " + o.axis +
                                     " has no place: give its coordinate, --at");
    }
    if (!o.plane.empty() || !o.axis.empty()) {
        nestgrid::Point through{};
        nestgrid::Point normal{};
        if (o.plane.empty()) {
            const auto d = static_cast<std::size_t>(o.axis[0] - 'x');
            through[d] = *o.at;
            normal[d] = 1;
        } else {
            through = point_at(o.plane, 0);
            normal = point_at(o.plane, 3);
        }
        return {std::make_unique<nestgrid::Plane>(through, normal), true, normal};
    }
    if (!o.sphere.empty()) {
        return {std::make_unique<nestgrid::Sphere>(point_at(o.sphere, 0), o.sphere[3]), false, {}};
    }
    if (!o.cylinder.empty()) {
        return {std::make_unique<nestgrid::Cylinder>(point_at(o.cylinder, 0),
                                                     point_at(o.cylinder, 3), o.cylinder[6]),
                false,
                {}};
    }
    return {std::make_unique<ExpressionFunction>(o.function), false, {}};
}
