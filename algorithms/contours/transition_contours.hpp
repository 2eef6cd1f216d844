// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The segments that elements draw on closed faces (walk/closed_parts.hpp): the finer side records
// them, the coarser side adopts them.
//
// Invariants:
//   - a segment is stored under the key of every closed face that contains it. An element that has
//     a closed face among its own faces does not divide it, so that all segments under the key of
//     that face come from its other side;
//   - a vertex is known by its number in the surface; or, where the surface has no numbers or may
//     not have the vertex, by its name and a number of the record, which keeps its cut.
// Memory: of the order of the surface on closed faces.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <nestgrid/detail/elements.hpp>
#include <nestgrid/detail/key_filter.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <surfaces/surface_builder.hpp>
#include <walk/closed_parts.hpp>

namespace nestgrid::engine {

class SharedNodes;

class TransitionContours {
public:
    using Index = std::uint32_t;

    /// The element that draws a segment.
    struct Owner {
        std::uint32_t element = 0;  ///< number in a list of the record
        Shape shape = Shape::point;
        int level = 0;
    };

    /// Must be called once, before the first vertex() and record().
    /// \param elements an empty list for elements of the grid
    void begin(std::size_t attribute_count, Elements elements) {
        attribute_count_ = attribute_count;
        owners_ = std::move(elements);
    }

    /// Chooses how vertices are known: by their names, to which vertex() gives numbers of the
    /// record, or else by their numbers in the surface. To be called before the first record().
    void know_by_names(bool by_names) { by_names_ = by_names; }
    bool by_names() const { return by_names_; }

    /// To be called before the first record() where ranks share nodes; null where they do not.
    void share(const SharedNodes* shared) { shared_ = shared; }
    /// Tells other ranks what was recorded on faces and edges that they may have, too, and records
    /// what they tell (ranks/contour_exchange.cpp). Collective, after the last record().
    void exchange();

    /// A polygon in a face that its two sides divide in different directions.
    struct Gap {
        std::vector<Index> loop;
        Owner owner;  ///< an element at it
    };

    /// Adds the segment from one vertex to the other, seen from outside the element that draws it:
    /// it leaves the region U >= C on its right.
    void record(const ClosedFace* innermost, Index from, Index to, const Handle& element,
                Shape shape, int level) {
        for (const ClosedFace* face = innermost; face != nullptr; face = face->outer) {
            const NodeKey key = face->key();
            record(key, from, to);
            if (shared_ != nullptr) note_shared(key, *face);
            const NodeKey divided_by = face->divided_by();
            if (divided_by != 0) note_split(key, divided_by, element, shape, level);
        }
    }
    void record(NodeKey face, Index from, Index to) { segments_.push_back({face, from, to}); }
    /// Records a node on the closed edge between two nodes.
    void record_on_edge(NodeKey edge, const std::array<NodeKey, 2>& ends, Index node) {
        record(edge, node, node);
        if (shared_ != nullptr) note_shared(edge, ends);
    }

    /// The number of the vertex with a name. Requires by_names(). make() returns its SurfaceCut
    /// where it is new.
    template <class Make>
    Index vertex(const KeyPair& name, Make&& make) {
        const auto [at, is_new] = vertex_of_.insert(name, static_cast<Index>(cuts_.size()));
        const Index number = *at;
        if (is_new) add(make());
        return number;
    }

    /// Fetches what vertex(name) reads into the cache.
    void expect(const KeyPair& name) const { vertex_of_.prefetch(name); }

    /// Adds the record of another task, as if this task had visited that task's elements.
    /// \param numbers where vertices are known by numbers of the surface: those that the vertices
    ///        of the other task's surface have in this one's
    /// \return the numbers by which this record knows the vertices of the other one
    std::vector<Index> append(const TransitionContours& other, std::vector<Index> numbers);

    /// Must be called once, after the last record() and before the first lookup.
    /// \param position tells where a vertex with a number of the surface is
    void finish(const std::function<Point(Index)>& position);

    const std::vector<Gap>& gaps() const { return gaps_; }

    bool empty() const { return segments_.empty(); }

    /// The number of a face on which something was recorded, or null.
    const Index* find_face(NodeKey key) const {
        return faces_.perhaps(hash(key)) ? face_number_.find(key) : nullptr;
    }

    /// The cut of a vertex. Requires by_names().
    SurfaceCut cut(Index vertex) const {
        const Place& place = cuts_[vertex];
        return {place.x, place.node, place.fraction,
                std::span(attributes_).subspan(vertex * attribute_count_, attribute_count_)};
    }
    /// A handle of the element of an owner, valid until the next record().
    Handle element(const Owner& owner) const { return owners_.handle(owner.element); }

    /// Follows the segments on a face from vertex `from` until stop(vertex) returns true, and calls
    /// pass(vertex) for the vertices between.
    /// \param face the number of the face
    /// \return false where the segments end before
    template <class Stop, class Pass>
    bool follow(Index face, Index from, Stop&& stop, Pass&& pass) const {
        const std::span<const Segment> on_face = segments_on(face);
        for (std::size_t steps = 0; steps < on_face.size(); ++steps) {
            const Segment* next = first_from(from, on_face);
            if (next == nullptr) return false;
            from = next->to;
            if (stop(from)) return true;
            pass(from);
        }
        return false;
    }

    /// Calls function(vertex) for the vertex that each segment on a face begins at.
    template <class Function>
    void for_each_from(Index face, Function&& function) const {
        for (const Segment& segment : segments_on(face)) function(segment.from);
    }

    void clear() {
        segments_.clear();
        gaps_.clear();
        split_of_.clear();
        conflicts_.clear();
        shared_parts_.clear();
        cuts_.clear();
        attributes_.clear();
        owners_.clear();
        vertex_of_.clear();
        face_number_.clear();
        first_on_.clear();
    }

    std::size_t memory_bytes() const {
        return segments_.capacity() * sizeof(Segment) + cuts_.capacity() * sizeof(Place) +
               attributes_.capacity() * sizeof(double) + faces_.memory_bytes() +
               vertex_of_.memory_bytes() + face_number_.memory_bytes() +
               (first_on_.capacity() + face_of_.capacity() + place_.capacity()) * sizeof(Index);
    }

private:
    struct Segment {
        NodeKey face;
        Index from;
        Index to;
        bool operator==(const Segment&) const = default;
    };
    /// The division of a face that is divided one way (ClosedFace::divided_by), and the element
    /// that recorded it first.
    struct Split {
        NodeKey by;
        Owner owner;
        bool fills = true;  ///< whether this rank fills the gaps in the face
    };
    /// The corners of a face, or the ends of an edge, that other ranks have, too.
    struct Corners {
        std::array<NodeKey, 4> key;
        std::uint8_t count;  ///< 0: not all of them are shared
        std::span<const NodeKey> all() const { return std::span(key).first(count); }
    };
    void note_shared(NodeKey part, std::span<const NodeKey> corners);
    void note_shared(NodeKey key, const ClosedFace& face) {
        std::array<NodeKey, 4> corners;
        for (std::size_t i = 0; i < face.face->corners; ++i) {
            corners[i] = face.nodes->key[face.face->corner[i]];
        }
        note_shared(key, std::span<const NodeKey>(corners).first(face.face->corners));
    }
    class Exchange;
    void note_split(NodeKey face, NodeKey by, const Handle& element, Shape shape, int level) {
        const auto next = static_cast<std::uint32_t>(owners_.size());
        const auto [first, is_new] = split_of_.insert(face, {by, {next, shape, level}});
        if (is_new) owners_.append(element);
        if (first->by != by) conflicts_.insert(face, first->owner);
    }

    struct Place {
        Point x;
        std::array<NodeKey, 2> node;
        double fraction;
    };
    void add(const SurfaceCut& cut) {
        cuts_.push_back({cut.x, cut.node, cut.fraction});
        attributes_.insert(attributes_.end(), cut.attributes.begin(), cut.attributes.end());
    }

    /// Orders the segments on one face.
    static bool before(const Segment& a, const Segment& b) {
        return a.from != b.from ? a.from < b.from : a.to < b.to;
    }

    /// Searches up to this many segments one by one, which is faster than sorting them.
    static constexpr std::size_t few = 8;
    /// The segment from a vertex to the least vertex, or null.
    static const Segment* first_from(Index from, std::span<const Segment> on_face) {
        if (on_face.size() > few) {
            const auto next =
                std::lower_bound(on_face.begin(), on_face.end(), Segment{0, from, 0}, before);
            return next == on_face.end() || next->from != from ? nullptr : &*next;
        }
        const Segment* found = nullptr;
        for (const Segment& s : on_face) {
            if (s.from == from && (found == nullptr || s.to < found->to)) found = &s;
        }
        return found;
    }

    /// Groups the segments by face, where they lie, and sorts those of faces that have many.
    void group_segments();
    void sort_segments(std::size_t face) {
        std::sort(segments_.data() + first_on_[face], segments_.data() + first_on_[face + 1],
                  before);
    }

    std::span<const Segment> segments_on(Index face) const {
        const Index first = first_on_[face];
        return std::span(segments_).subspan(first, first_on_[face + 1U] - first);
    }

    /// Links the segments on a face that only one side draws to loops. At each vertex as many of
    /// these segments begin as end.
    void find_gaps(NodeKey face, const Owner& owner, const std::function<Point(Index)>& position);

    bool by_names_ = true;
    std::vector<Segment> segments_;
    std::vector<Gap> gaps_;
    KeyTable<NodeKey, Split> split_of_;
    KeyTable<NodeKey, Owner> conflicts_;  // faces whose sides divide them in two directions
    std::vector<Place> cuts_;
    std::vector<double> attributes_;  // of all cuts, one after the other
    std::size_t attribute_count_ = 0;
    Elements owners_;
    KeyTable<KeyPair, Index> vertex_of_;
    KeyTable<NodeKey, Index> face_number_;
    std::vector<Index> first_on_;  // index of the first segment, by number of face
    std::vector<Index> face_of_;   // scratch of group_segments(), like the next one
    std::vector<Index> place_;     // where the next segment on a face belongs
    KeyFilter faces_;              // hashes of the faces in face_number_
    const SharedNodes* shared_ = nullptr;
    KeyTable<NodeKey, Corners> shared_parts_;  // by the key of a face or edge
};

}  // namespace nestgrid::engine
