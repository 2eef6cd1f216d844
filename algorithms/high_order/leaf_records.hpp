// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The polynomials of all leaves, and one record for each edge and face that leaves share.
//
// The owner of an edge or face of a leaf, among all leaves that have it in their closure, is the
// one with the largest edge or face that it lies in; among equals that of the least degree, then
// the first. The record is the owner's polynomial there, and all leaves around read it. Invariants:
//   - a record lies in its own frame: from the corner with the least key, first towards the
//     neighbour with the lesser key. Coefficients are moved into it, which is exact;
//   - values and beta of a place in a record are functions of record and place alone.
// Consequence: all leaves around an edge or face see the same bits on it, whatever their degrees,
// sizes, frames and data.
// Every node of the hierarchy that is inside an edge or face of a larger leaf is in a record, too.
#pragma once

#include <high_order/base_walk.hpp>
#include <nestgrid/detail/key_table.hpp>

namespace nestgrid::engine {

/// Where a part of a leaf, or of an element that is split, lies in a record.
struct RecordPlace {
    std::int32_t record = -1;     ///< -1: in none
    std::uint8_t shift = 0;       ///< the element has 2^-shift of the record's size
    std::uint8_t direction[2]{};  // NOLINT(modernize-avoid-c-arrays): of the element, by direction
    bool flipped[2]{};            // NOLINT(modernize-avoid-c-arrays)
    std::uint32_t low[2]{};  // NOLINT(modernize-avoid-c-arrays): of the element, in its own size
};

/// A leaf and its polynomial.
struct LeafPolynomial {
    std::size_t net = 0;  ///< of component 0 in LeafRecords::nets()
    std::uint8_t degree = 1;
    float jump = 0;  ///< the greatest difference of component 0 from the records and nodes around
    std::array<RecordPlace, 26> part{};  ///< by number; corners have none
};

class LeafRecords {
public:
    /// Asks the field once for each leaf. Borrows the hierarchy.
    /// \throw GridError where a degree is not 1 to 8, or a value not finite, and names the leaf
    LeafRecords(const Hierarchy<double>& base, const BaseWalk& walk);

    int dimension() const { return dimension_; }
    std::size_t components() const { return components_; }
    const std::vector<LeafPolynomial>& leaves() const { return leaves_; }
    std::size_t leaf_at(NodeKey path) const { return *leaf_of_.find(path); }
    const double* net(const LeafPolynomial& leaf, std::size_t component = 0) const {
        return nets_.data() + leaf.net + component * net_size(leaf.degree, dimension_);
    }
    /// Beta and range of component 0 on a part that starts at a place of the element, in units of
    /// 2^-level of its size, and is as long in the directions of `span`.
    NetFacts facts_on(const RecordPlace& of, unsigned span, const BoxPlace& at, int level) const;
    /// Values of all components at a place.
    void values_at(const RecordPlace& of, const BoxPlace& at, int level, double* out) const;
    /// Where a part of the last element on the way lies in a record.
    RecordPlace place_of(std::span<const BaseElement> way, unsigned span, const BoxPlace& at);

    double jump() const;
    void raise_jump(std::size_t leaf, double jump);
    int greatest_degree() const { return greatest_degree_; }
    double least() const { return least_; }
    double greatest() const { return greatest_; }
    std::size_t memory_bytes() const;
    /// Forgets what place_of() needs.
    void finish();

private:
    struct Record {
        std::size_t net;
        std::uint8_t degree;
        std::uint8_t dimension;
    };
    struct Frame {  // of an edge or face: its directions and where they begin
        int dimension = 0;
        std::array<std::uint8_t, 2> direction{};
        std::array<bool, 2> flipped{};
    };
    using Restricted = std::array<double, std::size_t{max_degree + 1} * (max_degree + 1)>;

    void add_leaf(Task* task, std::span<const BaseElement> way, std::vector<double>& values);
    void find_jumps();
    std::vector<double> trace(const LeafPolynomial& leaf, PartCode part, const Frame& frame,
                              std::size_t component) const;
    std::int32_t record_of(NodeKey key);
    int restrict_record(const RecordPlace& of, unsigned span, const BoxPlace& at, int level,
                        std::size_t component, Restricted& net) const;
    Frame frame_of(const BoxKeys& corners, PartCode part) const;

    const Hierarchy<double>* base_;
    int dimension_;
    std::size_t components_;
    std::vector<LeafPolynomial> leaves_;
    std::vector<double> nets_;
    std::vector<Record> records_;
    std::vector<double> record_nets_;
    KeyTable<NodeKey, std::uint32_t> leaf_of_;  // by path
    int greatest_degree_ = 1;
    double least_;
    double greatest_;
    // Until finish():
    std::vector<BoxKeys> corners_;                   // of the leaves
    KeyTable<NodeKey, std::uint32_t> owner_;         // of parts of leaves
    KeyTable<NodeKey, std::int32_t> record_number_;  // of those
};

}  // namespace nestgrid::engine
