// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hierarchy.hpp"

#include <algorithm>

using nestgrid::InvalidInput;

const nestgrid::NamedField* find_field(const std::vector<nestgrid::NamedField>& fields,
                                       const std::string& name) {
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&](const auto& each) { return each.name == name; });
    return field == fields.end() ? nullptr : &*field;
}

const nestgrid::NamedField& field_named(const std::vector<nestgrid::NamedField>& fields,
                                        const std::string& name) {
    if (fields.empty()) throw InvalidInput("the hierarchy has no field; give --field to mesh");
    if (name.empty() && fields.size() == 1) return fields.front();
    if (const auto* field = find_field(fields, name)) return *field;
    std::string known;
    for (const nestgrid::NamedField& f : fields) {
        known += (known.empty() ? "'" : ", '") + f.name + "'";
    }
    throw InvalidInput(name.empty() ? "there are several fields, choose one by --array: " + known
                                    : "there is no field '" + name + "', only " + known);
}

HierarchyInfo hierarchy_info(const std::filesystem::path& path) {
    HierarchyInfo info;
    with_hierarchy(path, [&](const auto& stored) {
        const auto& grid = stored.grid;
        using Grid = std::decay_t<decltype(grid)>;
        info.family = std::decay_t<decltype(grid.family())>::name;
        info.dimension = Grid::dimension;
        info.coarse_elements = grid.coarse_count();
        info.leaves = grid.leaf_count();
        info.nodes = grid.used_node_count();
        info.bytes = grid.memory_bytes();
        std::vector<bool> used(grid.node_count(), false);
        grid.for_each_leaf([&](const nestgrid::Leaf& leaf) {
            ++info.shapes[leaf.shape];
            info.levels = std::max(info.levels, leaf.level + 1);
            info.measure += std::abs(nestgrid::measure(leaf.shape, leaf.corners));
            for (const std::uint32_t node : leaf.nodes) used[node] = true;
        });
        for (std::uint32_t node = 0; node < used.size(); ++node) {
            if (used[node] && grid.hangs(node)) ++info.hanging;
        }
        for (const nestgrid::NamedField& f : stored.fields) {
            FieldRange range{f.name, INFINITY, -INFINITY};
            for (std::size_t node = 0; node < used.size(); ++node) {
                if (!used[node]) continue;
                range.least = std::min(range.least, f.values[node]);
                range.greatest = std::max(range.greatest, f.values[node]);
            }
            info.fields.push_back(range);
        }
    });
    return info;
}
