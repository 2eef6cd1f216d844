// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Forests of which some leaves are hidden.
#pragma once

#include "forests.hpp"
#include "hiding_forest.hpp"

namespace recording {

template <int dim>
void record_hiding(const std::string& name, Forest<dim> forest, double size) {
    const HidingForest<dim> grid(std::move(forest), std::mt19937(7));
    const auto subjects = subjects_on<dim>(grid, size);
    record_preroll(name, grid, subjects);
    record_options(name, grid, subjects);
    record_threads(name, grid, subjects);
}

}  // namespace recording
