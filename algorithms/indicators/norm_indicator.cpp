// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/norm_indicator.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <indicators/eta_source.hpp>
#include <indicators/offset_norms.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace engine {

namespace {

/// Norms of the offsets of all components.
class OffsetSource final : public EtaSource {
public:
    OffsetSource(std::size_t components, const NormOptions& options)
        : norm_{options.norm}, scales_{options.scales}, scaled_(components) {
        if (scales_.empty()) scales_.assign(components, 1.0);
        if (scales_.size() != components) {
            throw InvalidInput("the field has " + std::to_string(components) +
                               " components, but there are " + std::to_string(scales_.size()) +
                               " scales");
        }
        for (const double scale : scales_) {
            if (scale > 0) continue;
            throw InvalidInput("the scale of a component is not above 0: " + std::to_string(scale));
        }
    }

    std::string name() const override { return "norms of offsets"; }
    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               NodeEtas& etas) override {
        const auto made = nodes.subspan(split.corner_count());
        for (std::size_t n = 0; n < made.size(); ++n) etas.raise(made[n], measure(split, n));
    }

private:
    double measure(const MeasuredSplit& split, std::size_t n) {
        for (std::size_t c = 0; c < scaled_.size(); ++c) {
            const bool counts = std::isfinite(scales_[c]);
            scaled_[c] = counts ? finite_offset(split.offset(n, c)) / scales_[c] : 0;
        }
        switch (norm_) {
            case OffsetNorm::sum:
                return sum_of(scaled_);
            case OffsetNorm::euclid:
                return euclid_of(scaled_);
            case OffsetNorm::greatest:
                break;
        }
        return *std::ranges::max_element(scaled_);
    }

    OffsetNorm norm_;
    std::vector<double> scales_;
    std::vector<double> scaled_;  // offsets of one node
};

template <class Real>
SweptIndicator sweep_norms(const Hierarchy<Real>& hierarchy, const NormOptions& options) {
    OffsetSource source(static_cast<std::size_t>(hierarchy.facts().components), options);
    return sweep_source(hierarchy, source, options.spread);
}

}  // namespace

}  // namespace engine

SweptIndicator norm_indicator(const FieldOnGrid& field, const NormOptions& options) {
    return field.visit(
        [&](const auto& hierarchy) { return engine::sweep_norms(hierarchy, options); });
}

}  // namespace nestgrid
