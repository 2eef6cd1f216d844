// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The way through a hierarchy whose elements are divided in all directions at once, by red rules.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <high_order/shape_parts.hpp>

namespace nestgrid::engine {

inline constexpr std::size_t max_split_nodes = 27;  ///< of red rules, corners included
using CornerKeys = std::array<NodeKey, max_corners>;
/// Room for the nodes of a split, the corners first.
using RedSplitKeys = std::array<NodeKey, max_split_nodes>;

/// The name of a part: the same from all elements that have it.
NodeKey part_key(const CornerKeys& corners, const ShapePart& part);
/// Keys of the corners and, behind them, the new nodes of an element that the rule divides.
RedSplitKeys split_keys_of(const CornerKeys& corners, const Rule& rule);

inline double diameter_of(std::span<const Point> corners) {
    double diameter = 0;
    for (const Point& a : corners) {
        for (const Point& b : corners) diameter = std::max(diameter, norm(a - b));
    }
    return diameter;
}

/// An element of the hierarchy on the way down.
struct BaseElement {
    const Member* member = nullptr;
    const ShapeParts* shape = nullptr;
    CornerKeys key{};
    std::array<Point, max_corners> x{};  ///< of the corners, where the walk has positions
    NodeKey path = 0;                    ///< a hash of the way down
    std::size_t number = 0;              ///< among its father's children, or of the coarse element
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
    enum class Positions { no, yes };

    /// \throw InvalidInput where the hierarchy is of another dimension than 2 and 3
    explicit BaseWalk(const Hierarchy<double>& base);

    /// \throw InvalidInput for an element that is divided otherwise than by red_rule(), or
    ///        red_tetrahedron_rule() with any diagonal, but for the order of nodes and children
    void for_each(const Function& function, Positions positions = Positions::no) const;

    /// As in "element 3/0/1".
    static std::string name(std::span<const BaseElement> way);

private:
    struct Way;
    void visit(Way& way, std::size_t level) const;
    void put_positions(Way& way, const BaseElement& e, std::span<Point> x) const;

    const Hierarchy<double>* base_;
};

}  // namespace nestgrid::engine
