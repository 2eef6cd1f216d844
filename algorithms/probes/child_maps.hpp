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

/// The children of a rule.
struct ChildMaps {
    const Rule* rule;
    std::vector<InverseMap> child;  ///< from reference coordinates of the father
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
