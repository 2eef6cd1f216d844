// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The families of stored hierarchies that typed tests run over.
#pragma once

#include <gtest/gtest.h>

#include "sample_grids.hpp"

namespace nestgrid_test {

using Families =
    testing::Types<BisectionTriangles, BisectionTetrahedra, RedGreenTriangles, RedGreenTetrahedra,
                   RedGreenMixed2, RedGreenMixed3, BalancedQuadtree, UnbalancedQuadtree,
                   BalancedOctree, UnbalancedOctree, Prisms>;

}  // namespace nestgrid_test
