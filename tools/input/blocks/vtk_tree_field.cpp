// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>

#include <vtkBitArray.h>
#include <vtkDoubleArray.h>
#include <vtkHyperTreeGridNonOrientedCursor.h>
#include <vtkNew.h>

#include <nestgrid/adapters/vtk_hyper_tree_grid.hpp>
#include <nestgrid/algorithms/cell_data.hpp>

#include "input/blocks/block_file.hpp"
#include "input/blocks/vtk_tree_records.hpp"
#include "input/field_pair.hpp"

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;

/// The trees of a parcel as a grid of VTK, whose cells have the numbers in which they come.
class RestoredTrees {
public:
    explicit RestoredTrees(const Parcel& parcel)
        : cells_{parcel.block<std::uint8_t>(TreePart::cells)} {
        const TreeHead& head = parcel.block<TreeHead>(TreePart::head).front();
        grid->SetDimensions(head.points.data());
        grid->SetBranchFactor(head.factor);
        std::span<const double> rest = parcel.block<double>(TreePart::coordinates);
        std::array<vtkNew<vtkDoubleArray>, 3> along;
        for (std::size_t d = 0; d < 3; ++d) {
            for (unsigned i = 0; i < head.points[d]; ++i) along[d]->InsertNextValue(rest[i]);
            rest = rest.subspan(head.points[d]);
        }
        grid->SetXCoordinates(along[0]);
        grid->SetYCoordinates(along[1]);
        grid->SetZCoordinates(along[2]);
        const vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
        for (const vtkIdType tree : parcel.block<vtkIdType>(TreePart::trees)) {
            grid->InitializeNonOrientedCursor(cursor, tree, true);
            divide(*cursor);
        }
    }

    /// Masks what the file masks, and leaves without a number.
    void mask(std::span<const double> values) {
        const vtkNew<vtkBitArray> mask;
        mask->SetNumberOfValues(static_cast<vtkIdType>(cells_.size()));
        bool any = false;
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            const bool is_masked = (cells_[i] & TreeCell::masked) != 0 ||
                                   (cells_[i] == TreeCell::leaf && std::isnan(values[i]));
            mask->SetValue(static_cast<vtkIdType>(i), is_masked ? 1 : 0);
            any = any || is_masked;
        }
        if (any) grid->SetMask(mask);
    }

    vtkNew<vtkHyperTreeGrid> grid;

private:
    void divide(vtkHyperTreeGridNonOrientedCursor& cursor) {
        cursor.SetGlobalIndexFromLocal(static_cast<vtkIdType>(next_));
        if ((cells_[next_++] & TreeCell::divided) == 0) return;
        cursor.SubdivideLeaf();
        for (int c = 0; c < cursor.GetNumberOfChildren(); ++c) {
            cursor.ToChild(static_cast<unsigned char>(c));
            divide(cursor);
            cursor.ToParent();
        }
    }

    std::span<const std::uint8_t> cells_;
    std::size_t next_ = 0;
};

/// The value of a leaf, by the number of its cell.
template <class Grid>
struct NumberOfTree {
    const Grid* grid;
    std::span<const double> values;

    double operator()(const typename Grid::Element& e) const {
        return values[static_cast<std::size_t>(grid->index(e))];
    }
};

template <class Grid>
struct KeptTrees {
    explicit KeptTrees(std::vector<std::shared_ptr<const Parcel>> all)
        : parcels{std::move(all)}, trees{*parcels.front()} {}

    std::vector<std::shared_ptr<const Parcel>> parcels;
    RestoredTrees trees;
    std::optional<Grid> grid;
};

/// \throw InvalidInput where a file has other trees than the first one
void require_same_trees(const std::vector<std::shared_ptr<const Parcel>>& parcels,
                        const Paths& paths) {
    const auto bytes = [&](std::size_t i, std::size_t part) {
        const auto block = parcels[i]->block<char>(part);
        return std::string_view(block.data(), block.size());
    };
    for (std::size_t i = 1; i < parcels.size(); ++i) {
        for (const std::size_t part :
             {TreePart::head, TreePart::coordinates, TreePart::trees, TreePart::cells}) {
            if (bytes(i, part) == bytes(0, part)) continue;
            throw InvalidInput("'" + paths[i].string() + "' has another grid than the first input");
        }
    }
}

/// \throw InvalidInput where a file lacks the field in --by that the first one has
void require_other_field(const std::vector<std::shared_ptr<const Parcel>>& parcels,
                         const Paths& paths, const std::string& by) {
    const auto count = [&](std::size_t i) {
        return parcels[i]->block<TreeFieldHead>(TreePart::fields).size();
    };
    for (std::size_t i = 1; i < parcels.size(); ++i) {
        if (count(i) >= count(0)) continue;
        throw InvalidInput("'" + paths[i].string() + "' has no field '" + by + "'");
    }
}

/// How many nodes the leaves have.
template <class Grid>
std::size_t node_count(const Grid& grid) {
    std::vector<nestgrid::NodeKey> keys;
    const auto hierarchy = erase(grid, nestgrid::ZeroField<Grid>{});
    nestgrid::detail::for_each_leaf(hierarchy, [&](const nestgrid::detail::LeafView& leaf_view) {
        keys.insert(keys.end(), leaf_view.keys.begin(), leaf_view.keys.end());
    });
    std::sort(keys.begin(), keys.end());
    return static_cast<std::size_t>(std::unique(keys.begin(), keys.end()) - keys.begin());
}

template <int dim, int factor>
InputField frames_of(std::vector<std::shared_ptr<const Parcel>> parcels, const Input& input,
                     const std::vector<double>& times) {
    using Grid = nestgrid::HyperTreeGrid<dim, factor>;
    using Field = nestgrid::CellAverages<Grid, NumberOfTree<Grid>>;
    const auto kept = std::make_shared<KeptTrees<Grid>>(std::move(parcels));
    const std::size_t count =
        kept->parcels.front()->template block<std::uint8_t>(TreePart::cells).size();
    const auto heads = kept->parcels.front()->template block<TreeFieldHead>(TreePart::fields);
    const auto values = [&](std::size_t i, std::size_t of_field) {
        return kept->parcels[i]
            ->template block<double>(TreePart::values)
            .subspan(of_field * count, count);
    };
    std::vector<double> sums(count);  // NaN where a frame has none
    for (std::size_t f = 0; f < kept->parcels.size(); ++f) {
        for (std::size_t h = 0; h < heads.size(); ++h) {
            for (std::size_t i = 0; i < count; ++i) sums[i] += values(f, h)[i];
        }
    }
    kept->trees.mask(sums);
    kept->grid.emplace(*kept->trees.grid);
    const std::shared_ptr<const Grid> grid(kept, &*kept->grid);
    std::vector<Field> fields;
    std::vector<FieldPair<Field>> pairs;
    const auto add = [&](std::size_t f, std::size_t of_field) {
        return Field(*grid, {grid.get(), values(f, of_field)}, rule_of(input.cells));
    };
    for (std::size_t f = 0; f < kept->parcels.size(); ++f) {
        fields.push_back(add(f, 0));
        if (heads.size() > 1) pairs.emplace_back(fields.back(), add(f, 1));
    }
    const auto all_times = times_of_frames(times, times_of_files(kept->parcels.size()));
    InputField field;
    field.frames = heads.size() > 1
                       ? nestgrid::shared_frames(grid, std::move(pairs), all_times, kept)
                       : nestgrid::shared_frames(grid, std::move(fields), all_times, kept);
    const auto name =
        kept->parcels.front()->template block<char>(TreePart::names).first(heads.front().letters);
    field.name = {name.begin(), name.end()};
    field.nodes = node_count(*grid);
    const auto cells = kept->parcels.front()->template block<std::uint8_t>(TreePart::cells);
    std::vector<std::size_t> leaves;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i] == TreeCell::leaf) leaves.push_back(i);
    }
    field.leaf_elements = leaves.size();
    field.value_count = leaves.size();
    field.value = [kept, leaves](std::size_t i) {
        return kept->parcels.front()->template block<double>(TreePart::values)[leaves[i]];
    };
    return field;
}

}  // namespace

InputField tree_field(const Input& input, const Paths& paths, const std::vector<double>& times,
                      double seconds) {
    std::vector<std::shared_ptr<const Parcel>> parcels;
    for (const fs::path& path : paths) {
        parcels.push_back(trees_apart(path, &input, seconds));
    }
    require_same_trees(parcels, paths);
    require_other_field(parcels, paths, input.by);
    const TreeHead head = parcels.front()->block<TreeHead>(TreePart::head).front();
    if (head.dimension == 2) {
        return head.factor == 2 ? frames_of<2, 2>(std::move(parcels), input, times)
                                : frames_of<2, 3>(std::move(parcels), input, times);
    }
    return head.factor == 2 ? frames_of<3, 2>(std::move(parcels), input, times)
                            : frames_of<3, 3>(std::move(parcels), input, times);
}
