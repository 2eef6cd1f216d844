// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "archetype.hpp"
#include "forests.hpp"

using namespace recording;

int main(int count, char** arguments) {
    const auto boxes2 = some_boxes<2>(3, 3, 200);
    record_all("forest2/boxes", boxes2, subjects_on(boxes2, 3));
    const auto bisected = refined(kuhn<2>(2), 7, 500);
    record_options("forest2/bisected", bisected, subjects_on(bisected));
    Forest<2> red = kuhn<2>(0);
    std::mt19937 random(9);
    for (int i = 0; i < 200; ++i) {
        const auto e = static_cast<std::uint32_t>(random() % red.cells.size());
        if (red.cells[e].rule == nullptr) red.refine(e, red_triangle_rule());
    }
    record_options("forest2/red", red, subjects_on(red));
    Forest<2> unequal = kuhn<2>(0);
    for (std::uint32_t e = 0; unequal.cells.size() < 400; ++e) unequal.refine(e, thirds_rule());
    record_options("forest2/thirds", unequal, subjects_on(unequal));
    record("forest2/archetype", [](Case& c) {
        const ArchetypeGrid grid;
        for (const double isovalue : {0.5, 1.5, 3.0}) {
            for (const auto& named : all_options()) {
                c.add(named.name, grid,
                      draw_alone(grid, ArchetypeField{}, isovalue, named.options));
            }
        }
    });
    return finish(count, arguments);
}
