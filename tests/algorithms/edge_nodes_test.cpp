// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes inside edges, from several sheets of elements.
#include <array>
#include <limits>

#include <gtest/gtest.h>

#include <height_fields/edge_nodes.hpp>

using namespace nestgrid;
using engine::EdgeNodes;

namespace edge_nodes_test {

/// Several sheets at one edge record some nodes each, some of them twice.
TEST(EdgeNodes, AreKeptOnceInTheirOrder) {
    const KeyPair edge(7, 3);
    EdgeNodes nodes, task;
    nodes.begin(1);
    task.begin(1);
    const auto add = [&](EdgeNodes& to, double place, NodeKey key) {
        to.add({edge, place, key, {place, 0, 0}, 0}, std::array{10 * place});
    };
    add(nodes, 0.5, 20);
    add(nodes, 0.75, 10);
    add(task, 0.25, 30);
    add(task, 0.5, 20);
    nodes.append(task);
    nodes.finish();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto on = nodes.between({3, 7}, {-infinity, infinity});
    ASSERT_EQ(on.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(on[i].key, (std::array<NodeKey, 3>{30, 20, 10}[i]));
        EXPECT_EQ(nodes.values(on[i])[0], 10 * on[i].place);
    }
    const auto middle = nodes.between({3, 7}, {0.75, 0.25});
    ASSERT_EQ(middle.size(), 1U);
    EXPECT_EQ(middle[0].key, 20U);
    EXPECT_TRUE(nodes.between({3, 8}, {-infinity, infinity}).empty());
}

}  // namespace edge_nodes_test
