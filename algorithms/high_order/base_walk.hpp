// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The way through a hierarchy of quadrilaterals or hexahedra that are halved in all directions,
// with the entities around: edges and faces, named by how an element has them.
//
// A part of an element is a number in base 3, one digit a direction, the first one last: 0 or 1 at
// the lower or upper end of the element, 2 where the part goes from end to end. So parts without a
// 2 are corners, and the part of 2s alone is the element. Places are whole numbers in units of a
// part.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <high_order/box_net.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid::engine {

using PartCode = unsigned;
/// Places along the directions.
using BoxPlace = std::array<std::uint32_t, 3>;
using BoxKeys = std::array<NodeKey, max_box_corners>;
/// Room for the nodes of a split, the corners first.
using BoxSplitKeys = std::array<NodeKey, 27>;

constexpr PartCode part_count(int dimension) { return dimension == 3 ? 27 : 9; }

/// The directions in which a part goes from end to end, one bit each.
unsigned span_of(PartCode part, int dimension);
/// The corner of the element with the part's lower ends: bit d is set where it is at the upper one.
unsigned low_corner_of(PartCode part, int dimension);
/// The part of an element that a part of one of its parts lies in.
/// \param span directions in which the small part goes on \param at its lower end
/// \param level the element has 2^level units
PartCode part_around(unsigned span, const BoxPlace& at, int level, int dimension);
/// The name of a part: the same from all elements that have it.
NodeKey part_key(const BoxKeys& corners, PartCode part, int dimension);
/// Keys of the corners and, behind them, the new nodes of an element that the rule divides.
BoxSplitKeys split_keys_of(const BoxKeys& corners, const Rule& rule);
/// How a new node of the rule halves a part of the element.
struct HalvedPart {
    unsigned span = 0;  ///< directions in which the part is halved
    BoxPlace at{};      ///< its lower end: 0 or 1 in the others
};
std::vector<HalvedPart> halved_parts(const Rule& rule);

/// An element of the hierarchy on the way down.
struct BaseElement {
    const Member* member = nullptr;
    BoxKeys key{};
    NodeKey path = 0;        ///< a hash of the way down
    std::size_t number = 0;  ///< among its father's children, or of the coarse element
};

/// The path of an element whose father has a path.
constexpr NodeKey child_path(NodeKey father, std::size_t child) {
    return father * NodeKey{0x9e3779b97f4a7c15ULL} + child + 1U;
}
constexpr NodeKey coarse_path(std::size_t i) { return nestgrid::detail::mix(NodeKey{i}); }

/// Calls a function for every element, fathers first.
class BaseWalk {
public:
    /// \param way the elements on the way down, the one at hand last
    using Function = std::function<void(Task* task, std::span<const BaseElement> way)>;

    /// \throw InvalidInput where the hierarchy is of another dimension than 2 and 3
    explicit BaseWalk(const Hierarchy<double>& base);

    int dimension() const { return dimension_; }
    const Rule& rule() const { return *rule_; }
    /// \throw InvalidInput for an element that is neither a quadrilateral nor a hexahedron, or not
    ///        halved in all directions
    void for_each(const Function& function) const;

    /// As in "element 3/0/1".
    static std::string name(std::span<const BaseElement> way);

private:
    struct Way;
    void visit(Way& way, std::size_t level) const;

    const Hierarchy<double>* base_;
    int dimension_;
    const Rule* rule_;
};

}  // namespace nestgrid::engine
