// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/blocks/vtk_blocks.hpp"

#include <cmath>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkUnsignedCharArray.h>

#include <nestgrid/adapters/vtk_overlapping_amr.hpp>

#include "input/vtk_errors.hpp"

namespace {

using nestgrid::InvalidInput;

/// The numbers of a field where they are blanked, or of another type than wanted, are copied.
template <class Array>
void set_type(vtkUniformGrid& block, const std::string& name) {
    vtkDataArray* const given = block.GetCellData()->GetArray(name.c_str());
    if (given == nullptr) return;
    vtkUnsignedCharArray* const ghosts = block.GetCellGhostArray();
    if (Array::SafeDownCast(given) != nullptr && ghosts == nullptr) return;
    vtkNew<Array> copy;
    copy->DeepCopy(given);
    copy->SetName(name.c_str());
    const vtkIdType count =
        ghosts == nullptr ? 0 : std::min(ghosts->GetNumberOfValues(), copy->GetNumberOfTuples());
    for (vtkIdType i = 0; i < count; ++i) {
        if ((ghosts->GetValue(i) & vtkDataSetAttributes::HIDDENCELL) == 0) continue;
        for (int c = 0; c < copy->GetNumberOfComponents(); ++c) copy->SetComponent(i, c, NAN);
    }
    block.GetCellData()->RemoveArray(name.c_str());
    block.GetCellData()->AddArray(copy);
}

template <int dim, class Array>
BoxNumbers numbers_in(const vtkSmartPointer<vtkOverlappingAMR>& amr, const std::string& name,
                      int component) {
    for (unsigned l = 0; l < amr->GetNumberOfLevels(); ++l) {
        for (unsigned b = 0; b < amr->GetNumberOfDataSets(l); ++b) {
            if (vtkUniformGrid* const block = amr->GetDataSet(l, b)) set_type<Array>(*block, name);
        }
    }
    using Real = typename Array::ValueType;
    const auto arrays = nestgrid::vtk_block_arrays<dim, Real>(*amr, name, component);
    return {arrays_of<3, std::byte>(arrays),
            std::make_shared<vtkSmartPointer<vtkOverlappingAMR>>(amr)};
}

/// \throw InvalidInput where a level has blocks, but no data: a file gives them or is damaged
template <int dim>
nestgrid::Blocks<3> boxes_in(vtkOverlappingAMR& amr) {
    const nestgrid::Blocks<dim> blocks = nestgrid::vtk_blocks<dim>(amr);
    for (std::size_t l = blocks.levels.size(); l < amr.GetNumberOfLevels(); ++l) {
        if (amr.GetNumberOfDataSets(static_cast<unsigned>(l)) == 0) continue;
        throw InvalidInput("level " + std::to_string(blocks.levels.size()) + " has no data");
    }
    return blocks_in_space(blocks);
}

/// Without the place in VTK's source.
std::string without_place(const std::string& message) {
    const std::size_t place = message.find(", line ");
    const std::size_t end = place == std::string::npos ? place : message.find(' ', place + 7);
    return end == std::string::npos ? message : message.substr(end + 1);
}

std::optional<double> time_in(vtkOverlappingAMR& amr) {
    if (amr.GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()) != 0) {
        return amr.GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
    }
    vtkDataArray* const time = amr.GetFieldData()->GetArray("TimeValue");
    if (time == nullptr || time->GetNumberOfValues() != 1) return std::nullopt;
    return time->GetComponent(0, 0);
}

}  // namespace

vtkSmartPointer<vtkDataObject> read_quietly(
    const std::function<vtkSmartPointer<vtkDataObject>()>& read) {
    const vtkNew<ErrorCollector> errors;
    vtkOutputWindow* const window = vtkOutputWindow::GetInstance();
    vtkObject::GlobalWarningDisplayOn();  // what a child process prints is thrown away
    const unsigned long tags[]{window->AddObserver(vtkCommand::ErrorEvent, errors),
                               window->AddObserver(vtkCommand::WarningEvent, errors)};
    vtkSmartPointer<vtkDataObject> data = read();
    for (const unsigned long tag : tags) window->RemoveObserver(tag);
    if (!errors->message.empty()) {
        throw InvalidInput("it cannot be read: " + without_place(errors->message));
    }
    return data;
}

std::pair<std::vector<BlockFile::Field>, bool> fields_in(vtkCellData& cells) {
    std::pair<std::vector<BlockFile::Field>, bool> found;
    for (int i = 0; i < cells.GetNumberOfArrays(); ++i) {
        vtkDataArray* const array = cells.GetArray(i);
        if (array == nullptr || array->GetName() == nullptr) continue;
        if (array->GetName() == std::string(vtkDataSetAttributes::GhostArrayName())) continue;
        found.first.push_back({array->GetName(), array->GetNumberOfComponents()});
        found.second = found.second || vtkFloatArray::SafeDownCast(array) == nullptr;
    }
    return found;
}

BlockFile blocks_of_vtk(const vtkSmartPointer<vtkOverlappingAMR>& amr,
                        std::vector<BlockFile::Field> fields, bool is_double) {
    BlockFile file;
    file.is_double = is_double;
    file.dimension = amr->GetGridDescription() == VTK_XYZ_GRID ? 3 : 2;
    file.time = time_in(*amr);
    file.blocks = file.dimension == 2 ? boxes_in<2>(*amr) : boxes_in<3>(*amr);
    file.fields = std::move(fields);
    file.numbers = [amr, all = file.fields, is_double, is_flat = file.dimension == 2](
                       std::size_t field, int component) {
        const std::string& name = all.at(field).name;
        if (is_flat) {
            return is_double ? numbers_in<2, vtkDoubleArray>(amr, name, component)
                             : numbers_in<2, vtkFloatArray>(amr, name, component);
        }
        return is_double ? numbers_in<3, vtkDoubleArray>(amr, name, component)
                         : numbers_in<3, vtkFloatArray>(amr, name, component);
    };
    return file;
}
