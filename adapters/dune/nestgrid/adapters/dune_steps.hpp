// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of DuneGrid. Included at the end of dune.hpp.
#pragma once

namespace nestgrid {

template <class DuneType, class Traits>
DuneGrid<DuneType, Traits>::DuneGrid(const DuneType& grid)
    : grid_{&grid}, thread_{std::this_thread::get_id()} {
    if (grid.comm().size() > 1) {
        throw InvalidInput("the Dune grid is distributed over " +
                           std::to_string(grid.comm().size()) +
                           " processes; only grids on one process can be walked");
    }
    std::vector<Element> children;
    std::vector<PlacedChild> placed;
    const auto add_rule = [&](const Element& e) {
        if (e.isLeaf()) return;
        Traits::children(grid, e, children);
        rules_.add(e, children, placed);
    };
    for (const Element& e : elements(grid.levelGridView(0))) {
        if (e.partitionType() != Dune::InteriorEntity) {
            throw InvalidInput(
                "the Dune grid has overlap or ghost elements: it is periodic or part of a "
                "distributed one");
        }
        detail::dune_shape(e.type());
        coarse_.push_back(e.seed());
        add_rule(e);
        for (const Element& d : descendantElements(e, grid.maxLevel())) add_rule(d);
    }
    grid.leafIndexSet();
}

template <class DuneType, class Traits>
auto DuneGrid<DuneType, Traits>::coarse(std::size_t i) const -> CoarseElement<Element> {
    CoarseElement<Element> c;
    c.element = coarse_entity(i);
    c.shape = detail::dune_shape(c.element.type());
    const std::size_t corners = topology(c.shape).corners;
    const auto geometry = c.element.geometry();
    for (std::size_t k = 0; k < corners; ++k) {
        c.corners[k] = detail::dune_point(geometry.corner(static_cast<int>(k)));
        c.ids[k] = id(c.element, k);
    }
    if (dimension == 3 && measure(c.shape, std::span(c.corners).first(corners)) < 0) {
        c.orientation = -1;
    }
    return c;
}

template <class DuneType, class Traits>
auto DuneGrid<DuneType, Traits>::open(const Element& e, Opened& opened) const -> const Opened& {
    if (opened.known && opened.element == e) return opened;
    opened.known = false;
    Traits::children(*grid_, e, opened.children);
    opened.rule = rules_.find(e, opened.children, opened.placed);
    if (opened.rule == nullptr) {
        throw GridError("the Dune grid was adapted; its adapter must be made anew");
    }
    opened.element = e;
    opened.known = true;
    return opened;
}

template <class DuneType, class Traits>
std::pair<std::size_t, int> DuneGrid<DuneType, Traits>::child_at_corner(const Rule& rule,
                                                                        int corner) {
    for (std::size_t c = 0;; ++c) {
        const auto& corners = rule.children[c].corner;
        const int count = topology(rule.children[c].shape).corners;
        for (int i = 0; i < count; ++i) {
            if (corners[static_cast<std::size_t>(i)] == corner) return {c, i};
        }
    }
}

template <class DuneType, class Traits>
template <class Function>
void DuneGrid<DuneType, Traits>::for_each_new_corner(const Element& e, NodeMask which,
                                                     Context& context, Function&& f) const {
    const auto& opened = open(e, context.opened_);
    for (std::size_t n = 0; n < opened.rule->new_nodes.size(); ++n) {
        if ((which >> n & 1U) == 0) continue;
        const ChildCorner at = opened.rule->new_corner[n];
        f(n, opened.children[at.child], static_cast<int>(at.corner));
    }
}

template <class DuneType, class Traits>
template <class Function>
decltype(auto) DuneGrid<DuneType, Traits>::at_leaf(const Element& e, int corner, Context& context,
                                                   Function&& f) const {
    Element leaf = e;
    while (!leaf.isLeaf()) {
        const auto& opened = open(leaf, context.below_);
        const auto [child, at] = child_at_corner(*opened.rule, corner);
        leaf = Element(opened.children[child]);
        corner = at;
    }
    return f(leaf, corner);
}

}  // namespace nestgrid
