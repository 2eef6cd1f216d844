// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Any hierarchy, as a table of its elements, of which each leaf is given to a rank; and what one
// rank sees of it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/detail/operations.hpp>
#include <nestgrid/grid.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// The elements and nodes of a hierarchy, the grid of which must outlive them.
class Whole {
public:
    struct Element {
        const Rule* rule;
        Shape shape;
        std::uint32_t first_node;   ///< in numbers(): corners, then new nodes
        std::uint32_t first_child;  ///< the children follow each other
        std::uint32_t first_leaf;
        std::uint32_t last_leaf;  ///< one behind
    };
    struct Coarse {
        std::uint32_t element;
        std::array<Point, max_corners> corners;
        std::array<std::uint64_t, max_corners> ids;
        std::int8_t orientation;
    };

    template <class Grid>
    explicit Whole(const Grid& grid) : dimension{Grid::dimension} {
        auto context = make_context(grid);
        std::vector<ElementOf<Grid>> tops;
        for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
            const auto from = detail::call_coarse(grid, context, i);
            coarse.push_back({static_cast<std::uint32_t>(elements.size()), from.corners, from.ids,
                              from.orientation});
            std::vector<std::uint32_t> corners;
            for (std::size_t k = 0; k < topology(from.shape).corners; ++k) {
                corners.push_back(number(coarse_key(from.ids[k]), from.corners[k]));
            }
            add_element(from.shape, corners);
            tops.push_back(from.element);
        }
        for (std::size_t i = 0; i < tops.size(); ++i)
            build(grid, context, tops[i], coarse[i].element);
    }

    /// Moves all nodes, so that the grid is a curved one.
    void curve() {
        curved = true;
        const auto moved = [](const Point& x) {
            return Point{x[0] + 0.05 * std::sin(5 * x[1] + 3 * x[2]),
                         x[1] + 0.04 * std::sin(4 * x[0] + 1), x[2] + 0.03 * x[0] * x[1]};
        };
        std::ranges::transform(positions, positions.begin(), moved);
        for (Coarse& c : coarse) std::ranges::transform(c.corners, c.corners.begin(), moved);
    }

    /// Gives each leaf to a rank.
    enum class Cut { in_order, in_runs, leaf_by_leaf, to_every_third };
    std::vector<int> partition(int ranks, Cut how, std::mt19937& random) const {
        std::vector<int> owner(leaves);
        const auto any = [&] { return static_cast<int>(random() % static_cast<unsigned>(ranks)); };
        int now = any();
        for (std::size_t i = 0; i < leaves; ++i) {
            if (how == Cut::leaf_by_leaf || random() % 9 == 0) now = any();
            owner[i] = how == Cut::in_order
                           ? static_cast<int>(i * static_cast<std::size_t>(ranks) / leaves)
                           : now;
            if (how == Cut::to_every_third) owner[i] -= owner[i] % 3;
        }
        return owner;
    }

    std::span<const std::uint32_t> nodes_of(const Element& e) const {
        const std::size_t count =
            topology(e.shape).corners + (e.rule == nullptr ? 0 : e.rule->new_nodes.size());
        return std::span(numbers).subspan(e.first_node, count);
    }

    int dimension;
    std::vector<Element> elements;
    std::vector<Coarse> coarse;
    std::vector<std::uint32_t> numbers;
    std::vector<NodeKey> keys;     ///< derived, by number
    std::vector<Point> positions;  ///< likewise
    std::uint32_t leaves = 0;
    bool curved = false;  ///< the positions are not those between the corners

private:
    std::uint32_t number(NodeKey key, const Point& at) {
        const auto [found, is_new] =
            number_of_.insert(key, static_cast<std::uint32_t>(positions.size()));
        if (is_new) {
            keys.push_back(key);
            positions.push_back(at);
        }
        return *found;
    }

    /// An element that is not split yet, with room for new nodes behind its corners.
    void add_element(Shape shape, std::span<const std::uint32_t> corners) {
        elements.push_back({nullptr, shape, static_cast<std::uint32_t>(numbers.size()), 0, 0, 0});
        numbers.insert(numbers.end(), corners.begin(), corners.end());
        numbers.resize(numbers.size() + max_new_nodes);
    }

    template <class Grid, class AnyContext>
    void build(const Grid& grid, AnyContext& context, const ElementOf<Grid>& element,
               std::uint32_t at) {
        const Rule* const rule = detail::call_split(grid, context, element);
        elements[at].rule = rule;
        elements[at].first_leaf = leaves;
        if (rule == nullptr) {
            elements[at].last_leaf = ++leaves;
            return;
        }
        const std::vector<std::uint32_t> nodes = add_new_nodes(*rule, at);
        std::vector<ElementOf<Grid>> children(rule->children.size());
        detail::call_children(grid, context, element, std::span(children));
        const auto first = static_cast<std::uint32_t>(elements.size());
        elements[at].first_child = first;
        for (const Child& child : rule->children) {
            std::vector<std::uint32_t> corners;
            for (std::size_t k = 0; k < topology(child.shape).corners; ++k) {
                corners.push_back(nodes[child.corner[k]]);
            }
            add_element(child.shape, corners);
        }
        for (std::size_t c = 0; c < children.size(); ++c) {
            build(grid, context, children[c], first + static_cast<std::uint32_t>(c));
        }
        elements[at].last_leaf = leaves;
    }
    std::vector<std::uint32_t> add_new_nodes(const Rule& rule, std::uint32_t at) {
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        std::array<NodeKey, max_corners + max_new_nodes> key;
        std::array<Point, max_corners + max_new_nodes> x;
        std::vector<std::uint32_t> nodes;
        for (std::size_t k = 0; k < corners; ++k) {
            nodes.push_back(numbers[elements[at].first_node + k]);
            key[k] = keys[nodes[k]];
            x[k] = positions[nodes[k]];
        }
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            key[corners + n] = derived_key(rule.new_nodes[n], key.data());
            x[corners + n] = detail::interpolate(rule.new_nodes[n], x.data());
            nodes.push_back(number(key[corners + n], x[corners + n]));
            numbers[elements[at].first_node + corners + n] = nodes.back();
        }
        return nodes;
    }

    KeyTable<NodeKey, std::uint32_t> number_of_;
};

/// What of a hierarchy one rank has.
struct Part {
    Part(const Whole& whole, const std::vector<int>& owner, int rank)
        : presence(whole.elements.size()),
          own_nodes(whole.elements.size()),
          visited(whole.positions.size()) {
        std::vector<std::uint32_t> before(owner.size() + 1, 0);
        for (std::size_t i = 0; i < owner.size(); ++i) {
            before[i + 1] = before[i] + (owner[i] == rank ? 1 : 0);
        }
        for (std::size_t e = 0; e < whole.elements.size(); ++e) {
            const Whole::Element& element = whole.elements[e];
            const std::uint32_t mine = before[element.last_leaf] - before[element.first_leaf];
            const bool has_first = owner[element.first_leaf] == rank;
            presence[e] = mine == 0                                        ? Presence::elsewhere
                          : mine == element.last_leaf - element.first_leaf ? Presence::here
                          : has_first                                      ? Presence::partly_first
                                                                           : Presence::partly;
            if (mine == 0) continue;
            for (const std::uint32_t node : whole.nodes_of(element)) visited[node] = true;
        }
        for (const Whole::Coarse& c : whole.coarse) find_own(whole, c.element);
    }

    std::vector<Presence> presence;   ///< of each element
    std::vector<NodeMask> own_nodes;  ///< of each element: nodes that own leaves below it have
    std::vector<bool> visited;        ///< nodes of elements that are not elsewhere

private:
    /// \return the numbers of the corners of own leaves below an element, in order
    std::vector<std::uint32_t> find_own(const Whole& whole, std::uint32_t e) {
        const Whole::Element& element = whole.elements[e];
        std::vector<std::uint32_t> own;
        if (presence[e] == Presence::elsewhere) return own;
        const std::span<const std::uint32_t> nodes = whole.nodes_of(element);
        if (element.rule == nullptr) own.assign(nodes.begin(), nodes.end());
        for (std::size_t c = 0; element.rule != nullptr && c < element.rule->children.size(); ++c) {
            const auto below = find_own(whole, element.first_child + static_cast<std::uint32_t>(c));
            own.insert(own.end(), below.begin(), below.end());
        }
        std::sort(own.begin(), own.end());
        own.erase(std::unique(own.begin(), own.end()), own.end());
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const bool has = std::binary_search(own.begin(), own.end(), nodes[n]);
            own_nodes[e] |= NodeMask{has} << n;
        }
        return own;
    }
};

/// A hierarchy as one rank has it, or the whole of it.
template <int dim>
class CutGrid {
public:
    static constexpr int dimension = dim;
    struct Element {
        std::uint32_t at;
    };

    /// \param part null for the whole
    CutGrid(const Whole& whole, const Part* part, bool own_keys)
        : whole_{&whole}, part_{part}, own_keys_{own_keys} {}

    bool offers(Feature feature) const {
        return feature == Feature::presence        ? part_ != nullptr
               : feature == Feature::new_positions ? whole_->curved
                                                   : own_keys_;
    }
    std::size_t coarse_count() const { return whole_->coarse.size(); }
    CoarseElement<Element> coarse(std::size_t i) const {
        const Whole::Coarse& from = whole_->coarse[i];
        CoarseElement<Element> to;
        to.element = {from.element};
        to.shape = whole_->elements[from.element].shape;
        to.corners = from.corners;
        to.ids = from.ids;
        to.orientation = from.orientation;
        return to;
    }
    const Rule* split(const Element& e) const { return whole_->elements[e.at].rule; }
    void children(const Element& e, std::span<Element> out) const {
        for (std::size_t c = 0; c < out.size(); ++c) {
            out[c] = {whole_->elements[e.at].first_child + static_cast<std::uint32_t>(c)};
        }
    }
    void corner_keys(const Element& e, std::span<NodeKey> out) const { put_keys(e, 0, out); }
    void new_keys(const Element& e, std::span<NodeKey> out) const {
        put_keys(e, topology(whole_->elements[e.at].shape).corners, out);
    }
    void new_positions(const Element& e, NodeMask which, std::span<Point> out) const {
        const Whole::Element& element = whole_->elements[e.at];
        const std::span<const std::uint32_t> nodes =
            whole_->nodes_of(element).subspan(topology(element.shape).corners);
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            if ((which >> n & 1U) != 0) out[n] = whole_->positions[nodes[n]];
        }
    }
    std::size_t node_count() const { return whole_->positions.size(); }
    Presence presence(const Element& e) const { return part_->presence[e.at]; }

    const Whole& table() const { return *whole_; }
    const Part* part() const { return part_; }
    NodeKey key(std::size_t number) const {
        return own_keys_ ? static_cast<NodeKey>(number) : whole_->keys[number];
    }

private:
    void put_keys(const Element& e, std::size_t first, std::span<NodeKey> out) const {
        const std::span<const std::uint32_t> nodes = whole_->nodes_of(whole_->elements[e.at]);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = nodes[first + i];
    }

    const Whole* whole_;
    const Part* part_;
    bool own_keys_;
};

/// Two components. Where an element is here in part, it says `missing` for nodes that no own leaf
/// below that element has, although another one may.
template <int dim, class Real>
struct CutField {
    static constexpr int components = 2;
    using value_type = Real;

    NodeMask coarse_values(std::size_t i, std::span<Real> out) const {
        return put({cut->table().coarse[i].element}, 0, out.size() / components, out);
    }
    NodeMask new_values(const typename CutGrid<dim>::Element& e, NodeMask /*which*/,
                        std::span<Real> out) const {
        return put(e, topology(cut->table().elements[e.at].shape).corners, out.size() / components,
                   out);
    }

    const CutGrid<dim>* cut;
    const std::vector<Real>* values;  ///< by number of the node

private:
    NodeMask put(const typename CutGrid<dim>::Element& e, std::size_t first, std::size_t count,
                 std::span<Real> out) const {
        const std::span<const std::uint32_t> nodes =
            cut->table().nodes_of(cut->table().elements[e.at]);
        NodeMask missing = 0;
        for (std::size_t n = 0; n < count; ++n) {
            const bool has =
                cut->part() == nullptr || (cut->part()->own_nodes[e.at] >> (first + n) & 1U) != 0;
            missing |= NodeMask{!has} << n;
            for (std::size_t c = 0; c < components; ++c) {
                out[n * components + c] = has ? (*values)[components * nodes[first + n] + c]
                                              : std::numeric_limits<Real>::quiet_NaN();
            }
        }
        return missing;
    }
};

}  // namespace nestgrid_test
