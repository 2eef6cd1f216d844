// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The families of stored hierarchies that typed tests run over. Those of blocks have a header of
// this name in tests/adapters/blocks.
#pragma once

#include "fields_at_sphere.hpp"

namespace nestgrid_test {

using Families =
    testing::Types<BisectionTriangles, BisectionTetrahedra, RedGreenTriangles, RedGreenTetrahedra,
                   RedGreenMixed2, RedGreenMixed3, BalancedQuadtree, UnbalancedQuadtree,
                   BalancedOctree, UnbalancedOctree, Prisms>;

}  // namespace nestgrid_test
