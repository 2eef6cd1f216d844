// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a format of blocks registers: fields and descriptions of files that child processes open.
#pragma once

#include "formats.hpp"
#include "input/blocks/block_file.hpp"
#include "input/input_field.hpp"

/// Opens files of one format; others are refused with a sentence.
std::vector<BlockFile> open_all(const Input& input, const Paths& paths, OpenBlocks open);

template <OpenBlocks open>
InputField read_blocks(const Input& input, const Paths& paths, const std::vector<double>& times) {
    return block_field(open_all(input, paths, open), input, paths, times);
}

template <OpenBlocks open>
void describe_blocks(const std::filesystem::path& path, Report& report) {
    Input input;
    input.path = path;
    describe_blocks(open_all(input, {path}, open).front(), path, report);
}
