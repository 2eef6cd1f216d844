// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One economical store for all families of hierarchies (paper, section 8): coordinates and
// elements of the coarse grid, below it patterns and references to new nodes.
//
// Invariants:
//   - a record belongs to a refined element that has a refined exit. It holds, in 32-bit words,
//     the pattern of every exit (16 bits: 0 for a leaf, the highest bit where the exit has a
//     record), the set of entities that carry a node, the places of the exits' records, and one
//     reference per entity in the set;
//   - records stand in the order of a depth-first traversal; one record per coarse element, with
//     the pattern "unrefined", is the root.
// Consequences: a leaf costs 16 bits, a node one reference in each family of siblings that makes
// it, and nothing depends on the history of the grid: an adaptation writes the store anew.
#pragma once

#include <bit>
#include <functional>
#include <optional>

#include <nestgrid/adapters/coarse_checks.hpp>
#include <nestgrid/adapters/family.hpp>
#include <nestgrid/adapters/leaf_walk.hpp>
#include <nestgrid/adapters/node_field.hpp>
#include <nestgrid/adapters/work_tree.hpp>
#include <nestgrid/detail/constants.hpp>
#include <nestgrid/detail/erase.hpp>
#include <nestgrid/optional.hpp>

namespace nestgrid {

/// Tells what to do with a leaf.
using Marker = std::function<Mark(const Leaf&)>;

/// What an adaptation has done.
struct Adaptation {
    std::size_t marked = 0;     ///< leaves marked for refinement
    std::size_t coarsened = 0;  ///< families that were marked for coarsening and carried out
    /// Nodes that are new, in an order in which parents come first, and the parents of the i-th:
    /// parent[first_parent[i]] ... parent[first_parent[i + 1] - 1]. A new value is their mean.
    std::vector<std::uint32_t> created;
    std::vector<std::uint32_t> first_parent{0};
    std::vector<std::uint32_t> parent;

    /// Values at new nodes by interpolation; others are untouched.
    /// \param values one per node of the grid; is resized to `node_count`
    template <class Real>
    void interpolate(std::vector<Real>& values, std::size_t node_count) const {
        values.resize(node_count);
        for (std::size_t i = 0; i < created.size(); ++i) {
            Real sum = 0;
            for (std::size_t k = first_parent[i]; k < first_parent[i + 1]; ++k) {
                sum += values[parent[k]];
            }
            values[created[i]] = sum / static_cast<Real>(first_parent[i + 1] - first_parent[i]);
        }
    }
};

namespace detail {

template <class Family>
class Rewrite;
template <class Family>
class GridFile;

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

/// A nested grid that owns its hierarchy. A family says which shapes and rules there are and what
/// its closure demands: family.hpp. Grids of the library's families are compiled in it; others
/// where they are used.
template <class Family>
class StoredGrid {
public:
    static constexpr int dimension = Family::dimension;
    static constexpr int max_corners = Family::max_corners;
    static constexpr int max_new_nodes = Family::max_new_nodes;
    static constexpr int max_children = Family::max_children;
    static constexpr Shape only_shape = detail::only_shape<Family>();

    /// Where an element stands in the store.
    struct Place {
        std::uint32_t record;   ///< where the pattern of the refined element stands, or none_
        std::uint16_t pattern;  ///< that this record belongs to
        std::uint8_t exit;      ///< of that pattern, which is the refined element
        std::uint8_t inner;     ///< element inside the pattern that refines it

        friend bool operator==(const Place&, const Place&) = default;
    };
    struct Element {
        std::array<std::uint32_t, static_cast<std::size_t>(Family::max_corners)> corner;
        Place place;
    };

    /// New nodes of the elements that were asked about last: one operation after the other wants
    /// them, and a walk describes all children of an element before it enters the first one. Of
    /// the grid as it is: adapt() and renumber() make it void.
    class Context {
        friend StoredGrid;
        struct Known {
            Place place{none_, 0, 0, 0};
            std::uint32_t count = 0;
            std::array<std::uint32_t, static_cast<std::size_t>(Family::max_new_nodes)> node;
        };
        /// Where the nodes of an element are kept, if they are.
        Known& known(const Place& place) {
            return known_[(place.record + place.inner * 5U + place.exit * 3U) % known_.size()];
        }
        std::array<Known, 32> known_;
    };
    Context make_context() const { return {}; }

    /// \throw InvalidInput where the coarse grid fails check_and_orient(), or the family has no
    ///        rule for a shape of it
    explicit StoredGrid(CoarseGrid coarse, const Family& family = {},
                        const CoarseChecks& checks = {});

    // Required operations.
    std::size_t coarse_count() const { return coarse_.element_count(); }
    CoarseElement<Element> coarse(std::size_t i) const;
    const Rule* split(const Element& e) const {
        const unsigned code = code_of(e.place);
        if (code == 0) return nullptr;
        return table_.rule(table_[code].inner[e.place.inner].rule).rule.get();
    }
    void children(const Element& e, std::span<Element> out, Context& context) const;

    // Optional operations.
    std::size_t node_count() const { return node_count_; }
    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        std::copy_n(e.corner.begin(), out.size(), out.begin());
    }
    void new_keys(const Element& e, std::span<NodeKey> out, Context& context) const {
        std::ranges::copy(new_nodes(e, context), out.begin());
    }
    bool conforming() const requires(Family::conforming) { return true; }
    NodeMask constrained(const Element& e, Context& context) const requires(!Family::conforming) {
        NodeMask mask = 0;
        if (code_of(e.place) == 0 || hanging_.empty()) return mask;
        const std::span<const std::uint32_t> nodes = new_nodes(e, context);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            mask |= NodeMask{hanging_[nodes[k] / 32] >> (nodes[k] % 32) & 1U} << k;
        }
        return mask;
    }
    /// Another one after each change, also where another grid was assigned to this one.
    std::uint64_t epoch() const { return std::uint64_t{node_count_} << 32U ^ epoch_; }

    /// Numbers of the new nodes of a refined element, valid until the next call with the context.
    std::span<const std::uint32_t> new_nodes(const Element& e, Context& context) const;

    /// One step of adaptation: asks marker(Leaf) for the Mark of every leaf, refines and coarsens,
    /// and does what the family's closure demands. Nodes keep their numbers; new ones take free
    /// numbers. Where it throws, the grid is as before.
    /// \throw InvalidInput for a mark that the family does not have
    Adaptation adapt(const Marker& marker);

    Adaptation refine_uniformly() {
        return adapt([](const Leaf&) { return Mark::refine; });
    }

    /// Numbers the nodes anew, without gaps, in the order in which a traversal meets them: for
    /// shorter vectors after much coarsening, and for locality. Coarse nodes keep their numbers.
    /// \return the new number of every old one, no_node for those that were not in use
    std::vector<std::uint32_t> renumber() { return detail::Rewrite<Family>(*this).renumber(); }

    /// Calls function(Leaf) for every leaf, in the order of a depth-first traversal.
    template <class Function>
    void for_each_leaf(Function&& function) const;

    /// Positions of all nodes; numbers that are not in use are at the origin.
    std::vector<Point> node_positions() const;

    const CoarseGrid& coarse_grid() const { return coarse_; }
    const Family& family() const { return family_; }
    std::size_t leaf_count() const { return leaf_count_; }
    /// Nodes that are in use; node_count() bounds their numbers.
    std::size_t used_node_count() const { return used_node_count_; }
    /// Different rules in use.
    std::size_t rule_count() const { return table_.rule_count() - 1; }
    bool hangs(std::uint32_t node) const {
        return !hanging_.empty() && (hanging_[node / 32] >> (node % 32) & 1U) != 0;
    }

    /// Topology and references, without the coarse grid.
    std::size_t memory_bytes() const {
        return (words_.capacity() + root_.capacity() + hanging_.capacity()) * sizeof(words_[0]);
    }

private:
    friend class detail::Rewrite<Family>;
    friend class detail::GridFile<Family>;
    StoredGrid() = default;

    static constexpr std::uint32_t none_ = 0xFFFFFFFFU;
    static constexpr unsigned has_record_ = 0x8000U;

    struct Record {
        const std::uint32_t* codes;
        const std::uint32_t* mask;
        const std::uint32_t* links;
        const std::uint32_t* references;
    };

    unsigned raw_code(std::uint32_t record, unsigned exit) const {
        return words_[record + exit / 2] >> (exit % 2 * 16) & 0xFFFFU;
    }
    unsigned code_of(const Place& place) const {
        return place.record == none_ ? 0 : raw_code(place.record, place.exit) & ~has_record_;
    }
    /// How many of the two codes in a word have a record.
    static std::size_t records_in(std::uint32_t codes) {
        return (codes >> 15U & 1U) + (codes >> 31U);
    }
    Record record(const Place& place) const {
        const Pattern& p = table_[place.pattern];
        const std::uint32_t* at = words_.data() + place.record;
        Record r{at, at + p.code_words(), nullptr, nullptr};
        r.links = r.mask + p.mask_words();
        r.references = r.links;
        for (std::size_t i = 0; i < p.code_words(); ++i) {
            r.references += records_in(r.codes[i]);
        }
        return r;
    }
    std::uint32_t link(const Place& place) const {
        if ((raw_code(place.record, place.exit) & has_record_) == 0) return none_;
        const Record r = record(place);
        std::size_t before = 0;
        for (std::size_t i = 0; i < place.exit / 2U; ++i) {
            before += records_in(r.codes[i]);
        }
        if (place.exit % 2 == 1 && (r.codes[place.exit / 2] & 0x8000U) != 0) ++before;
        return r.links[before];
    }

    CoarseGrid coarse_;
    Family family_;
    PatternTable table_;
    std::vector<std::uint32_t> root_;     // record of each coarse element, or none_
    std::vector<std::uint32_t> words_;    // records
    std::vector<std::uint32_t> hanging_;  // one bit per node
    std::vector<std::int8_t> orientation_;
    std::size_t node_count_ = 0;
    std::size_t used_node_count_ = 0;
    std::size_t leaf_count_ = 0;
    std::uint64_t epoch_ = 0;
};

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
inline auto StoredGrid<Family>::coarse(std::size_t i) const -> CoarseElement<Element> {
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

template <class Family>
inline std::span<const std::uint32_t> StoredGrid<Family>::new_nodes(const Element& e,
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
inline void StoredGrid<Family>::children(const Element& e, std::span<Element> out,
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
Adaptation StoredGrid<Family>::adapt(const Marker& marker) {
    return detail::Rewrite<Family>(*this).run(marker);
}

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

#include <nestgrid/adapters/adapt.hpp>
