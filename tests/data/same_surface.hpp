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
using nestgrid::Surface;
using nestgrid::TraversalCounts;

template <class T>
void expect_same_bits(const std::vector<T>& a, const std::vector<T>& b, const char* what) {
    static_assert(std::is_trivially_copyable_v<T>);
    ASSERT_EQ(a.size(), b.size()) << what;
    EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0) << what;
}

template <int dimension>
void expect_same(const Surface<dimension>& a, const Surface<dimension>& b) {
    expect_same_bits(a.vertices, b.vertices, "vertices");
    expect_same_bits(a.normals, b.normals, "normals");
    expect_same_bits(a.attributes, b.attributes, "attributes");
    expect_same_bits(a.simplices, b.simplices, "simplices");
    expect_same_bits(a.element_of, b.element_of, "element_of");
    expect_same_bits(a.reference, b.reference, "reference");
    EXPECT_EQ(a.elements.size(), b.elements.size());
    expect_same_bits(a.shape_of, b.shape_of, "shape_of");
    expect_same_bits(a.level_of, b.level_of, "level_of");
    expect_same_bits(a.boundary, b.boundary, "boundary");
}

inline void expect_same(const TraversalCounts& a, const TraversalCounts& b) {
    EXPECT_EQ(a.calls, b.calls);
    EXPECT_EQ(a.visited, b.visited);
    EXPECT_EQ(a.extracted, b.extracted);
}

template <int dimension>
void expect_same(const Isosurface<dimension>& a, const Isosurface<dimension>& b) {
    expect_same(a.surface, b.surface);
    expect_same(a.counts, b.counts);
    EXPECT_EQ(a.error_bound, b.error_bound);
    EXPECT_EQ(a.stack_bytes, b.stack_bytes);
}

}  // namespace nestgrid_test
