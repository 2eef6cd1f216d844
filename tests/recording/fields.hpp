// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several components, and scalars derived from them.
#pragma once

#include <nestgrid/algorithms/derived_field.hpp>

#include "five_at_nodes.hpp"
#include "stored.hpp"

namespace recording {

/// A catching field, then the position, then x y.
template <class Grid>
FiveAtNodes<Grid> five_on(const Grid& grid, const NodalSamples& samples) {
    const auto x = grid.node_positions();
    std::vector<std::array<double, 5>> values;
    for (std::size_t n = 0; n < x.size(); ++n) {
        values.push_back({samples.values[n], x[n][0], x[n][1], x[n][2], x[n][0] * x[n][1]});
    }
    return {grid, std::move(values)};
}

template <class Family>
void record_fields(const std::string& name, int levels) {
    auto grid = Family::grids()[1];
    refine_at_sphere(grid, levels);
    using Grid = typename Family::Grid;
    std::vector<Subject<FiveAtNodes<Grid>>> subjects;
    for (const NodalSamples& samples : catching_fields(grid.node_positions(), 3)) {
        if (!samples.generic) continue;
        subjects.push_back(
            {samples.name.substr(0, samples.name.find(' ')), five_on(grid, samples), 0.0, 1.0});
    }
    record_all(name + "/five", grid, subjects);
    const auto derive = [](std::span<const double> u) {
        return std::hypot(u[1] - 0.5, u[2] - 0.5, u[3] - 0.5) + 0.02 * u[0];
    };
    using Derived = DerivedField<FiveAtNodes<Grid>, decltype(derive), 2>;
    std::vector<Subject<Derived>> derived;
    for (const auto& s : subjects)
        derived.push_back(
            {s.name, Derived(s.field, derive), Family::Grid::dimension == 2 ? 0.6 : 0.33, 1});
    record_options(name + "/derived", grid, derived);
    using First = DerivedField<FiveAtNodes<Grid>, Magnitude>;
    std::vector<Subject<First>> magnitudes;
    for (const auto& s : subjects) magnitudes.push_back({s.name, First(s.field), 1.1, 1});
    record_options(name + "/magnitude", grid, magnitudes);
}

}  // namespace recording
