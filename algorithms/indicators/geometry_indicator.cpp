// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/geometry_indicator.hpp>

#include <cmath>

#include <indicators/eta_source.hpp>
#include <indicators/offset_norms.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

class PositionSource final : public engine::EtaSource {
public:
    bool wants_values() const override { return false; }
    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               engine::NodeEtas& etas) override {
        const auto made = nodes.subspan(split.corner_count());
        for (std::size_t n = 0; n < made.size(); ++n) {
            const auto [x, y, z] = split.position_offset(n);
            if (!std::isfinite(x + y + z)) {
                throw InvalidInput("the position of a node is not finite");
            }
            etas.raise(made[n],
                       engine::euclid_of(std::array{std::abs(x), std::abs(y), std::abs(z)}));
        }
    }
};

}  // namespace

SweptIndicator geometry_indicator(const Hierarchy<float>& hierarchy,
                                  const GeometryOptions& options) {
    PositionSource source;
    return engine::sweep_source(hierarchy, source, options.spread);
}

SweptIndicator geometry_indicator(const Hierarchy<double>& hierarchy,
                                  const GeometryOptions& options) {
    PositionSource source;
    return engine::sweep_source(hierarchy, source, options.spread);
}

}  // namespace nestgrid
