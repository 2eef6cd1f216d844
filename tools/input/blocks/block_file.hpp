// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boxes of cells on levels, as files of block-structured codes have them. Each format fills a
// BlockFile; fields and descriptions of all formats are made of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nestgrid/adapters/block_fields.hpp>

struct Input;
struct InputField;
class Report;

/// Where each box has the numbers of one field, by level and number of the box.
struct BoxNumbers {
    nestgrid::BlockArrays<3, std::byte> arrays;  ///< of floats or doubles, as the file says
    std::shared_ptr<const void> memory;          ///< that the arrays lie in
};

struct BlockFile {
    struct Field {
        std::string name;
        int components = 1;
    };

    int dimension = 3;
    bool is_double = true;       ///< numbers are floats otherwise
    std::optional<double> time;  ///< where the file tells
    std::vector<Field> fields;
    nestgrid::Blocks<3> blocks;  ///< in the plane the third index means nothing
    std::function<BoxNumbers(std::size_t field, int component)> numbers;
};

/// How a format opens a file.
using OpenBlocks = BlockFile (*)(const std::filesystem::path&);

/// The boxes in their first dim directions.
template <int dim>
nestgrid::Blocks<dim> blocks_in(const BlockFile& file) {
    nestgrid::Blocks<dim> blocks;
    blocks.origin = file.blocks.origin;
    blocks.spacing = file.blocks.spacing;
    std::copy_n(file.blocks.axes.begin(), dim, blocks.axes.begin());
    for (const nestgrid::BlockLevel<3>& from : file.blocks.levels) {
        nestgrid::BlockLevel<dim>& level = blocks.levels.emplace_back();
        std::copy_n(from.ratio.begin(), dim, level.ratio.begin());
        for (const nestgrid::BlockBox<3>& each : from.boxes) {
            nestgrid::BlockBox<dim>& box = level.boxes.emplace_back();
            std::copy_n(each.lower.begin(), dim, box.lower.begin());
            std::copy_n(each.upper.begin(), dim, box.upper.begin());
        }
    }
    return blocks;
}

/// The same boxes in space: one layer of cells in directions that they do not have.
template <int dim>
nestgrid::Blocks<3> blocks_in_space(const nestgrid::Blocks<dim>& blocks) {
    nestgrid::Blocks<3> result;
    result.origin = blocks.origin;
    result.spacing = blocks.spacing;
    std::copy_n(blocks.axes.begin(), dim, result.axes.begin());
    for (const nestgrid::BlockLevel<dim>& from : blocks.levels) {
        nestgrid::BlockLevel<3>& level = result.levels.emplace_back();
        level.ratio.fill(1);
        std::copy_n(from.ratio.begin(), dim, level.ratio.begin());
        for (const nestgrid::BlockBox<dim>& each : from.boxes) {
            nestgrid::BlockBox<3>& box = level.boxes.emplace_back();
            std::copy_n(each.lower.begin(), dim, box.lower.begin());
            std::copy_n(each.upper.begin(), dim, box.upper.begin());
        }
    }
    return result;
}

/// Pointers and strides of another type, in the first directions that both have.
template <int dim, class Real, int from_dim, class From>
nestgrid::BlockArrays<dim, Real> arrays_of(const nestgrid::BlockArrays<from_dim, From>& arrays) {
    nestgrid::BlockArrays<dim, Real> result(arrays.size());
    for (std::size_t l = 0; l < arrays.size(); ++l) {
        for (const nestgrid::BlockArray<from_dim, From>& from : arrays[l]) {
            nestgrid::BlockArray<dim, Real>& array = result[l].emplace_back();
            array.first = from.first;
            std::copy_n(from.stride.begin(), std::min(dim, from_dim), array.stride.begin());
        }
    }
    return result;
}

/// Reads a file of foreign code or format in child processes: one for what it has in it, and one
/// for each field that is asked for, which is packed without gaps.
/// \param seconds that a child may take
/// \throw nestgrid::IoError, nestgrid::InvalidInput as run_apart()
BlockFile open_apart(const std::filesystem::path& path, double seconds, OpenBlocks open);

/// The field that an input chooses, or its frames, and the one of `by`.
/// \param paths one a file
/// \param given the times of the option --times
/// \throw nestgrid::InvalidInput where there is no such field, and where files differ in their
///        grids or types
InputField block_field(std::vector<BlockFile> files, const Input& input,
                       const std::vector<std::filesystem::path>& paths,
                       const std::vector<double>& given);

/// The number of a field; an empty name stands for the only one.
/// \throw nestgrid::InvalidInput where there is none
std::size_t number_of(const std::vector<BlockFile::Field>& fields, const std::string& name);
/// A field and a component of it, as --by names them: "velocity:1", or "density" for one of one
/// number.
struct OtherField {
    std::size_t field;
    int component;
};
/// What --by names, or nothing where it names no field.
/// \throw nestgrid::InvalidInput where a field has several numbers per cell and none of them is
/// chosen, or the chosen one is not there
std::optional<OtherField> other_field(const std::vector<BlockFile::Field>& fields,
                                      const std::string& by);
/// The component that an input chooses.
/// \throw nestgrid::InvalidInput where a field has several numbers per cell and none of them is
/// chosen, or the chosen one is not there
int component_of(const BlockFile::Field& field, const Input& input);
/// \param cells as --cells says it
nestgrid::CellRule rule_of(const std::string& cells);

/// Says what is in a file: levels, boxes, fields and their ranges in leaves.
/// \throw nestgrid::InvalidInput where its boxes are no hierarchy
void describe_blocks(const BlockFile& file, const std::filesystem::path& path, Report& report);
