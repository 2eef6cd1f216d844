// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The forests of the interface's tests, refined at random.
#pragma once

#include "closedness.hpp"
#include "forest.hpp"
#include "options.hpp"

namespace recording {

using namespace nestgrid_test;

inline std::string short_name(const NodalSamples& samples) {
    return samples.name.substr(0, samples.name.find(' '));
}

/// The catching fields at nodes in the unit cube, or scaled into it.
inline std::vector<NodalSamples> catching(std::vector<Point> nodes, double size = 1) {
    for (Point& x : nodes) x = (1 / size) * x;
    return catching_fields(nodes, 11);
}
inline double range_of(const NodalSamples& samples) {
    return samples.name == "5 units in the last place" ? 0x1p-52 : 1;
}

template <int dim>
std::vector<Subject<ForestField<dim>>> subjects_on(const Forest<dim>& forest, double size = 1) {
    std::vector<Subject<ForestField<dim>>> subjects;
    for (const NodalSamples& samples : catching(forest.positions, size)) {
        ForestField<dim> field(forest, [](const Point&) { return 0.0; });
        field.values = samples.values;
        subjects.push_back({short_name(samples), std::move(field), 0.0, range_of(samples)});
    }
    return subjects;
}

template <int dim>
Forest<dim> refined(Forest<dim> forest, unsigned seed, int steps) {
    std::mt19937 random(seed);
    refine_randomly(forest, random, steps);
    return forest;
}

template <int dim>
Forest<dim> some_boxes(unsigned seed, std::uint32_t n, int steps) {
    std::mt19937 random(seed);
    return refined(boxes<dim>(random, n), seed, steps);
}

}  // namespace recording
