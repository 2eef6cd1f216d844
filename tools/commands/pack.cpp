// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/error.hpp>

#include "input/frame_files.hpp"
#include "options/command_line.hpp"
#include "options/encoding_options.hpp"
#include "output/print.hpp"
#include "output/surface_file.hpp"

namespace {

struct PackArguments {
    Paths inputs;
    std::vector<double> times;
    EncodingOptions encoding;
    std::filesystem::path output;
};

void run_pack(const PackArguments& o, Report& report) {
    require_hierarchy_name(o.output);
    require_hierarchy_name(o.inputs.front());
    check_writable(o.output);
    {
        ProgressLine progress;
        progress.show("reading");
        with_hierarchy(o.inputs.front(), [&](auto& stored) {
            append_frames(stored, o.inputs, "");
            stored.times = times_of_frames(o.times, std::move(stored.times));
            progress.show("writing");
            nestgrid::write_hierarchy(
                stored.grid, o.output, stored.fields,
                {.times = stored.times, .compression = o.encoding.compression()});
        });
    }
    const HierarchyInfo info = hierarchy_info(o.output);
    report_info(info, report);
    report.wrote(o.output, {{"elements", info.leaves}});
}

Command add_pack(CLI::App& program) {
    auto o = std::make_shared<PackArguments>();
    CLI::App* pack = program.add_subcommand(
        "pack", "write .nestgrid files into one, as frames, or encoded otherwise");
    pack->footer(
        "Examples:\n"
        "  nestgrid pack first.nestgrid second.nestgrid --times 0,0.5 -o film.nestgrid\n"
        "  nestgrid pack film.nestgrid --encode-within 0.01 -o small.nestgrid\n");
    pack->add_option("INPUTS", o->inputs, ".nestgrid files with one grid: the frames")->required();
    pack->add_option("-o,--output", o->output, "write this .nestgrid")
        ->type_name("FILE")
        ->required();
    pack->add_option("--times", o->times,
                     "of the frames, ascending [0,1,2,..., or those of the only input]")
        ->type_name("T,T,...")
        ->delimiter(',');
    add_encoding_options(*pack, o->encoding);
    return {pack, [o](Report& report) { run_pack(*o, report); }};
}

const RegisteredCommand pack_command(110, add_pack);

}  // namespace
