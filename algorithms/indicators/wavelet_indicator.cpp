// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include <bit>
#include <cmath>

#include <indicators/eta_source.hpp>
#include <indicators/lifting.hpp>

namespace nestgrid {

namespace engine {

namespace {

/// Wavelet coefficients of component 0.
class DetailSource final : public EtaSource {
public:
    explicit DetailSource(WaveletNorm norm) : norm_{norm} {}

    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               NodeEtas& etas) override {
        const std::size_t corners = split.corner_count();
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            lifting_.set_value(nodes[k], split.values[k * split.components]);
        }
        for (std::size_t n = 0; corners + n < nodes.size(); ++n) {
            lifting_.add_parents(nodes[corners + n], split.rule.new_nodes[n], nodes);
            etas.raise(nodes[corners + n], trace_of(split.offset(n)));
        }
    }

    /// Each corner has an equal part of the hat functions of a leaf.
    void leaves(const MeasuredSplit& split, std::span<const std::size_t> nodes,
                NodeMask which) override {
        for (NodeMask left = which; left != 0; left &= left - 1) {
            const Child& child =
                split.rule.children[static_cast<std::size_t>(std::countr_zero(left))];
            const std::size_t corners = topology(child.shape).corners;
            std::array<Point, max_corners> x{};
            for (std::size_t k = 0; k < corners; ++k) x[k] = split.positions[child.corner[k]];
            const double size = std::abs(measure(child.shape, std::span(x).first(corners)));
            for (std::size_t k = 0; k < corners; ++k) {
                lifting_.add_integral(nodes[child.corner[k]], size / static_cast<double>(corners));
            }
        }
    }

    void finish(NodeEtas& etas) override {
        lifting_.run([&](std::size_t node, double detail, double integral) {
            const double weight = norm_ == WaveletNorm::amplitude ? 1 : std::sqrt(integral);
            etas.raise(node, std::abs(detail) * weight);
        });
    }

private:
    WaveletNorm norm_;
    Lifting lifting_;
};

template <class Real>
SweptIndicator sweep_details(const Hierarchy<Real>& hierarchy, const WaveletOptions& options) {
    DetailSource source(options.norm);
    return sweep_source(hierarchy, source, options.spread);
}

}  // namespace

}  // namespace engine

SweptIndicator wavelet_indicator(const FieldOnGrid& field, const WaveletOptions& options) {
    return field.visit(
        [&](const auto& hierarchy) { return engine::sweep_details(hierarchy, options); });
}

}  // namespace nestgrid
