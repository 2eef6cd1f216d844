// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Random hexahedra and prisms, each divided in some of its directions, and a judge that says by
// geometry alone whether nodes hang on their own parents.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>

#include <nestgrid/detail/shape_functions.hpp>

#include "closedness.hpp"
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
    for (std::uint32_t i = 0; i < 2 * 3 * (rows + 1); ++i) {
        forest.add_node({double(i % 3), double(i / 3 % (rows + 1)), double(i / 3 / (rows + 1))});
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
