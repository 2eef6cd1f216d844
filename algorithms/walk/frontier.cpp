// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/frontier.hpp>

#include <limits>

#include <nestgrid/error.hpp>

namespace nestgrid::engine {

namespace {

/// The level of an element, or of the first of the copies that lead to it. In preorder, the
/// elements below an element follow it, up to the next element whose head is not greater than its
/// level.
template <class Real>
int head(const ElementView<Real>& view) {
    int level = view.level;
    for (const ElementView<Real>* at = &view;
         at->father != nullptr && at->made_by->new_nodes.empty(); at = at->father) {
        --level;
    }
    return level;
}

}  // namespace

/// Lists the elements above the frontier and on it.
template <class Real>
class Frontier<Real>::Enumeration final : public Visitor<Real> {
public:
    Enumeration(Frontier& frontier, TaskVisitor<Real>& visitor, int level)
        : frontier_{&frontier}, visitor_{&visitor}, level_{level} {}

    /// How many entries have children that the visitor enters.
    std::size_t open() const { return open_; }

    bool sees_hidden() const override { return visitor_->sees_hidden(); }
    NodeMask children(const ElementView<Real>& view) override { return visitor_->children(view); }

    Decision inspect(const ElementView<Real>& view, const Split& split) override {
        auto& items = frontier_->items_;
        if (items.size() == std::numeric_limits<std::uint32_t>::max() ||
            view.coarse >= std::numeric_limits<std::uint32_t>::max()) {
            throw GridError("the coarse grid has 2^32 elements or more");
        }
        items.push_back({static_cast<std::uint32_t>(view.coarse),
                         static_cast<std::uint32_t>(frontier_->entries_), 0,
                         static_cast<std::uint16_t>(head(view)),
                         static_cast<std::uint16_t>(view.level), false});
        const Decision decision = visitor_->inspect(view, split);
        if (decision.visit == Visit::skip) return decision;
        const bool extracted = decision.visit == Visit::stop || split.rule == nullptr;
        if (!extracted && view.level < level_) return decision;
        if (!extracted) ++open_;
        visitor_->undo();
        items.back().entry = true;
        ++frontier_->entries_;
        return {Visit::skip, 0};
    }

    void entered(const ElementView<Real>& view, const Split& split, const Real* values) override {
        visitor_->entered(view, split, values);
    }
    void extract(const ElementView<Real>&) override {}

private:
    Frontier* frontier_;
    TaskVisitor<Real>* visitor_;
    int level_;
    std::size_t open_ = 0;
};

/// Walks down to some entries and hands them over to a visitor.
template <class Real>
class Frontier<Real>::Part final : public Visitor<Real> {
public:
    Part(const Frontier& frontier, const Walk<Real>& walk, TaskVisitor<Real>& visitor,
         std::size_t first, std::size_t last)
        : frontier_{&frontier},
          walk_{&walk},
          visitor_{&visitor},
          first_{first},
          last_{last},
          item_{frontier.item_of_coarse(first)} {}

    bool sees_hidden() const override { return visitor_->sees_hidden(); }
    NodeMask children(const ElementView<Real>& view) override { return visitor_->children(view); }

    Decision inspect(const ElementView<Real>& view, const Split& split) override {
        const auto& items = frontier_->items_;
        const Item& here = items[item_];
        const std::size_t end =
            here.next < items.size() ? items[here.next].first_entry : frontier_->entries_;
        if (here.first_entry >= last_ || end <= first_ || here.first_entry == end) {
            item_ = here.next;
            return {Visit::skip, 0};
        }
        ++item_;
        if (!here.entry) return visitor_->look(view, split);
        visitor_->begin_entry(here.first_entry);
        visitor_->walk_below(*walk_, view);
        return {Visit::skip, 0};
    }
    void extract(const ElementView<Real>&) override {}

private:
    const Frontier* frontier_;
    const Walk<Real>* walk_;
    TaskVisitor<Real>* visitor_;
    std::size_t first_;
    std::size_t last_;
    std::size_t item_;  // the item that the walk meets next
};

template <class Real>
Frontier<Real>::Frontier(const Walk<Real>& walk, TaskVisitor<Real>& visitor, std::size_t wanted) {
    for (int level = 0;; ++level) {
        items_.clear();
        entries_ = 0;
        visitor.restart();
        Enumeration enumeration(*this, visitor, level);
        walk.run(enumeration);
        if (enumeration.open() >= wanted || enumeration.open() == 0) break;
    }
    close_subtrees();
}

/// Sets `next` of all items: a subtree ends where an item on the level of its root or above begins.
template <class Real>
void Frontier<Real>::close_subtrees() {
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

template <class Real>
void Frontier<Real>::run(const Walk<Real>& walk, std::size_t first, std::size_t last,
                         TaskVisitor<Real>& visitor) const {
    if (first >= last) return;
    Part part(*this, walk, visitor, first, last);
    walk.run(part, items_[item_of_coarse(first)].coarse,
             std::size_t{items_[item_of_coarse(last - 1)].coarse} + 1);
}

template <class Real>
std::size_t Frontier<Real>::item_of_coarse(std::size_t entry) const {
    std::size_t item = 0;
    for (std::size_t next = items_[item].next;
         next < items_.size() && items_[next].first_entry <= entry; next = items_[item].next) {
        item = next;
    }
    return item;
}

template class Frontier<float>;
template class Frontier<double>;

}  // namespace nestgrid::engine
