// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "input/field_pair.hpp"
#include "input/input_field.hpp"

namespace {

/// What the fields of a hierarchy borrow from.
template <class Family>
struct Kept {
    nestgrid::StoredHierarchy<Family> stored;
    std::vector<std::uint32_t> leaf_nodes;
};

template <class Family>
InputField frames_of(nestgrid::StoredHierarchy<Family> stored, const Input& input) {
    using Grid = nestgrid::StoredGrid<Family>;
    auto nodes = leaf_nodes(stored.grid);
    const auto kept =
        std::make_shared<const Kept<Family>>(Kept<Family>{std::move(stored), std::move(nodes)});
    const auto& all = kept->stored;
    const std::shared_ptr<const Grid> grid(kept, &all.grid);
    const auto fields_of = [&](const nestgrid::NamedField& named) {
        std::vector<nestgrid::NodeField<Grid, double>> fields;
        for (std::size_t i = 0; i < all.times.size(); ++i) {
            fields.emplace_back(*grid, all.frame(named, i));
        }
        return fields;
    };
    InputField field;
    const nestgrid::NamedField& named = field_named(all.fields, input.array);
    auto fields = fields_of(named);
    if (const nestgrid::NamedField* const other = find_field(all.fields, input.by)) {
        const auto others = fields_of(*other);
        std::vector<FieldPair<nestgrid::NodeField<Grid, double>>> pairs;
        for (std::size_t i = 0; i < fields.size(); ++i) pairs.emplace_back(fields[i], others[i]);
        field.frames = nestgrid::shared_frames(grid, std::move(pairs), all.times, kept);
    } else {
        field.frames = nestgrid::shared_frames(grid, std::move(fields), all.times, kept);
    }
    const auto any_missing = [](const nestgrid::NamedField* each) {
        return each != nullptr &&
               std::ranges::any_of(each->values, [](double value) { return std::isnan(value); });
    };
    if (any_missing(&named) || any_missing(find_field(all.fields, input.by)))
        field.frames = field.frames.without_missing();
    field.name = named.name;
    field.nodes = grid->used_node_count();
    field.leaf_elements = grid->leaf_count();
    field.value_count = kept->leaf_nodes.size();
    field.value = [kept, values = all.frame(named, 0)](std::size_t i) {
        return values[kept->leaf_nodes[i]];
    };
    return field;
}

}  // namespace

InputField read_hierarchies(const Input& input, const Paths& paths,
                            const std::vector<double>& times) {
    InputField field;
    with_hierarchy(paths.front(), [&]<class Family>(nestgrid::StoredHierarchy<Family>& first) {
        field_named(first.fields, input.array);  // throws where there is none
        std::erase_if(first.fields, [&](const nestgrid::NamedField& each) {
            return first.fields.size() > 1 && each.name != input.array && each.name != input.by;
        });
        append_frames(first, paths, input.array);
        first.times = times_of_frames(times, std::move(first.times));
        field = frames_of(std::move(first), input);
    });
    return field;
}
