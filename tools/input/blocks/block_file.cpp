// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/blocks/block_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "input/field_pair.hpp"
#include "input/input_field.hpp"
#include "output/report.hpp"

namespace {

using nestgrid::BlockCell;
using nestgrid::BlockGrid;
using nestgrid::InvalidInput;
namespace fs = std::filesystem;

/// All cells of all boxes, by numbers.
template <int dim>
class CellNumbers {
public:
    explicit CellNumbers(const BlockGrid<dim>& grid) : grid_{&grid} {
        for (std::size_t l = 0; l < grid.level_count(); ++l) {
            for (std::size_t b = 0; b < grid.box_count(l); ++b) {
                boxes_.push_back(
                    {static_cast<std::int32_t>(l), static_cast<std::int32_t>(b), {}, {}});
                std::size_t cells = 1;
                for (const std::int32_t n : grid.box_size(l, b))
                    cells *= static_cast<std::size_t>(n);
                first_.push_back(first_.back() + cells);
            }
        }
    }
    std::size_t count() const { return first_.back(); }
    BlockCell<dim> cell(std::size_t i) const {
        const auto box = std::upper_bound(first_.begin(), first_.end(), i) - first_.begin() - 1;
        BlockCell<dim> cell = boxes_[static_cast<std::size_t>(box)];
        i -= first_[static_cast<std::size_t>(box)];
        const auto size = grid_->box_size(static_cast<std::size_t>(cell.level),
                                          static_cast<std::size_t>(cell.box));
        for (std::size_t d = 0; d < size.size(); ++d) {
            cell.place[d] = static_cast<std::int32_t>(i % static_cast<std::size_t>(size[d]));
            i /= static_cast<std::size_t>(size[d]);
        }
        return cell;
    }
    /// The first leaf within a cell: itself where no finer box covers it.
    BlockCell<dim> leaf(const BlockCell<dim>& cell) const { return grid_->first_leaf(cell); }
    bool is_leaf(const BlockCell<dim>& cell) const { return leaf(cell).level == cell.level; }

private:
    const BlockGrid<dim>* grid_;
    std::vector<BlockCell<dim>> boxes_;
    std::vector<std::size_t> first_{0};
};

template <int dim, class Real>
double number_at(const nestgrid::BlockArrays<dim, Real>& arrays, const BlockCell<dim>& cell) {
    const auto& of_level = arrays[static_cast<std::size_t>(cell.level)];
    return static_cast<double>(of_level[static_cast<std::size_t>(cell.box)].at(cell.place));
}

/// \throw InvalidInput that names the file where its boxes are no hierarchy
template <int dim>
BlockGrid<dim> grid_of(const BlockFile& file, const fs::path& path) {
    try {
        return BlockGrid<dim>(blocks_in<dim>(file));
    } catch (const InvalidInput& error) {
        throw InvalidInput("'" + path.string() + "': " + error.what());
    }
}

/// What fields borrow from.
template <int dim>
struct KeptBlocks {
    std::vector<BlockFile> files;
    BlockGrid<dim> grid;
    CellNumbers<dim> cells{grid};
    std::vector<std::shared_ptr<const void>> memory{};

    KeptBlocks(std::vector<BlockFile> all, const fs::path& first)
        : files{std::move(all)}, grid(grid_of<dim>(files.front(), first)) {}
    KeptBlocks(const KeptBlocks&) = delete;
    KeptBlocks& operator=(const KeptBlocks&) = delete;
    ~KeptBlocks() = default;
};

/// \throw InvalidInput where a file has another grid than the first one, or another type
template <int dim>
void require_one_grid(const KeptBlocks<dim>& kept, const Paths& paths) {
    const BlockFile& first = kept.files.front();
    for (std::size_t i = 1; i < kept.files.size(); ++i) {
        const BlockFile& other = kept.files[i];
        const auto refuse = [&](const std::string& what) {
            throw InvalidInput("'" + paths[i].string() + "' has " + what);
        };
        if (other.dimension != dim) {
            refuse(std::to_string(other.dimension) + " dimensions, not " + std::to_string(dim));
        }
        if (grid_of<dim>(other, paths[i]).epoch() != kept.grid.epoch() ||
            other.blocks.origin != first.blocks.origin ||
            other.blocks.spacing != first.blocks.spacing ||
            other.blocks.axes != first.blocks.axes) {
            refuse("another grid than the first input");
        }
        if (other.is_double != first.is_double) {
            refuse("numbers of another type than the first input");
        }
    }
}

/// The times that the files tell, or times_of_files() where one of them tells none.
std::vector<double> times_in(const std::vector<BlockFile>& files) {
    std::vector<double> times;
    for (const BlockFile& file : files) {
        if (!file.time) return times_of_files(files.size());
        times.push_back(*file.time);
    }
    return times;
}

template <int dim, class Real>
InputField frames_of(std::vector<BlockFile> files, const Input& input, const Paths& paths,
                     const std::vector<double>& given) {
    using Field = nestgrid::BlockCells<dim, Real>;
    const auto kept = std::make_shared<KeptBlocks<dim>>(std::move(files), paths.front());
    require_one_grid(*kept, paths);
    const std::shared_ptr<const BlockGrid<dim>> grid(kept, &kept->grid);
    const std::vector<double> times = times_of_frames(given, times_in(kept->files));
    const BlockFile& first = kept->files.front();
    const std::size_t chosen = number_of(first.fields, input.array);
    const std::string& name = first.fields[chosen].name;
    std::vector<Field> fields;
    std::vector<FieldPair<Field>> pairs;
    nestgrid::BlockArrays<dim, Real> first_arrays;
    bool any_missing = false;
    const auto add = [&](const BlockFile& file, const std::string& wanted, int component) {
        BoxNumbers numbers = file.numbers(number_of(file.fields, wanted), component);
        kept->memory.push_back(std::move(numbers.memory));
        auto arrays = arrays_of<dim, Real>(numbers.arrays);
        any_missing = any_missing || is_leaf_missing(*grid, arrays);
        if (first_arrays.empty()) first_arrays = arrays;
        return Field(*grid, std::move(arrays), rule_of(input.cells));
    };
    const std::optional<OtherField> other = other_field(first.fields, input.by);
    for (const BlockFile& file : kept->files) {
        const int component = component_of(file.fields[number_of(file.fields, name)], input);
        fields.push_back(add(file, name, component));
        if (!other) continue;
        pairs.emplace_back(fields.back(),
                           add(file, first.fields[other->field].name, other->component));
    }
    InputField field;
    field.frames = other ? nestgrid::shared_frames(grid, std::move(pairs), times, kept)
                         : nestgrid::shared_frames(grid, std::move(fields), times, kept);
    if (any_missing) field.frames = field.frames.without_missing();
    field.name = name;
    field.nodes = grid->used_node_count();
    field.leaf_elements = grid->leaf_count();
    field.value_count = kept->cells.count();
    field.value = [kept, arrays = std::move(first_arrays)](std::size_t i) {
        return number_at(arrays, kept->cells.leaf(kept->cells.cell(i)));
    };
    return field;
}

/// The least and the greatest value in leaves.
template <int dim, class Real>
std::array<double, 2> range_of(const BoxNumbers& numbers, const CellNumbers<dim>& cells,
                               const std::vector<bool>& is_leaf) {
    const auto arrays = arrays_of<dim, Real>(numbers.arrays);
    std::array<double, 2> range{INFINITY, -INFINITY};
    for (std::size_t i = 0; i < is_leaf.size(); ++i) {
        if (!is_leaf[i]) continue;
        const double value = number_at(arrays, cells.cell(i));
        range[0] = value < range[0] ? value : range[0];
        range[1] = value > range[1] ? value : range[1];
    }
    return range;
}

/// One row a field, with the range of its first component.
template <int dim>
void report_fields(const BlockFile& file, const BlockGrid<dim>& grid, Report& report) {
    const CellNumbers<dim> cells(grid);
    std::vector<bool> is_leaf(cells.count());
    for (std::size_t i = 0; i < is_leaf.size(); ++i) is_leaf[i] = cells.is_leaf(cells.cell(i));
    const bool has_vectors =
        std::ranges::any_of(file.fields, [](const auto& each) { return each.components > 1; });
    for (std::size_t f = 0; f < file.fields.size(); ++f) {
        const BoxNumbers numbers = file.numbers(f, 0);
        const auto range = file.is_double ? range_of<dim, double>(numbers, cells, is_leaf)
                                          : range_of<dim, float>(numbers, cells, is_leaf);
        Row row;
        row.add("field", file.fields[f].name);
        if (has_vectors) {
            row.add("components", static_cast<std::uint64_t>(file.fields[f].components));
        }
        row.add("least_value", range[0]).add("greatest_value", range[1]);
        report.add_row("fields", std::move(row));
    }
}

template <int dim>
void report_levels(const BlockGrid<dim>& grid, const BlockFile& file, Report& report) {
    for (std::size_t l = 0; l < grid.level_count(); ++l) {
        std::uint64_t cells = 0;
        for (std::size_t b = 0; b < grid.box_count(l); ++b) {
            std::uint64_t of_box = 1;
            for (const std::int32_t n : grid.box_size(l, b)) of_box *= static_cast<unsigned>(n);
            cells += of_box;
        }
        const int ratio = file.blocks.levels[l].ratio[0];
        Row row;
        row.add("level", std::uint64_t{l}).add("boxes", std::uint64_t{grid.box_count(l)});
        row.add("cells", cells);
        report.add_row("levels", row.add("ratio", l == 0 ? Cell() : Cell(std::uint64_t(ratio))));
    }
}

template <int dim>
void report_blocks(const BlockFile& file, const fs::path& path, Report& report) {
    const BlockGrid<dim> grid = grid_of<dim>(file, path);
    const nestgrid::Point& origin = file.blocks.origin;
    const nestgrid::Point& spacing = file.blocks.spacing;
    report.add("dimension", std::uint64_t{dim});
    report.add("type", std::string(file.is_double ? "float64" : "float32"));
    if (file.time) report.add("time", *file.time);
    report.add("leaf_elements", grid.leaf_count());
    report.add("nodes", grid.used_node_count());
    report.add("coarse_elements", std::uint64_t{grid.coarse_count()});
    std::vector<double> begin;
    for (const int axis : blocks_in<dim>(file).axes) {
        begin.push_back(origin[static_cast<std::size_t>(axis)]);
    }
    report.add("origin", begin);
    report.add("spacing", std::vector<double>(spacing.begin(), spacing.begin() + dim));
    report_levels(grid, file, report);
    report_fields(file, grid, report);
}

}  // namespace

std::size_t number_of(const std::vector<BlockFile::Field>& fields, const std::string& name) {
    std::vector<nestgrid::NamedField> all;
    for (const BlockFile::Field& each : fields) all.emplace_back().name = each.name;
    const std::string chosen = field_named(all, name).name;
    const auto at = std::ranges::find(fields, chosen, &BlockFile::Field::name);
    return static_cast<std::size_t>(at - fields.begin());
}

std::optional<OtherField> other_field(const std::vector<BlockFile::Field>& fields,
                                      const std::string& by) {
    const auto found = [&](const std::string& name) {
        return std::ranges::find(fields, name, &BlockFile::Field::name);
    };
    const std::size_t colon = std::min(by.rfind(':'), by.size());
    const bool is_whole = found(by) != fields.end();
    const auto at = is_whole ? found(by) : found(by.substr(0, colon));
    if (at == fields.end()) return std::nullopt;
    const std::string chosen = is_whole ? "" : by.substr(colon + 1);
    int component = 0;
    const char* const end = chosen.data() + chosen.size();
    const bool is_number =
        chosen.empty() || std::from_chars(chosen.data(), end, component).ptr == end;
    const bool is_chosen = !is_whole && !chosen.empty();
    if (!is_number || component < 0 || component >= at->components ||
        (at->components > 1 && !is_chosen)) {
        throw InvalidInput("'" + at->name + "' has " + std::to_string(at->components) +
                           " numbers per cell: choose one by --by '" + at->name + ":0' to '" +
                           at->name + ":" + std::to_string(at->components - 1) + "'");
    }
    return OtherField{static_cast<std::size_t>(at - fields.begin()), component};
}

int component_of(const BlockFile::Field& field, const Input& input) {
    const auto& chosen = input.choice.component;
    const std::string last = std::to_string(field.components - 1);
    if (field.components == 1) {
        if (!chosen) return 0;
        throw InvalidInput("--component chooses nothing: '" + field.name +
                           "' has one number per cell");
    }
    if (!chosen || static_cast<std::int64_t>(*chosen) >= field.components) {
        throw InvalidInput("'" + field.name + "' has " + std::to_string(field.components) +
                           " numbers per cell, not one: choose by --component, from 0 to " + last);
    }
    return static_cast<int>(*chosen);
}

nestgrid::CellRule rule_of(const std::string& cells) {
    if (cells == "smooth") return nestgrid::CellRule::smooth;
    return cells == "means" ? nestgrid::CellRule::sharp_means : nestgrid::CellRule::sharp_centres;
}

InputField block_field(std::vector<BlockFile> files, const Input& input, const Paths& paths,
                       const std::vector<double>& given) {
    const bool is_double = files.front().is_double;
    if (files.front().dimension == 2) {
        return is_double ? frames_of<2, double>(std::move(files), input, paths, given)
                         : frames_of<2, float>(std::move(files), input, paths, given);
    }
    return is_double ? frames_of<3, double>(std::move(files), input, paths, given)
                     : frames_of<3, float>(std::move(files), input, paths, given);
}

void describe_blocks(const BlockFile& file, const fs::path& path, Report& report) {
    if (file.dimension == 2) {
        report_blocks<2>(file, path, report);
    } else {
        report_blocks<3>(file, path, report);
    }
}
