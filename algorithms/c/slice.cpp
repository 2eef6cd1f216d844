// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/slice.h>

#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

#include "asked.hpp"
#include "calls.hpp"
#include "drawn.hpp"

namespace {

using namespace nestgrid;

void require_success(int code, const char* operation) {
    if (code == 0) return;
    throw GridError("the operation '" + std::string(operation) +
                    "' of the level function failed with code " + std::to_string(code));
}

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
        require_success(table_.value(table_.self, x.data(), &result), "value");
        return result;
    }
    double variation(const Point& centre, double radius) const override {
        if (table_.variation == nullptr) return LevelFunction::variation(centre, radius);
        double result = 0;
        require_success(table_.variation(table_.self, centre.data(), radius, &result), "variation");
        return result;
    }
    bool affine() const override { return table_.affine != 0; }

private:
    nestgrid_level_function table_{};
};

template <class Real>
void draw(const Hierarchy<Real>& hierarchy, const LevelFunction& function, const Asked& asked,
          nestgrid_surface& out) {
    hierarchy.facts().require_dimension(3);
    const IsosurfaceOptions how = asked.how_to_draw();
    if (asked.everything()) {
        hand_over(slice(hierarchy, function, how, asked.executor()), {}, out);
        return;
    }
    const Criteria criteria = asked.criteria(hierarchy, {});
    TriangleBudget search{.threshold = criteria.projection().least_threshold()};
    if (asked.options().max_triangles > 0) {
        search = find_threshold(
            hierarchy, function, [&](double threshold) { return criteria.at(threshold); },
            criteria.bounds(), asked.options().max_triangles, how, asked.executor());
    }
    hand_over(slice(hierarchy, function, criteria.at(search.threshold), criteria.bounds(), how,
                    asked.executor()),
              search, out);
}

}  // namespace

extern "C" int nestgrid_slice(const nestgrid_grid* grid, const nestgrid_field* field,
                              const double* through, const double* normal,
                              const nestgrid_options* options, nestgrid_surface* out, char* message,
                              size_t message_size) {
    *out = {};
    return without_exceptions(message, message_size, [&] {
        if (through == nullptr || normal == nullptr) {
            throw InvalidInput("the point or the normal of the plane is NULL");
        }
        const Plane plane({through[0], through[1], through[2]}, {normal[0], normal[1], normal[2]});
        const Asked asked(options, grid, field);
        return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
            draw(hierarchy, plane, asked, *out);
            return 0;
        });
    });
}

extern "C" int nestgrid_slice_along(const nestgrid_grid* grid, const nestgrid_field* field,
                                    const nestgrid_level_function* function,
                                    const nestgrid_options* options, nestgrid_surface* out,
                                    char* message, size_t message_size) {
    *out = {};
    return without_exceptions(message, message_size, [&] {
        const FunctionInC in_c(function);
        const Asked asked(options, grid, field);
        return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
            draw(hierarchy, in_c, asked, *out);
            return 0;
        });
    });
}
