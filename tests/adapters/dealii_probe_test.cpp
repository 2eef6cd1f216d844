// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// No point inside is lost in curved triangulations of deal.II, in cells of its MappingQ1.
#include <deal.II/grid/grid_generator.h>

#include <nestgrid/adapters/dealii.hpp>

#include "closedness.hpp"
#include "probe_laws.hpp"

using namespace nestgrid_test;
using dealii::Triangulation;

namespace {

/// Calls test(name, triangulation) for curved geometries, coarse ones and refined at random.
template <int dim, class Test>
void for_each_geometry(const Test& test) {
    namespace make = dealii::GridGenerator;
    const auto call = [&](const std::string& name, const auto& generate) {
        for (const int steps : {0, 2, 3}) {
            Triangulation<dim> triangulation;
            generate(triangulation);
            std::mt19937 random(static_cast<unsigned>(steps));
            for (int i = 0; i < steps; ++i) {
                for (const auto& c : triangulation.active_cell_iterators()) {
                    if (random() % 4 == 0) c->set_refine_flag();
                }
                triangulation.execute_coarsening_and_refinement();
            }
            SCOPED_TRACE(name + ", " + std::to_string(triangulation.n_active_cells()) + " cells");
            test(triangulation);
        }
    };
    call("ball", [](auto& t) { make::hyper_ball(t); });
    call("shell", [](auto& t) { make::hyper_shell(t, {}, 0.5, 1, 6); });
    call("half shell", [](auto& t) { make::half_hyper_shell(t, {}, 0.5, 1); });
    call("quarter ball", [](auto& t) { make::quarter_hyper_ball(t); });
    if constexpr (dim == 2) {
        call("channel with a cylinder", [](auto& t) { make::channel_with_cylinder(t); });
    } else {
        call("cylinder", [](auto& t) { make::cylinder(t); });
        call("torus", [](auto& t) { make::torus(t, 2, 0.5); });
    }
}

template <int dim>
void expect_no_point_of_a_geometry_lost() {
    for_each_geometry<dim>([](const auto& triangulation) {
        expect_no_point_lost(DealiiGrid<dim>(triangulation), 100'000, 1);
    });
}

TEST(DealiiProbes, LoseNoPointInTwoDimensions) { expect_no_point_of_a_geometry_lost<2>(); }
TEST(DealiiProbes, LoseNoPointInThreeDimensions) { expect_no_point_of_a_geometry_lost<3>(); }

}  // namespace
