// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Level functions of C codes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

#include <nestgrid/algorithms/slice.h>
#include <nestgrid/algorithms/level_function.hpp>
#include <nestgrid/error.hpp>

#include "calls.hpp"

namespace nestgrid {

/// A function that a C code gives.
class FunctionInC final : public LevelFunction {
public:
    /// \throw InvalidInput where there is no function
    explicit FunctionInC(const nestgrid_level_function* given) {
        if (given == nullptr) throw InvalidInput("the level function is NULL");
        if (given->size < offsetof(nestgrid_level_function, variation)) {
            throw InvalidInput("the table of the level function is too small: its size says " +
                               std::to_string(given->size) + " bytes");
        }
        std::memcpy(&table_, given, std::min(given->size, sizeof(table_)));
        if (table_.value == nullptr) {
            throw InvalidInput("the table of the level function lacks the function 'value'");
        }
    }
    double value(const Point& x) const override {
        double result = 0;
        require_success(table_.value(table_.self, x.data(), &result),
                        "the operation 'value' of the level function");
        return result;
    }
    double variation(const Point& centre, double radius) const override {
        if (table_.variation == nullptr) return LevelFunction::variation(centre, radius);
        double result = 0;
        require_success(table_.variation(table_.self, centre.data(), radius, &result),
                        "the operation 'variation' of the level function");
        return result;
    }
    bool affine() const override { return table_.affine != 0; }

private:
    nestgrid_level_function table_{};
};

/// The plane through a point, across a normal, three numbers each.
/// \throw InvalidInput where one of them is NULL, or the normal 0
inline Plane plane_in_c(const double* through, const double* normal) {
    if (through == nullptr || normal == nullptr) {
        throw InvalidInput("the point or the normal of the plane is NULL");
    }
    return {{through[0], through[1], through[2]}, {normal[0], normal[1], normal[2]}};
}

}  // namespace nestgrid
