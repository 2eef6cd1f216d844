// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// That two ways to a surface give the same one, to the last bit and in the same order.
#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid_test {

using nestgrid::Isosurface;

template <class T>
void expect_same_bits(const std::vector<T>& a, const std::vector<T>& b, const char* what) {
    static_assert(std::is_trivially_copyable_v<T>);
    ASSERT_EQ(a.size(), b.size()) << what;
    EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0) << what;
}

template <int dimension>
void expect_same(const Isosurface<dimension>& a, const Isosurface<dimension>& b) {
    expect_same_bits(a.surface.vertices, b.surface.vertices, "vertices");
    expect_same_bits(a.surface.normals, b.surface.normals, "normals");
    expect_same_bits(a.surface.attributes, b.surface.attributes, "attributes");
    expect_same_bits(a.surface.simplices, b.surface.simplices, "simplices");
    expect_same_bits(a.surface.element_of, b.surface.element_of, "element_of");
    expect_same_bits(a.surface.reference, b.surface.reference, "reference");
    EXPECT_EQ(a.surface.elements.size(), b.surface.elements.size());
    expect_same_bits(a.surface.shape_of, b.surface.shape_of, "shape_of");
    expect_same_bits(a.surface.level_of, b.surface.level_of, "level_of");
    expect_same_bits(a.surface.boundary, b.surface.boundary, "boundary");
    EXPECT_EQ(a.counts.calls, b.counts.calls);
    EXPECT_EQ(a.counts.visited, b.counts.visited);
    EXPECT_EQ(a.counts.extracted, b.counts.extracted);
    EXPECT_EQ(a.error_bound, b.error_bound);
    EXPECT_EQ(a.stack_bytes, b.stack_bytes);
}

}  // namespace nestgrid_test
