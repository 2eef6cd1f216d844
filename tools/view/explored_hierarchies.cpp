// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include <nestgrid/error.hpp>

#include "explored_files.hpp"

namespace nestgrid::view {

namespace {

/// Files of one family, as they were read.
template <class Family>
struct Kept {
    StoredGrid<Family> grid;
    std::vector<std::vector<double>> values;  ///< of the field, one list a frame
};

template <class Family>
ExploredField explored(StoredHierarchy<Family>& first, const Paths& paths, const std::string& array,
                       std::vector<double> times) {
    using Grid = StoredGrid<Family>;
    const std::string name = field_named(first.fields, array).name;
    std::vector<std::vector<double>> values = frame_values(first, paths, array);
    const auto kept = std::make_shared<const Kept<Family>>(
        Kept<Family>{std::move(first.grid), std::move(values)});
    const std::shared_ptr<const Grid> grid(kept, &kept->grid);
    std::vector<NodeField<Grid, double>> fields;
    for (const auto& v : kept->values) fields.emplace_back(*grid, v);
    ExploredField f = fields.size() == 1
                          ? still_field(grid, fields.front(), kept)
                          : moving_field(grid, std::move(fields), std::move(times), kept);
    f.name = name;
    const std::vector<std::uint32_t> nodes = leaf_nodes(*grid);
    f.histogram =
        histogram_of(nodes.size(), [&](std::size_t i) { return kept->values.front()[nodes[i]]; });
    return f;
}

}  // namespace

ExploredField read_explored_hierarchies(const Paths& paths, const std::string& array,
                                        std::vector<double> times) {
    ExploredField f;
    with_hierarchy(paths.front(), [&]<class Family>(StoredHierarchy<Family>& first) {
        if constexpr (Family::dimension == 3) {
            f = explored(first, paths, array, std::move(times));
        } else {
            throw InvalidInput("'" + paths.front().string() +
                               "' has 2 dimensions; only fields in space can be explored");
        }
    });
    return f;
}

ExploredField read_explored(Input& input, const Paths& paths, std::vector<double> times) {
    ExploredField f = is_hierarchy(paths.front())
                          ? read_explored_hierarchies(paths, input.array, std::move(times))
                          : read_explored_volumes(input, paths, std::move(times));
    if (f.name == "value" && !input.array.empty()) f.name = input.array;
    f.title = paths.front().filename().string();
    if (paths.size() > 1) f.title += " … " + paths.back().filename().string();
    return f;
}

}  // namespace nestgrid::view
