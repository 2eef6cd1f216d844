// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plotfiles of AMReX: folders, which are mapped. Cells are drawn by the means at their nodes.
#include <nestgrid/adapters/amrex_plotfile.hpp>

#include <algorithm>
#include <cmath>

#include "formats.hpp"
#include "input/field_pair.hpp"
#include "input/input_field.hpp"
#include "output/report.hpp"

namespace {

using nestgrid::AmrexPlotfile;
using nestgrid::BlockCell;
using nestgrid::BlockGrid;
namespace fs = std::filesystem;

/// The folder of a plotfile, which may be named by its Header, too.
fs::path folder_of(const fs::path& path) {
    if (path.filename() != "Header") return path;
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

bool is_plotfile(const fs::path& path) {
    std::error_code none;
    return fs::is_regular_file(folder_of(path) / "Header", none);
}

/// The number of a field of a file.
std::size_t number_of(const AmrexPlotfile& file, const std::string& name) {
    std::vector<nestgrid::NamedField> all;
    for (const std::string& each : file.fields()) all.emplace_back().name = each;
    const std::string chosen = field_named(all, name).name;
    const auto at = std::ranges::find(file.fields(), chosen);
    return static_cast<std::size_t>(at - file.fields().begin());
}

/// \param cells as --cells says it
nestgrid::CellRule rule_of(const std::string& cells) {
    if (cells == "smooth") return nestgrid::CellRule::smooth;
    return cells == "means" ? nestgrid::CellRule::sharp_means : nestgrid::CellRule::sharp_centres;
}

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

/// What fields borrow from.
template <int dim>
struct MappedPlotfiles {
    std::vector<AmrexPlotfile> files;
    BlockGrid<dim> grid;
    CellNumbers<dim> cells{grid};

    explicit MappedPlotfiles(std::vector<AmrexPlotfile> all)
        : files{std::move(all)}, grid(files.front().blocks<dim>()) {}
    MappedPlotfiles(const MappedPlotfiles&) = delete;
    MappedPlotfiles& operator=(const MappedPlotfiles&) = delete;
    ~MappedPlotfiles() = default;
};

/// \throw nestgrid::InvalidInput where a file has another grid than the first one
template <int dim>
void require_one_grid(const MappedPlotfiles<dim>& kept, const Paths& paths) {
    const nestgrid::Blocks<dim> first = kept.files.front().template blocks<dim>();
    for (std::size_t i = 1; i < kept.files.size(); ++i) {
        const nestgrid::Blocks<dim> other = kept.files[i].template blocks<dim>();
        if (BlockGrid<dim>(other).epoch() == kept.grid.epoch() && other.origin == first.origin &&
            other.spacing == first.spacing) {
            continue;
        }
        throw nestgrid::InvalidInput("'" + paths[i].string() +
                                     "' has another grid than the first input");
    }
}

template <int dim, class Real>
InputField plotfile_frames(std::vector<AmrexPlotfile> files, const Input& input, const Paths& paths,
                           const std::vector<double>& given) {
    using Field = nestgrid::BlockCells<dim, Real>;
    const auto kept = std::make_shared<const MappedPlotfiles<dim>>(std::move(files));
    require_one_grid(*kept, paths);
    const std::shared_ptr<const BlockGrid<dim>> grid(kept, &kept->grid);
    std::vector<Field> fields;
    std::vector<FieldPair<Field>> pairs;
    std::vector<double> times;
    bool any_missing = false;
    const auto add = [&](const AmrexPlotfile& file, const std::string& name) {
        auto arrays = file.arrays<dim, Real>(number_of(file, name));
        any_missing = any_missing || is_leaf_missing(*grid, arrays);
        return Field(*grid, std::move(arrays), rule_of(input.cells));
    };
    const std::string& first_name =
        kept->files.front().fields()[number_of(kept->files.front(), input.array)];
    const auto& names = kept->files.front().fields();
    const bool has_other = std::ranges::find(names, input.by) != names.end();
    for (const AmrexPlotfile& file : kept->files) {
        fields.push_back(add(file, first_name));
        if (has_other) pairs.emplace_back(fields.back(), add(file, input.by));
        times.push_back(file.time());
    }
    InputField field;
    times = times_of_frames(given, times);
    field.frames = has_other
                       ? nestgrid::shared_frames(grid, std::move(pairs), std::move(times), kept)
                       : nestgrid::shared_frames(grid, std::move(fields), std::move(times), kept);
    if (any_missing) field.frames = field.frames.without_missing();
    field.name = first_name;
    field.nodes = grid->used_node_count();
    field.leaf_elements = grid->leaf_count();
    field.value_count = kept->cells.count();
    field.value = [kept, arrays = kept->files.front().template arrays<dim, Real>(
                             number_of(kept->files.front(), first_name))](std::size_t i) {
        return number_at(arrays, kept->cells.leaf(kept->cells.cell(i)));
    };
    return field;
}

InputField read_plotfiles(const Input& input, const Paths& paths,
                          const std::vector<double>& times) {
    std::vector<AmrexPlotfile> files;
    for (const fs::path& path : paths) {
        if (!is_plotfile(path)) {
            throw nestgrid::InvalidInput("'" + path.string() + "' is no plotfile, as the first is");
        }
        files.emplace_back(folder_of(path));
    }
    const AmrexPlotfile& first = files.front();
    const bool is_double = first.is_double();
    if (first.dimension() == 2) {
        return is_double ? plotfile_frames<2, double>(std::move(files), input, paths, times)
                         : plotfile_frames<2, float>(std::move(files), input, paths, times);
    }
    return is_double ? plotfile_frames<3, double>(std::move(files), input, paths, times)
                     : plotfile_frames<3, float>(std::move(files), input, paths, times);
}

/// One row a field, with the least and the greatest value in leaves.
template <int dim, class Real>
void report_fields(const AmrexPlotfile& file, const CellNumbers<dim>& cells, Report& report) {
    std::vector<nestgrid::BlockArrays<dim, Real>> arrays;
    for (std::size_t f = 0; f < file.fields().size(); ++f) {
        arrays.push_back(file.arrays<dim, Real>(f));
    }
    std::vector<std::array<double, 2>> ranges(arrays.size(), {INFINITY, -INFINITY});
    for (std::size_t i = 0; i < cells.count(); ++i) {
        const BlockCell<dim> cell = cells.cell(i);
        if (cells.leaf(cell).level != cell.level) continue;
        for (std::size_t f = 0; f < arrays.size(); ++f) {
            const double value = number_at(arrays[f], cell);
            ranges[f][0] = value < ranges[f][0] ? value : ranges[f][0];
            ranges[f][1] = value > ranges[f][1] ? value : ranges[f][1];
        }
    }
    for (std::size_t f = 0; f < arrays.size(); ++f) {
        report.add_row("fields", Row()
                                     .add("field", file.fields()[f])
                                     .add("least_value", ranges[f][0])
                                     .add("greatest_value", ranges[f][1]));
    }
}

template <int dim>
void report_plotfile(const AmrexPlotfile& file, Report& report) {
    const nestgrid::Blocks<dim> blocks = file.blocks<dim>();
    const BlockGrid<dim> grid(blocks);
    report.add("dimension", std::uint64_t{dim});
    report.add("type", std::string(file.is_double() ? "float64" : "float32"));
    report.add("time", file.time());
    report.add("leaf_elements", grid.leaf_count());
    report.add("nodes", grid.used_node_count());
    report.add("coarse_elements", std::uint64_t{grid.coarse_count()});
    report.add("origin", std::vector<double>(blocks.origin.begin(), blocks.origin.begin() + dim));
    report.add("spacing",
               std::vector<double>(blocks.spacing.begin(), blocks.spacing.begin() + dim));
    for (std::size_t l = 0; l < file.level_count(); ++l) {
        const int ratio = blocks.levels[l].ratio[0];
        Row row;
        row.add("level", std::uint64_t{l}).add("boxes", std::uint64_t{file.box_count(l)});
        row.add("cells", file.cell_count(l));
        report.add_row("levels", row.add("ratio", l == 0 ? Cell() : Cell(std::uint64_t(ratio))));
    }
    const CellNumbers<dim> cells(grid);
    if (file.is_double()) {
        report_fields<dim, double>(file, cells, report);
    } else {
        report_fields<dim, float>(file, cells, report);
    }
}

void describe_plotfile(const fs::path& path, Report& report) {
    const AmrexPlotfile file(folder_of(path));
    if (file.dimension() == 2) {
        report_plotfile<2>(file, report);
    } else {
        report_plotfile<3>(file, report);
    }
}

const RegisteredFormat plotfile({.name = "AMReX plotfile",
                                 .endings = {},
                                 .holds = "boxes of cells on levels, several fields",
                                 .options = {"--array", "--cells"},
                                 .recognises = is_plotfile,
                                 .read_field = read_plotfiles,
                                 .describe = describe_plotfile});

}  // namespace
