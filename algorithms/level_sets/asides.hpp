// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Elements that a walk puts aside, because finer ones beside them may come later. What they draw is
// known when the walk is over (docs/closed_surfaces.md).
//
// Most elements are kept as numbers alone: signs, the vertices on their cut edges, and the keys of
// their cut faces, about 55 bytes. Corners are kept where a part of the drawing depends on them.
// Elements lie behind each other in blocks of memory, without lists of their own.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <nestgrid/detail/elements.hpp>
#include <nestgrid/shape.hpp>
#include <surfaces/surface_builder.hpp>

namespace nestgrid::engine {

/// The parts of an element that was put aside which every element has. Sets of corners, edges and
/// faces have one bit each.
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

/// Blocks of memory that only grow in number. What lies there is never moved.
class MemoryBlocks {
public:
    /// Memory behind all that was taken before, at an address that is a multiple of 8.
    /// \param size in bytes
    std::byte* room(std::size_t size) {
        while (blocks_.empty() || blocks_[last_].size - blocks_[last_].used < size) begin(size);
        return blocks_[last_].memory.get() + blocks_[last_].used;
    }
    /// Takes the beginning of what room() returned.
    /// \param size in bytes, a multiple of 8
    void take(std::size_t size) { blocks_[last_].used += size; }
    /// Calls function(begin, end) for the part of each block that is used.
    template <class Function>
    void for_each(Function&& function) const {
        for (const Block& block : blocks_) {
            const std::byte* const begin = block.memory.get();
            function(begin, begin + block.used);
        }
    }
    /// The same, and frees each block behind its call.
    template <class Function>
    void drain(Function&& function) {
        for (Block& block : std::exchange(blocks_, {})) {
            const std::unique_ptr<std::byte[]> memory = std::move(block.memory);  // NOLINT
            function(memory.get(), memory.get() + block.used);
        }
        last_ = 0;
        bytes_ = 0;
    }
    /// Takes all back, and keeps the memory.
    void clear() {
        for (Block& block : blocks_) block.used = 0;
        last_ = 0;
    }
    std::size_t memory_bytes() const { return bytes_; }

private:
    struct Block {
        std::unique_ptr<std::byte[]> memory;  // NOLINT(modernize-avoid-c-arrays): not set to zeros
        std::size_t size;
        std::size_t used;
    };

    /// Goes on in the next block, and makes it where there is none. A block has an eighth of the
    /// memory so far, so that little remains empty.
    void begin(std::size_t size) {
        if (last_ + 1 < blocks_.size()) {
            ++last_;
            return;
        }
        const std::size_t bytes = std::max({size, bytes_ / 8, std::size_t{4096}});
        blocks_.push_back({std::unique_ptr<std::byte[]>(new std::byte[bytes]), bytes, 0});
        bytes_ += bytes;
        last_ = blocks_.size() - 1;
    }

    std::vector<Block> blocks_;
    std::size_t last_ = 0;  // the block that is filled
    std::size_t bytes_ = 0;
};

/// A list of elements in the order in which a walk met them.
template <class Real>
class Asides {
public:
    using Number = std::uint32_t;

    /// An element of the list. Its pointers are null where nothing is kept there.
    struct Aside : AsideElement {
        std::size_t index;                        ///< in the list; add() does not read it
        std::array<Number, max_edges> vertex;     ///< by edge: its number in the surface or record
        std::array<NodeKey, max_faces> face_key;  ///< by face
        const NodeKey* key;                       ///< of the corners
        const Point* x;                           ///< their positions
        const Real* value;                        ///< all components at them, corner by corner
        const NodeKey* edge_key;  ///< of the maximal edge around each edge, where faces are capped
    };

    /// To be called once.
    /// \param elements an empty list for elements of the grid
    void begin(std::size_t components, Elements elements) {
        components_ = components;
        elements_ = std::move(elements);
    }

    /// Adds an element.
    void add(const Aside& aside) {
        const Topology& t = topology(aside.shape);
        const std::size_t corners = aside.has_corners ? t.corners : 0U;
        const std::size_t edges = aside.capped != 0 ? t.edges : 0U;
        const std::size_t values = corners * components_;
        std::byte* const begin = blocks_.room(most_bytes + values * sizeof(Real) + 2 * alignment);
        std::byte* at = begin;
        const AsideElement& element = aside;
        put(at, &element, 1);
        for_each_bit(aside.edges, [&](std::size_t e) { put(at, &aside.vertex[e], 1); });
        at = begin + aligned(at - begin);
        for_each_bit(aside.faces, [&](std::size_t f) { put(at, &aside.face_key[f], 1); });
        put(at, aside.key, corners);
        put(at, aside.x, corners);
        put(at, aside.edge_key, edges);
        put(at, aside.value, values);
        blocks_.take(aligned(at - begin));
        ++size_;
    }
    /// Adds a handle of the element that was added last.
    void add_handle(const Handle& element) { elements_.append(element); }

    /// Adds the list of another task.
    /// \param numbers those that the vertices of the other task have in this one
    void append(const Asides& other, std::span<const Number> numbers) {
        other.for_each([&](const Aside& from) {
            Aside aside = from;
            for_each_bit(aside.edges,
                         [&](std::size_t e) { aside.vertex[e] = numbers[from.vertex[e]]; });
            add(aside);
        });
        elements_.append(other.elements_);
    }

    bool empty() const { return size_ == 0; }

    /// Calls function(aside) for each element.
    template <class Function>
    void for_each(Function&& function) const {
        blocks_.for_each(reader(function));
    }
    /// The same, and frees the memory of elements behind it. handle() is valid until it returns.
    template <class Function>
    void drain(Function&& function) {
        blocks_.drain(reader(function));
        clear();
    }
    /// A handle of the element, valid until the list changes. Requires that handles were added.
    Handle handle(const Aside& aside) const { return elements_.handle(aside.index); }

    void clear() {
        blocks_.clear();
        size_ = 0;
        elements_.clear();
    }
    std::size_t memory_bytes() const { return blocks_.memory_bytes() + elements_.memory_bytes(); }

private:
    // An element lies in memory as add() puts it: the numbers of its vertices behind its
    // AsideElement; then its face keys, the keys and positions of its corners, its edge keys and
    // its values.
    static constexpr std::size_t alignment = 8;
    static constexpr std::size_t most_bytes =
        sizeof(AsideElement) + max_edges * sizeof(Number) +
        (max_faces + max_corners + max_edges) * sizeof(NodeKey) + max_corners * sizeof(Point);

    static std::size_t aligned(std::ptrdiff_t bytes) {
        return (static_cast<std::size_t>(bytes) + alignment - 1) & ~(alignment - 1);
    }
    template <class Function>
    static void for_each_bit(unsigned bits, Function&& function) {
        for (; bits != 0; bits &= bits - 1) {
            function(static_cast<std::size_t>(std::countr_zero(bits)));
        }
    }
    template <class T>
    static void put(std::byte*& at, const T* from, std::size_t count) {
        if (count > 0) std::memcpy(at, from, count * sizeof(T));
        at += count * sizeof(T);
    }
    template <class T>
    static const T* array_at(const std::byte*& at, std::size_t count) {
        const auto* const array = reinterpret_cast<const T*>(at);
        at += count * sizeof(T);
        return count == 0 ? nullptr : array;
    }

    /// Calls function(aside) for each element between two addresses.
    template <class Function>
    auto reader(Function& function) const {
        return [this, &function, aside = Aside{}](const std::byte* begin,
                                                  const std::byte* end) mutable {
            while (begin != end) {
                begin += read(begin, aside);
                function(std::as_const(aside));
                ++aside.index;
            }
        };
    }
    /// Reads the element that begins at an address.
    /// \return its size in bytes
    std::size_t read(const std::byte* begin, Aside& aside) const {
        const std::byte* at = begin;
        static_cast<AsideElement&>(aside) = *array_at<AsideElement>(at, 1);
        for_each_bit(aside.edges,
                     [&](std::size_t e) { aside.vertex[e] = *array_at<Number>(at, 1); });
        at = begin + aligned(at - begin);
        for_each_bit(aside.faces,
                     [&](std::size_t f) { aside.face_key[f] = *array_at<NodeKey>(at, 1); });
        const Topology& t = topology(aside.shape);
        const std::size_t corners = aside.has_corners ? t.corners : 0U;
        aside.key = array_at<NodeKey>(at, corners);
        aside.x = array_at<Point>(at, corners);
        aside.edge_key = array_at<NodeKey>(at, aside.capped != 0 ? t.edges : 0U);
        aside.value = array_at<Real>(at, corners * components_);
        return aligned(at - begin);
    }

    std::size_t components_ = 1;
    MemoryBlocks blocks_;
    std::size_t size_ = 0;
    Elements elements_;  // where the surface keeps elements
};

}  // namespace nestgrid::engine
