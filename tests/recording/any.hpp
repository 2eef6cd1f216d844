// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lattices.hpp"
#include "table_in_c.hpp"

namespace recording {

/// Behind tables in C.
template <class Grid, class Field>
void record_any(const std::string& name, const Grid& grid,
                const std::vector<Subject<Field>>& subjects, bool all = false) {
    const TableInC in_c(grid);
    const TabledGrid<Grid::dimension> tabled{in_c.table};
    std::vector<Subject<TabledField<typename Field::value_type>>> behind;
    for (const auto& s : subjects) {
        behind.push_back({s.name, {field_in_c(grid, s.field)}, s.isovalue, s.range});
    }
    if (all) {
        record_all(name, tabled, behind);
    } else {
        record_options(name, tabled, behind);
    }
}

}  // namespace recording
