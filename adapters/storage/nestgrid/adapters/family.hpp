// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a family of stored hierarchies must answer. It is a class with
//     static constexpr int dimension, max_corners, max_new_nodes, max_children;
//     static constexpr int pattern_height;   levels of the tree that one pattern spans
//     static constexpr bool conforming;      whether no node hangs after close()
//     static constexpr const char* name;     of at most 15 characters
//     static bool refines(Shape);            whether a coarse element may have the shape
//     static std::shared_ptr<const Rule> make_rule(std::uint64_t descriptor);
//                                            throws InvalidInput for a number that names no rule
//     static std::uint16_t rule_for(tree, element, Mark);
//                                            number in tree.table of the rule for a marked leaf;
//                                            throws InvalidInput for a mark it does not know
//     void close(tree) const;                what the closure demands; throws InvalidInput where
//                                            it cannot be
// and may offer
//     static constexpr Shape only_shape;     of all elements, as a grid (optional.hpp)
//     std::vector<std::int8_t> prepare(CoarseGrid&) const;
//                                            puts the corners in order, and returns the orientation
//                                            of every element then; default: nothing, all 1
//     bool is_prepared(const CoarseGrid&) const;       default: true
//     static bool is_temporary(std::uint64_t descriptor);
//                                            rules of the closure; default: none
//     std::uint32_t options() const, static Family from_options(std::uint32_t);
//                                            its members, for files; default: none
#pragma once

#include <cstdint>
#include <vector>

#include <nestgrid/adapters/coarse.hpp>

namespace nestgrid::detail {

template <class Family>
std::vector<std::int8_t> prepare(const Family& family, CoarseGrid& grid) {
    if constexpr (requires { family.prepare(grid); }) {
        return family.prepare(grid);
    } else {
        return std::vector<std::int8_t>(grid.element_count(), std::int8_t{1});
    }
}

template <class Family>
bool is_prepared(const Family& family, const CoarseGrid& grid) {
    if constexpr (requires { family.is_prepared(grid); }) {
        return family.is_prepared(grid);
    } else {
        return true;
    }
}

template <class Family>
bool is_temporary(std::uint64_t descriptor) {
    if constexpr (requires { Family::is_temporary(descriptor); }) {
        return Family::is_temporary(descriptor);
    } else {
        return false;
    }
}

template <class Family>
std::uint32_t options(const Family& family) {
    if constexpr (requires { family.options(); }) {
        return family.options();
    } else {
        return 0;
    }
}

template <class Family>
Family from_options(std::uint32_t options) {
    if constexpr (requires { Family::from_options(options); }) {
        return Family::from_options(options);
    } else {
        return {};
    }
}

}  // namespace nestgrid::detail
