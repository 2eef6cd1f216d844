// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes that may hang, and where they lie.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/detail/shape_functions.hpp>

#include "grid_law.hpp"

namespace nestgrid::detail {

/// A new node, as the first element makes it.
struct HangingCandidate {
    std::size_t known = 0;  // its number in KnownNodes
    NodeKey place = 0;
    std::size_t coarse = 0;  // number of the coarse element that the weights are of
    std::array<double, max_corners> weights{};
    std::size_t parents = 0;
    std::array<NodeKey, max_corners> parent{};  // places
    std::array<double, max_corners> weight{};
    bool given = false;     // whether the grid gives the parents, not the rule
    bool deviates = false;  // whether the value is not the mean of those of the parents
};

/// An element with flat faces, its boundary included.
class ClosedRegion {
public:
    explicit ClosedRegion(const CheckedElement& element) {
        const Topology& t = topology(element.shape);
        const auto x = [&](std::size_t k) { return element.corner[k].position; };
        Point middle{0, 0, 0};
        for (std::size_t k = 0; k < t.corners; ++k) middle = middle + (1.0 / t.corners) * x(k);
        for (std::size_t f = 0; f < t.faces; ++f) {
            const auto& c = t.face[f].corner;
            const Point along = x(c[1]) - x(c[0]);
            const Point normal = t.dimension == 1   ? x(1) - x(0)
                                 : t.dimension == 2 ? Point{along[1], -along[0], 0}
                                                    : cross(along, x(c[2]) - x(c[0]));
            const double height = dot(normal, middle - x(c[0]));
            sides_.push_back({(1 / height) * normal, x(c[0])});
        }
    }

    bool contains(const Point& x) const {
        return std::all_of(sides_.begin(), sides_.end(), [&](const Side& side) {
            return dot(side.inwards, x - side.corner) >= -1e-9;
        });
    }

private:
    struct Side {
        Point inwards;  // as long as makes the distance of the element's middle 1
        Point corner;
    };
    std::vector<Side> sides_;
};

/// The weights of a leaf's corners at the nodes in it, as far as these follow from stencils.
class LeafNodes {
public:
    explicit LeafNodes(const CheckedElement& leaf) : shape_{leaf.shape} {
        for (std::size_t k = 0; k < topology(shape_).corners; ++k) {
            Weights corner{};
            corner[k] = 1;
            known_.insert(leaf.corner[k].place, corner);
        }
    }
    bool has_parents(const HangingCandidate& node) const {
        const auto parents = std::span(node.parent).first(node.parents);
        return std::all_of(parents.begin(), parents.end(),
                           [&](NodeKey place) { return known_.find(place) != nullptr; });
    }
    /// Requires its parents.
    /// \return whether its value is that of the leaf's shape functions
    bool add(const HangingCandidate& node) {
        Weights weights{};
        for (std::size_t p = 0; p < node.parents; ++p) {
            const Weights* parent = known_.find(node.parent[p]);
            for (std::size_t k = 0; k < max_corners; ++k) {
                weights[k] += node.weight[p] * (*parent)[k];
            }
        }
        Point at{0, 0, 0};
        const Topology& t = topology(shape_);
        for (std::size_t k = 0; k < t.corners; ++k) at = at + weights[k] * t.reference[k];
        const Weights wanted = shape_functions(shape_, at);
        for (std::size_t k = 0; k < t.corners; ++k) {
            if (std::abs(wanted[k] - weights[k]) > 1e-9) return false;
        }
        known_.insert(node.place, weights);
        return true;
    }

private:
    using Weights = std::array<double, max_corners>;

    Shape shape_;
    KeyTable<NodeKey, Weights> known_;  // by place
};

}  // namespace nestgrid::detail
