// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/geometry_indicator.hpp>

#include <algorithm>
#include <cmath>

#include <indicators/eta_source.hpp>
#include <indicators/offset_norms.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

/// |x - sum omega x| of new node n, rounded up.
double distance_to_mean(const MeasuredSplit& split, std::size_t n) {
    const auto [x, y, z] = split.position_offset(n);
    if (!std::isfinite(x + y + z)) throw InvalidInput("the position of a node is not finite");
    return engine::euclid_of(std::array{std::abs(x), std::abs(y), std::abs(z)});
}

class PositionSource final : public engine::EtaSource {
public:
    std::string name() const override { return "the geometry indicator"; }
    bool wants_values() const override { return false; }
    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               engine::NodeEtas& etas) override {
        const auto made = nodes.subspan(split.corner_count());
        for (std::size_t n = 0; n < made.size(); ++n) {
            etas.raise(made[n], distance_to_mean(split, n));
        }
    }
};

/// The recursive sums of section 4.4, of positions.
class PositionBoundSource final : public engine::EtaSource {
public:
    bool wants_values() const override { return false; }
    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               engine::NodeEtas&) override {
        const auto made = nodes.subspan(split.corner_count());
        for (const std::size_t node : nodes) {
            if (node >= nodes_.size()) nodes_.resize(node + 1);
        }
        for (std::size_t n = 0; n < made.size(); ++n) {
            float& offset = nodes_[made[n]].offset;
            offset = std::max(offset, detail::float_above(distance_to_mean(split, n)));
        }
    }
    void finish(engine::NodeEtas& etas) override {
        const auto of_node = [&](std::size_t node) { return nodes_[node].bound(); };
        const auto hand = [](std::uint16_t bound) { return bound; };
        const auto raise = [&](std::size_t node, std::uint16_t to) {
            std::uint16_t& finer = nodes_[node].finer;
            const bool raises = finer < to;
            finer = std::max(finer, to);
            return raises;
        };
        engine::sweep(etas.maxima().splits(), false,
                      [&](const Rule& rule, std::span<const std::size_t> of, float) {
                          std::uint16_t greatest = 0;
                          return engine::raise_parents(rule, of, of_node, hand, raise, greatest);
                      });
        for (std::size_t node = 0; node < nodes_.size(); ++node) {
            etas.raise(node, detail::bfloat16_value(nodes_[node].bound()));
        }
    }

private:
    struct Node {
        float offset = 0;
        std::uint16_t finer = 0;  // the greatest bound of finer nodes

        std::uint16_t bound() const {
            return detail::bfloat16_above(detail::sum_above(offset, detail::bfloat16_value(finer)));
        }
    };
    std::vector<Node> nodes_;
};

}  // namespace

SweptIndicator geometry_indicator(const FieldOnGrid& field, const GeometryOptions& options) {
    PositionSource source;
    return field.visit([&](const auto& hierarchy) {
        return engine::sweep_source(hierarchy, source, options.spread);
    });
}

SweptIndicator position_bounds(const FieldOnGrid& field) {
    PositionBoundSource source;
    return field.visit(
        [&](const auto& hierarchy) { return engine::sweep_source(hierarchy, source, {}); });
}

}  // namespace nestgrid
