// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The visual indicator (paper, section 4.1): how sharply surfaces and isolines fold at a node.
//
// eta of a node is the greatest difference between normals around it, 2 sin(angle / 2), so between
// 0 and 2: the diagonal of the box of all normals n at corners of the elements that have the node
// for a corner when it is created. n is the gradient of component 0, made a unit vector where the
// data change by much more than tau across the element, and 0 where they change by much less:
//     n = h grad U / sqrt(|h grad U|^2 + tau^2), h the diameter of the element.
// eta does not depend on the amplitude of the data, and not on an isovalue. At threshold 0 the
// projection is U.
// Memory, while it is made: 24 bytes a node more than swept_indicator.hpp says.
#pragma once

#include <optional>

#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

/// What visual_indicator may be told.
struct VisualOptions {
    /// Below it differences of the data are noise, in their units: not negative. By default 2^-20
    /// of the range of the data, which takes a second walk to find.
    std::optional<double> tau{};
    Spread spread{};
};

/// \throw InvalidInput where tau is negative or not finite, a value of the field is not finite, and
///        for a spread as in measured_indicator()
SweptIndicator visual_indicator(const FieldOnGrid& field, const VisualOptions& options = {});

}  // namespace nestgrid
