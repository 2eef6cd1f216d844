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

#include <nestgrid/detail/forwarding_hierarchy.hpp>
#include <nestgrid/detail/made_for.hpp>
#include <nestgrid/detail/node_set.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid {

/// Which elements of a grid are hidden.
class HiddenElements {
public:
    /// Hides the leaves that the grid hides, those at whose corners data have no value, and, where
    /// nodes hang no longer and have no value of their own, those around these. Of grids that know
    /// their stars, such as samples, walks what is around nodes without a value, of others all of
    /// the hierarchy, once where it is conforming, else until no leaf is added.
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

    /// Tells of an element how it and all below it are hidden.
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
    /// \throw GridError where the grid has changed since its hidden elements were found
    template <class Real>
    void require_same(const Hierarchy<Real>& hierarchy) const {
        made_for_.require_same(hierarchy, "the list of hidden elements");
    }
    bool any() const { return any_; }
    /// Whether the same elements are hidden, of the same grid.
    bool operator==(const HiddenElements& other) const {
        return coarse_ == other.coarse_ && marks_ == other.marks_;
    }
    std::size_t memory_bytes() const {
        return (coarse_.capacity() + marks_.capacity()) * sizeof(Mark) + unseen_.memory_bytes();
    }

private:
    class Builder;
    template <class Real>
    void find(const Hierarchy<Real>& hierarchy);
    template <class Real>
    void find_in_all(const Hierarchy<Real>& hierarchy);
    template <class Real>
    void find_by_stars(const Hierarchy<Real>& hierarchy);

    // Marks from partly_ on are of elements that are hidden in part: partly_ and the place in
    // marks_ at which the marks of the children begin.
    static constexpr Mark shown_ = 0;
    static constexpr Mark wholly_ = 1;
    static constexpr Mark partly_ = 2;

    detail::MadeFor made_for_;
    std::vector<Mark> coarse_;
    std::vector<Mark> marks_;
    NodeSet unseen_;
    bool any_ = false;
};

#define NESTGRID_HIDDEN_ELEMENTS(prefix, Real)                                             \
    prefix template HiddenElements::HiddenElements(const Hierarchy<Real>&,                 \
                                                   std::shared_ptr<const HiddenElements>); \
    prefix template std::shared_ptr<const HiddenElements> HiddenElements::of_all(          \
        std::span<const Hierarchy<Real>* const>);
NESTGRID_HIDDEN_ELEMENTS(extern, float)
NESTGRID_HIDDEN_ELEMENTS(extern, double)

/// Another hierarchy with elements of it hidden.
template <class Real>
class Holes final : public detail::ForwardingHierarchy<Real> {
public:
    /// Hides the elements at which the field has no values.
    /// \param inner is borrowed, and is none with holes itself
    /// \throw GridError as HiddenElements
    explicit Holes(const Hierarchy<Real>& inner)
        : Holes(inner, std::make_shared<const HiddenElements>(inner)) {}
    /// \param hidden of this grid, and of all nodes at which the field has no value; for fields
    ///        that are drawn together, such as the frames of one
    /// \throw InvalidInput for a hierarchy with holes
    /// \throw GridError where the grid has changed since its hidden elements were found
    Holes(const Hierarchy<Real>& inner, std::shared_ptr<const HiddenElements> hidden);

    const std::shared_ptr<const HiddenElements>& hidden() const { return hidden_; }

    std::unique_ptr<Task> open() const override {
        hidden_->require_same(this->inner());
        return this->inner().open();
    }
    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        this->inner().coarse(task, i, coarse, family);
        hide(family, 0, hidden_->coarse(i));
    }
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& children) const override;
    /// Not a number at nodes of hidden leaves alone.
    void row_values(NodeKey first, std::size_t stride, std::span<Real> out) const override;
    /// None: bisections in rows are not told which elements are hidden.
    const detail::BisectionRows<Real>* bisection_rows() const override { return nullptr; }

private:
    static HierarchyFacts facts_with_hidden(const Hierarchy<Real>& inner);
    static void hide(Family& family, std::size_t c, HiddenElements::Mark mark) {
        Member& member = family.members[c];
        member.element.mark = mark;
        member.hidden = HiddenElements::hidden(mark);
        if (member.hidden == Hidden::wholly) family.hidden |= NodeMask{1} << c;
    }

    std::shared_ptr<const HiddenElements> hidden_;
};

extern template class Holes<float>;
extern template class Holes<double>;

namespace detail {

/// The holes of a hierarchy, also behind others that hand every question on to it; or null.
template <class Real>
const Holes<Real>* holes_of(const Hierarchy<Real>& hierarchy) {
    const Hierarchy<Real>* at = &hierarchy;
    while (at != nullptr) {
        if (const auto* holes = dynamic_cast<const Holes<Real>*>(at)) return holes;
        const auto* forwards = dynamic_cast<const ForwardingHierarchy<Real>*>(at);
        at = forwards == nullptr ? nullptr : &forwards->inner();
    }
    return nullptr;
}

}  // namespace detail

}  // namespace nestgrid
