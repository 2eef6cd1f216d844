// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the adapter of Dune asks a grid beside its elements, by Dune's interface alone.
#pragma once

#include <array>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <nestgrid/error.hpp>
#include <nestgrid/rule_table.hpp>

#include <dune/common/fvector.hh>
#include <dune/geometry/type.hh>
#include <dune/grid/common/capabilities.hh>
#include <dune/grid/common/rangegenerators.hh>

namespace nestgrid {

namespace detail {

inline Shape dune_shape(const Dune::GeometryType& type) {
    if (type.isTriangle()) return Shape::triangle;
    if (type.isQuadrilateral()) return Shape::quadrilateral;
    if (type.isTetrahedron()) return Shape::tetrahedron;
    if (type.isPyramid()) return Shape::pyramid;
    if (type.isPrism()) return Shape::prism;
    if (type.isHexahedron()) return Shape::hexahedron;
    throw InvalidInput("an element of the Dune grid is of dimension " + std::to_string(type.dim()) +
                       " and none of the known shapes");
}

template <class Coordinates>
Point dune_point(const Coordinates& x) {
    Point point{0, 0, 0};
    for (std::size_t d = 0; d < x.size(); ++d) point[d] = static_cast<double>(x[d]);
    return point;
}

/// An id of at most 64 bits is itself; others are hashed.
template <class Id>
std::uint64_t dune_id(const Id& id) {
    if constexpr (std::is_integral_v<Id>) {
        return static_cast<std::uint64_t>(id);
    } else if constexpr (std::has_unique_object_representations_v<Id>) {
        std::array<std::uint64_t, (sizeof(Id) + 7) / 8> words{};
        std::memcpy(words.data(), &id, sizeof(Id));
        std::uint64_t sum = 0;
        for (const std::uint64_t word : words) sum = mix64(sum + word);
        return sum;
    } else {
        return mix64(static_cast<std::uint64_t>(std::hash<Id>{}(id)));
    }
}

/// The rules of a grid, found by Dune's interface alone.
template <class Element>
class DuneRules {
public:
    /// \param placed room to work in
    const Rule& add(const Element& e, std::span<const Element> children,
                    std::vector<PlacedChild>& placed) {
        place(children, placed);
        return table_.add(dune_shape(e.type()), placed);
    }
    /// Null where there was no such rule.
    const Rule* find(const Element& e, std::span<const Element> children,
                     std::vector<PlacedChild>& placed) const {
        place(children, placed);
        return table_.find(dune_shape(e.type()), placed);
    }
    const RuleTable& table() const { return table_; }

private:
    static void place(std::span<const Element> children, std::vector<PlacedChild>& placed) {
        placed.resize(children.size());
        for (std::size_t c = 0; c < children.size(); ++c) {
            placed[c].shape = dune_shape(children[c].type());
            const auto geometry = children[c].geometryInFather();
            for (int i = 0; i < topology(placed[c].shape).corners; ++i) {
                placed[c].corners[static_cast<std::size_t>(i)] = dune_point(geometry.corner(i));
            }
        }
    }

    RuleTable table_;
};

}  // namespace detail

/// What a grid is known to do by Dune's interface alone.
template <class DuneType>
struct DuneDefaults {
    using Element = typename DuneType::template Codim<0>::Entity;
    using Rules = detail::DuneRules<Element>;

    /// The most children an element may have.
    static constexpr int max_children = nestgrid::max_children;
    /// leafIndexSet().subIndex() is right at the corners of elements that are no leaves.
    static constexpr bool leaf_indices_on_branches = false;
    /// No node hangs on a leaf, which then need not be found out.
    static constexpr bool conforming = Dune::Capabilities::isLeafwiseConforming<DuneType>::v;
    /// Several threads may copy entities and ask them at a time.
    static constexpr bool several_threads = Dune::Capabilities::viewThreadSafe<DuneType>::v;

    /// The children, in the same order whenever they are asked for.
    static void children(const DuneType&, const Element& e, std::vector<Element>& out) {
        out.clear();
        for (const Element& child : descendantElements(e, e.level() + 1)) out.push_back(child);
    }
    /// The position of a corner: the same bits in every element and on every process that has it.
    static Point corner(const DuneType&, const Element& e, int corner) {
        return detail::dune_point(e.geometry().corner(corner));
    }
    /// A number that is the less the earlier one process would list an element of the coarse grid;
    /// for grids over several processes. Here by ids, which are given in that order.
    static std::uint64_t coarse_place(const DuneType& grid, const Element& e) {
        return detail::dune_id(grid.globalIdSet().id(e));
    }
};

/// To be specialised for types of grids of which more is known; what is known of one grid alone,
/// such as that it is conforming, goes into a class derived from this.
template <class DuneType>
struct DuneTraits : DuneDefaults<DuneType> {};

}  // namespace nestgrid
