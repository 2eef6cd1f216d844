// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/blocks/vtk_tree_records.hpp"

#include <algorithm>
#include <cmath>

#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkHyperTree.h>
#include <vtkUnsignedCharArray.h>

#include "input/blocks/block_file.hpp"
#include "input/blocks/vtk_blocks.hpp"
#include "input/blocks/vtk_tree_boxes.hpp"
#include "output/report.hpp"

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;

/// All cells of a grid, tree by tree, along x first, each depth first.
struct TreeRecords {
    std::vector<vtkIdType> trees;  ///< their numbers along x first, however the file counts them
    std::vector<std::uint8_t> cells;
    std::vector<vtkIdType> numbers;  ///< of the cells, in the arrays of the grid

    explicit TreeRecords(vtkHyperTreeGrid& grid) : ghosts_{grid.GetGhostCells()} {
        if (grid.HasMask()) mask_ = grid.GetMask();
        require_masks(grid);
        const unsigned* const points = grid.GetDimensions();
        const auto along = [&](int d) { return points[d] == 1 ? 1 : points[d] - 1; };
        for (vtkIdType number = 0; number < grid.GetMaxNumberOfTrees(); ++number) {
            const auto i = static_cast<unsigned>(number % along(0));
            const auto j = static_cast<unsigned>(number / along(0) % along(1));
            const auto k = static_cast<unsigned>(number / along(0) / along(1));
            vtkIdType t = 0;
            grid.GetIndexFromLevelZeroCoordinates(t, i, j, k);
            vtkHyperTree* const tree = grid.GetTree(t);
            if (tree == nullptr) continue;
            trees.push_back(number);
            add(*tree, 0, false);
        }
        if (trees.empty()) throw InvalidInput("it has no trees");
    }

private:
    /// \param is_hidden whether a larger cell is masked
    void add(vtkHyperTree& tree, vtkIdType vertex, bool is_hidden) {
        const vtkIdType number = tree.GetGlobalIndexFromLocal(vertex);
        const bool is_leaf = tree.IsLeaf(vertex);
        is_hidden = is_hidden || (mask_ != nullptr && mask_->GetValue(number) != 0) ||
                    (is_leaf && ghosts_ != nullptr && ghosts_->GetValue(number) != 0);
        cells.push_back(static_cast<std::uint8_t>((is_leaf ? TreeCell::leaf : TreeCell::divided) |
                                                  (is_hidden ? TreeCell::masked : TreeCell::leaf)));
        numbers.push_back(number);
        if (is_leaf) return;
        const vtkIdType first = tree.GetElderChildIndex(static_cast<unsigned>(vertex));
        for (int c = 0; c < tree.GetNumberOfChildren(); ++c) add(tree, first + c, is_hidden);
    }

    vtkBitArray* mask_ = nullptr;
    vtkUnsignedCharArray* ghosts_;
};

/// One component of a field, for all cells in the order of the records.
std::vector<double> numbers_of(const TreeRecords& records, vtkDataArray& data, int component) {
    if (data.GetNumberOfTuples() <= *std::ranges::max_element(records.numbers)) {
        throw InvalidInput("the field '" + std::string(data.GetName()) +
                           "' has fewer numbers than the trees have cells");
    }
    std::vector<double> values;
    for (const vtkIdType number : records.numbers) {
        values.push_back(data.GetComponent(number, component));
    }
    return values;
}

std::array<double, 2> range_in_leaves(const TreeRecords& records,
                                      const std::vector<double>& values) {
    std::array<double, 2> range{INFINITY, -INFINITY};
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (records.cells[i] != TreeCell::leaf) continue;
        range[0] = values[i] < range[0] ? values[i] : range[0];
        range[1] = values[i] > range[1] ? values[i] : range[1];
    }
    return range;
}

void put_head(vtkHyperTreeGrid& grid, Parcel& out) {
    const TreeHead head = head_of(grid);
    out.put(std::span<const TreeHead>(&head, 1));
}

/// \param input that chooses a field; null for the ranges of all
void put_trees(const fs::path& path, const Input* input, Parcel& out) {
    const auto grid = read_htg(path);
    put_head(*grid, out);
    std::vector<double> coordinates;
    for (vtkDataArray* const each : coordinates_of(*grid)) {
        for (vtkIdType i = 0; i < each->GetNumberOfTuples(); ++i) {
            coordinates.push_back(each->GetTuple1(i));
        }
    }
    const TreeRecords records(*grid);
    const std::vector<BlockFile::Field> fields = fields_in(*grid->GetCellData()).first;
    if (fields.empty()) throw InvalidInput("it has no data of cells");
    std::vector<double> values;
    std::vector<TreeFieldHead> heads;
    std::string names;
    const auto data_of = [&](const BlockFile::Field& field) -> vtkDataArray& {
        return *grid->GetCellData()->GetArray(field.name.c_str());
    };
    if (input != nullptr) {
        const BlockFile::Field& field = fields[number_of(fields, input->array)];
        values = numbers_of(records, data_of(field), component_of(field, *input));
        heads.push_back({field.components, field.name.size(), {}});
        names = field.name;
        if (const auto other = other_field(fields, input->by)) {
            const BlockFile::Field& by = fields[other->field];
            const auto more = numbers_of(records, data_of(by), other->component);
            values.insert(values.end(), more.begin(), more.end());
            heads.push_back({by.components, by.name.size(), {}});
            names += by.name;
        }
    } else {
        for (const BlockFile::Field& field : fields) {
            const auto range = range_in_leaves(records, numbers_of(records, data_of(field), 0));
            heads.push_back({field.components, field.name.size(), range});
            names += field.name;
        }
    }
    out.put(std::span<const double>(coordinates));
    out.put(std::span<const vtkIdType>(records.trees));
    out.put(std::span<const std::uint8_t>(records.cells));
    out.put(std::span<const double>(values));
    out.put(std::span<const TreeFieldHead>(heads));
    out.put(std::span<const char>(names));
}

/// Cells of each level, tree by tree.
void count_levels(std::span<const std::uint8_t> cells, std::size_t& next, std::size_t level,
                  unsigned children, std::vector<std::uint64_t>& counts) {
    counts.resize(std::max(counts.size(), level + 1));
    ++counts[level];
    if ((cells[next++] & TreeCell::divided) == 0) return;
    for (unsigned c = 0; c < children; ++c) {
        count_levels(cells, next, level + 1, children, counts);
    }
}

}  // namespace

TreeHead head_of(vtkHyperTreeGrid& grid) {
    const unsigned* const points = grid.GetDimensions();
    TreeHead head{{points[0], points[1], points[2]},
                  grid.GetDimension(),
                  static_cast<unsigned>(grid.GetBranchFactor()),
                  grid.GetBranchFactor() == 2};
    if (head.dimension < 2) {
        throw InvalidInput("its trees have dimension " + std::to_string(head.dimension) +
                           ": trees in space or in a plane across an axis are read");
    }
    const auto along = coordinates_of(grid);
    for (std::size_t d = 0; d < 3; ++d) {
        if (along[d] != nullptr && along[d]->GetNumberOfTuples() == vtkIdType{points[d]}) continue;
        throw InvalidInput("its trees have " + std::to_string(points[d]) + " points in direction " +
                           std::to_string(d) + ", but another number of coordinates");
    }
    const bool is_across_z = head.dimension == 3 || points[2] == 1;
    head.holds_boxes = head.holds_boxes && is_across_z && trees_fill_boxes(grid);
    return head;
}

TreeHead tree_head(const fs::path& path, double seconds) {
    const auto parcel =
        read_file_apart(path, seconds, [&](Parcel& out) { put_head(*read_htg(path), out); });
    return parcel->block<TreeHead>(TreePart::head).front();
}

std::shared_ptr<const Parcel> trees_apart(const fs::path& path, const Input* input,
                                          double seconds) {
    return read_file_apart(path, seconds, [&](Parcel& out) { put_trees(path, input, out); });
}

void describe_trees(const fs::path& path, double seconds, Report& report) {
    const auto parcel = trees_apart(path, nullptr, seconds);
    const TreeHead head = parcel->block<TreeHead>(TreePart::head).front();
    const auto cells = parcel->block<std::uint8_t>(TreePart::cells);
    const auto trees = parcel->block<vtkIdType>(TreePart::trees).size();
    report.add("dimension", std::uint64_t{head.dimension});
    report.add("branch_factor", std::uint64_t{head.factor});
    report.add("leaf_elements",
               static_cast<std::uint64_t>(std::ranges::count(cells, TreeCell::leaf)));
    report.add("coarse_elements", static_cast<std::uint64_t>(trees));
    unsigned children = 1;
    for (unsigned d = 0; d < head.dimension; ++d) children *= head.factor;
    std::vector<std::uint64_t> counts;
    for (std::size_t next = 0; next < cells.size();) {
        count_levels(cells, next, 0, children, counts);
    }
    for (std::size_t l = 0; l < counts.size(); ++l) {
        Row row;
        report.add_row("levels",
                       std::move(row.add("level", std::uint64_t{l}).add("cells", counts[l])));
    }
    auto names = parcel->block<char>(TreePart::names);
    for (const TreeFieldHead& field : parcel->block<TreeFieldHead>(TreePart::fields)) {
        Row row;
        row.add("field", std::string(names.data(), field.letters));
        row.add("components", static_cast<std::uint64_t>(field.components));
        row.add("least_value", field.range[0]).add("greatest_value", field.range[1]);
        report.add_row("fields", std::move(row));
        names = names.subspan(field.letters);
    }
}
