// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/unstructured_file.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUtilities.h>

#include <nestgrid/adapters/vtk_cells.hpp>

#include "formats.hpp"
#include "input/end_checks.hpp"
#include "input/input_file.hpp"
#include "input/vtk_errors.hpp"
#include "suggestion.hpp"

namespace {

using nestgrid::CellArrays;
using nestgrid::InvalidInput;
using nestgrid::IoError;
namespace fs = std::filesystem;

/// What a child process hands over, in this order of blocks.
struct CellBlock {
    enum Number : std::size_t {
        coordinates,
        types,
        first,
        points,
        degrees,
        arrays,
        time,
        values,
        name,
        by
    };
};

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

bool has_pieces(const fs::path& path) { return ending_of(path) == ".pvtu"; }

template <class Reader>
vtkSmartPointer<vtkUnstructuredGrid> read_with(const fs::path& path) {
    const vtkNew<Reader> reader;
    const vtkNew<ErrorCollector> errors;
    reader->AddObserver(vtkCommand::ErrorEvent, errors);
    reader->AddObserver(vtkCommand::WarningEvent, errors);
    if (reader->CanReadFile(path.c_str()) == 0) {
        throw IoError(quoted(path) + " is no VTK unstructured grid file");
    }
    check_xml_end(path);
    reader->SetFileName(path.c_str());
    reader->Update();
    if (!errors->message.empty()) {
        throw IoError(quoted(path) + " cannot be read: " + errors->message);
    }
    return reader->GetOutput();
}

/// Reads the files that a .pvtu names, too: VTK leaves out those that it cannot read.
void check_pieces(const fs::path& path) {
    const vtkSmartPointer<vtkXMLDataElement> root = vtkSmartPointer<vtkXMLDataElement>::Take(
        vtkXMLUtilities::ReadElementFromFile(path.c_str()));
    vtkXMLDataElement* const grid =
        root == nullptr ? nullptr : root->FindNestedElementWithName("PUnstructuredGrid");
    if (grid == nullptr) return;
    for (int i = 0; i < grid->GetNumberOfNestedElements(); ++i) {
        vtkXMLDataElement* const piece = grid->GetNestedElement(i);
        const char* const source = piece->GetAttribute("Source");
        if (std::string(piece->GetName()) != "Piece" || source == nullptr) continue;
        const fs::path file = path.parent_path() / source;
        require_file(file);
        check_xml_end(file);
    }
}

vtkSmartPointer<vtkUnstructuredGrid> read_with_vtk(const fs::path& path) {
    if (!has_pieces(path)) return read_with<vtkXMLUnstructuredGridReader>(path);
    check_pieces(path);
    return read_with<vtkXMLPUnstructuredGridReader>(path);
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
    const std::vector<std::string> names = names_of(all);
    const std::string array = chosen(wanted.array, names);
    const auto components = [&](const std::string& name) {
        return grid.GetPointData()->GetArray(name.c_str())->GetNumberOfComponents();
    };
    if (components(array) > 1 && wanted.component < 0) {
        throw InvalidInput("'" + array + "' has " + std::to_string(components(array)) +
                           " numbers per point, not one: choose by --component, from 0 to " +
                           std::to_string(components(array) - 1));
    }
    const auto numbers = nestgrid::vtk_point_values(grid, array, std::max(0, wanted.component));
    out.put(std::span<const double>(numbers));
    out.put(std::span<const char>(array));
    std::vector<double> colours;
    if (std::ranges::find(names, wanted.by) != names.end()) {
        if (components(wanted.by) > 1) {
            throw InvalidInput("'" + wanted.by + "' has " + std::to_string(components(wanted.by)) +
                               " numbers per point, and colours are those of one");
        }
        colours = nestgrid::vtk_point_values(grid, wanted.by, 0);
    }
    out.put(std::span<const double>(colours));
}

/// VTK writes TimeValue, deal.II TIME.
std::vector<double> time_in(vtkUnstructuredGrid& grid) {
    for (const char* const name : {"TimeValue", "TIME"}) {
        vtkDataArray* const array = grid.GetFieldData()->GetArray(name);
        if (array != nullptr && array->GetNumberOfValues() == 1) return {array->GetComponent(0, 0)};
    }
    return {};
}

std::shared_ptr<const Parcel> read_apart(const fs::path& path, double seconds,
                                         const std::optional<WantedValues>& wanted) {
    require_file(path);
    if (!(seconds > 0)) {
        Format format;
        format.reads_beside = has_pieces(path);
        seconds = reading_time(bytes_to_read(path, format));
    }
    return run_apart(quoted(path), seconds, [&](Parcel& out) {
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
            out.put(std::span<const double>(time_in(*grid)));
            if (wanted) put_values(*grid, *wanted, all, out);
        } catch (const InvalidInput& error) {
            throw InvalidInput(quoted(path) + ": " + error.what());
        }
    });
}

}  // namespace

UnstructuredFile::UnstructuredFile(const fs::path& path, double seconds,
                                   const std::optional<WantedValues>& wanted)
    : parcel_{read_apart(path, seconds, wanted)} {}

CellArrays UnstructuredFile::cells() const {
    return {.coordinates = parcel_->block<double>(CellBlock::coordinates),
            .types = parcel_->block<std::uint8_t>(CellBlock::types),
            .first = parcel_->block<std::int64_t>(CellBlock::first),
            .points = parcel_->block<std::int64_t>(CellBlock::points),
            .degrees = parcel_->block<double>(CellBlock::degrees)};
}

std::span<const PointArray> UnstructuredFile::arrays() const {
    return parcel_->block<PointArray>(CellBlock::arrays);
}

std::span<const double> UnstructuredFile::values() const {
    return parcel_->block<double>(CellBlock::values);
}

std::string UnstructuredFile::name() const {
    const std::span<const char> text = parcel_->block<char>(CellBlock::name);
    return {text.begin(), text.end()};
}

std::span<const double> UnstructuredFile::by() const {
    return parcel_->block<double>(CellBlock::by);
}

std::optional<double> UnstructuredFile::time() const {
    const std::span<const double> time = parcel_->block<double>(CellBlock::time);
    if (time.empty()) return std::nullopt;
    return time.front();
}

PvdSets read_pvd(const fs::path& path) {
    require_file(path);
    const auto parcel = run_apart(quoted(path), reading_time(0), [&](Parcel& out) {
        check_xml_end(path);
        const vtkSmartPointer<vtkXMLDataElement> root = vtkSmartPointer<vtkXMLDataElement>::Take(
            vtkXMLUtilities::ReadElementFromFile(path.c_str()));
        vtkXMLDataElement* const list =
            root == nullptr ? nullptr : root->FindNestedElementWithName("Collection");
        if (list == nullptr) throw IoError(quoted(path) + " is no collection of VTK");
        std::vector<double> times;
        std::string names;
        for (int i = 0; i < list->GetNumberOfNestedElements(); ++i) {
            vtkXMLDataElement* const set = list->GetNestedElement(i);
            const char* const file = set->GetAttribute("file");
            double time = 0;
            if (std::string(set->GetName()) != "DataSet" || file == nullptr) continue;
            if (set->GetScalarAttribute("timestep", time) == 0) time = i;
            times.push_back(time);
            names += std::string(file) + '\0';
        }
        out.put(std::span<const double>(times));
        out.put(std::span<const char>(names));
    });
    PvdSets sets;
    const std::span<const double> times = parcel->block<double>(0);
    const std::span<const char> names = parcel->block<char>(1);
    sets.times.assign(times.begin(), times.end());
    for (auto at = names.begin(); at != names.end();) {
        const auto end = std::find(at, names.end(), '\0');
        sets.paths.push_back(path.parent_path() / std::string(at, end));
        at = end + 1;
    }
    if (sets.paths.empty()) throw InvalidInput(quoted(path) + " lists no files");
    for (std::size_t i = 1; i < times.size(); ++i) {
        if (times[i] > times[i - 1]) continue;
        throw InvalidInput(quoted(path) + " lists " + quoted(sets.paths[i]) +
                           " at no later time than the file before: one file for each time is "
                           "drawn, which a .pvtu is for those of several processes");
    }
    return sets;
}
