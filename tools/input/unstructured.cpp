// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Unstructured grids of VTK (.vtu, .pvtu): linear, quadratic and Lagrange cells with values at
// points, and frames of them (.pvd).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include <nestgrid/adapters/lagrange.hpp>

#include "formats.hpp"
#include "input/field_pair.hpp"
#include "input/input_field.hpp"
#include "input/unstructured_file.hpp"
#include "output/report.hpp"

namespace {

using nestgrid::CellArrays;
using nestgrid::InvalidInput;
using nestgrid::LagrangeGrid;
namespace fs = std::filesystem;

/// The grid of a file, whose name refusals give.
template <int dim>
LagrangeGrid<dim> grid_in(const CellArrays& cells, const fs::path& path) {
    try {
        return LagrangeGrid<dim>(cells);
    } catch (const InvalidInput& error) {
        throw InvalidInput("'" + path.string() + "': " + error.what());
    }
}

/// Words with a number in the place of %.
std::string with_number(std::string words, double number) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.3g", number);
    return words.replace(words.find('%'), 1, text.data());
}

/// Appends a sentence to others.
void add_note(std::string& notes, const std::string& note) {
    notes += (notes.empty() ? "" : "; ") + note;
}

/// What of the cells is not drawn.
template <int dim>
std::string note_on(const LagrangeGrid<dim>& grid) {
    if (grid.left_out() == 0) return "";
    return std::to_string(grid.left_out()) + " cells are left out, of a dimension below " +
           std::to_string(dim) + " or ghosts";
}

/// Frames of one field on one grid.
struct FrameValues {
    std::vector<std::span<const double>> values;
    std::vector<std::span<const double>> by;  ///< of the field that colours; or none
    std::vector<double> times;
    std::shared_ptr<const void> memory;  ///< that they lie in
};

/// What a field borrows from.
template <int dim>
struct KeptCells {
    LagrangeGrid<dim> grid;
    FrameValues frames;
};

template <class Field, int dim>
void set_frames(InputField& field, const std::shared_ptr<const KeptCells<dim>>& kept) {
    const std::shared_ptr<const LagrangeGrid<dim>> grid(kept, &kept->grid);
    const FrameValues& frames = kept->frames;
    std::vector<Field> fields;
    std::vector<FieldPair<Field>> pairs;
    for (std::size_t i = 0; i < frames.values.size(); ++i) {
        fields.emplace_back(*grid, frames.values[i]);
        if (frames.by.empty()) continue;
        pairs.emplace_back(fields.back(), Field(*grid, frames.by[i]));
    }
    if constexpr (requires { fields.front().jump(); }) {
        const double jump = fields.front().jump();
        const auto [least, greatest] = std::ranges::minmax(frames.values.front());
        if (jump > 1e-6 * (greatest - least)) {
            add_note(field.note,
                     with_number("cells disagree on values at nodes that they share, by up to %: "
                                 "their mean is drawn",
                                 jump));
        }
    }
    field.frames = frames.by.empty()
                       ? nestgrid::shared_frames(grid, std::move(fields), frames.times, kept)
                       : nestgrid::shared_frames(grid, std::move(pairs), frames.times, kept);
}

template <int dim>
InputField field_in(const CellArrays& cells, FrameValues frames, const fs::path& path) {
    const auto kept = std::make_shared<const KeptCells<dim>>(
        KeptCells<dim>{grid_in<dim>(cells, path), std::move(frames)});
    InputField field;
    field.note = note_on(kept->grid);
    // Where all cells are linear, corners say all.
    if (kept->grid.greatest_degree() > 1) {
        set_frames<nestgrid::LagrangeField<dim>>(field, kept);
    } else {
        set_frames<nestgrid::LagrangeCornerField<dim>>(field, kept);
    }
    const std::vector<std::span<const double>>& all = kept->frames.values;
    field.range = {all[0][0], all[0][0]};
    for (const std::span<const double> each : all) {
        const auto [least, greatest] = std::ranges::minmax(each);
        field.range = {std::min((*field.range)[0], least), std::max((*field.range)[1], greatest)};
    }
    field.nodes = kept->grid.point_count();
    field.leaf_elements = kept->grid.coarse_count();
    field.value_count = all.front().size();
    field.value = [kept](std::size_t i) { return kept->frames.values.front()[i]; };
    return field;
}

bool is_same(const auto& a, const auto& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

bool is_same_grid(const CellArrays& a, const CellArrays& b) {
    return is_same(a.coordinates, b.coordinates) && is_same(a.types, b.types) &&
           is_same(a.first, b.first) && is_same(a.points, b.points) &&
           is_same(a.degrees, b.degrees);
}

/// The times that all files tell, if these ascend; 0, 1, 2, ... otherwise.
std::vector<double> times_in(const std::vector<UnstructuredFile>& files) {
    std::vector<double> times;
    for (const UnstructuredFile& file : files) {
        const std::optional<double> time = file.time();
        if (!time || !std::isfinite(*time) || (!times.empty() && *time <= times.back())) {
            return times_of_files(files.size());
        }
        times.push_back(*time);
    }
    return times;
}

/// \param told the times that a list of the files tells; or none
InputField read_frames(const Input& input, const Paths& paths, const std::vector<double>& given,
                       const std::vector<double>& told) {
    WantedValues wanted{input.array, -1, input.by};
    if (input.choice.component) wanted.component = static_cast<int>(*input.choice.component);
    const auto files = std::make_shared<std::vector<UnstructuredFile>>();
    FrameValues frames;
    for (const fs::path& path : paths) {
        const UnstructuredFile& file = files->emplace_back(path, input.read_limit, wanted);
        const UnstructuredFile& first = files->front();
        wanted.array = first.name();
        if (!is_same_grid(file.cells(), first.cells())) {
            throw InvalidInput("'" + path.string() + "' has another grid than '" +
                               paths.front().string() + "'");
        }
        if (file.by().empty() != first.by().empty()) {
            throw InvalidInput("'" + (file.by().empty() ? path : paths.front()).string() +
                               "' has no field '" + input.by + "'");
        }
        frames.values.push_back(file.values());
        if (!file.by().empty()) frames.by.push_back(file.by());
    }
    frames.times = times_of_frames(given, told.empty() ? times_in(*files) : told);
    frames.memory = files;
    const CellArrays cells = files->front().cells();
    InputField field = nestgrid::dimension_of(cells) == 2
                           ? field_in<2>(cells, std::move(frames), paths.front())
                           : field_in<3>(cells, std::move(frames), paths.front());
    field.name = wanted.array;
    return field;
}

InputField read_cells(const Input& input, const Paths& paths, const std::vector<double>& times) {
    return read_frames(input, paths, times, {});
}

InputField read_collection(const Input& input, const Paths& paths,
                           const std::vector<double>& times) {
    if (paths.size() > 1) {
        throw InvalidInput("'" + paths.front().string() +
                           "' lists frames of its own: it is for one input");
    }
    const PvdSets sets = read_pvd(paths.front());
    return read_frames(input, sets.paths, times, sets.times);
}

/// One row for each kind of cells.
template <int dim>
void report_cells(const LagrangeGrid<dim>& grid, Report& report) {
    std::map<std::pair<std::string, int>, std::uint64_t> counts;
    for (std::uint32_t cell = 0; cell < grid.coarse_count(); ++cell) {
        const nestgrid::CellKind& kind = grid.kind(cell);
        ++counts[{std::string(nestgrid::topology(kind.shape).name), kind.degree}];
    }
    for (const auto& [kind, count] : counts) {
        Row row;
        row.add("shape", kind.first).add("degree", static_cast<std::uint64_t>(kind.second));
        report.add_row("cells", row.add("count", count));
    }
}

template <int dim>
void report_grid(const UnstructuredFile& file, const fs::path& path, Report& report) {
    const LagrangeGrid<dim> grid = grid_in<dim>(file.cells(), path);
    report.add("dimension", std::uint64_t{dim});
    report.add("points", std::uint64_t{grid.point_count()});
    report.add("nodes", std::uint64_t{grid.vertex_count()});
    report.add("leaf_elements", std::uint64_t{grid.coarse_count()});
    report_cells(grid, report);
    for (const PointArray& each : file.arrays()) {
        Row row;
        row.add("field", std::string(each.name.data()));
        row.add("components", static_cast<std::uint64_t>(each.components));
        row.add("least_value", each.range[0]).add("greatest_value", each.range[1]);
        report.add_row("fields", std::move(row));
    }
    const nestgrid::CurvedCells& curved = grid.curved();
    if (curved.count > 0) {
        report.say(with_number(
            std::to_string(curved.count) + " cells are curved, by up to % in units of length",
            curved.distance));
    }
    if (const std::string note = note_on(grid); !note.empty()) report.say(note);
}

void describe_cells(const fs::path& path, Report& report) {
    const UnstructuredFile file(path, 0, std::nullopt);
    if (nestgrid::dimension_of(file.cells()) == 2) {
        report_grid<2>(file, path, report);
    } else {
        report_grid<3>(file, path, report);
    }
}

void describe_collection(const fs::path& path, Report& report) {
    const PvdSets sets = read_pvd(path);
    report.add("frames", std::uint64_t{sets.paths.size()});
    report.add("first_time", sets.times.front());
    report.add("last_time", sets.times.back());
    describe_cells(sets.paths.front(), report);
}

const RegisteredFormat vtu({.name = "VTK unstructured grid",
                            .endings = {".vtu"},
                            .holds = "a mesh with values at points, of degrees to 8",
                            .options = {"--array", "--component", "--read-limit"},
                            .read_field = read_cells,
                            .describe = describe_cells});

const RegisteredFormat pvtu({.name = "VTK unstructured grid in pieces",
                             .endings = {".pvtu"},
                             .holds = "such a mesh in files of several processes",
                             .options = {"--array", "--component", "--read-limit"},
                             .reads_beside = true,
                             .read_field = read_cells,
                             .describe = describe_cells});

const RegisteredFormat pvd({.name = "VTK collection",
                            .endings = {".pvd"},
                            .holds = "a list of such meshes, frames of one field",
                            .options = {"--array", "--component", "--read-limit"},
                            .reads_beside = true,
                            .read_field = read_collection,
                            .describe = describe_collection});

}  // namespace
