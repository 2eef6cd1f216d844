// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The segments that elements draw on closed faces (walk/closed_parts.hpp): the finer side records
// them, the coarser side adopts them.
//
// Invariant: a segment is stored under the key of every closed face that contains it. An element
// that has a closed face among its own faces does not divide it, so that all segments under the key
// of that face come from its other side.
// Memory: of the order of the surface on closed faces.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <nestgrid/detail/elements.hpp>
#include <nestgrid/detail/key_filter.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <surfaces/surface_builder.hpp>
#include <walk/closed_parts.hpp>

namespace nestgrid::engine {

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
            const NodeKey divided_by = face->divided_by();
            if (divided_by != 0) note_split(key, divided_by, element, shape, level);
        }
    }
    void record(NodeKey face, Index from, Index to) { segments_.push_back({face, from, to}); }

    /// The number of the vertex with a name; make() returns its SurfaceCut where it is new.
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
    void append(const TransitionContours& other) {
        std::vector<KeyPair> names(other.cuts_.size());
        other.vertex_of_.for_each([&](const KeyPair& name, Index v) { names[v] = name; });
        std::vector<Index> number(names.size());
        for (std::size_t v = 0; v < names.size(); ++v) {
            number[v] = vertex(names[v], [&] { return other.cut(static_cast<Index>(v)); });
        }
        for (const Segment& s : other.segments_) {
            segments_.push_back({s.face, number[s.from], number[s.to]});
        }
        other.split_of_.for_each([&](NodeKey face, const Split& s) {
            note_split(face, s.by, other.element(s.owner), s.owner.shape, s.owner.level);
        });
        other.conflicts_.for_each([&](NodeKey face, const Owner&) {
            conflicts_.insert(face, split_of_.find(face)->owner);
        });
    }

    /// Must be called once, after the last record() and before the first lookup.
    void finish() {
        group_segments();
        conflicts_.for_each([&](NodeKey face, const Owner& owner) { find_gaps(face, owner); });
        std::sort(gaps_.begin(), gaps_.end(),
                  [](const Gap& a, const Gap& b) { return a.loop < b.loop; });
        conflicts_ = {};
        split_of_ = {};
        faces_.reset(face_number_.size());
        face_number_.for_each([&](NodeKey face, Index) { faces_.add(hash(face)); });
    }

    const std::vector<Gap>& gaps() const { return gaps_; }

    bool empty() const { return segments_.empty(); }

    /// The recorded vertex with a name, or null.
    const Index* find(const KeyPair& name) const { return vertex_of_.find(name); }

    /// The number of a face on which something was recorded, or null.
    const Index* find_face(NodeKey key) const {
        return faces_.perhaps(hash(key)) ? face_number_.find(key) : nullptr;
    }

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
        cuts_.clear();
        attributes_.clear();
        owners_.clear();
        vertex_of_.clear();
        face_number_.clear();
        first_on_.clear();
    }

    std::size_t memory_bytes() const {
        return (segments_.capacity() + grouped_.capacity()) * sizeof(Segment) +
               cuts_.capacity() * sizeof(Place) + attributes_.capacity() * sizeof(double) +
               faces_.memory_bytes() + vertex_of_.memory_bytes() + face_number_.memory_bytes() +
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
    };
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

    /// Groups the segments by face, and sorts those of faces that have many.
    void group_segments() {
        face_of_.resize(segments_.size());
        for (std::size_t i = 0; i < segments_.size(); ++i) {
            const auto next = static_cast<Index>(face_number_.size());
            face_of_[i] = *face_number_.insert(segments_[i].face, next).first;
        }
        first_on_.assign(face_number_.size() + 1, 0);
        for (const Index f : face_of_) ++first_on_[f + 1U];
        std::partial_sum(first_on_.begin(), first_on_.end(), first_on_.begin());
        place_.assign(first_on_.begin(), first_on_.end());
        grouped_.resize(segments_.size());
        for (std::size_t i = 0; i < segments_.size(); ++i) {
            grouped_[place_[face_of_[i]]++] = segments_[i];
        }
        segments_.swap(grouped_);
        for (std::size_t f = 0; f + 1 < first_on_.size(); ++f) {
            if (first_on_[f + 1] - first_on_[f] > few) sort_segments(f);
        }
    }
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
    void find_gaps(NodeKey face, const Owner& owner) {
        std::vector<Segment> left;
        const Index number = *face_number_.find(face);
        sort_segments(number);
        const std::span<const Segment> all = segments_on(number);
        for (const Segment& s : all) {
            if (!std::binary_search(all.begin(), all.end(), Segment{face, s.to, s.from}, before)) {
                if (left.empty() || !(left.back() == s)) left.push_back(s);
            }
        }
        while (!left.empty()) {
            Gap gap{{}, owner};
            const Index start = left.back().from;
            for (Index at = start; gap.loop.empty() || at != start;) {
                const auto next = std::find_if(left.begin(), left.end(),
                                               [&](const Segment& s) { return s.from == at; });
                if (next == left.end()) break;
                gap.loop.push_back(at);
                at = next->to;
                left.erase(next);
            }
            if (gap.loop.size() > 2) gaps_.push_back(std::move(gap));
        }
    }

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
    std::vector<Index> face_of_;   // scratch of group_segments(), like the next two
    std::vector<Index> place_;
    std::vector<Segment> grouped_;
    KeyFilter faces_;  // hashes of the faces in face_number_
};

}  // namespace nestgrid::engine
