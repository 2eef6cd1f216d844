// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A traversal cut into tasks: subtrees of one level, in the order in which one walk meets them.
//
// Invariants:
//   - an entry is an element on the frontier's level, or one above it that is extracted; every
//     element of interest lies above the frontier or below exactly one entry;
//   - the elements above it are kept in preorder, so a task finds its entries by walking down to
//     them from the coarse grid, past everything else: nothing of an element but its place is
//     stored, and fathers, keys and values are those of an ordinary walk.
// Memory: 20 bytes for each element above the frontier and on it.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <nestgrid/traversal.hpp>

namespace nestgrid {

class Frontier {
public:
    /// The first level with enough entries, or the last one with any.
    /// \param visitor decides above the frontier as in an ordinary walk. Three members beside those
    ///        that Traversal asks for: undo() takes the last inspect() back, which a task will
    ///        repeat; restart() takes all of them back; look(state, split) decides without counting
    template <class Walk, class Visitor>
    Frontier(const Walk& walk, Visitor& visitor, std::size_t wanted) {
        for (int level = 0;; ++level) {
            items_.clear();
            entries_ = 0;
            std::size_t open = 0;
            visitor.restart();
            Enumeration<Visitor> enumeration{this, &visitor, level, &open};
            walk.run(enumeration);
            if (open >= wanted || open == 0) break;
        }
        // Each item's subtree ends where one at its level or above begins.
        std::vector<std::uint32_t> pending;
        for (auto i = static_cast<std::uint32_t>(items_.size()); i-- > 0;) {
            while (!pending.empty() && items_[pending.back()].head > items_[i].level) {
                pending.pop_back();
            }
            items_[i].next =
                pending.empty() ? static_cast<std::uint32_t>(items_.size()) : pending.back();
            pending.push_back(i);
        }
    }

    std::size_t entry_count() const { return entries_; }

    /// Shows a visitor the entries first ... last - 1 and what lies below them.
    template <class Walk, class Visitor>
    void run(const Walk& walk, std::size_t first, std::size_t last, Visitor& visitor) const {
        if (first >= last) return;
        Part<Walk, Visitor> part{this, &walk, &visitor, first, last, item_of_coarse(first)};
        walk.run(part, items_[part.item].coarse, items_[item_of_coarse(last - 1)].coarse + 1);
    }

private:
    struct Item {
        std::uint32_t coarse;
        std::uint32_t first_entry;  ///< of those below it, or itself
        std::uint32_t next;         ///< item behind its subtree
        std::uint16_t head;         ///< level where the copies begin that it was looked for through
        std::uint16_t level;
        bool entry;
    };

    /// What lies below an element has a greater head than the element's level, and nothing else
    /// that follows in preorder does before the next one beside it or above.
    template <class State>
    static int head(const State& s) {
        int level = s.level;
        for (const State* at = &s; at->father != nullptr && at->made_by->new_nodes.empty();
             at = at->father) {
            --level;
        }
        return level;
    }

    template <class Visitor>
    struct Enumeration {
        Frontier* frontier;
        Visitor* visitor;
        int level;
        std::size_t* open;

        bool sees_hidden() const { return detail::sees_hidden(*visitor); }
        template <class State>
        NodeMask children_to_enter(const State& s) const {
            return detail::children_to_enter(*visitor, s);
        }
        template <class State>
        Decision inspect(const State& s, const Split& split) {
            auto& items = frontier->items_;
            if (items.size() == std::numeric_limits<std::uint32_t>::max() ||
                s.coarse >= std::numeric_limits<std::uint32_t>::max()) {
                throw GridError("the coarse grid has 2^32 elements or more");
            }
            items.push_back({static_cast<std::uint32_t>(s.coarse),
                             static_cast<std::uint32_t>(frontier->entries_), 0,
                             static_cast<std::uint16_t>(head(s)),
                             static_cast<std::uint16_t>(s.level), false});
            const Decision decision = visitor->inspect(s, split);
            if (decision.visit == Visit::skip) return decision;
            const bool extracted = decision.visit == Visit::stop || split.rule == nullptr;
            if (!extracted && s.level < level) return decision;
            if (!extracted) ++*open;
            visitor->undo();
            items.back().entry = true;
            ++frontier->entries_;
            return {Visit::skip, 0};
        }
        template <class State, class Values>
        void made(const State& s, const Split& split,
                  const Values& values) requires(requires { visitor->made(s, split, values); }) {
            visitor->made(s, split, values);
        }
        template <class State>
        void extract(const State&) {}
    };

    template <class Walk, class Visitor>
    struct Part {
        const Frontier* frontier;
        const Walk* walk;
        Visitor* visitor;
        std::size_t first;
        std::size_t last;
        std::size_t item;  ///< the next one to be met

        bool sees_hidden() const { return detail::sees_hidden(*visitor); }
        template <class State>
        NodeMask children_to_enter(const State& s) const {
            return detail::children_to_enter(*visitor, s);
        }
        template <class State>
        Decision inspect(const State& s, const Split& split) {
            const auto& items = frontier->items_;
            const Item& here = items[item];
            const std::size_t end =
                here.next < items.size() ? items[here.next].first_entry : frontier->entries_;
            if (here.first_entry >= last || end <= first || here.first_entry == end) {
                item = here.next;
                return {Visit::skip, 0};
            }
            ++item;
            if (!here.entry) return visitor->look(s, split);
            walk->walk_below(s, *visitor);
            return {Visit::skip, 0};
        }
        template <class State>
        void extract(const State&) {}
    };

    /// The coarse element above an entry.
    std::size_t item_of_coarse(std::size_t entry) const {
        std::size_t item = 0;
        for (std::size_t next = items_[item].next;
             next < items_.size() && items_[next].first_entry <= entry; next = items_[item].next) {
            item = next;
        }
        return item;
    }

    std::vector<Item> items_;
    std::size_t entries_ = 0;
};

}  // namespace nestgrid
