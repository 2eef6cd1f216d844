// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From the reference coordinates of an element to those of its children.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include <nestgrid/rule.hpp>
#include <probes/inverse_map.hpp>

namespace nestgrid::engine {

/// A child as it lies in the reference element of its father.
class ChildMap {
public:
    /// \param nodes of the rule, in reference coordinates
    ChildMap(const Child& child, std::span<const Point> nodes);

    Shape shape() const { return shape_; }
    bool affine() const { return affine_; }
    std::span<const Point> corners() const { return {corner_.data(), topology(shape_).corners}; }
    /// Takes reference coordinates of the father to those of the child.
    /// \return whether there are any
    bool enter(const Point& father, Point& child) const {
        if (!affine_) return invert(shape_, corners(), father, child = reference_middle(shape_));
        const Point d = father - corner_[0];
        child = {dot(row_[0], d), dot(row_[1], d), dot(row_[2], d)};
        return true;
    }

private:
    Shape shape_;
    bool affine_;
    std::array<Point, max_corners> corner_{};
    std::array<Point, 3> row_{};  // of the inverse of the derivative of the child's map
};

/// The children of a rule.
struct ChildMaps {
    std::vector<ChildMap> child;
    /// Whether the map of each child is a part of the father's, however deformed the father is.
    bool nested = true;
};

ChildMaps make_child_maps(const Rule& rule);

/// Keeps the maps of rules that were asked for.
class ChildMapTable {
public:
    const ChildMaps& of(const Rule& rule) {
        std::unique_ptr<ChildMaps>& maps = maps_[&rule];
        if (!maps) maps = std::make_unique<ChildMaps>(make_child_maps(rule));
        return *maps;
    }

private:
    std::map<const Rule*, std::unique_ptr<ChildMaps>> maps_;
};

}  // namespace nestgrid::engine
