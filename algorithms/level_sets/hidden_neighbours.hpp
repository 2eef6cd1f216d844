// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is hidden beyond the faces of elements: there caps close the surface, too.
//
// A face between a part of the domain that is shown and one that is hidden is capped once:
//   - by elements that are shown, where a hidden element has the face, or one around it, or where
//     all of the face is hidden by finer elements;
//   - by hidden elements, where the face is a part of that of a leaf which is shown.
// An element that is shown and is no leaf does not stop above a face of which a part is hidden.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <nestgrid/detail/key_table.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// The faces at which elements are hidden, of all levels, by key. Construction walks the elements
/// that are hidden in part, and those around leaves with a face of which a part is hidden.
class HiddenFaces {
public:
    template <class Real>
    explicit HiddenFaces(const Hierarchy<Real>& hierarchy);

    using Flags = std::uint8_t;
    static constexpr Flags some = 1;   ///< a part of the face, or all, is that of hidden elements
    static constexpr Flags whole = 2;  ///< all of it
    static constexpr Flags leaf = 4;  ///< the face of a leaf that is shown, beyond which it is part

    Flags find(NodeKey face) const {
        const Flags* const found = faces_.find(face);
        return found == nullptr ? Flags{0} : *found;
    }
    void add(NodeKey face, Flags flags) { *faces_.insert(face, 0).first |= flags; }
    /// Whether hidden elements draw caps.
    bool any_leaf() const { return any_leaf_; }
    std::size_t memory_bytes() const { return faces_.memory_bytes(); }

private:
    KeyTable<NodeKey, Flags> faces_;
    bool any_leaf_ = false;
};

/// Faces of one element, one bit each.
struct HiddenBeyond {
    std::uint8_t whole = 0;  ///< beyond which all is hidden; none of a hidden element
    std::uint8_t part = 0;   ///< beyond which a part is
    std::uint8_t leaf = 0;   ///< beyond which a leaf is shown that has a larger face
};

/// Answers for the elements that a walk is at. The walk must carry keys.
template <class Real>
class HiddenNeighbours {
public:
    using View = ElementView<Real>;

    HiddenNeighbours() = default;
    /// Borrows the walk.
    HiddenNeighbours(const Walk<Real>& walk, std::shared_ptr<const HiddenFaces> faces)
        : walk_{&walk}, faces_{std::move(faces)} {}

    /// Whether any element is hidden.
    bool any() const { return faces_ != nullptr; }
    bool hidden_elements_draw() const { return any() && faces_->any_leaf(); }
    const HiddenBeyond& of(const View& view);
    std::size_t memory_bytes() const { return any() ? faces_->memory_bytes() : 0; }

private:
    struct AtLevel {
        NodeKey path = 0;
        bool known = false;
        HiddenBeyond beyond;
    };
    HiddenBeyond find(const View& view);

    const Walk<Real>* walk_ = nullptr;
    std::shared_ptr<const HiddenFaces> faces_;
    std::vector<AtLevel> levels_;  // the element last asked for on each level
};

}  // namespace nestgrid::engine
