// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Grids with holes where their data have no values: samples outside a scanner's view, land in the
// data of an ocean, masked arrays. A value that is missing is not a number (NaN).
//
// Invariants:
//   - a leaf is hidden where a component has no value at a corner, also a corner that hangs, whose
//     value is that of its parents; an element is hidden as the leaves below it are, partly where
//     they differ;
//   - so nodes without a value are corners of hidden leaves alone, which nobody asks for
//     (optional.hpp, hidden): drawings, indicators and bounds are those of the leaves that are
//     left.
// Memory: 4 bytes for each child of an element that is hidden in part, and a bit for each node,
// where keys are dense, else a table of the nodes of hidden leaves alone.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <nestgrid/detail/made_for.hpp>
#include <nestgrid/detail/node_set.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid {

/// Which elements of a grid are hidden.
class HiddenElements {
public:
    /// Hides the leaves that the grid hides, those at whose corners data have no value, and, where
    /// nodes hang no longer and have no value of their own, those around these. Walks all of the
    /// hierarchy, once where it is conforming, else until no leaf is added.
    /// \param already hidden elements of the grid, which stay hidden; may be null
    /// \throw GridError as derive_hanging_nodes(), where the field gives nothing at all at a node,
    ///        and for more than 2^32 children of elements that are hidden in part
    template <class Real>
    explicit HiddenElements(const Hierarchy<Real>& hierarchy,
                            std::shared_ptr<const HiddenElements> already = nullptr);

    /// The elements of a grid that any of several fields on it hides, such as the frames of one.
    template <class Real>
    static std::shared_ptr<const HiddenElements> of_all(
        std::span<const Hierarchy<Real>* const> fields);

    /// What stands for an element: how it and all below it is hidden.
    using Mark = std::uint32_t;
    Mark coarse(std::size_t i) const { return coarse_[i]; }
    Mark child(Mark of, std::size_t c) const {
        return of < partly_ ? of : marks_[of - partly_ + c];
    }
    static Hidden hidden(Mark of) {
        if (of >= partly_) return Hidden::partly;
        return of == wholly_ ? Hidden::wholly : Hidden::not_at_all;
    }

    /// Nodes of hidden leaves alone, or of no leaf.
    const NodeSet& unseen() const { return unseen_; }
    std::size_t hidden_leaves() const { return hidden_leaves_; }
    bool any() const { return hidden_leaves_ > 0; }
    std::size_t memory_bytes() const {
        return (coarse_.capacity() + marks_.capacity()) * sizeof(Mark) + unseen_.memory_bytes();
    }

private:
    class Builder;
    template <class Real>
    void find(const Hierarchy<Real>& hierarchy);

    // Of an element that is hidden in part: behind these, where the marks of its children begin.
    static constexpr Mark shown_ = 0;
    static constexpr Mark wholly_ = 1;
    static constexpr Mark partly_ = 2;

    std::vector<Mark> coarse_;
    std::vector<Mark> marks_;
    NodeSet unseen_;
    std::size_t hidden_leaves_ = 0;
};

#define NESTGRID_HIDDEN_ELEMENTS(prefix, Real)                                             \
    prefix template HiddenElements::HiddenElements(const Hierarchy<Real>&,                 \
                                                   std::shared_ptr<const HiddenElements>); \
    prefix template std::shared_ptr<const HiddenElements> HiddenElements::of_all(          \
        std::span<const Hierarchy<Real>* const>);
NESTGRID_HIDDEN_ELEMENTS(extern, float)
NESTGRID_HIDDEN_ELEMENTS(extern, double)

/// A hierarchy with hidden elements, and beside that another one.
template <class Real>
class Holes final : public Hierarchy<Real> {
public:
    /// Hides the elements at which the field has no values.
    /// \param inner is borrowed, and is none with holes itself
    /// \throw GridError as HiddenElements
    explicit Holes(const Hierarchy<Real>& inner)
        : Holes(inner, std::make_shared<const HiddenElements>(inner)) {}
    /// \param hidden of this grid, and of all nodes at which the field has no value; for fields
    ///        that are drawn together, such as the frames of one
    /// \throw InvalidInput for a hierarchy with holes
    Holes(const Hierarchy<Real>& inner, std::shared_ptr<const HiddenElements> hidden);

    const std::shared_ptr<const HiddenElements>& hidden() const { return hidden_; }

    std::size_t coarse_count() const override { return inner_->coarse_count(); }
    std::uint64_t epoch() const override { return inner_->epoch(); }
    Elements make_elements() const override { return inner_->make_elements(); }
    std::unique_ptr<Task> open() const override {
        made_for_.require_same(*inner_, "the list of hidden elements");
        return inner_->open();
    }
    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        inner_->coarse(task, i, coarse, family);
        hide(family, 0, hidden_->coarse(i));
    }
    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           Real* out) const override {
        return inner_->coarse_values(task, i, corners, out);
    }
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& children) const override;
    NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                        Real* values) const override {
        return inner_->new_values(task, element, rule, which, values);
    }
    void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                 Point* positions, unsigned* boundary) const override {
        inner_->corners(task, element, count, keys, positions, boundary);
    }
    void new_positions(Task* task, const Handle& element, NodeMask which,
                       std::span<Point> out) const override {
        inner_->new_positions(task, element, which, out);
    }
    void corner_gradients(Task* task, const Handle& element, std::span<Point> out) const override {
        inner_->corner_gradients(task, element, out);
    }
    std::array<NodeKey, 2> hanging_parents(NodeKey node) const override {
        return inner_->hanging_parents(node);
    }
    void star_rows(const std::function<void(const StarRow&)>& function) const override {
        inner_->star_rows(function);
    }
    /// Not a number at nodes of hidden leaves alone.
    void row_values(NodeKey first, std::size_t stride, std::span<Real> out) const override;
    Point node_position(NodeKey node) const override { return inner_->node_position(node); }

private:
    static HierarchyFacts facts_with_hidden(const Hierarchy<Real>& inner);
    static void hide(Family& family, std::size_t c, HiddenElements::Mark mark) {
        Member& member = family.members[c];
        member.element.mark = mark;
        member.hidden = HiddenElements::hidden(mark);
        if (member.hidden == Hidden::wholly) family.hidden |= NodeMask{1} << c;
    }

    const Hierarchy<Real>* inner_;
    std::shared_ptr<const HiddenElements> hidden_;
    detail::MadeFor made_for_;
};

extern template class Holes<float>;
extern template class Holes<double>;

}  // namespace nestgrid
