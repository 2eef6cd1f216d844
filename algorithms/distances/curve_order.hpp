// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

/// The numbers of points in the order in which the Z curve through their box meets them, so that
/// near ones follow each other, as a BoxTree wants them.
std::vector<std::uint32_t> order_on_curve(std::span<const Point> points);

}  // namespace nestgrid::engine
