// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every forest must be, whatever its connectivity, its balance and the data on it.
#pragma once

#include <nestgrid/check_grid.hpp>

#include "p4est_samples.hpp"
#include "refusal.hpp"
#include "solver_laws.hpp"

namespace nestgrid_test {

class Mpi : public testing::Environment {
public:
    void SetUp() override {
        MPI_Init(nullptr, nullptr);
        sc_init(sc_MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_SILENT);
        p4est_init(nullptr, SC_LP_SILENT);
    }
    void TearDown() override { MPI_Finalize(); }
};
[[maybe_unused]] inline const auto* const mpi = testing::AddGlobalTestEnvironment(new Mpi);

/// Calls function(name, forest, map) for forests over all kinds of connectivities.
template <int dim, class Function>
void for_each_forest(bool balanced, Function&& function) {
    const auto call = [&](const char* name, Forest<dim>&& forest, unsigned seed, int depth,
                          const auto& map) {
        SCOPED_TRACE(std::string(name) + (balanced ? ", balanced" : ", unbalanced"));
        forest.refine_at_random(seed, depth);
        if (balanced) forest.balance();
        function(name, forest, map);
    };
    const P4estVertices straight;
    if constexpr (dim == 2) {
        call("square", Forest<2>(p4est_connectivity_new_unitsquare()), 1, 9, straight);
        call("brick", Forest<2>(p4est_connectivity_new_brick(3, 2, 0, 0)), 2, 7, straight);
        call("star", Forest<2>(p4est_connectivity_new_star()), 3, 5, straight);
        call("cubed", Forest<2>(p4est_connectivity_new_cubed()), 4, 6, straight);
        call("moebius", Forest<2>(p4est_connectivity_new_moebius()), 5, 6, straight);
        // A ring of four trees, periodic in one direction, which the map closes.
        call("ring", Forest<2>(p4est_connectivity_new_brick(4, 1, 1, 0)), 6, 6,
             [](std::size_t tree, const Point& r) {
                 const double angle = 0.5 * M_PI * (static_cast<double>(tree) + r[0]);
                 return (1 + r[1]) * Point{std::cos(angle), std::sin(angle), 0};
             });
    } else {
        call("cube", Forest<3>(p8est_connectivity_new_unitcube()), 8, 5, straight);
        call("brick", Forest<3>(p8est_connectivity_new_brick(2, 2, 1, 0, 0, 0)), 2, 4, straight);
        call("rotated cubes", Forest<3>(p8est_connectivity_new_rotcubes()), 3, 4, straight);
        call("two trees", Forest<3>(p8est_connectivity_new_twotrees(1, 4, 3)), 4, 4, straight);
        Forest<3> mirrored(p8est_connectivity_new_brick(2, 1, 1, 0, 0, 0));
        double* const x = mirrored.connectivity().vertices;
        for (p4est_topidx_t v = 0; v < mirrored.connectivity().num_vertices; ++v) x[3 * v] *= -1;
        call("mirrored", std::move(mirrored), 6, 4, straight);
        Forest<3> shell(p8est_connectivity_new_shell());
        p8est_geometry_t* geometry = p8est_geometry_new_shell(&shell.connectivity(), 1, 0.55);
        call("shell", std::move(shell), 5, 2, P4estGeometry{geometry});
        p8est_geometry_destroy(geometry);
    }
}

template <class Function>
void for_each_forest(Function&& function) {
    for (const bool balanced : {false, true}) {
        for_each_forest<2>(balanced, function);
        for_each_forest<3>(balanced, function);
    }
}

inline std::vector<double> noise(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<double> values(count);
    for (double& v : values) v = uniform(random) - 0.5;
    return values;
}

template <class Grid, class Field>
void expect_sound(const Grid& grid, const Field& field, const CheckOptions& options = {}) {
    const auto violation = check_grid(grid, field, options);
    EXPECT_FALSE(violation) << violation->sentence;
}

/// In two dimensions on a surface that cannot be oriented: every vertex ends two segments.
inline void expect_lines(const Surface<2>& lines) {
    std::vector<int> ends(lines.vertices.size(), 0);
    for (const auto& segment : lines.simplices) {
        for (const auto v : segment) ++ends[v];
    }
    for (const auto& [v] : lines.boundary) ++ends[v];
    for (const int n : ends) EXPECT_EQ(n, 2);
}

struct Expected {
    bool orientable = true;
    bool generic = true;  ///< no offset is exactly 0, so that nothing stops at threshold 0
};

/// Compiled once for all grids of a dimension.
/// \param is_leaf whether element i of a list is a leaf
template <int dim>
void expect_closed_surfaces(
    const Hierarchy<double>& hierarchy, const Expected& expected,
    const std::function<bool(const Elements& elements, std::size_t i)>& is_leaf) {
    const HierarchicalIndicator indicator(hierarchy);
    for (const double threshold : six_thresholds) {
        SCOPED_TRACE("threshold " + std::to_string(threshold));
        const auto result =
            isosurface<dim>(hierarchy, 0, under(indicator, threshold), {.verify = true});
        if constexpr (dim == 2) {
            if (expected.orientable) expect_closed(result.surface);
            if (!expected.orientable) expect_lines(result.surface);
        } else {
            expect_closed(result.surface);
        }
        expect_slices_or_shading<dim>(hierarchy, 0, indicator, threshold, expected.orientable);
        const bool crossed = indicator.least() < 0 && indicator.greatest() > 0;
        EXPECT_TRUE(threshold > 0 || !crossed || !result.surface.simplices.empty());
        const Elements& elements = result.surface.elements;
        for (std::size_t i = 0; i < elements.size(); ++i) {
            EXPECT_TRUE(threshold > 0 || !expected.generic || is_leaf(elements, i));
        }
    }
}

template <class Grid, class Field>
void expect_closed_at_all_thresholds(const Grid& grid, const Field& field,
                                     const Expected& expected) {
    auto context = make_context(grid);
    expect_closed_surfaces<Grid::dimension>(
        erase(grid, field), expected, [&](const Elements& elements, std::size_t i) {
            const auto& e = elements.as<ElementOf<Grid>>()[i];
            return nestgrid::detail::call_split(grid, context, e) == nullptr;
        });
}

}  // namespace nestgrid_test
