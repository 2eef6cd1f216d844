// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The leaves that a drawing looks at, and where the records lie that they need: on their edges and
// faces, and on those of the elements above that have these in them.
#pragma once

#include <functional>

#include <high_order/base_walk.hpp>
#include <nestgrid/detail/key_table.hpp>

namespace nestgrid::engine {

class LeafChoice {
public:
    /// \param number of a leaf in the order of the walk
    using Chooses = std::function<bool(std::size_t number, const BaseElement& leaf)>;
    enum class Needs { records, polynomials };
    static constexpr std::uint32_t none = 0xFFFFFFFFU;

    /// No leaf.
    LeafChoice() = default;
    /// \param chooses where it is empty all leaves are chosen
    LeafChoice(const BaseWalk& walk, const Chooses& chooses, Needs needs = Needs::records);

    /// The number of a leaf among those that are chosen, or null.
    const std::uint32_t* find(NodeKey path) const { return number_.find(path); }
    std::size_t size() const { return number_.size(); }
    bool all() const { return all_; }
    /// The names of edges and faces that records may lie on, each with `none`; not where all are
    /// chosen.
    const KeyTable<NodeKey, std::uint32_t>& parts() const { return parts_; }
    /// Whether a leaf may have such an edge or face.
    bool may_have_record(const BaseElement& leaf) const;
    /// Forgets all but which leaves are chosen.
    void finish();
    std::size_t memory_bytes() const { return number_.memory_bytes(); }

private:
    void mark_parts(std::span<const BaseElement> way);
    void mark_corners();

    bool all_ = false;
    KeyTable<NodeKey, std::uint32_t> number_;  // by path
    KeyTable<NodeKey, std::uint32_t> parts_;
    std::vector<NodeKey> corners_;     // of marked parts
    std::vector<bool> may_be_corner_;  // by hash
};

}  // namespace nestgrid::engine
