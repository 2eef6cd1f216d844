// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The way through a hierarchy whose elements are divided in all directions at once, by red rules.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <high_order/shape_parts.hpp>

namespace nestgrid::engine {

inline constexpr std::size_t max_split_nodes = 27;  ///< of red rules, corners included
using CornerKeys = std::array<NodeKey, max_corners>;
/// Room for the nodes of a split, the corners first.
using RedSplitKeys = std::array<NodeKey, max_split_nodes>;

/// The names of the parts of an element: the same from all elements that have them.
using PartKeys = std::array<NodeKey, max_parts>;
PartKeys part_keys(const CornerKeys& corners, const ShapeParts& shape);
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
    const InFather* in_father = nullptr;  ///< null in a coarse element
    CornerKeys key{};
    std::array<Point, max_corners> x{};  ///< of the corners, where the walk has positions
    double moved = 0;                    ///< how far these may be from means of means
    NodeKey path = 0;                    ///< a hash of the way down
    std::size_t number = 0;              ///< among its father's children, or of the coarse element
};

/// The path of an element whose father has a path.
constexpr NodeKey child_path(NodeKey father, std::size_t child) {
    return father * NodeKey{0x9e3779b97f4a7c15ULL} + child + 1U;
}
constexpr NodeKey coarse_path(std::size_t i) { return nestgrid::detail::mix(NodeKey{i}); }

/// The numbers of the elements on the way to a leaf.
using WayToLeaf = std::vector<std::size_t>;

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
    /// Calls it for `count` leaves, the first of which is `from`, and for those elements above them
    /// whose first leaf is one of these. Positions are not given.
    void for_each(const Function& function, const WayToLeaf& from, std::size_t count) const;

    /// As in "element 3/0/1".
    static std::string name(std::span<const BaseElement> way);

private:
    struct Way;
    void run(Way& way) const;
    void visit(Way& way, std::size_t level, bool is_first) const;
    static const std::vector<InFather>& children_of(Way& way, const Rule& rule);
    double put_positions(Way& way, const BaseElement& e, std::span<Point> x) const;

    const Hierarchy<double>* base_;
};

/// Calls a function with the elements on the way that have the part or corner of the last one in
/// an edge or face, from the coarse one down, until it returns true.
/// \param function called with the number of the element on the way, and that of its part
/// \return whether it did
template <class Function>
bool look_around(std::span<const BaseElement> way, PartOrCorner of, const Function& function) {
    const BaseElement& e = way.back();
    if (e.in_father != nullptr) {
        const int around = e.in_father->around[of];
        const auto above = way.first(way.size() - 1);
        if (around != ShapeParts::inside &&
            look_around(above, static_cast<PartOrCorner>(around), function)) {
            return true;
        }
    }
    return of < e.shape->parts.size() && function(way.size() - 1, of);
}

}  // namespace nestgrid::engine
