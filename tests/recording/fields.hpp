// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several components, and scalars derived from them.
#pragma once

#include <nestgrid/algorithms/derived_field.hpp>

#include "stored.hpp"

namespace recording {

/// A catching field, then the position, then x y.
template <class Grid>
class FiveOn {
public:
    using value_type = double;
    static constexpr int components = 5;

    FiveOn(const Grid& grid, const NodalSamples& samples) : grid_{&grid} {
        const auto x = grid.node_positions();
        for (std::size_t n = 0; n < x.size(); ++n) {
            values_.push_back({samples.values[n], x[n][0], x[n][1], x[n][2], x[n][0] * x[n][1]});
        }
    }
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        std::array<NodeKey, max_corners> keys;
        const auto coarse = grid_->coarse(i);
        const auto n = static_cast<std::size_t>(topology(coarse.shape).corners);
        grid_->corner_keys(coarse.element, std::span(keys).first(n));
        for (std::size_t k = 0; k < n; ++k) put(static_cast<std::size_t>(keys[k]), out, k);
        return 0;
    }
    NodeMask new_values(const typename Grid::Element& e, NodeMask which, std::span<double> out,
                        typename Grid::Context& context) const {
        const std::span<const std::uint32_t> nodes = grid_->new_nodes(e, context);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            if ((which >> k & 1U) != 0) put(nodes[k], out, k);
        }
        return 0;
    }

private:
    void put(std::size_t node, std::span<double> out, std::size_t k) const {
        std::ranges::copy(values_[node], out.begin() + static_cast<std::ptrdiff_t>(5 * k));
    }
    const Grid* grid_;
    std::vector<std::array<double, 5>> values_;
};

template <class Family>
void record_fields(const std::string& name, int levels) {
    auto grid = Family::grids()[1];
    refine_at_sphere(grid, levels);
    using Grid = typename Family::Grid;
    std::vector<Subject<FiveOn<Grid>>> subjects;
    for (const NodalSamples& samples : catching_fields(grid.node_positions(), 3)) {
        if (!samples.generic) continue;
        subjects.push_back({samples.name.substr(0, samples.name.find(' ')),
                            FiveOn<Grid>(grid, samples), 0.0, 1.0});
    }
    record_all(name + "/five", grid, subjects);
    const auto derive = [](std::span<const double> u) {
        return std::hypot(u[1] - 0.5, u[2] - 0.5, u[3] - 0.5) + 0.02 * u[0];
    };
    using Derived = DerivedField<FiveOn<Grid>, decltype(derive), 2>;
    std::vector<Subject<Derived>> derived;
    for (const auto& s : subjects)
        derived.push_back(
            {s.name, Derived(s.field, derive), Family::Grid::dimension == 2 ? 0.6 : 0.33, 1});
    record_options(name + "/derived", grid, derived);
    using First = DerivedField<FiveOn<Grid>, Magnitude>;
    std::vector<Subject<First>> magnitudes;
    for (const auto& s : subjects) magnitudes.push_back({s.name, First(s.field), 1.1, 1});
    record_options(name + "/magnitude", grid, magnitudes);
}

}  // namespace recording
