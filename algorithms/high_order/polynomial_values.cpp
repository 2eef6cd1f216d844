// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/polynomial_values.hpp>

#include <limits>

#include <high_order/virtual_elements.hpp>
#include <surfaces/probed_colours.hpp>

namespace nestgrid {

ProbeResult probe(const HighOrder& data, std::span<const Point> points) {
    // At a tolerance that all leaves are within, elements are those of the hierarchy.
    const VirtualRefinement leaves(data, {.tolerance = std::numeric_limits<double>::max()});
    ProbeResult result = probe<double>(leaves, points);
    const engine::LeafRecords& records = data.data_->records;
    const auto elements = result.elements.as<engine::VirtualElement>();
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!result.found(i)) continue;
        const engine::LeafPolynomial& leaf = records.leaves()[elements[result.element_of[i]].leaf];
        for (std::size_t c = 0; c < result.components; ++c) {
            result.values[i * result.components + c] = engine::net_value(
                records.net(leaf, c), leaf.degree, leaf.factors(), result.reference[i]);
        }
    }
    result.elements = Elements();
    result.element_of.clear();
    result.shape_of.clear();
    return result;
}

void set_polynomial_colours(Surface<3>& surface, const HighOrder& data) {
    if (surface.attributes.empty()) return;
    engine::ProbedColours(surface, [&](std::span<const Point> points) {
        return probe(data, points);
    }).colour_from(0);
}

}  // namespace nestgrid
