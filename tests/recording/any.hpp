// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lattices.hpp"

namespace recording {

template <class Grid, class Field>
void record_any(const std::string& name, const Grid& grid,
                const std::vector<Subject<Field>>& subjects, bool all = false) {
    using Real = typename Field::value_type;
    const AnyGrid<Grid::dimension> any(grid);
    std::vector<Subject<AnyField<Real>>> erased;
    for (const auto& s : subjects) {
        erased.push_back({s.name, AnyField<Real>(grid, s.field), s.isovalue, s.range});
    }
    if (all) {
        record_all(name, any, erased);
    } else {
        record_options(name, any, erased);
    }
}

}  // namespace recording
