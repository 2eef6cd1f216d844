// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// That two ways to a surface give the same one, to the last bit; in the same order, or in any.
#pragma once

#include <algorithm>
#include <array>
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

/// The positions of the corners of each simplex, from its least one on, in order. The order of the
/// simplices themselves depends on what bounds know of the elements beside those that stop.
template <int dimension>
auto sorted_simplices(const Surface<dimension>& surface) {
    std::vector<std::array<nestgrid::Point, static_cast<std::size_t>(dimension)>> all;
    for (const auto& simplex : surface.simplices) {
        auto& corners = all.emplace_back();
        for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = surface.vertices[simplex[i]];
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
    }
    std::sort(all.begin(), all.end());
    return all;
}

template <int dimension>
void expect_same_simplices(const Surface<dimension>& a, const Surface<dimension>& b) {
    EXPECT_EQ(a.vertices.size(), b.vertices.size());
    EXPECT_TRUE(sorted_simplices(a) == sorted_simplices(b));
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
