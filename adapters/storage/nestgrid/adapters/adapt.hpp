// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One adaptation: unpack the hierarchy, coarsen, refine, close, write it anew. Included at the end
// of stored_grid.hpp.
#pragma once

#include <deque>
#include <utility>

#include <nestgrid/adapters/hanging_mask.hpp>

namespace nestgrid::detail {

/// Writes the store of a grid anew: adapted, renumbered, or to see whether it is what it should be.
template <class Family>
class Rewrite {
public:
    using Grid = StoredGrid<Family>;
    using Tree = WorkTree<Family::max_corners>;
    using Element = typename Grid::Element;

    explicit Rewrite(Grid& grid) : grid_{grid}, table_{grid.table_}, tree_{table_} {}

    Adaptation run(const Marker& marker) {
        unpack(marker);
        coarsen();
        tree_.activate();
        const auto count = static_cast<std::uint32_t>(tree_.elements.size());
        for (std::uint32_t e = 0; e < count; ++e) {
            if (!tree_.is_leaf(tree_.elements[e]) || tree_.elements[e].mark < Mark::refine) {
                continue;
            }
            ++result_.marked;
            tree_.refine(e, Family::rule_for(tree_, tree_.elements[e], tree_.elements[e].mark));
        }
        for (auto e = count; e < tree_.elements.size(); ++e) tree_.open.push_back(e);
        grid_.family_.close(tree_);
        for (const std::uint32_t e : coarsened_) {
            const std::uint16_t rule = tree_.elements[e].rule;
            if (rule == 0 || table_.rule(rule).temporary) ++result_.coarsened;
        }
        if constexpr (!Family::conforming) hanging_ = hanging_nodes(tree_);
        pack();
        report();
        commit();
        return std::move(result_);
    }

    /// New number of every node, no_node where a number is not in use.
    std::vector<std::uint32_t> renumber() {
        unpack([](const Leaf&) { return Mark::keep; });
        tree_.activate();
        grid_.family_.close(tree_);
        if constexpr (!Family::conforming) hanging_ = hanging_nodes(tree_);
        new_number_.assign(tree_.position.size(), no_node);
        next_number_ = static_cast<std::uint32_t>(grid_.coarse_.nodes.size());
        for (std::uint32_t node = 0; node < next_number_; ++node) new_number_[node] = node;
        pack();
        std::vector<std::uint32_t> hanging((tree_.position.size() + 31) / 32, 0);
        for (std::uint32_t node = 0; node < new_number_.size() && !hanging_.empty(); ++node) {
            const std::uint32_t to = new_number_[node];
            if (to != no_node && (hanging_[node / 32] >> node % 32 & 1U) != 0) {
                hanging[to / 32] |= 1U << to % 32;
            }
        }
        if (!hanging_.empty()) hanging_ = std::move(hanging);
        commit();
        return std::move(new_number_);
    }

    /// Whether the grid is just what an adaptation would have written: nodes fit together, nothing
    /// is left to close, the hanging nodes are those in the mask.
    /// \throw GridError, InvalidInput as adaptations do
    bool is_sound() {
        tree_.verify = true;
        unpack([](const Leaf&) { return Mark::keep; });
        tree_.activate();
        for (std::uint32_t e = 0; e < tree_.elements.size(); ++e) tree_.open.push_back(e);
        grid_.family_.close(tree_);
        if constexpr (!Family::conforming) hanging_ = hanging_nodes(tree_);
        pack();
        if (grid_.hanging_.empty()) {  // of a grid that was never adapted
            if (std::any_of(hanging_.begin(), hanging_.end(), [](auto w) { return w != 0; })) {
                return false;
            }
            hanging_.clear();
        }
        return root_ == grid_.root_ && words_ == grid_.words_ && hanging_ == grid_.hanging_ &&
               leaves_ == grid_.leaf_count_;
    }

private:
    static constexpr int max_exits_ = std::max(Family::max_children, 1 << Family::pattern_height);

    // Unpacking.
    void unpack(const Marker& marker);
    void unpack(const Element& e, std::uint32_t place, const Marker& marker);
    Mark ask(const Element& e, Shape shape, int level, const Marker& marker);
    Mark ask_children(const Element& e, const Rule& rule, int level, const Marker& marker);

    void coarsen();
    bool all_children_want_it(const typename Tree::Element& e) const;

    // Packing.
    struct Subtree {
        std::vector<std::uint16_t> tree;   // rules in preorder
        std::vector<std::uint32_t> inner;  // elements that have them
        std::vector<std::uint32_t> exits;

        void clear() {
            tree.clear();
            inner.clear();
            exits.clear();
        }
    };
    struct Level {  // room for one record, used again
        std::array<Subtree, static_cast<std::size_t>(max_exits_)> subtree;
        std::array<std::uint16_t, static_cast<std::size_t>(max_exits_)> code;
    };
    void collect(std::uint32_t e, int height, Subtree& subtree);
    std::uint16_t written(std::uint16_t rule);
    std::uint32_t numbered(std::uint32_t node) {
        if (new_number_.empty()) return node;
        if (new_number_[node] == no_node) new_number_[node] = next_number_++;
        return new_number_[node];
    }
    bool is_refined(std::uint32_t e) const { return tree_.elements[e].rule != 0; }
    void pack();
    std::uint32_t pack(std::uint16_t pattern, std::span<const std::uint32_t> exits,
                       std::size_t depth);

    void report();
    void commit();

    Grid& grid_;
    PatternTable table_;    // of the grid as it is, and rules that come up
    PatternTable written_;  // only what the new grid needs, in the order of its records
    std::vector<std::uint16_t> written_rule_;  // number there of each rule of `table_`, or 0
    Tree tree_;
    Adaptation result_;
    std::vector<std::uint32_t> coarsened_;  // elements whose children went; the closure may refine
    std::size_t coarse_ = 0;
    std::vector<std::uint32_t> root_, words_, hanging_;
    std::vector<bool> used_;
    std::vector<std::uint32_t> new_number_;  // only for renumber()
    std::uint32_t next_number_ = 0;
    std::deque<Level> levels_;
    std::size_t leaves_ = 0;
};

template <class Family>
void Rewrite<Family>::unpack(const Marker& marker) {
    const std::size_t coarse_nodes = grid_.coarse_.nodes.size();
    tree_.reserve(grid_.used_node_count_, 2 * grid_.leaf_count_);
    tree_.add_nodes(grid_.node_count_);
    for (std::size_t i = 0; i < coarse_nodes; ++i) {
        tree_.add_coarse_node(static_cast<std::uint32_t>(i), grid_.coarse_.nodes[i]);
    }
    for (std::size_t i = 0; i < grid_.coarse_count(); ++i) {
        const auto c = grid_.coarse(i);
        typename Tree::Element e;
        e.shape = c.shape;
        e.corner = c.element.corner;
        tree_.elements.push_back(e);
    }
    for (std::size_t i = 0; i < grid_.coarse_count(); ++i) {
        coarse_ = i;
        unpack(grid_.coarse(i).element, static_cast<std::uint32_t>(i), marker);
    }
}

template <class Family>
void Rewrite<Family>::unpack(const Element& e, std::uint32_t place, const Marker& marker) {
    const unsigned code = grid_.code_of(e.place);
    const int level = tree_.elements[place].level;
    if (code == 0) {
        tree_.elements[place].mark = ask(e, tree_.elements[place].shape, level, marker);
        return;
    }
    const std::uint16_t number = table_[code].inner[e.place.inner].rule;
    const StoredRule& stored = table_.rule(number);
    const Rule& rule = *stored.rule;
    typename Grid::Context context;
    const std::span<const std::uint32_t> nodes = grid_.new_nodes(e, context);
    if (stored.temporary) {
        tree_.remember(tree_.elements[place], number, nodes);
        tree_.elements[place].mark = ask_children(e, rule, level, marker);
        return;
    }
    const std::uint32_t child = tree_.restore(place, number, nodes);
    std::array<Element, static_cast<std::size_t>(Grid::max_children)> below;
    grid_.children(e, std::span(below).first(rule.children.size()), context);
    for (std::uint32_t k = 0; k < rule.children.size(); ++k) unpack(below[k], child + k, marker);
}

template <class Family>
Mark Rewrite<Family>::ask(const Element& e, Shape shape, int level, const Marker& marker) {
    const std::size_t n = topology(shape).corners;
    std::array<Point, max_corners> x;
    for (std::size_t i = 0; i < n; ++i) x[i] = tree_.position[e.corner[i]];
    return marker(Leaf{shape, level, coarse_, {x.data(), n}, {e.corner.data(), n}});
}

/// Children made by the closure: refined if one wants it, coarsened if all of them do.
template <class Family>
Mark Rewrite<Family>::ask_children(const Element& e, const Rule& rule, int level,
                                   const Marker& marker) {
    std::array<Element, static_cast<std::size_t>(Grid::max_children)> below;
    typename Grid::Context context;
    grid_.children(e, std::span(below).first(rule.children.size()), context);
    Mark least = Mark::refine, most = Mark::coarsen;
    for (std::size_t k = 0; k < rule.children.size(); ++k) {
        const Mark mark = ask(below[k], rule.children[k].shape, level + 1, marker);
        least = std::min(least, mark);
        most = std::max(most, mark);
    }
    return most >= Mark::refine ? most : most == Mark::coarsen ? least : Mark::keep;
}

template <class Family>
bool Rewrite<Family>::all_children_want_it(const typename Tree::Element& e) const {
    if (!e.alive || e.rule == 0) return false;
    for (std::size_t k = 0; k < tree_.rule(e).children.size(); ++k) {
        const auto& child = tree_.elements[e.child + k];
        if (child.rule != 0 || child.mark != Mark::coarsen) return false;
    }
    return true;
}

template <class Family>
void Rewrite<Family>::coarsen() {
    std::vector<std::uint32_t> families;
    for (std::uint32_t e = 0; e < tree_.elements.size(); ++e) {
        if (all_children_want_it(tree_.elements[e])) families.push_back(e);
    }
    for (const std::uint32_t e : families) {
        tree_.coarsen(tree_.elements[e]);
        tree_.open.push_back(e);
    }
    coarsened_ = std::move(families);
}

template <class Family>
std::uint16_t Rewrite<Family>::written(std::uint16_t rule) {
    if (written_rule_.size() <= rule) written_rule_.resize(rule + 1U, 0);
    if (written_rule_[rule] == 0) {
        const StoredRule& r = table_.rule(rule);
        written_rule_[rule] = written_.rule(r.descriptor, r.temporary, [&] { return r.rule; });
    }
    return written_rule_[rule];
}

template <class Family>
void Rewrite<Family>::collect(std::uint32_t e, int height, Subtree& subtree) {
    const auto& element = tree_.elements[e];
    if (height == 0 || element.rule == 0) {
        subtree.tree.push_back(0);
        subtree.exits.push_back(e);
        return;
    }
    subtree.tree.push_back(written(element.rule));
    subtree.inner.push_back(e);
    const auto n = static_cast<std::uint32_t>(tree_.rule(element).children.size());
    for (std::uint32_t k = 0; k < n; ++k) collect(element.child + k, height - 1, subtree);
}

template <class Family>
void Rewrite<Family>::pack() {
    used_.assign(tree_.position.size(), false);
    root_.assign(grid_.coarse_count(), Grid::none_);
    for (std::size_t i = 0; i < grid_.coarse_.nodes.size(); ++i) {
        used_[i] = true;
    }
    for (std::uint32_t e = 0; e < grid_.coarse_count(); ++e) {
        if (!is_refined(e)) {
            ++leaves_;
            continue;
        }
        root_[e] = pack(static_cast<std::uint16_t>(tree_.elements[e].shape), {&e, 1}, 0);
    }
    words_.shrink_to_fit();
}

/// Writes the record of an element that is refined by `pattern` and has `exits`.
template <class Family>
std::uint32_t Rewrite<Family>::pack(std::uint16_t pattern, std::span<const std::uint32_t> exits,
                                    std::size_t depth) {
    if (levels_.size() <= depth) levels_.emplace_back();
    auto& subtrees = levels_[depth].subtree;
    const std::span<std::uint16_t> codes(levels_[depth].code.data(), exits.size());
    std::array<std::uint32_t, max_entities> reference;
    std::array<std::uint32_t, max_entities / 32> mask{};
    for (std::size_t j = 0; j < exits.size(); ++j) {
        codes[j] = 0;
        if (!is_refined(exits[j])) {
            ++leaves_;
            continue;
        }
        subtrees[j].clear();
        collect(exits[j], Family::pattern_height, subtrees[j]);
        codes[j] = written_.pattern(subtrees[j].tree);
        const Pattern& refined = written_[codes[j]];
        const auto& entity_of_exit = written_[pattern].exits[j].entity;
        for (std::size_t i = 0; i < refined.inner.size(); ++i) {
            const auto nodes = tree_.nodes(tree_.elements[subtrees[j].inner[i]]);
            for (std::size_t k = 0; k < nodes.size(); ++k) {
                const unsigned entity = entity_of_exit[refined.inner[i].entity[k]];
                mask[entity / 32] |= 1U << entity % 32;
                reference[entity] = numbered(nodes[k]);
                used_[reference[entity]] = true;
            }
        }
        for (const std::uint32_t e : subtrees[j].exits) {
            if (is_refined(e)) codes[j] |= Grid::has_record_;
        }
    }
    const auto at = static_cast<std::uint32_t>(words_.size());
    if (words_.size() + 2 * max_entities >= Grid::none_) {
        throw GridError("the store of a grid is full: more than 16 GiB");
    }
    for (std::size_t j = 0; j < codes.size(); j += 2) {
        const std::uint32_t high = j + 1 < codes.size() ? codes[j + 1] : 0U;
        words_.push_back(codes[j] | high << 16U);
    }
    words_.insert(words_.end(), mask.begin(),
                  mask.begin() + static_cast<std::ptrdiff_t>(written_[pattern].mask_words()));
    std::size_t link = words_.size();
    for (const std::uint16_t code : codes) {
        if ((code & Grid::has_record_) != 0) words_.push_back(Grid::none_);
    }
    for (unsigned entity = 0; entity < static_cast<unsigned>(max_entities); ++entity) {
        if ((mask[entity / 32] >> entity % 32 & 1U) != 0) words_.push_back(reference[entity]);
    }
    for (std::size_t j = 0; j < codes.size(); ++j) {
        if ((codes[j] & Grid::has_record_) != 0) {
            const auto number = static_cast<std::uint16_t>(codes[j] & ~Grid::has_record_);
            const std::uint32_t below = pack(number, subtrees[j].exits, depth + 1);
            words_[link++] = below;
        } else if (codes[j] != 0) {
            leaves_ += subtrees[j].exits.size();
        }
    }
    return at;
}

template <class Family>
void Rewrite<Family>::report() {
    for (std::size_t i = 0; i < tree_.created.size(); ++i) {
        if (!used_[tree_.created[i]]) continue;
        result_.created.push_back(tree_.created[i]);
        for (std::size_t k = tree_.created_first[i]; k < tree_.created_first[i + 1]; ++k) {
            result_.parent.push_back(tree_.created_parent[k]);
        }
        result_.first_parent.push_back(static_cast<std::uint32_t>(result_.parent.size()));
    }
}

template <class Family>
void Rewrite<Family>::commit() {
    std::size_t count = used_.size();
    while (count > 0 && !used_[count - 1]) --count;
    if (!hanging_.empty()) {
        hanging_.resize((count + 31) / 32);
        hanging_.shrink_to_fit();
    }
    grid_.table_ = std::move(written_);
    grid_.root_ = std::move(root_);
    grid_.words_ = std::move(words_);
    grid_.hanging_ = std::move(hanging_);
    grid_.node_count_ = count;
    grid_.used_node_count_ = static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
    grid_.leaf_count_ = leaves_;
    ++grid_.epoch_;
}

}  // namespace nestgrid::detail
