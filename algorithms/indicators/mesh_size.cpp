// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/mesh_size.hpp>

#include <indicators/eta_source.hpp>
#include <indicators/split_kinds.hpp>
#include <indicators/star_sweep.hpp>

namespace nestgrid {

namespace {

/// The diameters of split elements, at their new nodes.
class DiameterSource final : public engine::EtaSource {
public:
    std::string name() const override { return "mesh sizes"; }
    bool wants_values() const override { return false; }
    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               engine::NodeEtas& etas) override {
        const double diameter = split.diameter();
        for (const std::size_t made : nodes.subspan(split.corner_count())) {
            etas.raise(made, diameter);
        }
    }
};

/// Gives a node the greatest diameter of all splits with its parents, row by row.
template <class Real>
SweptIndicator sweep_diameters_of_rows(const Hierarchy<Real>& hierarchy, const Spread& spread) {
    engine::require_spread(spread);
    const engine::SplitKinds kinds(hierarchy);
    std::vector<std::uint16_t> sizes(hierarchy.facts().node_count, 0);
    hierarchy.star_rows([&](const StarRow& row) {
        if (row.gathers) return;
        const std::uint16_t size =
            detail::bfloat16_above(detail::float_above(kinds.diameter(row.parents)));
        for (std::size_t i = 0; i < row.count; ++i) sizes[row.first + i * row.stride] = size;
    });
    engine::sweep_rows(hierarchy, spread, sizes);
    return {{std::move(sizes), {}}, spread, hierarchy.epoch()};
}

template <class Real>
SweptIndicator sweep_diameters(const Hierarchy<Real>& hierarchy, const Spread& spread) {
    if (hierarchy.facts().knows_star_positions) {
        return sweep_diameters_of_rows(hierarchy, spread);
    }
    DiameterSource source;
    return engine::sweep_source(hierarchy, source, spread);
}

}  // namespace

SweptIndicator mesh_size(const FieldOnGrid& field, const Spread& spread) {
    return field.visit([&](const auto& hierarchy) { return sweep_diameters(hierarchy, spread); });
}

}  // namespace nestgrid
