// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK image data (.vti), read by VTK.
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>

#include <nestgrid/error.hpp>

#include "formats.hpp"
#include "input/end_checks.hpp"
#include "input/volumes/vtk_reading.hpp"
#include "suggestion.hpp"

namespace {

using nestgrid::InvalidInput;
using nestgrid::IoError;
namespace fs = std::filesystem;

std::vector<std::string> names_of_arrays(vtkDataSetAttributes* data) {
    std::vector<std::string> names;
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        const char* name = data->GetArrayName(i);
        if (name != nullptr && data->GetArray(i) != nullptr) names.emplace_back(name);
    }
    return names;
}

/// The array of this name; without one, the active scalars, else the only array.
/// \return null where there is no such array
vtkDataArray* chosen_array(const fs::path& path, const std::string& name,
                           vtkDataSetAttributes* data) {
    if (!name.empty()) return data->GetArray(name.c_str());
    if (data->GetScalars() != nullptr) return data->GetScalars();
    const std::vector<std::string> names = names_of_arrays(data);
    if (names.size() == 1) return data->GetArray(names.front().c_str());
    if (names.empty()) return data->GetArray(0);
    throw InvalidInput(path.string() +
                       " has several arrays, choose one by --array: " + listed(names));
}

/// Values of cells are those at their centres, which is exact where the data are linear.
void move_to_centres(FileSamples& samples) {
    auto& g = samples.geometry;
    for (std::size_t d = 0; d < 3; ++d) {
        // A plane or a line has cells of fewer dimensions, as many as samples across them.
        if (g.samples[d] < 2) continue;
        --g.samples[d];
        for (std::size_t r = 0; r < 3; ++r) {
            g.origin[r] += g.direction[r][d] * g.spacing[d] / 2;
        }
    }
    samples.note = "the cell data of " + samples.path.filename().string() +
                   " are taken at the centres of the cells";
}

FileSamples read_vti(const fs::path& path, const WantedSamples& wanted) {
    const vtkNew<vtkXMLImageDataReader> reader;
    const VtkReading reading(path);
    reading.listen(reader);
    if (reader->CanReadFile(path.c_str()) == 0) {
        throw IoError(path.string() + " is no VTK image data file");
    }
    check_xml_end(path);
    reader->SetFileName(path.c_str());
    reading.read_header(reader);
    const vtkSmartPointer<vtkImageData> image = reading.read_samples(reader);
    vtkDataSetAttributes* const points = image->GetPointData();
    vtkDataSetAttributes* const cells = image->GetCellData();
    FileSamples samples{.path = path};
    set_geometry(samples, image);
    vtkDataArray* array = chosen_array(path, wanted.array, points);
    if (array == nullptr) {
        array = chosen_array(path, wanted.array, cells);
        if (array != nullptr) move_to_centres(samples);
    }
    if (array == nullptr && !wanted.array.empty()) {
        std::vector<std::string> names = names_of_arrays(points);
        for (std::string& name : names_of_arrays(cells)) names.push_back(std::move(name));
        throw InvalidInput(path.string() + " has no point data array '" + wanted.array + "', " +
                           (names.empty() ? "and no other" : "only " + listed(names)) +
                           did_you_mean(wanted.array, names));
    }
    if (array == nullptr) throw InvalidInput(path.string() + " has neither point nor cell data");
    set_numbers(samples, array);
    samples.name = array->GetName() == nullptr ? "" : array->GetName();
    // VTK's own name for what nobody has named.
    if (samples.name == "ImageScalars") samples.name.clear();
    return samples;
}

const RegisteredFormat vti({.name = "VTK image data",
                            .endings = {".vti"},
                            .holds = "samples in space, several arrays",
                            .options = {"--array"},
                            .read_samples = read_vti});

}  // namespace
