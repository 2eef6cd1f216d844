// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Floats behind tables, and bisections that a C code tells.
#include "any.hpp"
#include "tetrahedra_in_c.h"

int main(int count, char** arguments) {
    using namespace recording;
    for (const auto& lattice : lattices(std::integral_constant<int, 3>())) {
        const Sampled<float, 3> samples(lattice.geometry);
        const LatticeBisection<3> bisection(lattice.geometry);
        record_any(std::string("any3_float/lattice_bisection/") + lattice.name, bisection,
                   samples.on(bisection));
        const LatticeOctree<3> octree(lattice.geometry);
        record_any(std::string("any3_float/lattice_octree/") + lattice.name, octree,
                   samples.on(octree));
    }
    const std::vector<SampledField> fields = sampled_fields({17, 17, 17});
    std::vector<samples_in_c> in_c;
    in_c.reserve(fields.size());
    for (const SampledField& data : fields) in_c.push_back({16, data.values.data()});
    for (const bool told : {true, false}) {
        nestgrid_grid table = tetrahedra_in_c(in_c.data());
        if (!told) table.middles = nullptr;
        const TabledGrid<3> grid{table};
        std::vector<Subject<TabledField<float>>> subjects;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            subjects.push_back({fields[i].name,
                                {samples_field_in_c(&in_c[i])},
                                fields[i].isovalue,
                                fields[i].range});
        }
        record_all(told ? "any3_float/told_in_c" : "any3_float/in_c", grid, subjects);
    }
    return finish(count, arguments);
}
