// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plotfiles of AMReX: folders, which are mapped.
#include <nestgrid/adapters/amrex_plotfile.hpp>

#include "formats.hpp"
#include "input/blocks/block_file.hpp"
#include "input/input_field.hpp"

namespace {

using nestgrid::AmrexPlotfile;
namespace fs = std::filesystem;

/// The folder of a plotfile, which may be named by its Header, too.
fs::path folder_of(const fs::path& path) {
    if (path.filename() != "Header") return path;
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

bool is_plotfile(const fs::path& path) {
    std::error_code none;
    return fs::is_regular_file(folder_of(path) / "Header", none);
}

template <int dim>
BlockFile blocks_of(const std::shared_ptr<const AmrexPlotfile>& read) {
    BlockFile file;
    file.dimension = dim;
    file.is_double = read->is_double();
    file.time = read->time();
    for (const std::string& name : read->fields()) file.fields.push_back({name});
    file.blocks = blocks_in_space(read->blocks<dim>());
    file.numbers = [read](std::size_t field, int) {
        return BoxNumbers{read->is_double()
                              ? arrays_of<3, std::byte>(read->arrays<dim, double>(field))
                              : arrays_of<3, std::byte>(read->arrays<dim, float>(field)),
                          read};
    };
    return file;
}

BlockFile open_plotfile(const fs::path& path) {
    const auto read = std::make_shared<const AmrexPlotfile>(folder_of(path));
    return read->dimension() == 2 ? blocks_of<2>(read) : blocks_of<3>(read);
}

InputField read_plotfiles(const Input& input, const Paths& paths,
                          const std::vector<double>& times) {
    std::vector<BlockFile> files;
    for (const fs::path& path : paths) {
        if (!is_plotfile(path)) {
            throw nestgrid::InvalidInput("'" + path.string() + "' is no plotfile, as the first is");
        }
        files.push_back(open_plotfile(path));
    }
    return block_field(std::move(files), input, paths, times);
}

void describe_plotfile(const fs::path& path, Report& report) {
    describe_blocks(open_plotfile(path), path, report);
}

const RegisteredFormat plotfile({.name = "AMReX plotfile",
                                 .endings = {},
                                 .holds = "boxes of cells on levels, several fields",
                                 .options = {"--array", "--cells"},
                                 .recognises = is_plotfile,
                                 .read_field = read_plotfiles,
                                 .describe = describe_plotfile});

}  // namespace
