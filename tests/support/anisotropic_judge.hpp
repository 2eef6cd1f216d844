// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A judge that says by geometry alone whether the nodes of a grid hang on their own parents, and
// grids that give what the judge sees: keys, and the parents of nodes on edges.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>

#include <nestgrid/detail/shape_functions.hpp>

#include "closedness.hpp"
#include "forest.hpp"

namespace nestgrid_test {

/// Nodes of a grid by where they are; the grid has neither slits nor curved elements.
class Places {
public:
    explicit Places(const Forest<3>& forest) {
        for (const Point& x : forest.positions) {
            const auto [at, is_new] = number_.try_emplace(x, positions.size());
            if (is_new) positions.push_back(x);
            of_node.push_back(at->second);
        }
    }
    /// Those in the box around a cell.
    std::vector<std::size_t> around(const Forest<3>& forest, const Forest<3>::Cell& cell) const {
        Point low = forest.positions[cell.nodes[0]];
        Point high = low;
        for (std::size_t k = 1; k < topology(cell.shape).corners; ++k) {
            for (std::size_t d = 0; d < 3; ++d) {
                low[d] = std::min(low[d], forest.positions[cell.nodes[k]][d]);
                high[d] = std::max(high[d], forest.positions[cell.nodes[k]][d]);
            }
        }
        std::vector<std::size_t> result;
        for (std::size_t p = 0; p < positions.size(); ++p) {
            const Point& x = positions[p];
            if (x[0] >= low[0] && x[0] <= high[0] && x[1] >= low[1] && x[1] <= high[1] &&
                x[2] >= low[2] && x[2] <= high[2]) {
                result.push_back(p);
            }
        }
        return result;
    }
    std::optional<std::size_t> find(const Point& x) const {
        const auto at = number_.find(x);
        return at == number_.end() ? std::nullopt : std::optional(at->second);
    }
    std::vector<std::size_t> of_node;
    std::vector<Point> positions;

private:
    std::map<Point, std::size_t> number_;
};

/// For each node that hangs inside an edge of a leaf: the ends of the part of the edge in whose
/// middle it lies, when edges are halved again and again. By places.
struct ParentsOnEdges {
    std::map<std::size_t, std::set<std::size_t>> of;
    bool unique = true;  ///< no node lies between other ends on another edge, nor between no nodes
};

inline ParentsOnEdges find_parents_on_edges(const Forest<3>& forest, const Places& places) {
    ParentsOnEdges parents;
    for (const auto& cell : forest.cells) {
        if (cell.rule != nullptr) continue;
        const Topology& t = topology(cell.shape);
        const std::vector<std::size_t> near = places.around(forest, cell);
        for (std::size_t e = 0; e < t.edges; ++e) {
            const Point& a = forest.positions[cell.nodes[t.edge[e][0]]];
            const Point& b = forest.positions[cell.nodes[t.edge[e][1]]];
            for (const std::size_t p : near) {
                const Point& x = places.positions[p];
                const double at = dot(x - a, b - a) / dot(b - a, b - a);
                if (!(at > 0 && at < 1) || !(x == a + at * (b - a))) continue;
                Point low = a;
                Point high = b;
                for (Point middle = 0.5 * (a + b); middle != x; middle = 0.5 * (low + high)) {
                    (norm(x - a) < norm(middle - a) ? high : low) = middle;
                }
                const auto first = places.find(low);
                const auto second = places.find(high);
                parents.unique = parents.unique && first && second;
                if (!first || !second) continue;
                const std::set<std::size_t> ends{*first, *second};
                parents.unique =
                    parents.unique && parents.of.try_emplace(p, ends).first->second == ends;
            }
        }
    }
    return parents;
}

/// Whether on every leaf each node that lies in it without being a corner has the value that the
/// leaf has there, whatever the values of the nodes that hang nowhere; and each node one stencil.
/// With parents: those of the nodes that hang inside edges are known; a node that hangs on several
/// edges has the same parents on all of them, and one that hangs elsewhere has one stencil.
class Judge {
public:
    Judge(const Forest<3>& forest, std::mt19937& random, bool with_parents = false)
        : forest_{&forest}, places_{forest} {
        if (with_parents) parents_ = find_parents_on_edges(forest, places_);
        value_.resize(places_.positions.size());
        hangs_.resize(value_.size());
        find_hanging();
        find_stencils();
        for (double& v : value_) v = uniform(random);
        for (auto& [place, stencils] : stencils_) {
            one_stencil_ = one_stencil_ && stencils.size() == 1;
            const bool has_value = parents_.of.contains(place) || (with_parents && !hangs_[place]);
            if (!has_value) one_value_ = one_value_ && stencils.size() == 1;
        }
        for (std::size_t p = 0; p < value_.size(); ++p) interpolate(p);
    }

    bool supports() const { return one_value_ && parents_.unique && leaves_agree(); }
    /// Whether elements make all nodes alike.
    bool has_one_stencil() const { return one_stencil_; }
    std::size_t hanging() const { return hanging_.size(); }

private:
    struct Hanging {
        const Forest<3>::Cell* leaf;
        std::size_t place;
        Point at;  // in the leaf
    };

    const Point& corner(const Forest<3>::Cell& cell, std::size_t k) const {
        return forest_->positions[cell.nodes[k]];
    }

    /// Reference coordinates in an element, which is an affine image of its reference element.
    Point place_in(const Forest<3>::Cell& cell, const Point& x) const {
        const bool prism = cell.shape == Shape::prism;
        const Point u = corner(cell, 1) - corner(cell, 0);
        const Point v = corner(cell, 2) - corner(cell, 0);
        const Point w = corner(cell, prism ? 3 : 4) - corner(cell, 0);
        const Point r = x - corner(cell, 0);
        const double volume = dot(u, cross(v, w));
        return {dot(r, cross(v, w)) / volume, dot(r, cross(w, u)) / volume,
                dot(r, cross(u, v)) / volume};
    }

    void find_hanging() {
        for (const auto& cell : forest_->cells) {
            if (cell.rule != nullptr) continue;
            std::set<std::size_t> corners;
            for (const std::uint32_t node : cell.nodes) corners.insert(places_.of_node[node]);
            for (const std::size_t p : places_.around(*forest_, cell)) {
                const Point at = place_in(cell, places_.positions[p]);
                const auto [least, most] = std::minmax({at[0], at[1], at[2]});
                if (least < 0 || most > 1 || corners.contains(p)) continue;
                if (cell.shape == Shape::prism && at[0] + at[1] > 1) continue;
                hanging_.push_back({&cell, p, at});
                hangs_[p] = true;
            }
        }
    }

    using WeightAt = std::map<std::size_t, double>;  // by parent

    void find_stencils() {
        for (const auto& cell : forest_->cells) {
            for (std::size_t n = 0; cell.rule != nullptr && n < cell.rule->new_nodes.size(); ++n) {
                const Stencil& s = cell.rule->new_nodes[n];
                WeightAt stencil;
                for (std::size_t i = 0; i < s.count; ++i) {
                    stencil[places_.of_node[cell.nodes[s.parent[i]]]] = s.weight[i];
                }
                const std::size_t node =
                    places_.of_node[cell.nodes[topology(cell.shape).corners + n]];
                stencils_[node].insert(stencil);
            }
        }
    }

    /// Gives a hanging node the mean of its parents, after these.
    void interpolate(std::size_t place) {
        if (!hangs_[place] || !stencils_.contains(place) || !done_.insert(place).second) return;
        WeightAt stencil = *stencils_.at(place).begin();
        if (const auto given = parents_.of.find(place); given != parents_.of.end()) {
            stencil.clear();
            for (const std::size_t parent : given->second) stencil[parent] = 0.5;
        }
        double mean = 0;
        for (const auto& [parent, weight] : stencil) {
            interpolate(parent);
            mean += weight * value_[parent];
        }
        value_[place] = mean;
    }

    bool leaves_agree() const {
        return std::all_of(hanging_.begin(), hanging_.end(), [&](const Hanging& h) {
            const auto weights = shape_functions(h.leaf->shape, h.at);
            double value = 0;
            for (std::size_t k = 0; k < topology(h.leaf->shape).corners; ++k) {
                value += weights[k] * value_[places_.of_node[h.leaf->nodes[k]]];
            }
            return std::abs(value - value_[h.place]) < 1e-12;
        });
    }

    const Forest<3>* forest_;
    Places places_;
    std::vector<double> value_;  // by place
    std::vector<bool> hangs_;
    std::vector<Hanging> hanging_;
    ParentsOnEdges parents_;
    std::map<std::size_t, std::set<WeightAt>> stencils_;  // by place
    std::set<std::size_t> done_;
    bool one_stencil_ = true;
    bool one_value_ = true;
};

/// The same grid with the numbers of places for keys: a node has one, whatever makes it.
class KeysByPlace {
public:
    using Element = Forest<3>::Element;
    static constexpr int dimension = 3;

    explicit KeysByPlace(const Forest<3>& forest) : forest_{&forest}, places_{forest} {}
    std::size_t coarse_count() const { return forest_->coarse_count(); }
    CoarseElement<Element> coarse(std::size_t i) const { return forest_->coarse(i); }
    const Rule* split(Element e) const { return forest_->split(e); }
    void children(Element e, std::span<Element> out) const { forest_->children(e, out); }
    void corner_keys(Element e, std::span<NodeKey> out) const { keys(e, 0, out); }
    void new_keys(Element e, std::span<NodeKey> out) const {
        keys(e, topology(forest_->cells[e].shape).corners, out);
    }

private:
    void keys(Element e, std::size_t first, std::span<NodeKey> out) const {
        const auto& nodes = forest_->cells[e].nodes;
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = places_.of_node[nodes[first + k]];
    }
    const Forest<3>* forest_;

protected:
    Places places_;
};

/// The same grid, which gives the parents of nodes that hang on edges.
class ParentsByPlace : public KeysByPlace {
public:
    explicit ParentsByPlace(const Forest<3>& forest)
        : KeysByPlace(forest), parents_{find_parents_on_edges(forest, places_)} {}
    std::array<NodeKey, 2> hanging_parents(NodeKey node) const {
        const auto at = parents_.of.find(static_cast<std::size_t>(node));
        if (at == parents_.of.end()) return {node, node};
        return {*at->second.begin(), *at->second.rbegin()};
    }

private:
    ParentsOnEdges parents_;
};

}  // namespace nestgrid_test
