// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The polynomials of all leaves, those of the field or of positions (leaf_functions.hpp), and one
// record for each edge and face that leaves share.
//
// The owner of an edge or face of a leaf, among all leaves that have it in their closure, is the
// one with the largest edge or face that it lies in; among equals that of the least degree, then
// the first. The record is the owner's polynomial there, and all leaves around read it. Invariants:
//   - a record lies in its own frame: from the corner with the least key, first towards the
//     neighbour with the lesser key. Coefficients are moved into it, which is exact;
//   - values and beta of a place in a record are functions of record and place alone.
// Consequence: all leaves around an edge or face see the same bits on it, whatever their degrees,
// sizes, shapes, frames and data.
// Every node of the hierarchy that is inside an edge or face of a larger leaf is in a record, too.
#pragma once

#include <algorithm>
#include <map>
#include <tuple>

#include <high_order/base_walk.hpp>
#include <high_order/leaf_functions.hpp>
#include <high_order/pyramid.hpp>
#include <nestgrid/detail/key_table.hpp>

namespace nestgrid::engine {

/// Points in the frame of a record.
struct OnRecord {
    std::int32_t record = -1;  ///< -1: the points are in none
    int shift = 0;             ///< the element that was asked for has 2^-shift of the record's size
    int level = 0;             ///< the points are in units of 2^-level of the record's size
    std::array<Place, 4> at{};
    std::size_t count = 0;
};

/// A leaf and its polynomial.
struct LeafPolynomial {
    std::uint64_t net = 0;    ///< of component 0
    std::uint32_t first = 0;  ///< of its parts in the list of all
    float jump = 0;           ///< the greatest difference from the records and nodes around
    Shape shape = Shape::point;
    std::uint8_t degree = 1;

    const ShapeParts& parts() const { return parts_of(shape); }
    const Factors& factors() const { return parts().factors; }
    /// How many numbers one component has: its coefficients, and in a pyramid those of the triangle
    /// nets behind them.
    std::size_t size() const {
        const std::size_t triangles = shape == Shape::pyramid ? triangle_nets_size(degree) : 0;
        return net_size(degree, factors()) + triangles;
    }
};

class LeafRecords {
public:
    /// Asks the function once for each leaf.
    /// \throw GridError where a degree is not 1 to 8, or a value not finite, and names the leaf
    LeafRecords(const LeafFunction& function, const BaseWalk& walk);

    std::size_t components() const { return components_; }
    /// How many components are drawn: beta and jumps are norms of these together, ranges are those
    /// of component 0.
    std::size_t drawn() const { return drawn_; }
    const std::vector<LeafPolynomial>& leaves() const { return leaves_; }
    std::size_t leaf_at(NodeKey path) const { return *leaf_of_.find(path); }
    const double* net(const LeafPolynomial& leaf, std::size_t component = 0) const {
        return nets_.data() + leaf.net + component * leaf.size();
    }
    /// Points on a part of a leaf. \param points at most 4, in units of 2^-level of the leaf
    OnRecord on_part(const LeafPolynomial& leaf, std::size_t part, std::span<const Place> points,
                     int level) const;
    /// Points on an edge or face of the last element on the way.
    OnRecord around(std::span<const BaseElement> way, std::span<const Place> points);
    /// Beta and range in a leaf, without the records around.
    NetFacts facts_of(const LeafPolynomial& leaf) const {
        return joined_facts(drawn_, [&](std::size_t c) {
            return net_facts(net(leaf, c), leaf.degree, leaf.factors());
        });
    }
    /// Beta and range on the part with these corners.
    NetFacts facts_on(const OnRecord& part) const;
    /// Beta and range on a part of a leaf, read from its record.
    NetFacts facts_on(const LeafPolynomial& leaf, std::size_t part) const;
    /// Puts the points of a part of a record as points of its owner. \return the owner, a leaf
    std::uint32_t in_owner(const OnRecord& part, std::array<Place, 4>& points) const;
    /// Values of all components at one point.
    void values_at(const OnRecord& point, double* out) const;

    double jump() const;
    void raise_jump(std::size_t leaf, double jump);
    int greatest_degree() const { return greatest_degree_; }
    double least() const { return least_[0]; }
    double greatest() const { return greatest_[0]; }
    /// From the least to the greatest of what is drawn, and its greatest magnitude.
    double extent() const {
        return norm_of(drawn_, [&](std::size_t c) { return greatest_[c] - least_[c]; });
    }
    double magnitude() const {
        return norm_of(drawn_, [&](std::size_t c) {
            return std::max(std::abs(least_[c]), std::abs(greatest_[c]));
        });
    }
    std::size_t memory_bytes() const;
    /// Forgets what around() needs.
    void finish();

private:
    struct Record {
        std::uint32_t leaf;                  // the owner
        std::array<std::uint8_t, 3> corner;  // of the owner: the frame
        std::uint8_t part;
    };
    /// From places in a leaf to those in a record: low + step x, in units of the leaf.
    struct RecordMap {
        std::array<std::int32_t, 2> low{};
        std::array<std::array<std::int8_t, 3>, 2> step{};
        std::uint8_t shift = 0;

        bool operator<(const RecordMap& other) const {
            return std::tie(low, step, shift) < std::tie(other.low, other.step, other.shift);
        }
    };
    struct PartRecord {
        std::int32_t record;
        std::uint32_t map;
    };

    void add_leaf(const LeafFunction& function, Task* task, std::span<const BaseElement> way,
                  std::vector<double>& values);
    void add_parts(std::span<const BaseElement> way, LeafPolynomial& leaf);
    double jump_on(const LeafPolynomial& leaf, std::size_t part) const;
    void take(const LeafPolynomial& leaf, std::size_t component, std::span<const Place> frame,
              const Factors& part, double* out) const;
    std::int32_t record_of(NodeKey key);
    const Factors& factors_of(const Record& record) const;
    int put_record(const OnRecord& at, std::size_t component, NetRoom& net) const;

    std::size_t components_;
    std::size_t drawn_;
    std::vector<LeafPolynomial> leaves_;
    std::vector<double> nets_;
    std::vector<Record> records_;
    std::vector<RecordMap> maps_;               // each once
    std::vector<PartRecord> of_part_;           // of the parts of all leaves
    KeyTable<NodeKey, std::uint32_t> leaf_of_;  // by path
    int greatest_degree_ = 1;
    std::vector<double> least_;  // of each component
    std::vector<double> greatest_;
    // Until finish():
    std::vector<CornerKeys> corners_;                // of the leaves
    KeyTable<NodeKey, std::uint32_t> owner_;         // of parts of leaves
    KeyTable<NodeKey, std::int32_t> record_number_;  // of those
    std::map<RecordMap, std::uint32_t> map_number_;
};

/// The corners of a part of a reference element.
std::array<Place, 4> corners_of(const ShapeParts& shape, const ShapePart& part);

}  // namespace nestgrid::engine
