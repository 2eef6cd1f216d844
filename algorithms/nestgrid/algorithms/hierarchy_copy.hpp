// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A copy of a grid and a field in one block of memory, for many drawings of one state.
//
// A grid of a solver is asked for children, keys and values at each element; the copy answers from
// numbers that lie behind each other. It draws the same surfaces. Made once, in the time of about
// one drawing of all leaves, it pays where the same state is drawn often: series of isovalues,
// searches for a budget, films around a still solution.
//     const HierarchyCopy copy(erase(grid, field));
//     const Prerolls prerolls(copy);
// Memory: for each element that is split four bytes a corner, new node and child, and eight more;
// for each node 24 bytes and its values. In octrees that is about 22 bytes a leaf and 32 a node.
#pragma once

#include <cstdint>
#include <vector>

#include <nestgrid/detail/erase.hpp>

namespace nestgrid {

/// An element of a HierarchyCopy.
struct CopiedElement {
    std::uint32_t father;  ///< the place of its father's record; none of a coarse element
    std::uint32_t own;     ///< the place of its own record; none of a leaf
    std::uint32_t number;  ///< among the children of its father, or among coarse elements
};

/// What a hierarchy says of its elements, nodes and values at the time of the copy; only the rules
/// are borrowed. It has own keys and positions, hidden elements and boundary faces where the
/// original has. Elements that are drawn are CopiedElement, and normals are those of the values:
/// gradients that the field gives are not copied.
/// \tparam Real float or double
template <class Real>
class HierarchyCopy final : public Hierarchy<Real> {
public:
    /// Walks all of it once.
    /// \throw InvalidInput where the hierarchy is distributed, has data or leaves of higher degree,
    ///        or nodes that hang on edges of other trees (hanging_parents)
    /// \throw GridError where there are 2^32 nodes or more, or records take 16 GB
    explicit HierarchyCopy(const Hierarchy<Real>& of);

    /// Of everything that is kept.
    std::size_t memory_bytes() const;

    std::size_t coarse_count() const override { return roots_.size(); }
    std::uint64_t epoch() const override { return epoch_; }
    Elements make_elements() const override { return Elements::of<CopiedElement>(); }
    std::unique_ptr<Task> open() const override { return nullptr; }
    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override;
    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           Real* out) const override;
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& children) const override;
    NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                        Real* values) const override;
    void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                 Point* positions, unsigned* boundary) const override;
    void new_positions(Task* task, const Handle& element, NodeMask which,
                       std::span<Point> out) const override;
    void corner_gradients(Task*, const Handle&, std::span<Point>) const override {}

private:
    struct Root {
        Coarse coarse;
        std::array<std::uint32_t, max_corners> node;
        std::uint32_t own;    // its record, or what it is instead
        std::uint32_t marks;  // as of a child
    };
    class Copier;

    void describe(const CopiedElement& element, std::uint32_t marks, std::size_t c,
                  Family& family) const;
    NodeMask values_at(const std::uint32_t* nodes, NodeMask which, Real* out) const;
    bool has_marks() const {
        return this->offers(Feature::hidden) || this->offers(Feature::boundary_faces);
    }
    const Rule& rule_of(std::uint32_t record) const { return *rules_[words_[record]]; }
    const std::uint32_t* nodes_of(std::uint32_t record) const;

    std::uint64_t epoch_;
    std::vector<Root> roots_;
    std::vector<const Rule*> rules_;
    std::vector<std::uint32_t> words_;  // records of the elements that are split
    std::vector<Point> position_;       // by node
    std::vector<Real> value_;           // all components, by node
    std::vector<bool> absent_;          // nodes without a value; none where all have values
};

template <class Real>
HierarchyCopy(const Hierarchy<Real>&) -> HierarchyCopy<Real>;

}  // namespace nestgrid
