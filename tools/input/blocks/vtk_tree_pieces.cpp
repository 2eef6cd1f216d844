// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hyper tree grids of several processes (.phtg): a list of files, each with some of the trees of
// one grid, or none, and with copies of trees of other processes, which are ghost cells. Here the
// trees get together again: each from the file that has it as its own.
#include <optional>

#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkHyperTree.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include "input/blocks/vtk_tree_boxes.hpp"
#include "input/blocks/vtk_tree_records.hpp"
#include "input/end_checks.hpp"
#include "input/input_file.hpp"

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& path) {
    check_xml_end(path);
    const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(
        vtkXMLUtilities::ReadElementFromFile(path.c_str()));
    vtkXMLDataElement* const grid =
        root == nullptr ? nullptr : root->FindNestedElementWithName("PHyperTreeGrid");
    if (grid == nullptr) throw InvalidInput("it is no file of VTK's hyper tree grids in pieces");
    std::vector<fs::path> files;
    for (int i = 0; i < grid->GetNumberOfNestedElements(); ++i) {
        const char* const source = grid->GetNestedElement(i)->GetAttribute("Source");
        if (source == nullptr) continue;
        files.push_back(path.parent_path() / source);
        if (ending_of(files.back()) != ".htg") {
            throw InvalidInput("its piece '" + std::string(source) + "' does not end in .htg");
        }
    }
    if (files.empty()) throw InvalidInput("it names no pieces");
    return files;
}

bool has_trees(vtkHyperTreeGrid& piece) {
    for (vtkIdType t = 0; t < piece.GetMaxNumberOfTrees(); ++t) {
        if (piece.GetTree(t) != nullptr) return true;
    }
    return false;
}

bool have_one_lattice(vtkHyperTreeGrid& a, vtkHyperTreeGrid& b) {
    const auto along_a = coordinates_of(a);
    const auto along_b = coordinates_of(b);
    for (std::size_t d = 0; d < 3; ++d) {
        const vtkIdType count = along_a[d] == nullptr ? 0 : along_a[d]->GetNumberOfTuples();
        if (along_b[d] == nullptr || along_b[d]->GetNumberOfTuples() != count) return false;
        for (vtkIdType i = 0; i < count; ++i) {
            if (along_a[d]->GetTuple1(i) != along_b[d]->GetTuple1(i)) return false;
        }
    }
    return a.GetBranchFactor() == b.GetBranchFactor() &&
           a.GetTransposedRootIndexing() == b.GetTransposedRootIndexing() &&
           std::equal(a.GetDimensions(), a.GetDimensions() + 3, b.GetDimensions());
}

/// The trees of pieces that have been added, with their masks and the arrays of the first piece.
class JoinedTrees {
public:
    explicit JoinedTrees(vtkHyperTreeGrid& first) {
        whole_->CopyEmptyStructure(&first);
        vtkCellData& cells = *first.GetCellData();
        for (int i = 0; i < cells.GetNumberOfArrays(); ++i) {
            vtkDataArray* const from = cells.GetArray(i);
            if (from == nullptr || from->GetName() == nullptr) continue;
            const auto array = vtkSmartPointer<vtkDataArray>::Take(from->NewInstance());
            array->SetName(from->GetName());
            array->SetNumberOfComponents(from->GetNumberOfComponents());
            arrays_.push_back(array);
        }
    }

    /// \throw InvalidInput for a tree that another piece has as its own, and an array in part
    void add(vtkHyperTreeGrid& piece) {
        require_masks(piece);
        vtkUnsignedCharArray* const ghosts = piece.GetGhostCells();
        for (vtkIdType t = 0; t < piece.GetMaxNumberOfTrees(); ++t) {
            vtkHyperTree* const tree = piece.GetTree(t);
            if (tree == nullptr) continue;
            const vtkIdType root = tree->GetGlobalIndexFromLocal(0);
            if (ghosts != nullptr && ghosts->GetValue(root) != 0) continue;
            if (whole_->GetTree(t) != nullptr) {
                throw InvalidInput("it has tree " + std::to_string(t) +
                                   ", which an earlier piece has, too");
            }
            add(piece, *tree);
            tree->SetGlobalIndexStart(cells_ - tree->GetNumberOfVertices());
            whole_->SetTree(t, tree);
        }
    }

    vtkSmartPointer<vtkHyperTreeGrid> finish() {
        for (vtkDataArray* const each : arrays_) whole_->GetCellData()->AddArray(each);
        if (is_any_masked_) whole_->SetMask(mask_);
        return whole_;
    }

private:
    void add(vtkHyperTreeGrid& piece, vtkHyperTree& tree) {
        const vtkIdType count = tree.GetNumberOfVertices();
        for (vtkDataArray* const to : arrays_) {
            vtkDataArray* const from = piece.GetCellData()->GetArray(to->GetName());
            const bool fits =
                from != nullptr && from->GetNumberOfComponents() == to->GetNumberOfComponents();
            const vtkIdType numbers = fits ? from->GetNumberOfTuples() : 0;
            for (vtkIdType v = 0; v < count; ++v) {
                const vtkIdType i = tree.GetGlobalIndexFromLocal(v);
                if (i >= numbers) {
                    throw InvalidInput("it has not the field '" + std::string(to->GetName()) +
                                       "' of the first piece in all its cells");
                }
                to->InsertTuple(cells_ + v, i, from);
            }
        }
        for (vtkIdType v = 0; v < count; ++v) {
            const bool is_masked =
                piece.HasMask() && piece.GetMask()->GetValue(tree.GetGlobalIndexFromLocal(v)) != 0;
            mask_->InsertValue(cells_ + v, is_masked ? 1 : 0);
            is_any_masked_ = is_any_masked_ || is_masked;
        }
        cells_ += count;
    }

    vtkNew<vtkHyperTreeGrid> whole_;
    std::vector<vtkSmartPointer<vtkDataArray>> arrays_;
    vtkNew<vtkBitArray> mask_;
    bool is_any_masked_ = false;
    vtkIdType cells_ = 0;
};

}  // namespace

vtkSmartPointer<vtkHyperTreeGrid> read_phtg(const fs::path& path) {
    std::optional<JoinedTrees> joined;
    vtkSmartPointer<vtkHyperTreeGrid> first;
    for (const fs::path& file : files_in(path)) {
        require_file(file);
        try {
            const vtkSmartPointer<vtkHyperTreeGrid> piece = read_htg(file);
            if (!has_trees(*piece)) continue;
            if (!joined) joined.emplace(*(first = piece));
            if (!have_one_lattice(*first, *piece)) {
                throw InvalidInput("its trees lie elsewhere than those of the first piece");
            }
            joined->add(*piece);
        } catch (const InvalidInput& error) {
            throw InvalidInput("the piece '" + file.filename().string() + "': " + error.what());
        }
    }
    if (!joined) throw InvalidInput("it has no trees");
    return joined->finish();
}
