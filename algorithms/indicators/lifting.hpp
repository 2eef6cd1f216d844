// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A wavelet transform over the nodes of a hierarchy, by lifting (paper, section 4.2).
//
// Generation of a node: 0 on the coarse grid, else 1 + the greatest of its parents. From the last
// generation to the first, each node y with the parents p and weights omega gives
//     its detail    d(y) = c(y) - sum omega c(p),
//     its integral  I(p) += omega I(y),
//     its mean      c(p) += s d(y), with s = I(y) / (number of parents * I(p)),
// where c is the value and I the integral of the hat function at a node.
// Invariant: the sum of c I over the nodes that are left does not change. Consequence: on the
// coarse grid it is the integral of the data.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <nestgrid/rule.hpp>

namespace nestgrid::engine {

class Lifting {
public:
    struct Node {
        double value = 0;
        double integral = 0;
        std::size_t generation = 0;
    };

    /// Nodes by number; those that were not met have the value and the integral 0.
    std::span<const Node> nodes() const { return nodes_; }
    void set_value(std::size_t node, double value) { at(node).value = value; }
    void add_integral(std::size_t node, double share) { at(node).integral += share; }
    /// Tells the parents of a node, in whose stencil they are numbers of `of`. Those of the parents
    /// must be known. Does nothing where they are known already.
    void add_parents(std::size_t node, const Stencil& stencil, std::span<const std::size_t> of) {
        Made made{node, &stencil, {}};
        std::size_t generation = 0;
        for (std::size_t i = 0; i < stencil.count; ++i) {
            made.parent[i] = of[stencil.parent[i]];
            generation = std::max(generation, 1 + at(made.parent[i]).generation);
        }
        if (at(node).generation != 0) return;
        at(node).generation = generation;
        if (generations_.size() <= generation) generations_.resize(generation + 1);
        generations_[generation].push_back(made);
    }

    /// Transforms. Calls found(node, detail, integral of its hat function) for each node that has
    /// parents.
    template <class Found>
    void run(const Found& found) {
        std::vector<double> details;
        for (std::size_t g = generations_.size(); g-- > 1;) {
            details.clear();
            for (const Made& made : generations_[g]) {
                const Node& node = nodes_[made.node];
                details.push_back(node.value - mean(made));
                for (std::size_t i = 0; i < made.stencil->count; ++i) {
                    nodes_[made.parent[i]].integral += made.stencil->weight[i] * node.integral;
                }
            }
            for (std::size_t k = 0; k < details.size(); ++k) {
                const Made& made = generations_[g][k];
                const double integral = nodes_[made.node].integral;
                found(made.node, details[k], integral);
                if (!(integral > 0)) continue;
                const double share = details[k] * integral / made.stencil->count;
                for (std::size_t i = 0; i < made.stencil->count; ++i) {
                    Node& parent = nodes_[made.parent[i]];
                    parent.value += share / parent.integral;
                }
            }
        }
    }

private:
    struct Made {
        std::size_t node;
        const Stencil* stencil;
        std::array<std::size_t, max_corners> parent;
    };

    Node& at(std::size_t node) {
        if (node >= nodes_.size()) nodes_.resize(node + 1);
        return nodes_[node];
    }
    double mean(const Made& made) const {
        double sum = 0;
        for (std::size_t i = 0; i < made.stencil->count; ++i) {
            sum += made.stencil->weight[i] * nodes_[made.parent[i]].value;
        }
        return sum;
    }

    std::vector<Node> nodes_;
    std::vector<std::vector<Made>> generations_;
};

}  // namespace nestgrid::engine
