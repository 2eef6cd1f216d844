// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/mesh_size.hpp>

#include <indicators/eta_source.hpp>
#include <indicators/star_sizes.hpp>

namespace nestgrid {

namespace {

/// The diameters of split elements, at their new nodes.
class DiameterSource final : public engine::EtaSource {
public:
    bool wants_values() const override { return false; }
    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               engine::NodeEtas& etas) override {
        const double diameter = split.diameter();
        for (const std::size_t made : nodes.subspan(split.corner_count())) {
            etas.raise(made, diameter);
        }
    }
};

template <class Real>
SweptIndicator sweep_diameters(const Hierarchy<Real>& hierarchy, const Spread& spread) {
    if (hierarchy.facts().knows_star_positions) return engine::star_sizes(hierarchy, spread);
    DiameterSource source;
    return engine::sweep_source(hierarchy, source, spread);
}

}  // namespace

SweptIndicator mesh_size(const Hierarchy<float>& hierarchy, const Spread& spread) {
    return sweep_diameters(hierarchy, spread);
}

SweptIndicator mesh_size(const Hierarchy<double>& hierarchy, const Spread& spread) {
    return sweep_diameters(hierarchy, spread);
}

}  // namespace nestgrid
