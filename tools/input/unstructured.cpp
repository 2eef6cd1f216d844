// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Unstructured grids of VTK (.vtu): linear, quadratic and Lagrange cells with values at points. VTK
// reads them in a child process.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include <vtkNew.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <nestgrid/adapters/vtk_cells.hpp>

#include "formats.hpp"
#include "input/child_process.hpp"
#include "input/end_checks.hpp"
#include "input/input_field.hpp"
#include "input/vtk_errors.hpp"
#include "output/report.hpp"
#include "suggestion.hpp"

namespace {

using nestgrid::CellArrays;
using nestgrid::InvalidInput;
using nestgrid::IoError;
using nestgrid::LagrangeGrid;
namespace fs = std::filesystem;

/// An array of points in a file.
struct PointArray {
    std::array<char, 256> name;
    int components;
    std::array<double, 2> range;  ///< of the first component
};

/// What is wanted of a file: the values of an array, or where it is null the arrays alone.
struct WantedValues {
    const std::string* array;
    int component;
};

/// What a child process hands over, in this order of blocks.
struct CellBlock {
    enum Number : std::size_t { coordinates, types, first, points, degrees, arrays, values, name };
};

vtkSmartPointer<vtkUnstructuredGrid> read_with_vtk(const fs::path& path) {
    const std::string quoted = "'" + path.string() + "'";
    const vtkNew<vtkXMLUnstructuredGridReader> reader;
    const vtkNew<ErrorCollector> errors;
    reader->AddObserver(vtkCommand::ErrorEvent, errors);
    reader->AddObserver(vtkCommand::WarningEvent, errors);
    if (reader->CanReadFile(path.c_str()) == 0) {
        throw IoError(quoted + " is no VTK unstructured grid file");
    }
    check_xml_end(path);
    reader->SetFileName(path.c_str());
    reader->Update();
    if (!errors->message.empty()) throw IoError(quoted + " cannot be read: " + errors->message);
    return reader->GetOutput();
}

std::vector<PointArray> arrays_of(vtkUnstructuredGrid& grid) {
    std::vector<PointArray> all;
    for (int i = 0; i < grid.GetPointData()->GetNumberOfArrays(); ++i) {
        vtkDataArray* const array = grid.GetPointData()->GetArray(i);
        if (array == nullptr || array->GetName() == nullptr) continue;
        PointArray& row = all.emplace_back();
        std::snprintf(row.name.data(), row.name.size(), "%s", array->GetName());
        row.components = array->GetNumberOfComponents();
        array->GetRange(row.range.data(), 0);
    }
    return all;
}

std::vector<std::string> names_of(const std::vector<PointArray>& all) {
    std::vector<std::string> names;
    for (const PointArray& each : all) names.emplace_back(each.name.data());
    return names;
}

/// The name of the array that is wanted, or of the only one.
std::string chosen(const std::string& wanted, const std::vector<std::string>& names) {
    if (names.empty()) throw InvalidInput("it has no values at points");
    if (wanted.empty() && names.size() == 1) return names.front();
    if (std::ranges::find(names, wanted) != names.end()) return wanted;
    throw InvalidInput(wanted.empty()
                           ? "there are several fields, choose one by --field: " + listed(names)
                           : "there is no field '" + wanted + "', only " + listed(names) +
                                 did_you_mean(wanted, names));
}

void put_values(vtkUnstructuredGrid& grid, const WantedValues& wanted,
                const std::vector<PointArray>& all, Parcel& out) {
    const std::string array = chosen(*wanted.array, names_of(all));
    const int components = grid.GetPointData()->GetArray(array.c_str())->GetNumberOfComponents();
    if (components > 1 && wanted.component < 0) {
        throw InvalidInput("'" + array + "' has " + std::to_string(components) +
                           " numbers per point, not one: choose by --component, from 0 to " +
                           std::to_string(components - 1));
    }
    const auto numbers = nestgrid::vtk_point_values(grid, array, std::max(0, wanted.component));
    out.put(std::span<const double>(numbers));
    out.put(std::span<const char>(array));
}

std::shared_ptr<const Parcel> read_apart(const fs::path& path, double seconds,
                                         const WantedValues& wanted) {
    require_file(path);
    const std::string quoted = "'" + path.string() + "'";
    std::error_code none;
    if (!(seconds > 0)) seconds = reading_time(fs::file_size(path, none));
    return run_apart(quoted, seconds, [&](Parcel& out) {
        const vtkSmartPointer<vtkUnstructuredGrid> grid = read_with_vtk(path);
        try {
            const nestgrid::VtkCells read(*grid);
            const CellArrays cells = read.arrays();
            out.put(cells.coordinates);
            out.put(cells.types);
            out.put(cells.first);
            out.put(cells.points);
            out.put(cells.degrees);
            const std::vector<PointArray> all = arrays_of(*grid);
            out.put(std::span<const PointArray>(all));
            if (wanted.array != nullptr) put_values(*grid, wanted, all, out);
        } catch (const InvalidInput& error) {
            throw InvalidInput(quoted + ": " + error.what());
        }
    });
}

CellArrays cells_in(const Parcel& parcel) {
    return {.coordinates = parcel.block<double>(CellBlock::coordinates),
            .types = parcel.block<std::uint8_t>(CellBlock::types),
            .first = parcel.block<std::int64_t>(CellBlock::first),
            .points = parcel.block<std::int64_t>(CellBlock::points),
            .degrees = parcel.block<double>(CellBlock::degrees)};
}

/// The grid of a file, whose name refusals give.
template <int dim>
LagrangeGrid<dim> grid_in(const Parcel& parcel, const fs::path& path) {
    try {
        return LagrangeGrid<dim>(cells_in(parcel));
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

template <int dim>
std::string note_on(const LagrangeGrid<dim>& grid) {
    const nestgrid::CurvedCells& curved = grid.curved();
    if (curved.count == 0) return "";
    return with_number(
        std::to_string(curved.count) + " cells are curved, by up to % in units of length",
        curved.distance);
}

/// What a field borrows from.
template <int dim>
struct KeptCells {
    std::shared_ptr<const Parcel> parcel;
    LagrangeGrid<dim> grid;
    std::span<const double> values;
};

/// Where all cells are linear, corners say all.
template <int dim>
void set_frames(InputField& field, const std::shared_ptr<const KeptCells<dim>>& kept) {
    const std::shared_ptr<const LagrangeGrid<dim>> grid(kept, &kept->grid);
    if (grid->greatest_degree() > 1) {
        std::vector fields{nestgrid::LagrangeField<dim>(*grid, kept->values)};
        field.frames = nestgrid::shared_frames(grid, std::move(fields), {0}, kept);
        return;
    }
    std::vector fields{nestgrid::LagrangeCornerField<dim>(*grid, kept->values)};
    const double jump = fields.front().jump();
    const auto [least, greatest] = std::ranges::minmax(kept->values);
    if (jump > 1e-6 * (greatest - least)) {
        field.note += (field.note.empty() ? "" : "; ") +
                      with_number(
                          "cells disagree on values at nodes that they share, by up to %: "
                          "their mean is drawn",
                          jump);
    }
    field.frames = nestgrid::shared_frames(grid, std::move(fields), {0}, kept);
}

template <int dim>
InputField field_in(std::shared_ptr<const Parcel> parcel, const fs::path& path) {
    const std::span<const double> numbers = parcel->block<double>(CellBlock::values);
    const std::span<const char> text = parcel->block<char>(CellBlock::name);
    LagrangeGrid<dim> read = grid_in<dim>(*parcel, path);
    const auto kept = std::make_shared<const KeptCells<dim>>(
        KeptCells<dim>{std::move(parcel), std::move(read), numbers});
    InputField field;
    set_frames(field, kept);
    field.name.assign(text.begin(), text.end());
    field.nodes = kept->grid.point_count();
    field.leaf_elements = kept->grid.coarse_count();
    field.value_count = numbers.size();
    field.value = [kept](std::size_t i) { return kept->values[i]; };
    return field;
}

InputField read_cells(const Input& input, const Paths& paths, const std::vector<double>& times) {
    const fs::path& path = paths.front();
    if (paths.size() > 1 || !times.empty()) {
        throw InvalidInput("'" + path.string() +
                           "' is no frame of several: fields of .vtu files are drawn alone");
    }
    const int component = input.choice.component ? static_cast<int>(*input.choice.component) : -1;
    auto parcel = read_apart(path, input.read_limit, {&input.array, component});
    const auto all = parcel->block<PointArray>(CellBlock::arrays);
    if (std::ranges::any_of(all, [&](const auto& each) { return input.by == each.name.data(); })) {
        throw InvalidInput("'" + input.by + "' is a field of '" + path.string() +
                           "', which colours no surface of another one yet");
    }
    return nestgrid::dimension_of(cells_in(*parcel)) == 2 ? field_in<2>(std::move(parcel), path)
                                                          : field_in<3>(std::move(parcel), path);
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
void report_grid(const Parcel& parcel, const fs::path& path, Report& report) {
    const LagrangeGrid<dim> grid = grid_in<dim>(parcel, path);
    report.add("dimension", std::uint64_t{dim});
    report.add("points", std::uint64_t{grid.point_count()});
    report.add("nodes", std::uint64_t{grid.vertex_count()});
    report.add("leaf_elements", std::uint64_t{grid.coarse_count()});
    report_cells(grid, report);
    for (const PointArray& each : parcel.block<PointArray>(CellBlock::arrays)) {
        Row row;
        row.add("field", std::string(each.name.data()));
        row.add("components", static_cast<std::uint64_t>(each.components));
        row.add("least_value", each.range[0]).add("greatest_value", each.range[1]);
        report.add_row("fields", std::move(row));
    }
    if (const std::string note = note_on(grid); !note.empty()) report.say(note);
}

void describe_cells(const fs::path& path, Report& report) {
    const auto parcel = read_apart(path, 0, {nullptr, 0});
    if (nestgrid::dimension_of(cells_in(*parcel)) == 2) {
        report_grid<2>(*parcel, path, report);
    } else {
        report_grid<3>(*parcel, path, report);
    }
}

const RegisteredFormat vtu({.name = "VTK unstructured grid",
                            .endings = {".vtu"},
                            .holds = "a mesh with values at points, of degrees to 8",
                            .options = {"--array", "--component", "--read-limit"},
                            .read_field = read_cells,
                            .describe = describe_cells});

}  // namespace
