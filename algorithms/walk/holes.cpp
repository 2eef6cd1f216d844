// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/holes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <nestgrid/error.hpp>
#include <walk/for_each_element.hpp>
#include <walk/hanging_nodes.hpp>
#include <walk/nodes_below.hpp>

namespace nestgrid {

/// Takes all elements in the order of a depth-first traversal.
class HiddenElements::Builder {
public:
    explicit Builder(HiddenElements& to) : to_{&to} {}

    /// Takes a leaf, or an element of whose leaves all are hidden, or none.
    template <class Real>
    void add(const engine::ElementView<Real>& element, bool hidden) {
        open_to(element);
        put(element.level, element.child, element.coarse, hidden ? wholly_ : shown_);
        to_->any_ = to_->any_ || hidden;
    }
    void finish() {
        close_to(0);
        to_->marks_.shrink_to_fit();
    }

private:
    /// An element to whose children more may come.
    struct Open {
        NodeKey path;
        std::size_t coarse;
        std::size_t child;  // of its father
        std::size_t count;  // of its children
        bool any_shown;
        bool any_hidden;
        std::array<Mark, max_children> marks;  // shown where a child is masked
    };

    /// Opens the fathers of an element, and closes all others.
    template <class Real>
    void open_to(const engine::ElementView<Real>& view) {
        const auto* const father = view.father;
        const auto depth = static_cast<std::size_t>(view.level);
        if (father == nullptr) return close_to(0);
        if (depth <= open_.size() && open_[depth - 1].path == father->path) return close_to(depth);
        open_to(*father);
        open_.push_back({father->path,
                         father->coarse,
                         father->child,
                         view.made_by->children.size(),
                         false,
                         false,
                         {}});
    }
    void close_to(std::size_t depth) {
        while (open_.size() > depth) {
            const Open closed = open_.back();
            open_.pop_back();
            put(static_cast<int>(open_.size()), closed.child, closed.coarse, mark_of(closed));
        }
    }
    Mark mark_of(const Open& element) {
        if (!element.any_hidden) return shown_;
        if (!element.any_shown) return wholly_;
        const std::size_t first = to_->marks_.size();
        if (first + element.count > std::numeric_limits<Mark>::max() - partly_) {
            throw GridError("more than 2^32 elements beside those without values");
        }
        to_->marks_.insert(to_->marks_.end(), element.marks.begin(),
                           element.marks.begin() + static_cast<std::ptrdiff_t>(element.count));
        return static_cast<Mark>(first) + partly_;
    }
    void put(int level, std::size_t child, std::size_t coarse, Mark mark) {
        if (level == 0) {
            to_->coarse_[coarse] = mark;
            return;
        }
        Open& father = open_[static_cast<std::size_t>(level) - 1];
        father.marks[child] = mark;
        father.any_shown = father.any_shown || mark != wholly_;
        father.any_hidden = father.any_hidden || mark != shown_;
    }

    HiddenElements* to_;
    std::vector<Open> open_;
};

template <class Real>
void HiddenElements::find(const Hierarchy<Real>& hierarchy) {
    coarse_.assign(hierarchy.coarse_count(), shown_);
    marks_.clear();
    any_ = false;
    const HierarchyFacts& facts = hierarchy.facts();
    const bool hides = facts.offers(Feature::hidden) && detail::holes_of(hierarchy) == nullptr;
    const bool by_stars = facts.knows_stars && facts.conforming && facts.components == 1 && !hides;
    by_stars ? find_by_stars(hierarchy) : find_in_all(hierarchy);
}

template <class Real>
void HiddenElements::find_in_all(const Hierarchy<Real>& hierarchy) {
    const HangingNodes hanging = engine::find_hanging_nodes(hierarchy);
    const engine::Walk<Real> walk(hierarchy, {.values = true, .keys = true}, &hanging);
    const std::size_t components = walk.components();
    Builder builder(*this);
    engine::UnseenSearch unseen(hierarchy.facts().node_count);
    const auto look = [&](const engine::ElementView<Real>& view, const engine::Split& split) {
        if (split.rule != nullptr) return unseen.add(walk, view, split, false);
        const std::span<const Real> values(view.value, view.corner_count() * components);
        const bool hidden = view.member->hidden == Hidden::wholly ||
                            std::ranges::any_of(values, [](Real u) { return std::isnan(u); });
        builder.add(view, hidden);
        unseen.add(walk, view, split, !hidden);
    };
    engine::for_each_element<Real>(walk, false, look);
    builder.finish();
    unseen_ = unseen.found();
}

/// Finds the hidden elements in a walk that leaves out those below which all nodes have values, or
/// none has; then, of the nodes of leaves that were met, those of hidden leaves alone.
template <class Real>
void HiddenElements::find_by_stars(const Hierarchy<Real>& hierarchy) {
    const engine::Walk<Real> walk(hierarchy, {.values = false, .keys = true});
    std::array<NodeKey, max_corners> keys;
    const auto corners = [&](const engine::ElementView<Real>& view) {
        walk.corners(view, keys.data(), nullptr);
        return std::span<const NodeKey>(keys).first(view.corner_count());
    };
    const engine::NodesBelow missing(hierarchy, engine::find_missing_nodes(hierarchy));
    NodeSet of_hidden = missing.nodes();
    Builder builder(*this);
    engine::for_each_near(walk, missing, missing, [&](const auto& view, bool hidden) {
        builder.add(view, hidden);
        if (!hidden || !view.is_leaf()) return;
        for (const NodeKey key : corners(view)) of_hidden.insert(key);
    });
    builder.finish();
    if (!any()) return;
    NodeSet seen(hierarchy.facts().node_count);
    const engine::NodesBelow near(hierarchy, of_hidden);
    engine::for_each_near(walk, near, missing, [&](const auto& view, bool) {
        if (!view.is_leaf() || missing.nodes().mask(corners(view)) != 0) return;
        for (const NodeKey key : corners(view)) seen.insert(key);
    });
    unseen_ = of_hidden.without(seen);
}

template <class Real>
HiddenElements::HiddenElements(const Hierarchy<Real>& hierarchy,
                               std::shared_ptr<const HiddenElements> already)
    : made_for_{hierarchy} {
    const auto look = [&] {
        if (already) return find(Holes<Real>(hierarchy, already));
        find(hierarchy);
    };
    look();
    if (hierarchy.facts().conforming) return;
    while (any() && !(already && *this == *already)) {
        already = std::make_shared<const HiddenElements>(std::move(*this));
        look();
    }
}

template <class Real>
std::shared_ptr<const HiddenElements> HiddenElements::of_all(
    std::span<const Hierarchy<Real>* const> fields) {
    std::shared_ptr<const HiddenElements> hidden;
    const auto look = [&] {
        const auto before = hidden;
        for (const Hierarchy<Real>* field : fields) {
            hidden = std::make_shared<const HiddenElements>(*field, std::move(hidden));
        }
        return hidden->any() && !(before && *hidden == *before);
    };
    bool added = look();
    // Nodes hang no longer where one field hides the leaf they hung on. Another field may have no
    // value of its own there, so all are looked at again until nothing is added.
    const bool again = !fields.front()->facts().conforming && fields.size() > 1;
    while (again && added) added = look();
    return hidden;
}

NESTGRID_HIDDEN_ELEMENTS(, float)
NESTGRID_HIDDEN_ELEMENTS(, double)

template <class Real>
HierarchyFacts Holes<Real>::facts_with_hidden(const Hierarchy<Real>& inner) {
    HierarchyFacts facts = inner.facts();
    facts.features |= static_cast<unsigned>(Feature::hidden);
    // Patches are not told which elements are hidden.
    facts.knows_patches = facts.bisects_means = facts.gradients_at_nodes = false;
    return facts;
}

template <class Real>
Holes<Real>::Holes(const Hierarchy<Real>& inner, std::shared_ptr<const HiddenElements> hidden)
    : detail::ForwardingHierarchy<Real>(inner, facts_with_hidden(inner)),
      hidden_{std::move(hidden)} {
    hidden_->require_same(inner);
    if (dynamic_cast<const Holes<Real>*>(&inner) != nullptr) {
        throw InvalidInput("a hierarchy with holes gets no others: hide all at once");
    }
}

template <class Real>
NodeMask Holes<Real>::enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                            Real* values, NodeMask wanted, Family& children) const {
    const HiddenElements::Mark mark = element.mark;
    const NodeMask missing =
        this->inner().enter(task, element, rule, which, values, wanted, children);
    for (std::size_t c = 0; c < rule.children.size(); ++c) {
        hide(children, c, hidden_->child(mark, c));
    }
    return missing;
}

template <class Real>
void Holes<Real>::row_values(NodeKey first, std::size_t stride, std::span<Real> out) const {
    this->inner().row_values(first, stride, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (hidden_->unseen().contains(first + static_cast<NodeKey>(i * stride))) {
            out[i] = std::numeric_limits<Real>::quiet_NaN();
        }
    }
}

template class Holes<float>;
template class Holes<double>;

}  // namespace nestgrid
