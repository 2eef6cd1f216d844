// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Random hexahedra and prisms, each divided in some of its directions.
#pragma once

#include <random>
#include <vector>

#include "forest.hpp"

namespace nestgrid_test {

/// Directions of a hexahedron, one bit each, that are halved in one step.
using Step = unsigned;

/// Halves a hexahedron in one step after the other: a node in the middle of several directions is
/// the mean of nodes in the directions of its last step.
inline Rule make_halving(const std::vector<Step>& steps) {
    Step all = 0;
    for (const Step step : steps) all |= step;
    std::vector<std::array<unsigned, 3>> at;  // 0, 1 or 2 in each direction
    for (unsigned c = 0; c < 8; ++c) at.push_back({2 * (c & 1U), c & 2U, c >> 1U & 2U});
    const auto number = [&](const std::array<unsigned, 3>& x) {
        return static_cast<std::uint8_t>(std::find(at.begin(), at.end(), x) - at.begin());
    };
    std::vector<Stencil> stencils;
    const auto add = [&](const std::array<unsigned, 3>& x, Step last) {
        Stencil s;
        for (unsigned c = 0; c < 8; ++c) {
            std::array<unsigned, 3> parent = x;
            for (unsigned d = 0; d < 3; ++d) {
                if ((last >> d & 1U) != 0 && x[d] == 1) parent[d] = 2 * (c >> d & 1U);
            }
            const std::uint8_t p = number(parent);
            if (std::find(s.parent.begin(), s.parent.begin() + s.count, p) ==
                s.parent.begin() + s.count) {
                s.parent[s.count++] = p;
            }
        }
        std::fill_n(s.weight.begin(), s.count, 1.0 / s.count);
        stencils.push_back(s);
        at.push_back(x);
    };
    Step done = 0;
    for (const Step step : steps) {
        for (unsigned i = 0; i < 27; ++i) {
            const std::array<unsigned, 3> x{i % 3, i / 3 % 3, i / 9};
            Step odd = 0;
            for (unsigned d = 0; d < 3; ++d) odd |= (x[d] == 1 ? 1U : 0U) << d;
            if ((odd & step) != 0 && (odd & ~(done | step)) == 0) add(x, step);
        }
        done |= step;
    }
    std::vector<Child> children;
    for (unsigned c = 0; c < 8; ++c) {
        if ((c & ~all) != 0) continue;
        Child child{.shape = Shape::hexahedron};
        for (unsigned k = 0; k < 8; ++k) {
            std::array<unsigned, 3> x{};
            for (unsigned d = 0; d < 3; ++d) {
                const unsigned up = k >> d & 1U;
                x[d] = (all >> d & 1U) != 0 ? (c >> d & 1U) + up : 2 * up;
            }
            child.corner[k] = number(x);
        }
        children.push_back(child);
    }
    return make_rule("halving in some directions", Shape::hexahedron, stencils, children);
}

/// The halvings in one direction, in several at once, and in one after the other.
inline const std::vector<Rule>& halvings() {
    static const std::vector<Rule> rules = [] {
        std::vector<Rule> result;
        for (const std::vector<Step>& steps : std::vector<std::vector<Step>>{{1},
                                                                             {2},
                                                                             {4},
                                                                             {3},
                                                                             {5},
                                                                             {6},
                                                                             {7},
                                                                             {1, 2},
                                                                             {2, 1},
                                                                             {1, 4},
                                                                             {4, 2},
                                                                             {3, 4},
                                                                             {4, 3},
                                                                             {1, 2, 4}}) {
            result.push_back(make_halving(steps));
        }
        return result;
    }();
    return rules;
}

/// Unit cubes in a row or a square, hexahedra or two prisms each, along z.
inline Forest<3> cubes_and_prisms(std::mt19937& random) {
    const auto pick = [&](unsigned of) { return static_cast<unsigned>(random() % of); };
    Forest<3> forest;
    const std::uint32_t rows = 1 + pick(2);
    const bool prisms = pick(3) == 0;
    for (const double z : {0.0, 1.0}) {
        for (std::uint32_t y = 0; y <= rows; ++y) {
            for (const double x : {0.0, 1.0, 2.0}) forest.add_node({x, double(y), z});
        }
    }
    const std::uint32_t up = 3 * (rows + 1);
    for (std::uint32_t e = 0; e < 2 * rows; ++e) {
        const std::uint32_t a = e % 2 + 3 * (e / 2);
        if (prisms && pick(2) == 0) {
            forest.add_coarse(Shape::prism, {a, a + 1, a + 3, a + up, a + 1 + up, a + 3 + up}, 1);
            forest.add_coarse(Shape::prism,
                              {a + 4, a + 3, a + 1, a + 4 + up, a + 3 + up, a + 1 + up}, 1);
        } else {
            forest.add_coarse(Shape::hexahedron,
                              {a, a + 1, a + 3, a + 4, a + up, a + 1 + up, a + 3 + up, a + 4 + up},
                              1);
        }
    }
    return forest;
}

/// Refined in one to three levels. At most three of the halvings are used: a grid of a few rules is
/// more often sound.
inline Forest<3> random_anisotropic_grid(std::mt19937& random) {
    const auto pick = [&](unsigned of) { return static_cast<unsigned>(random() % of); };
    Forest<3> forest = cubes_and_prisms(random);
    std::vector<const Rule*> rules;
    for (unsigned i = 1 + pick(3); i > 0; --i) {
        rules.push_back(&halvings()[pick(2) == 0 ? pick(3) : pick(14)]);
    }
    const unsigned levels = 1 + pick(3);
    const unsigned tenths = 2 + pick(8);  // of the elements are divided
    for (std::size_t begin = 0, level = 0; level < levels; ++level) {
        const std::size_t end = forest.cells.size();
        for (; begin < end; ++begin) {
            if (pick(10) >= tenths) continue;
            const bool prism = forest.cells[begin].shape == Shape::prism;
            forest.refine(static_cast<std::uint32_t>(begin),
                          prism ? prism_rule(static_cast<PrismSplit>(pick(3)))
                                : *rules[pick(static_cast<unsigned>(rules.size()))]);
        }
    }
    return forest;
}

}  // namespace nestgrid_test
