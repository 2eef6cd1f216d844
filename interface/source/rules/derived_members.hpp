// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the sources of the rules share: measures in reference coordinates, and the steps in which
// make_rule() fills the derived members.
#pragma once

#include <span>
#include <vector>

#include <nestgrid/rule.hpp>

namespace nestgrid::detail {

/// Signed measure of an element that is given in reference coordinates.
double signed_reference_measure(Shape shape, std::span<const Point> x);

/// For every node of a rule the faces of the parent that hold it, one bit each.
std::vector<unsigned> face_incidence(const Rule& rule);

/// Fills Rule::edges and Rule::faces.
/// \throw InvalidInput where they are more than max_rule_edges or max_rule_faces
void find_parts(Rule& rule);

/// Fills the members of Child that name edges and faces of the rule, the members of RuleFace that
/// say how children divide it, and those of Rule that sum these up. Requires find_parts().
void place_in_parts(Rule& rule);

}  // namespace nestgrid::detail
