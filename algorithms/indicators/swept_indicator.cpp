// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/swept_indicator.hpp>

#include <algorithm>
#include <limits>

#include <indicators/diameter.hpp>
#include <indicators/eta_source.hpp>
#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid {

Point MeasuredSplit::position_offset(std::size_t n) const {
    return positions[corner_count() + n] - detail::interpolate(rule.new_nodes[n], positions.data());
}

double MeasuredSplit::diameter() const {
    return engine::diameter_of(positions.first(corner_count()));
}

NodeMask SweptIndicator::stops_at_most(const Rule&, std::span<const NodeKey> nodes,
                                       double epsilon) const {
    if (!(epsilon >= 0)) return 0;
    const std::uint16_t most = detail::bfloat16_below(epsilon);
    NodeMask mask = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        mask |= NodeMask{stops_.at(nodes[i]) <= most} << i;
    }
    return mask;
}

double SweptIndicator::surface_error(std::span<const double> isovalues, double epsilon) const {
    const bool known = std::ranges::all_of(isovalues, [&](double isovalue) {
        return std::ranges::find(isovalues_, isovalue) != isovalues_.end();
    });
    if (!known || !(epsilon >= 0)) return std::numeric_limits<double>::infinity();
    const std::uint16_t most = detail::bfloat16_below(epsilon);
    std::uint16_t greatest = 0;
    stops_.for_each([&](std::uint16_t stop) {
        if (stop <= most) greatest = std::max(greatest, stop);
    });
    return detail::bfloat16_value(greatest);
}

namespace {

/// The numbers of a user's measure.
class MeasureSource final : public engine::EtaSource {
public:
    explicit MeasureSource(const Measure& measure) : measure_{&measure} {}

    std::string name() const override { return "an indicator of measures"; }
    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               engine::NodeEtas& etas) override {
        const auto made = nodes.subspan(split.corner_count());
        eta_.assign(made.size(), 0);
        (*measure_)(split, eta_);
        for (std::size_t n = 0; n < made.size(); ++n) etas.raise(made[n], eta_[n]);
    }

private:
    const Measure* measure_;
    std::vector<double> eta_;
};

}  // namespace

SweptIndicator measured_indicator(const FieldOnGrid& field, const Measure& measure,
                                  const Spread& spread) {
    MeasureSource source(measure);
    return field.visit(
        [&](const auto& hierarchy) { return engine::sweep_source(hierarchy, source, spread); });
}

}  // namespace nestgrid
