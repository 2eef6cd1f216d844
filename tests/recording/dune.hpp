// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Grids of Dune, with values at the vertices of their leaves.
#pragma once

#include <nestgrid/adapters/dune_fields.hpp>

#include "dune_laws.hpp"
#include "options.hpp"

namespace recording {

using namespace nestgrid_test;

template <class Solver>
void record_dune(const std::string& name, const Solver& solver, bool all = false) {
    std::vector<Point> x(static_cast<std::size_t>(solver.size(Solver::dimension)));
    for (const auto& v : vertices(solver.leafGridView())) {
        const auto i = static_cast<std::size_t>(solver.leafIndexSet().index(v));
        x[i] = nestgrid::detail::dune_point(v.geometry().corner(0));
    }
    const auto fields = catching_fields(x, 7);
    const DuneGrid grid(solver);
    using Field = std::decay_t<decltype(DuneVertexField(grid, fields[0].values))>;
    std::vector<Subject<Field>> subjects;
    for (const NodalSamples& samples : fields) {
        subjects.push_back({samples.name.substr(0, samples.name.find(' ')),
                            Field(grid, samples.values), 0.0,
                            samples.name == "5 units in the last place" ? 0x1p-52 : 1});
    }
    record_preroll(name, grid, subjects);
    record_options(name, grid, subjects);
    if (all) record_threads(name, grid, subjects);
}

}  // namespace recording
