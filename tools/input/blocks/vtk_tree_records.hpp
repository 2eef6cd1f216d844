// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hyper tree grids of VTK (.htg, .phtg) that are no boxes of cells: divided by three, with trees of
// several sizes, or in planes across x or y. A child process reads the file; the trees pass through
// a parcel cell by cell, depth first, and become a hyper tree grid again.
#pragma once

#include <vtkHyperTreeGrid.h>
#include <vtkSmartPointer.h>

#include "formats.hpp"
#include "input/child_process.hpp"
#include "input/input_field.hpp"

/// Reads a file of hyper trees, and says what is wrong with it.
/// \throw nestgrid::InvalidInput
vtkSmartPointer<vtkHyperTreeGrid> read_htg(const std::filesystem::path& path);
/// Reads the pieces of several processes as one grid. Ghost cells are trees of other pieces.
/// \throw nestgrid::InvalidInput also where pieces do not fit each other
vtkSmartPointer<vtkHyperTreeGrid> read_phtg(const std::filesystem::path& path);

/// What a child tells of a file and of one field, in this order of blocks.
struct TreePart {
    enum Number : std::size_t { head, coordinates, trees, cells, values, fields, names };
};
/// What a child tells of a cell: a sum of these. What lies below a masked cell is masked, too.
struct TreeCell {
    enum Bits : std::uint8_t { leaf = 0, divided = 1, masked = 2 };
};

struct TreeFieldHead {
    int components;
    std::size_t letters;
    std::array<double, 2> range;  ///< of the first component, in leaves that are drawn
};

/// What a child tells of a file first.
struct TreeHead {
    std::array<unsigned, 3> points;
    unsigned dimension;
    unsigned factor;   ///< by which trees are divided
    bool holds_boxes;  ///< whether tree_boxes() makes boxes of it
};

/// \throw nestgrid::InvalidInput for trees that are not read
TreeHead head_of(vtkHyperTreeGrid& grid);
/// \throw nestgrid::IoError, nestgrid::InvalidInput as run_apart()
TreeHead tree_head(const std::filesystem::path& path, double seconds);

/// The trees of a file and the values of a field, or the ranges of all.
/// \param input that chooses the field, and a second one behind it where --by names one of the
///        file; null for the ranges of all
/// \throw nestgrid::IoError, nestgrid::InvalidInput as run_apart()
std::shared_ptr<const Parcel> trees_apart(const std::filesystem::path& path, const Input* input,
                                          double seconds);

/// The field that an input chooses, or its frames.
/// \param seconds that a child may take for a file
/// \throw nestgrid::IoError, nestgrid::InvalidInput as run_apart(), and where there is no such
///        field, or files differ in their trees
InputField tree_field(const Input& input, const Paths& paths, const std::vector<double>& times,
                      double seconds);

/// Says what is in a file: levels, cells, fields and their ranges in leaves.
void describe_trees(const std::filesystem::path& path, double seconds, Report& report);
