// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/slice.h>

#include <nestgrid/algorithms/drawing.hpp>

#include "asked.hpp"
#include "calls.hpp"
#include "drawn.hpp"

namespace {

using namespace nestgrid;

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

/// Draws on the grid of the tables what slice(prerolls, projection, options, work) gives.
template <class Draw>
int draw(const nestgrid_grid* grid, const nestgrid_field* field, const Asked& asked,
         nestgrid_surface& out, const Draw& slice) {
    return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
        hierarchy.facts().require_dimension(3);
        const Projection projection = asked.projection(hierarchy, false);
        auto drawn = asked.with_prerolls(hierarchy, [&](Prerolls& prerolls, const Work& work) {
            return slice(prerolls, projection, asked.how_to_draw(), work);
        });
        hand_over(std::move(drawn), asked.part(), out);
        return 0;
    });
}

}  // namespace

extern "C" int nestgrid_slice(const nestgrid_grid* grid, const nestgrid_field* field,
                              const double* through, const double* normal,
                              const nestgrid_options* options, nestgrid_surface* out, char* message,
                              size_t message_size) {
    *out = {};
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        if (through == nullptr || normal == nullptr) {
            throw InvalidInput("the point or the normal of the plane is NULL");
        }
        const Plane plane({through[0], through[1], through[2]}, {normal[0], normal[1], normal[2]});
        return draw(grid, field, asked, *out, [&](Prerolls& prerolls, const auto&... how) {
            return slice(prerolls, plane, how...);
        });
    });
}

extern "C" int nestgrid_slice_along(const nestgrid_grid* grid, const nestgrid_field* field,
                                    const nestgrid_level_function* function,
                                    const nestgrid_options* options, nestgrid_surface* out,
                                    char* message, size_t message_size) {
    *out = {};
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        const FunctionInC in_c(function);
        return draw(grid, field, asked, *out, [&](Prerolls& prerolls, const auto&... how) {
            return slice(prerolls, in_c, how...);
        });
    });
}

extern "C" int nestgrid_boundary_surface(const nestgrid_grid* grid, const nestgrid_field* field,
                                         const nestgrid_options* options, nestgrid_surface* out,
                                         char* message, size_t message_size) {
    *out = {};
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        return draw(grid, field, asked, *out, [&](Prerolls& prerolls, const auto&... how) {
            return boundary_surface(prerolls, how...);
        });
    });
}
