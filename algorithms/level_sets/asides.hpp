// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Elements that a walk puts aside, because finer ones beside them may come later. What they draw is
// known when the walk is over (docs/closed_surfaces.md).
//
// Most elements are kept as numbers alone: signs, the vertices on their cut edges, and the keys of
// their cut faces, about 60 bytes. Corners are kept where a part of the drawing depends on them.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <nestgrid/detail/elements.hpp>
#include <nestgrid/shape.hpp>
#include <surfaces/surface_builder.hpp>

namespace nestgrid::engine {

/// An element that was put aside, without what it has lists of. Sets of corners, edges and faces
/// have one bit each.
struct AsideElement {
    std::uint16_t edges;  ///< cut edges whose vertices are kept
    std::uint16_t level;  ///< of the element in the hierarchy
    Shape shape;
    std::uint8_t inside;    ///< corners inside the level
    std::uint8_t faces;     ///< cut faces whose keys are kept
    std::uint8_t joins;     ///< faces that join their corners inside, by the values at the corners
    std::uint8_t boundary;  ///< faces on the boundary of the domain, where vertices have names
    std::uint8_t capped;    ///< faces to be capped
    bool mirrored : 1;
    bool beyond : 1;       ///< hidden, and draws caps on elements beyond its faces
    bool has_corners : 1;  ///< keys, positions and values at the corners are kept
};

/// A list of elements in the order in which a walk met them.
template <class Real>
class Asides {
public:
    using Number = std::uint32_t;

    /// An element of the list; pointers are valid until the list changes.
    struct Aside : AsideElement {
        std::size_t index;                        ///< in the list
        std::array<Number, max_edges> vertex;     ///< by edge: its number, or that of a kept cut
        std::array<NodeKey, max_faces> face_key;  ///< by face
        const NodeKey* key;                       ///< of the corners
        const Point* x;                           ///< their positions
        const Real* value;                        ///< all components at them, corner by corner
        const NodeKey* edge_key;  ///< of the maximal edge around each edge, where faces are capped
    };

    /// To be called once.
    /// \param elements an empty list for elements of the grid
    void begin(std::size_t components, std::size_t attribute_count, Elements elements) {
        components_ = components;
        attribute_count_ = attribute_count;
        elements_ = std::move(elements);
    }

    /// Begins an element. What is kept of it is to be added next, in the order of its edges, faces
    /// and corners.
    void add(const AsideElement& element) { all_.push_back(element); }
    void add_vertex(Number number) { vertices_.push_back(number); }
    void add_cut(const SurfaceCut& cut) {
        vertices_.push_back(static_cast<Number>(cuts_.size()));
        cuts_.push_back({cut.x, cut.node, cut.fraction});
        attributes_.insert(attributes_.end(), cut.attributes.begin(), cut.attributes.end());
    }
    /// Adds the name of a cut alone, where simplices are only counted.
    void add_name(const KeyPair& name) {
        vertices_.push_back(static_cast<Number>(cuts_.size()));
        cuts_.push_back({{}, {name.low, name.high}, 0});
        attributes_.resize(attributes_.size() + attribute_count_);
    }
    void add_face_key(NodeKey key) { face_keys_.push_back(key); }
    void add_corners(std::span<const NodeKey> keys, const Point* x, const Real* values) {
        keys_.insert(keys_.end(), keys.begin(), keys.end());
        x_.insert(x_.end(), x, x + keys.size());
        values_.insert(values_.end(), values, values + keys.size() * components_);
    }
    void add_edge_keys(std::span<const NodeKey> keys) {
        edge_keys_.insert(edge_keys_.end(), keys.begin(), keys.end());
    }
    void add_handle(const Handle& element) { elements_.append(element); }

    /// Adds the list of another task.
    /// \param numbers those that the vertices of the other task's surface have in this one's; empty
    ///        where cuts are kept
    void append(const Asides& other, std::span<const Number> numbers) {
        const auto append_to = [](auto& to, const auto& from) {
            to.insert(to.end(), from.begin(), from.end());
        };
        const auto cuts = static_cast<Number>(cuts_.size());
        for (const Number v : other.vertices_) {
            vertices_.push_back(numbers.empty() ? cuts + v : numbers[v]);
        }
        append_to(all_, other.all_);
        append_to(cuts_, other.cuts_);
        append_to(attributes_, other.attributes_);
        append_to(face_keys_, other.face_keys_);
        append_to(keys_, other.keys_);
        append_to(x_, other.x_);
        append_to(values_, other.values_);
        append_to(edge_keys_, other.edge_keys_);
        elements_.append(other.elements_);
    }

    bool empty() const { return all_.empty(); }

    /// Calls function(aside) for each element.
    template <class Function>
    void for_each(Function&& function) const {
        Aside aside{};
        const Number* vertex = vertices_.data();
        const NodeKey* face_key = face_keys_.data();
        aside.key = keys_.data();
        aside.x = x_.data();
        aside.value = values_.data();
        aside.edge_key = edge_keys_.data();
        for (const AsideElement& element : all_) {
            static_cast<AsideElement&>(aside) = element;
            for (unsigned left = element.edges; left != 0; left &= left - 1) {
                aside.vertex[static_cast<std::size_t>(std::countr_zero(left))] = *vertex++;
            }
            for (unsigned left = element.faces; left != 0; left &= left - 1) {
                aside.face_key[static_cast<std::size_t>(std::countr_zero(left))] = *face_key++;
            }
            function(std::as_const(aside));
            const Topology& t = topology(element.shape);
            if (element.has_corners) {
                aside.key += t.corners;
                aside.x += t.corners;
                aside.value += t.corners * components_;
            }
            if (element.capped != 0) aside.edge_key += t.edges;
            ++aside.index;
        }
    }
    /// A cut that was kept.
    SurfaceCut cut(Number number) const {
        const Cut& cut = cuts_[number];
        return {cut.x, cut.node, cut.fraction,
                std::span(attributes_).subspan(number * attribute_count_, attribute_count_)};
    }
    /// A handle of the element, valid until the list changes. Requires that handles were added.
    Handle handle(const Aside& aside) const { return elements_.handle(aside.index); }

    void clear() {
        all_.clear();
        vertices_.clear();
        cuts_.clear();
        attributes_.clear();
        face_keys_.clear();
        keys_.clear();
        x_.clear();
        values_.clear();
        edge_keys_.clear();
        elements_.clear();
    }
    std::size_t memory_bytes() const {
        return bytes(all_) + bytes(vertices_) + bytes(cuts_) + bytes(attributes_) +
               bytes(face_keys_) + bytes(keys_) + bytes(x_) + bytes(values_) + bytes(edge_keys_) +
               elements_.memory_bytes();
    }

private:
    struct Cut {
        Point x;
        std::array<NodeKey, 2> node;
        double fraction;
    };
    template <class T>
    static std::size_t bytes(const std::vector<T>& list) {
        return list.capacity() * sizeof(T);
    }

    std::size_t components_ = 1;
    std::size_t attribute_count_ = 0;
    std::vector<AsideElement> all_;
    std::vector<Number> vertices_;
    std::vector<Cut> cuts_;
    std::vector<double> attributes_;  // of the cuts
    std::vector<NodeKey> face_keys_;
    std::vector<NodeKey> keys_;
    std::vector<Point> x_;
    std::vector<Real> values_;
    std::vector<NodeKey> edge_keys_;
    Elements elements_;  // where the surface keeps elements
};

}  // namespace nestgrid::engine
