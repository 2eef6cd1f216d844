// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hierarchies in .nestgrid files.
#include <algorithm>
#include <cmath>
#include <optional>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/adapters/prism_grid.hpp>
#include <nestgrid/adapters/red_green.hpp>
#include <nestgrid/adapters/stored_file.hpp>

#include "source.hpp"

namespace nestgrid::python {

std::size_t index_of_field(const std::vector<std::string>& names, const std::string& name) {
    if (names.empty()) throw InvalidInput("the hierarchy has no field");
    if (name.empty() && names.size() == 1) return 0;
    std::string known;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == name) return i;
        known += (i == 0 ? "'" : ", '") + names[i] + "'";
    }
    throw InvalidInput(name.empty() ? "there are several fields, choose one by array: " + known
                                    : "there is no field '" + name + "', only " + known);
}

namespace {

/// Whether a value of a frame is not a number (NaN).
bool any_missing(const NamedField& field) {
    return std::ranges::any_of(field.values, [](double value) { return std::isnan(value); });
}

template <class Family>
LoadedField loaded_field(StoredHierarchy<Family> stored, const std::string& array,
                         const Call& call) {
    using Grid = StoredGrid<Family>;
    using Field = NodeField<Grid, double>;
    std::vector<std::string> names;
    for (const NamedField& field : stored.fields) names.push_back(field.name);
    const std::size_t index = index_of_field(names, array);
    const auto kept = std::make_shared<const StoredHierarchy<Family>>(std::move(stored));
    const NamedField& named = kept->fields[index];
    std::vector<Field> fields;
    for (std::size_t i = 0; i < kept->times.size(); ++i) {
        fields.emplace_back(kept->grid, kept->frame(named, i));
    }
    const Frames frames = shared_frames(std::shared_ptr<const Grid>(kept, &kept->grid),
                                        std::move(fields), kept->times, kept);
    return {any_missing(named) ? frames.without_missing(call.work()) : frames, named.name};
}

/// \return whether the file holds this family
template <class Family>
bool load_family(const HierarchyHeader& header, const std::filesystem::path& path,
                 const std::string& array, const Call& call, std::optional<LoadedField>& loaded) {
    if (header.family != Family::name || header.dimension != Family::dimension ||
        header.corners != Family::max_corners) {
        return false;
    }
    loaded = loaded_field(read_hierarchy<Family>(path), array, call);
    return true;
}

template <class... Families>
LoadedField load_one_of(const std::filesystem::path& path, const std::string& array,
                        const Call& call) {
    const HierarchyHeader header = read_hierarchy_header(path);
    std::optional<LoadedField> loaded;
    if ((load_family<Families>(header, path, array, call, loaded) || ...))
        return *std::move(loaded);
    throw IoError("'" + path.string() + "' holds a family that is not known: " + header.family);
}

}  // namespace

LoadedField load_hierarchy(const std::filesystem::path& path, const std::string& array,
                           const Call& call) {
    return load_one_of<Bisection<2>, Bisection<3>, RedGreen<2, 3>, RedGreen<2, 4>, RedGreen<3, 4>,
                       RedGreen<3, 8>, Octree<2>, Octree<3>, Prism>(path, array, call);
}

}  // namespace nestgrid::python
