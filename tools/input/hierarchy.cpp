// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/hierarchy.hpp"

#include <algorithm>

#include "formats.hpp"
#include "suggestion.hpp"

using nestgrid::InvalidInput;

namespace {

const RegisteredFormat nestgrid_format({.name = "nestgrid",
                                        .endings = {".nestgrid"},
                                        .holds = "a hierarchy with fields, several frames",
                                        .options = {"--array"},
                                        .keeps_hierarchies = true});

}  // namespace

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
    std::vector<std::string> known;
    for (const nestgrid::NamedField& f : fields) known.push_back(f.name);
    throw InvalidInput(name.empty()
                           ? "there are several fields, choose one by --array: " + listed(known)
                           : "there is no field '" + name + "', only " + listed(known) +
                                 did_you_mean(name, known));
}

bool is_hierarchy(const std::filesystem::path& path) {
    const Format* const format = format_of(path);
    return format != nullptr && format->keeps_hierarchies;
}

void require_hierarchy_name(const std::filesystem::path& path) {
    if (is_hierarchy(path)) return;
    throw nestgrid::IoError("'" + path.string() + "' is no name of a .nestgrid file");
}

namespace {

/// \param used whether a node is in use
template <class Family>
FieldInfo field_info(const nestgrid::StoredHierarchy<Family>& stored,
                     const nestgrid::NamedField& field, const std::vector<bool>& used) {
    FieldInfo info{.name = field.name, .bytes = field.values.size() * sizeof(double)};
    const auto add = [&](std::span<const double> values) {
        for (std::size_t node = 0; node < used.size(); ++node) {
            if (!used[node]) continue;
            info.least = std::min(info.least, values[node]);
            info.greatest = std::max(info.greatest, values[node]);
        }
    };
    for (const auto& encoded : field.encoded) {
        info.step = encoded.packed().step;
        info.bytes += encoded.memory_bytes();
        add(nestgrid::decode(stored.grid, encoded));
    }
    if (!field.values.empty()) {
        for (std::size_t i = 0; i < stored.times.size(); ++i) add(stored.frame(field, i));
    }
    return info;
}

template <class Family>
HierarchyInfo info_of(const nestgrid::StoredHierarchy<Family>& stored) {
    const auto& grid = stored.grid;
    HierarchyInfo info;
    info.family = Family::name;
    info.dimension = Family::dimension;
    info.coarse_elements = grid.coarse_count();
    info.leaves = grid.leaf_count();
    info.nodes = grid.used_node_count();
    info.bytes = grid.memory_bytes();
    info.times = stored.times;
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
    for (const nestgrid::NamedField& field : stored.fields) {
        info.fields.push_back(field_info(stored, field, used));
    }
    return info;
}

}  // namespace

HierarchyInfo hierarchy_info(const std::filesystem::path& path) {
    HierarchyInfo info;
    with_hierarchy(
        path, [&](const auto& stored) { info = info_of(stored); }, nestgrid::Encoded::keep);
    return info;
}
