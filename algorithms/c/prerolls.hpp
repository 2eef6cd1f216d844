// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators of one grid and field that several calls of a C code share.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include <nestgrid/algorithms/options.h>
#include <nestgrid/algorithms/swept_indicator.hpp>

/// Several calls may ask at once; the one that comes first computes.
struct nestgrid_prerolls {
    /// Keeps the tables that are asked for first.
    /// \throw nestgrid::InvalidInput where they are of another grid or field
    void require_same(const nestgrid_grid& grid, const nestgrid_field& field);
    /// The indicator that `map` has under a number; make() gives it where there is none yet.
    template <class Map, class Make>
    typename Map::mapped_type kept(Map& map, int number, const Make& make) {
        const std::scoped_lock lock(mutex);
        auto& entry = map[number];
        if (entry == nullptr) entry = make();
        return entry;
    }

    std::mutex mutex;
    bool used = false;
    const void* grid = nullptr;  // `self` of the tables
    const void* field = nullptr;
    std::map<int, std::shared_ptr<const nestgrid::HierarchicalIndicator>> of_nodes;
    std::map<int, std::shared_ptr<const nestgrid::SweptIndicator>> swept;
};
