// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What C codes call.
#include <nestgrid/algorithms/isosurface.h>

#include "forests.hpp"
#include "lattices.hpp"
#include "table_in_c.hpp"
#include "tetrahedra_in_c.h"

namespace {

using namespace recording;

void add_in_c(Case& c, const std::string& run, const nestgrid_grid& grid,
              const nestgrid_field& field, double isovalue, double threshold) {
    nestgrid_surface s;
    std::array<char, 200> message{};
    const int code =
        nestgrid_isosurface(&grid, &field, isovalue, threshold, &s, message.data(), message.size());
    if (code != 0) throw InvalidInput(message.data());
    c.add_bits(run + ".vertices", std::vector<double>(s.vertices, s.vertices + 3 * s.vertex_count));
    const std::size_t numbers = static_cast<std::size_t>(s.dimension) * s.simplex_count;
    c.add_bits(run + ".simplices", std::vector<std::uint32_t>(s.simplices, s.simplices + numbers));
    c.add_bits(run + ".bound", s.error_bound);
    c.add_triangles(s.simplex_count);
    c.count("visited", s.visited);
    c.count("extracted", s.extracted);
    nestgrid_surface_free(&s);
}

template <class Grid, class Field>
void record_in_c(const std::string& name, const Grid& grid,
                 const std::vector<Subject<Field>>& subjects) {
    const TableInC in_c(grid);
    record(name, [&](Case& c) {
        for (const auto& s : subjects) {
            for (const double threshold : {0.0, 0.02, 0.2}) {
                add_in_c(c, s.name, in_c.table, field_in_c(grid, s.field), s.isovalue,
                         threshold * s.range);
            }
        }
    });
}

}  // namespace

int main(int count, char** arguments) {
    const Sampled<float, 3> in3({.samples = {13, 18, 21}});
    const Sampled<double, 2> in2({.samples = {30, 18}});
    const LatticeBisection<3> bisection({.samples = {13, 18, 21}});
    record_in_c("c_functions/lattice_bisection3", bisection, in3.on(bisection));
    const LatticeOctree<2> octree({.samples = {30, 18}});
    record_in_c("c_functions/lattice_octree2", octree, in2.on(octree));
    const auto forest = some_boxes<3>(3, 2, 60);
    record_in_c("c_functions/forest3", forest, subjects_on<3>(forest, 2));
    const std::vector<SampledField> fields = sampled_fields({17, 17, 17});
    record("c_functions/in_c", [&](Case& c) {
        for (const SampledField& data : fields) {
            const samples_in_c samples{16, data.values.data()};
            for (const double threshold : {0.0, 0.02, 0.2}) {
                add_in_c(c, data.name, tetrahedra_in_c(&samples), samples_field_in_c(&samples),
                         data.isovalue, threshold * data.range);
            }
        }
    });
    return finish(count, arguments);
}
