// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The polynomials of leaves, those of the field or of positions (leaf_functions.hpp), and one
// record for each edge and face that leaves share: of all leaves, or of those that a drawing looks
// at.
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
// Owners are chosen among all leaves, whichever are looked at: these see the same bits.
#pragma once

#include <map>
#include <memory>
#include <tuple>

#include <high_order/leaf_choice.hpp>
#include <high_order/leaf_summary.hpp>
#include <high_order/pyramid.hpp>

namespace nestgrid::engine {

/// Points in the frame of a record.
struct OnRecord {
    std::int32_t record = -1;  ///< -1: the points are in none
    int shift = 0;             ///< the element that was asked for has 2^-shift of the record's size
    int level = 0;             ///< the points are in units of 2^-level of the record's size
    std::array<Place, 4> at{};
    std::size_t count = 0;

    /// Whether the points, corners of a part, are those of the record.
    bool is_whole() const { return level == 0 && count > 1; }
};

/// An edge or face of a leaf, or a part of one.
struct PartOfLeaf {
    std::uint32_t leaf = 0;  ///< its number among all leaves
    int level = 0;           ///< the corners are in units of 2^-level of the leaf
    std::array<Place, 4> corner{};
    std::size_t count = 0;

    std::span<const Place> corners() const { return std::span(corner).first(count); }
};

/// A leaf and its polynomial.
struct LeafPolynomial {
    const double* net = nullptr;  ///< of component 0, then those of others
    std::uint32_t first = 0;      ///< of its parts in the list of all
    std::uint32_t number = 0;     ///< among all leaves, in the order of the walk
    float jump = 0;               ///< the greatest difference from the records and nodes around
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

/// Room for coefficients, which stay where they are.
class NetStore {
public:
    double* add(std::size_t count);
    std::size_t memory_bytes() const { return size_ * sizeof(double); }

private:
    struct Block {
        std::unique_ptr<double[]> room;
        std::size_t size;
    };
    std::vector<Block> blocks_;
    std::size_t left_ = 0;  // in the last block
    std::size_t size_ = 0;  // of all blocks
};

/// The record of an edge or face (ShapePart), bounded, and how far one of its leaves is from it.
struct PartFacts {
    NetFacts record;
    double jump = 0;  ///< how far the leaf is from the record there
};

class RecordSearch;

class LeafRecords {
public:
    /// Looks for the records of all leaves: claim() is called for each of them, in the order of the
    /// walk, then read() where its polynomial is needed.
    explicit LeafRecords(const LeafFunction& function)
        : components_{function.components()}, drawn_{function.drawn()} {}
    /// Adds the last element on the way, a leaf, and makes it the owner of records.
    /// \throw GridError where a degree is not 1 to 8, and names the leaf
    void claim(const LeafFunction& function, Task* task, std::span<const BaseElement> way);
    /// Takes the polynomial of a leaf, the last element on the way.
    /// \param room for it
    /// \throw GridError where a value is not finite, and names the leaf
    void read(const LeafFunction& function, Task* task, std::span<const BaseElement> way,
              std::uint32_t leaf, NetStore& room);
    /// No more leaves are added.
    void end_claims();

    /// The records of no leaf.
    explicit LeafRecords(const LeafSummary& summary)
        : components_{summary.components}, drawn_{summary.drawn} {}
    /// Reads the chosen leaves, in the order of the choice, and behind them the owners of records
    /// on these. Asks the function once for each leaf. Where the choice marks no parts for records,
    /// there are polynomials alone.
    /// \throw GridError as claim() and read()
    LeafRecords(const LeafFunction& function, const BaseWalk& walk, const LeafChoice& choice,
                const LeafSummary& summary);

    std::size_t components() const { return components_; }
    /// As in LeafSummary.
    std::size_t drawn() const { return drawn_; }
    const std::vector<LeafPolynomial>& leaves() const { return leaves_; }
    const double* net(const LeafPolynomial& leaf, std::size_t component = 0) const {
        return leaf.net + component * leaf.size();
    }
    /// Points on a part of a leaf. \param points at most 4, in units of 2^-level of the leaf
    OnRecord on_part(const LeafPolynomial& leaf, std::size_t part, std::span<const Place> points,
                     int level) const;
    /// Beta and range in a leaf, without the records around.
    NetFacts facts_of(const LeafPolynomial& leaf) const {
        return joined_facts(drawn_, [&](std::size_t c) {
            return net_facts(net(leaf, c), leaf.degree, leaf.factors());
        });
    }
    /// Beta and range on the part with these corners.
    NetFacts facts_on(const OnRecord& part) const;
    /// The same of a part of a leaf, with the record on its corners, and what the leaf has there.
    PartFacts compared(const LeafPolynomial& leaf, std::size_t part, const OnRecord& on) const;
    /// Whether the record that is a part of a leaf has the very coefficients that the leaf has
    /// there and these say nothing that the leaf's own do not: in boxes, a part is no less flat
    /// than the whole, and in its range.
    bool coincides(const LeafPolynomial& leaf, const BaseElement& e, std::size_t part,
                   std::int32_t record) const;
    std::uint32_t owner_of(const OnRecord& part) const {
        return records_[static_cast<std::size_t>(part.record)].leaf;
    }
    /// A part of a record as one of its owner.
    PartOfLeaf in_owner(const OnRecord& part) const;
    /// Values of all components at one point.
    void values_at(const OnRecord& point, double* out) const;
    std::size_t memory_bytes() const;

private:
    friend class RecordSearch;
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

    static int degree_of(const LeafFunction& function, Task* task,
                         std::span<const BaseElement> way);
    bool claim_parts(const LeafFunction& function, Task* task, std::span<const BaseElement> way,
                     const LeafChoice* choice, std::uint32_t index);
    void add_parts(RecordSearch& search, std::span<const BaseElement> way, LeafPolynomial& leaf);
    void take(const LeafPolynomial& leaf, std::size_t component, std::span<const Place> frame,
              const Factors& part, double* out) const;
    const Factors& factors_of(const Record& record) const;
    NetPart part_of(const OnRecord& at) const;
    int put_record(const OnRecord& at, std::size_t component, NetRoom& net) const;
    const double* on_record(const OnRecord& at, const NetPart& there, std::size_t component,
                            std::array<NetRoom, 2>& room, int& degree) const;

    std::size_t components_;
    std::size_t drawn_;
    std::vector<LeafPolynomial> leaves_;
    NetStore nets_;
    std::vector<Record> records_;
    std::vector<RecordMap> maps_;                 // each once
    std::vector<PartRecord> of_part_;             // of the parts of the leaves that are looked at
    KeyTable<NodeKey, std::uint32_t> record_of_;  // by the names of parts, until all are found
    std::map<RecordMap, std::uint32_t> map_number_;
};

/// Finds the records around the elements of one walk, when all leaves have made their claims.
class RecordSearch {
public:
    explicit RecordSearch(const LeafRecords& records) : records_{&records} {}

    /// The record of the largest edge or face of a leaf that has a part or corner of the last
    /// element on the way in it. \param points of that part, in the coordinates of the element
    OnRecord around(std::span<const BaseElement> way, PartOrCorner of,
                    std::span<const Place> points);
    /// The leaf that owns the record on a part of a leaf.
    std::uint32_t owner(std::span<const BaseElement> way, std::size_t part);
    /// The record that a part of a leaf is; -1 where it is a part of one.
    std::int32_t whole(std::span<const BaseElement> way, std::size_t part);

private:
    static constexpr std::int32_t none = -1;
    struct Found {
        std::int32_t record = none;
        std::uint32_t level = 0;  // of the element on the way that has it on a part
        std::uint8_t part = 0;
        bool known = false;
    };
    /// What was found for an element on the way.
    struct Known {
        NodeKey path = 0;
        PartKeys key{};
        std::array<Found, max_parts> part{};
    };
    Found find(std::span<const BaseElement> way, PartOrCorner of);

    const LeafRecords* records_;
    std::vector<Known> known_;  // by level
};

/// The corners of a part of a reference element, and those of the frame of a part.
std::array<Place, 4> corners_of(const ShapeParts& shape, const ShapePart& part);
std::array<Place, 3> places_of(const ShapeParts& shape, const std::array<std::uint8_t, 3>& frame);

}  // namespace nestgrid::engine
