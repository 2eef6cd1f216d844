// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/unusable_values.hpp>

#include <cmath>
#include <string>

#include <walk/for_each_element.hpp>
#include <walk/hanging_nodes.hpp>

namespace nestgrid::engine {

void require_numbers(std::span<const double> values) {
    for (const double value : values) {
        if (!std::isfinite(value)) {
            throw UnusableValue("a value of the field is not a usable number: " +
                                std::to_string(value));
        }
    }
}

template <class Real>
void refuse_with_place(const Hierarchy<Real>& hierarchy, std::size_t functions,
                       const UnusableValue& refusal) {
    const HangingNodes hanging = find_hanging_nodes(hierarchy);
    const Walk<Real> walk(
        hierarchy, {.values = true, .keys = true, .positions = true, .on_ranks = true}, &hanging);
    const auto components = static_cast<std::size_t>(hierarchy.facts().components);
    for_each_element(walk, false, [&](const ElementView<Real>& view, const Split& split) {
        if (split.rule != nullptr || view.member->hidden == Hidden::wholly) return;
        for (std::size_t i = 0; i < view.corner_count() * components; ++i) {
            if (std::isfinite(view.value[i])) continue;
            std::array<NodeKey, max_corners> keys;
            std::array<Point, max_corners> x;
            walk.corners(view, keys.data(), x.data());
            const std::string component =
                components == functions + 1
                    ? ""
                    : ", component " + std::to_string(i % components - functions);
            throw InvalidInput(
                "a value of the field is not a usable number: " + std::to_string(view.value[i]) +
                ", at " + text_of(x[i / components]) + " in coarse element " +
                std::to_string(view.coarse) + component);
        }
    });
    throw refusal;
}

template void refuse_with_place(const Hierarchy<float>&, std::size_t, const UnusableValue&);
template void refuse_with_place(const Hierarchy<double>&, std::size_t, const UnusableValue&);

}  // namespace nestgrid::engine
