// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A forest that offers the optional operations it is told to offer, and errs at one place.
#pragma once

#include <map>
#include <set>

#include <nestgrid/algorithms/hanging_nodes.hpp>

#include "forest.hpp"

namespace nestgrid_test {

template <int dim>
class MutantGrid {
public:
    using Element = std::uint32_t;
    static constexpr int dimension = dim;

    explicit MutantGrid(const Forest<dim>& f) : forest{f}, positions{f.positions}, keys{f.keys} {
        const HangingNodes derived = derive_hanging_nodes(forest);
        for (std::uint32_t n = 0; n < keys.size(); ++n) {
            if (derived.contains(keys[n])) hanging.insert(n);
        }
    }

    std::size_t coarse_count() const { return forest.coarse_count(); }
    CoarseElement<Element> coarse(std::size_t i) const {
        auto c = forest.coarse(i);
        if (i == coarse_at) change_coarse(c);
        return c;
    }
    const Rule* split(Element e) const {
        if (e == forgets && asked++ % 2 == 1) return nullptr;
        const auto at = rules.find(e);
        return at != rules.end() ? at->second : forest.split(e);
    }
    void children(Element e, std::span<Element> out) const { forest.children(e, out); }

    bool offers(Feature feature) const { return (features & static_cast<unsigned>(feature)) != 0; }
    void corner_keys(Element e, std::span<NodeKey> out) const {
        const auto& cell = forest.cells[e];
        for (std::size_t k = 0; k < topology(cell.shape).corners; ++k) {
            out[k] = keys[cell.nodes[k]] + (e == rekeyed && k == corner ? 77 : 0);
        }
    }
    void new_keys(Element e, std::span<NodeKey> out) const {
        const auto& cell = forest.cells[e];
        const std::size_t corners = topology(cell.shape).corners;
        for (std::size_t n = 0; n < out.size(); ++n) out[n] = keys[cell.nodes[corners + n]];
    }
    std::size_t node_count() const { return keys.size(); }
    void corner_positions(Element e, std::span<Point> out) const {
        const auto& cell = forest.cells[e];
        for (std::size_t k = 0; k < topology(cell.shape).corners; ++k) {
            out[k] = positions[cell.nodes[k]];
            if (e == moved && k == corner) out[k][0] = std::nextafter(out[k][0], 1e9);
        }
    }
    NodeMask constrained(Element e) const {
        const auto& cell = forest.cells[e];
        const std::size_t corners = topology(cell.shape).corners;
        NodeMask mask = 0;
        for (std::size_t n = 0; corners + n < cell.nodes.size(); ++n) {
            if (hanging.contains(cell.nodes[corners + n])) mask |= NodeMask{1} << n;
        }
        return mask;
    }
    bool conforming() const { return says_conforming; }
    Hidden hidden(Element e) const {
        const auto at = hides.find(e);
        return at == hides.end() ? Hidden::not_at_all : at->second;
    }

    static constexpr Element nowhere = 0xFFFFFFFFU;
    Forest<dim> forest;
    std::vector<Point> positions;
    std::vector<NodeKey> keys;
    std::set<std::uint32_t> hanging;
    std::map<Element, const Rule*> rules;
    std::map<Element, Hidden> hides;
    unsigned features = 0;
    bool says_conforming = false;
    std::size_t corner = 0;
    Element forgets = nowhere;
    Element rekeyed = nowhere;
    Element moved = nowhere;
    std::size_t coarse_at = ~std::size_t{0};
    std::function<void(CoarseElement<Element>&)> change_coarse;
    mutable int asked = 0;
};

template <int dim>
class MutantField {
public:
    using value_type = double;

    MutantField(const MutantGrid<dim>& grid, const std::function<double(const Point&)>& f)
        : forest_{&grid.forest}, field{grid.forest, f} {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return field.coarse_values(i, out);
    }
    NodeMask new_values(std::uint32_t e, NodeMask which, std::span<double> out) const {
        field.new_values(e, which, out);
        if (e == differs) out[node] += 1;
        return e == misses ? NodeMask{1} << node : NodeMask{0};
    }

private:
    const Forest<dim>* forest_;

public:
    ForestField<dim> field;
    std::uint32_t differs = MutantGrid<dim>::nowhere;
    std::uint32_t misses = MutantGrid<dim>::nowhere;
    std::size_t node = 0;
};

}  // namespace nestgrid_test
