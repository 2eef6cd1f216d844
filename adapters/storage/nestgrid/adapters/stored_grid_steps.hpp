// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of StoredGrid. Included at the end of stored_grid.hpp.
#pragma once

#include <bit>

namespace nestgrid {

template <class Family>
StoredGrid<Family>::StoredGrid(CoarseGrid coarse, const Family& family, const CoarseChecks& checks)
    : coarse_{std::move(coarse)}, family_{family} {
    check_and_orient(coarse_, checks);
    for (std::size_t i = 0; i < coarse_.element_count(); ++i) {
        if (!Family::refines(coarse_.shapes[i])) {
            throw InvalidInput(std::string("the family ") + Family::name + " has no rule for a " +
                               std::string(topology(coarse_.shapes[i]).name) + " (element " +
                               std::to_string(i) + ")");
        }
    }
    orientation_ = detail::prepare(family_, coarse_);
    root_.assign(coarse_.element_count(), none_);
    leaf_count_ = coarse_.element_count();
    node_count_ = used_node_count_ = coarse_.nodes.size();
}

template <class Family>
auto StoredGrid<Family>::coarse(std::size_t i) const -> CoarseElement<Element> {
    CoarseElement<Element> c;
    c.shape = coarse_.shapes[i];
    c.orientation = orientation_[i];
    const auto nodes = coarse_.element(i);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        c.corners[k] = coarse_.nodes[nodes[k]];
        c.ids[k] = c.element.corner[k] = nodes[k];
    }
    c.element.place = {root_[i], static_cast<std::uint16_t>(c.shape), 0, 0};
    return c;
}

namespace detail {

/// std::popcount without the call that it is on processors that may lack the instruction.
constexpr std::uint32_t count_ones(std::uint32_t x) {
#if defined(__POPCNT__)
    return static_cast<std::uint32_t>(std::popcount(x));
#else
    x -= x >> 1U & 0x55555555U;
    x = (x & 0x33333333U) + (x >> 2U & 0x33333333U);
    return ((x + (x >> 4U)) & 0x0F0F0F0FU) * 0x01010101U >> 24U;
#endif
}

}  // namespace detail

template <class Family>
std::span<const std::uint32_t> StoredGrid<Family>::new_nodes(const Element& e,
                                                             Context& context) const {
    const Place& place = e.place;
    auto& known = context.known(place);
    if (known.place == place) return {known.node.data(), known.count};
    const Record r = record(place);
    const Pattern& pattern = table_[place.pattern];
    const auto& entity_of_exit = pattern.exits[place.exit].entity;
    const Pattern::Inner& inner = table_[code_of(place)].inner[place.inner];
    std::array<std::uint32_t, max_entities / 32> before;  // each word of the mask
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < pattern.mask_words(); ++i) {
        before[i] = sum;
        sum += detail::count_ones(r.mask[i]);
    }
    const std::size_t count = inner.entity.size();
    for (std::size_t k = 0; k < count; ++k) {
        const unsigned entity = entity_of_exit[inner.entity[k]];
        const std::uint32_t lower = r.mask[entity / 32] & ((1U << entity % 32) - 1U);
        known.node[k] = r.references[before[entity / 32] + detail::count_ones(lower)];
    }
    known.place = place;
    known.count = static_cast<std::uint32_t>(count);
    return {known.node.data(), count};
}

template <class Family>
void StoredGrid<Family>::children(const Element& e, std::span<Element> out,
                                  Context& context) const {
    const unsigned code = code_of(e.place);
    const Pattern::Inner& inner = table_[code].inner[e.place.inner];
    const Rule& rule = *table_.rule(inner.rule).rule;
    std::array<std::uint32_t, static_cast<std::size_t>(max_corners + max_new_nodes)> node;
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    std::copy_n(e.corner.begin(), corners, node.begin());
    std::ranges::copy(new_nodes(e, context), node.begin() + rule.corner_count());
    const std::uint32_t below = link(e.place);
    for (std::size_t c = 0; c < out.size(); ++c) {
        const Child& child = rule.children[c];
        Element& o = out[c];
        for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
            o.corner[i] = node[child.corner[i]];
        }
        const Pattern::Target target = inner.child[c];
        o.place = target.exit ? Place{below, static_cast<std::uint16_t>(code), target.number, 0}
                              : Place{e.place.record, e.place.pattern, e.place.exit, target.number};
    }
}

template <class Family>
template <class Marker>
Adaptation StoredGrid<Family>::adapt(Marker&& marker) {
    return detail::Rewrite<Family>(*this).run(marker);
}

namespace detail {

/// Walks a stored grid with the positions of its nodes.
template <class Grid, class Visitor>
class PositionWalk {
public:
    PositionWalk(const Grid& grid, Visitor& visitor) : grid_{grid}, visitor_{visitor} {}

    void run() {
        for (std::size_t i = 0; i < grid_.coarse_count(); ++i) {
            const auto c = grid_.coarse(i);
            coarse_ = i;
            visit(c.element, c.shape, 0, c.corners.data());
        }
    }

private:
    using Element = typename Grid::Element;

    void visit(const Element& e, Shape shape, int level, const Point* corners) {
        const std::size_t n = topology(shape).corners;
        const Rule* rule = grid_.split(e);
        visitor_(Leaf{shape, level, coarse_, {corners, n}, {e.corner.data(), n}}, rule == nullptr);
        if (rule == nullptr) return;
        std::array<Point, static_cast<std::size_t>(Grid::max_corners + Grid::max_new_nodes)> x;
        std::copy_n(corners, n, x.begin());
        for (std::size_t k = 0; k < rule->new_nodes.size(); ++k) {
            const Stencil& s = rule->new_nodes[k];
            Point sum{0, 0, 0};
            for (std::size_t i = 0; i < s.count; ++i) sum = sum + s.weight[i] * x[s.parent[i]];
            x[n + k] = sum;
        }
        std::array<Element, static_cast<std::size_t>(Grid::max_children)> child;
        grid_.children(e, std::span(child).first(rule->children.size()), context_);
        for (std::size_t c = 0; c < rule->children.size(); ++c) {
            const Child& to = rule->children[c];
            std::array<Point, static_cast<std::size_t>(Grid::max_corners)> y;
            for (std::size_t i = 0; i < topology(to.shape).corners; ++i) y[i] = x[to.corner[i]];
            visit(child[c], to.shape, level + 1, y.data());
        }
    }

    const Grid& grid_;
    Visitor& visitor_;
    typename Grid::Context context_;
    std::size_t coarse_ = 0;
};

}  // namespace detail

template <class Family>
template <class Function>
void StoredGrid<Family>::for_each_leaf(Function&& function) const {
    const auto visit = [&](const Leaf& element, bool is_leaf) {
        if (is_leaf) function(element);
    };
    detail::PositionWalk<StoredGrid, decltype(visit)>(*this, visit).run();
}

template <class Family>
std::vector<Point> StoredGrid<Family>::node_positions() const {
    std::vector<Point> x(node_count_, Point{0, 0, 0});
    for_each_leaf([&](const Leaf& leaf) {
        for (std::size_t i = 0; i < leaf.nodes.size(); ++i) x[leaf.nodes[i]] = leaf.corners[i];
    });
    return x;
}

}  // namespace nestgrid
