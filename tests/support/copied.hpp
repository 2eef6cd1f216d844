// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A copy of a hierarchy is drawn as the hierarchy itself.
#pragma once

#include <gtest/gtest.h>

#include <nestgrid/algorithms/hierarchy_copy.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/shading.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "same_surface.hpp"

namespace nestgrid_test {

using namespace nestgrid;

/// Surfaces, capped and not, slices and shadings of both are the same to the last bit, and so are
/// bounds; counts, too, but where the original is walked in patches or prepared by rows. There, and
/// where the original has no dense keys, which are then those of the copy, numbers of vertices
/// differ; and normals, where the field gives gradients, which are not copied.
template <int dimension, class Real>
void expect_copied(const Hierarchy<Real>& hierarchy, double isovalue,
                   std::initializer_list<double> thresholds = {0.0, 0.01, 0.1}) {
    if (hierarchy.offers(Feature::hanging_parents)) {
        EXPECT_THROW(HierarchyCopy{hierarchy}, InvalidInput);
        return;
    }
    const HierarchyCopy copy(hierarchy);
    const Prerolls original(hierarchy);
    const Prerolls copied(copy);
    const bool normals = dimension == 3 && !hierarchy.offers(Feature::gradients);
    const HierarchyFacts& facts = hierarchy.facts();
    const bool walked_alike = !facts.knows_patches && !facts.knows_stars;
    const auto expect_alike = [&](const auto& a, const auto& b) {
        expect_same_simplices(a.surface, b.surface);
        if (walked_alike && facts.node_count > 0) expect_same(a.surface, b.surface);
        if (walked_alike) expect_same(a.counts, b.counts);
        EXPECT_EQ(a.error_bound, b.error_bound);
    };
    for (const double threshold : thresholds) {
        SCOPED_TRACE("threshold " + std::to_string(threshold));
        const Projection projection{.threshold = threshold};
        for (const bool cap : {false, true}) {
            const IsosurfaceOptions options{.normals = normals, .cap = cap, .elements = false};
            expect_alike(isosurface<dimension>(original, isovalue, projection, options),
                         isosurface<dimension>(copied, isovalue, projection, options));
        }
        if constexpr (dimension == 3) {
            const Plane plane({0.51, 0.43, 0.37}, {1, 2, 3});
            const IsosurfaceOptions options{.elements = false};
            expect_alike(slice(original, plane, projection, options),
                         slice(copied, plane, projection, options));
        } else {
            const ShadingOptions options{.elements = false};
            expect_alike(shading(original, projection, options),
                         shading(copied, projection, options));
        }
    }
}

}  // namespace nestgrid_test
