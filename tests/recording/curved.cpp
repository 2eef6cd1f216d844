// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// All optional operations of a grid: contexts, own dense keys, hanging nodes, true positions.
#include "curved.hpp"

#include "forests.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    const auto on = [](const CurvedGrid& grid, double size) {
        std::vector<Subject<CurvedField>> subjects;
        for (const NodalSamples& samples : catching(grid.positions, size)) {
            CurvedField field(grid, [](const Point&) { return 0.0; });
            field.field.values = samples.values;
            subjects.push_back({short_name(samples), std::move(field), 0.0, range_of(samples)});
        }
        return subjects;
    };
    const CurvedGrid tetrahedra(refined(kuhn<3>(3), 4, 600));
    record_all("curved/tetrahedra", tetrahedra, on(tetrahedra, 1));
    const CurvedGrid hexahedra(some_boxes<3>(5, 2, 50));
    record_preroll("curved/hexahedra", hexahedra, on(hexahedra, 2));
    record_options("curved/hexahedra", hexahedra, on(hexahedra, 2));
    return finish(count, arguments);
}
