// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// C codes ask for an error of the positions of curved leaves, and are told what is kept.
#include <nestgrid/algorithms/isolines.h>

#include "c_scenes.hpp"
#include "curved_world.hpp"

namespace c_algorithms_test {

/// Calls a function for C, which succeeds.
template <class Call>
void succeed(const Call& call) {
    std::array<char, 200> message{};
    ASSERT_EQ(call(message.data(), message.size()), 0) << message.data();
}

double radius(const Point& x) { return dot(x, x); }

TEST(CurvedForC, PointsKeepTheErrorThatIsAskedFor) {
    const CurvedWorld<DegreeWorld<2>> world(polynomial_bend(3, 0.1, 2), WorldOptions{.levels = 1},
                                            radius);
    const DegreeField<2> values(world);
    const TableInC<CurvedWorld<DegreeWorld<2>>> grid(world);
    const nestgrid_field field = field_in_c(world, values);
    nestgrid_options options{};
    options.size = sizeof(options);
    options.error = 0.5;
    std::array<std::size_t, 3> before{};
    for (const double places : {0.03, 0.003, 0.0003}) {
        options.position_error = places;
        std::array<std::size_t, 3> counts{};
        const auto expect_told = [&](double bound) {
            EXPECT_GT(bound, 0);
            EXPECT_LE(bound, places * (1 + 1e-6));
        };
        const auto draw = [&](std::size_t& count, const auto& function) {
            nestgrid_surface surface;
            succeed([&](char* text, std::size_t size) { return function(&surface, text, size); });
            nestgrid_surface_details details{};
            details.size = sizeof(details);
            nestgrid_details(&surface, &details, nullptr, 0);
            expect_told(details.position_bound);
            count = surface.simplex_count;
            nestgrid_surface_free(&surface);
        };
        draw(counts[0], [&](auto... out) {
            return nestgrid_isosurface_with(&grid.table, &field, 0.8, &options, out...);
        });
        draw(counts[1], [&](auto... out) {
            return nestgrid_height_field(&grid.table, &field, 1, &options, out...);
        });
        nestgrid_lines lines{};
        lines.size = sizeof(lines);
        const double value = 0.8;
        succeed([&](char* text, std::size_t size) {
            return nestgrid_isolines(&grid.table, &field, &value, 1, &options, &lines, text, size);
        });
        expect_told(lines.position_bound);
        counts[2] = lines.vertex_count;
        nestgrid_lines_free(&lines);
        for (std::size_t i = 0; i < counts.size(); ++i) EXPECT_GT(counts[i], before[i]);
        before = counts;
    }
    // Where the caller's struct ends before the member, it is not read.
    options.size = offsetof(nestgrid_options, position_error);
    nestgrid_surface surface;
    succeed([&](char* text, std::size_t size) {
        return nestgrid_isosurface_with(&grid.table, &field, 0.8, &options, &surface, text, size);
    });
    EXPECT_LT(surface.simplex_count, before[0]);
    nestgrid_surface_free(&surface);
}

}  // namespace c_algorithms_test
