// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hyper tree grids of VTK (.htg, .phtg), which VTK reads in child processes. Where they are boxes
// of cells they are drawn as such, otherwise as trees.
#include <tuple>

#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLHyperTreeGridReader.h>

#include "input/blocks/read_blocks.hpp"
#include "input/blocks/vtk_blocks.hpp"
#include "input/blocks/vtk_tree_boxes.hpp"
#include "input/blocks/vtk_tree_records.hpp"
#include "input/end_checks.hpp"
#include "input/input_file.hpp"

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;

/// VTK's reader, with all numbers of arrays that have several for each cell. Where an array is in
/// one piece, in files of version 2, VTK asks for it tree by tree, and 9.1 for as many numbers as
/// there are cells: here the first tree gets all of it.
class TreeReader : public vtkXMLHyperTreeGridReader {
public:
    vtkTypeMacro(TreeReader, vtkXMLHyperTreeGridReader) static TreeReader* New() {
        VTK_STANDARD_NEW_BODY(TreeReader);
    }

    /// Takes all numbers of arrays away that a file has in part: what VTK leaves unset is no value.
    void clear_short_arrays() const {
        for (vtkAbstractArray* const each : short_) each->SetNumberOfTuples(0);
    }

protected:
    int ReadArrayValues(vtkXMLDataElement* element, vtkIdType to, vtkAbstractArray* array,
                        vtkIdType from, vtkIdType count, FieldType type) override {
        const bool is_cells = element->GetParent()->GetName() == std::string_view("CellData");
        const bool is_whole = is_cells && type == OTHER;
        if (is_whole && from > 0) return 1;
        if (is_whole) count = array->GetNumberOfValues();
        const int is_read =
            vtkXMLHyperTreeGridReader::ReadArrayValues(element, to, array, from, count, type);
        if (!is_cells || is_read != 0) return is_read;
        short_.emplace_back(array);
        return 1;
    }

private:
    std::vector<vtkSmartPointer<vtkAbstractArray>> short_;
};

template <class Real>
BoxNumbers numbers_of(const TreeBoxes& trees, vtkDataArray& data, int component) {
    const auto values = std::make_shared<std::vector<std::vector<Real>>>();
    BoxNumbers numbers;
    for (std::size_t l = 0; l < trees.cells.size(); ++l) {
        auto& arrays = numbers.arrays.emplace_back();
        for (std::size_t b = 0; b < trees.cells[l].size(); ++b) {
            auto& own = values->emplace_back();
            for (const vtkIdType i : trees.cells[l][b]) {
                own.push_back(static_cast<Real>(data.GetComponent(i, component)));
            }
            auto& array = arrays.emplace_back();
            array.first = own.data();
            std::ptrdiff_t stride = sizeof(Real);
            const auto& box = trees.blocks.levels[l].boxes[b];
            for (std::size_t d = 0; d < 3; ++d) {
                array.stride[d] = stride;
                stride *= box.upper[d] - box.lower[d] + 1;
            }
        }
    }
    numbers.memory = values;
    return numbers;
}

BlockFile open_htg(const fs::path& path) {
    const auto grid = read_htg(path);
    if (!head_of(*grid).holds_boxes) {
        throw InvalidInput(
            "its trees are no boxes, unlike those of the first file: they are divided by three, of "
            "several sizes, in a plane across x or y, or some cells are hidden");
    }
    const auto trees = std::make_shared<const TreeBoxes>(tree_boxes(grid));
    BlockFile file;
    file.dimension = trees->dimension;
    file.blocks = trees->blocks;
    std::tie(file.fields, file.is_double) = fields_in(*grid->GetCellData());
    file.numbers = [trees, file_fields = file.fields, is_double = file.is_double](std::size_t field,
                                                                                  int component) {
        vtkDataArray* const data =
            trees->grid->GetCellData()->GetArray(file_fields.at(field).name.c_str());
        if (data->GetNumberOfTuples() <= trees->grid->GetGlobalNodeIndexMax()) {
            throw InvalidInput("the field '" + file_fields.at(field).name +
                               "' has fewer numbers than the trees have cells");
        }
        return is_double ? numbers_of<double>(*trees, *data, component)
                         : numbers_of<float>(*trees, *data, component);
    };
    return file;
}

double seconds_for(const Input& input, const fs::path& path) {
    require_file(path);
    const Format* const format = format_of(path);
    if (format == nullptr || (format != format_of("x.htg") && format != format_of("x.phtg"))) {
        throw InvalidInput("'" + path.string() + "' is no file of the format of the first one");
    }
    return input.read_limit > 0 ? input.read_limit : reading_time(bytes_to_read(path, *format));
}

InputField read_trees(const Input& input, const Paths& paths, const std::vector<double>& times) {
    double seconds = 0;
    for (const fs::path& path : paths) seconds = std::max(seconds, seconds_for(input, path));
    if (tree_head(paths.front(), seconds).holds_boxes) {
        return read_blocks<open_htg>(input, paths, times);
    }
    return tree_field(input, paths, times, seconds);
}

void describe_htg(const fs::path& path, Report& report) {
    Input input;
    input.path = path;
    const double seconds = seconds_for(input, path);
    if (tree_head(path, seconds).holds_boxes) return describe_blocks<open_htg>(path, report);
    describe_trees(path, seconds, report);
}

const RegisteredFormat htg({.name = "VTK hyper tree grid",
                            .endings = {".htg"},
                            .holds = "trees of cells, several fields",
                            .options = {"--array", "--cells", "--component", "--read-limit"},
                            .read_field = read_trees,
                            .describe = describe_htg});

const RegisteredFormat phtg({.name = "VTK hyper tree grid in pieces",
                             .endings = {".phtg"},
                             .holds = "such trees in files of several processes",
                             .options = {"--array", "--cells", "--component", "--read-limit"},
                             .reads_beside = true,
                             .read_field = read_trees,
                             .describe = describe_htg});

}  // namespace

vtkSmartPointer<vtkHyperTreeGrid> read_htg(const fs::path& path) {
    if (ending_of(path) == ".phtg") return read_phtg(path);
    check_xml_end(path);
    return read_quietly<vtkHyperTreeGrid>([&] {
        const vtkNew<TreeReader> reader;
        if (reader->CanReadFile(path.c_str()) == 0) {
            throw InvalidInput("it is no file of VTK's hyper tree grids");
        }
        reader->SetFileName(path.c_str());
        reader->Update();
        reader->clear_short_arrays();
        return vtkSmartPointer<vtkDataObject>(reader->GetOutputDataObject(0));
    });
}
