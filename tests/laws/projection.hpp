// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a criterion does to the nodes of a grid.
#pragma once

#include <cmath>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/indicator.hpp>
#include <walk/for_each_element.hpp>
#include <walk/project.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// A node of the adaptive grid.
struct ProjectedValues {
    double value;  ///< P_S U
    Point position;
};
using Projection = std::map<NodeKey, ProjectedValues>;

/// The nodes of the adaptive grid; each is the same in all elements.
template <class Grid, class Field>
Projection projection(const Grid& grid, const Field& field, const Criterion& criterion,
                      const Bounds& bounds) {
    Projection nodes;
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.keys = true, .positions = true}, bounds.hanging());
    engine::project(walk, criterion, [&](const engine::ElementView<double>& view) {
        std::array<NodeKey, max_corners> keys{};
        std::array<Point, max_corners> x{};
        walk.corners(view, keys.data(), x.data());
        for (std::size_t i = 0; i < view.corner_count(); ++i) {
            const auto [at, is_new] = nodes.emplace(keys[i], ProjectedValues{view.value[i], x[i]});
            EXPECT_EQ(at->second.value, view.value[i]);
            EXPECT_EQ(at->second.position, x[i]);
        }
    });
    return nodes;
}

/// How far nodes move, over all nodes that two projections have.
struct Moves {
    double value = 0;
    double position = 0;
};

inline Moves greatest_moves(const Projection& before, const Projection& after) {
    Moves greatest;
    for (const auto& [key, node] : before) {
        const auto at = after.find(key);
        if (at == after.end()) continue;
        greatest.value = std::max(greatest.value, std::abs(at->second.value - node.value));
        greatest.position = std::max(greatest.position, norm(at->second.position - node.position));
    }
    return greatest;
}

/// A split, the positions of its corners and new nodes, and S at each of these; coarse nodes have
/// S = 0.
struct AskedSplit {
    const Rule& rule;
    NodeMask outside;
    std::span<const NodeKey> keys;
    std::span<const Point> positions;
    std::vector<float> s;

    std::size_t corner_count() const { return static_cast<std::size_t>(rule.corner_count()); }
    /// The greatest distance between two corners.
    double diameter() const {
        double greatest = 0;
        for (const Point& a : positions.first(corner_count())) {
            for (const Point& b : positions.first(corner_count())) {
                greatest = std::max(greatest, norm(a - b));
            }
        }
        return greatest;
    }
};

/// Asks a criterion about all splits of a grid. S at a node is the same in all elements, and 1
/// where the criterion holds.
template <class Real, class Function>
void for_each_asked_split(const Hierarchy<Real>& hierarchy, const HangingNodes* hanging,
                          const Criterion& criterion, const Function& function) {
    const engine::Walk<Real> walk(hierarchy, {.values = false, .keys = true, .positions = true},
                                  hanging);
    std::map<NodeKey, float> known;
    engine::SplitKeys keys;
    engine::SplitPositions positions;
    engine::for_each_element(
        walk, true, [&](const engine::ElementView<Real>& view, const engine::Split& split) {
            if (split.rule == nullptr) return;
            const std::size_t corners = view.corner_count();
            AskedSplit asked{*split.rule,
                             split.outside,
                             walk.split_keys(view, split, keys),
                             walk.split_positions(view, split, positions),
                             {}};
            asked.s.resize(asked.keys.size());
            const NewNodes nodes{*split.rule, split.keys, view.level + 1, split.outside,
                                 asked.positions.subspan(corners)};
            criterion.weights(nodes, std::span(asked.s).subspan(corners));
            const NodeMask holds = criterion.holds(nodes);
            for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
                EXPECT_EQ((holds >> n & 1U) != 0, asked.s[corners + n] == 1);
            }
            for (std::size_t i = 0; i < corners; ++i) asked.s[i] = known[asked.keys[i]];
            for (std::size_t i = corners; i < asked.keys.size(); ++i) {
                const auto [at, is_new] = known.emplace(asked.keys[i], asked.s[i]);
                EXPECT_EQ(at->second, asked.s[i]) << "S is no function of the node";
            }
            function(asked);
        });
}

/// The number of splits with a corner at which S > 0 and a new node at which S < 1.
template <class Real>
std::size_t count_violations(const Hierarchy<Real>& hierarchy, const HangingNodes* hanging,
                             const Criterion& criterion) {
    std::size_t violations = 0;
    for_each_asked_split(hierarchy, hanging, criterion, [&](const AskedSplit& split) {
        float greatest = 0;
        float least = 1;
        for (std::size_t i = 0; i < split.s.size(); ++i) {
            if (i < split.corner_count()) {
                greatest = std::max(greatest, split.s[i]);
            } else {
                least = std::min(least, split.s[i]);
            }
        }
        violations += greatest > 0 && least < 1 ? 1U : 0U;
    });
    return violations;
}

}  // namespace nestgrid_test
