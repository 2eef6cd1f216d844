// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Two walks draw elements that stop without conforming. The first one records what finer sides draw
// on closed faces (transitions.hpp), the second one draws. Where no element of some level has a
// finer neighbour, the first walk draws the elements of that level, and the second one enters only
// elements that lead to others.
#pragma once

#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <walk/element_view.hpp>

namespace nestgrid::engine {

enum class Pass : std::uint8_t {
    only,    ///< draws everything and records nothing
    record,  ///< the first walk of two
    finish,  ///< the second one
};

/// Says what the current walk does with an element, and remembers the ways to elements that the
/// first walk leaves to the second.
template <class Real>
class TwoWalks {
public:
    using View = ElementView<Real>;

    /// \param finest a level on which no element has a finer neighbour, or -1
    void begin(Pass pass, int finest) {
        pass_ = pass;
        finest_ = finest;
        later_below_.clear();
        enter_ = &later_below_;
    }
    /// Makes this one do as `leader` does, which must outlive the walk.
    void join(const TwoWalks& leader) {
        begin(leader.pass_, leader.finest_);
        enter_ = leader.enter_;
    }
    /// Goes over from the first walk to the second.
    void finish() { pass_ = Pass::finish; }

    bool is_recording() const { return pass_ == Pass::record; }
    /// Whether this walk draws only what the first one left.
    bool draws_rest() const { return pass_ == Pass::finish && finest_ >= 0; }
    /// Whether this walk adopts what the first one recorded.
    bool adopts() const { return pass_ == Pass::finish; }
    /// Whether the first walk draws some elements.
    bool draws_finest() const { return finest_ >= 0; }

    /// Whether the element at hand is drawn in this walk.
    /// \param shown whether it is not hidden
    bool draws(const View& view, bool shown) const {
        return pass_ == Pass::record ? shown && view.level == finest_ : !is_drawn(view);
    }
    /// Whether the first walk has drawn the element.
    bool is_drawn(const View& view) const { return draws_rest() && view.level == finest_; }
    /// Whether this walk enters a coarse element.
    bool enters(const View& coarse) const {
        return !draws_rest() || enter_->find(coarse.path) != nullptr;
    }
    /// The children that this walk enters, one bit each.
    NodeMask children(const View& view) const {
        if (!draws_rest()) return ~NodeMask{0};
        const NodeMask* children = enter_->find(view.path);
        return children == nullptr ? 0 : *children;
    }

    /// Leaves an element to the second walk. Remembers the hash of the way to it: where two ways
    /// have the same hash, the second walk enters more than it must.
    void leave_for_later(const View& view) {
        if (draws_finest()) remember_way(view);
    }
    /// Adds what a task leaves to the second walk.
    void append(const TwoWalks& task) {
        task.later_below_.for_each([&](NodeKey path, NodeMask children) {
            *later_below_.insert(path, 0).first |= children;
        });
    }
    std::size_t memory_bytes() const { return later_below_.memory_bytes(); }

private:
    void remember_way(const View& view) {
        if (view.father == nullptr) later_below_.insert(view.path, 0);
        for (const View* at = &view; at->father != nullptr; at = at->father) {
            NodeMask& children = *later_below_.insert(at->father->path, 0).first;
            const NodeMask before = children;
            children |= NodeMask{1} << at->child;
            if (before != 0) break;
        }
    }

    /// By the path of an element: its children that lead to elements left for later, one bit each.
    using Ways = KeyTable<NodeKey, NodeMask>;

    Pass pass_ = Pass::only;
    int finest_ = -1;
    Ways later_below_;
    const Ways* enter_ = &later_below_;  // the ways of all tasks
};

}  // namespace nestgrid::engine
