// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The command-line program: options in, one line per result out.
#include <cstdio>

#include <vtkObject.h>

#include "command_line.hpp"

int main(int argc, char** argv) {
    vtkObject::GlobalWarningDisplayOff();
    CLI::App app{"Adaptive, crack-free surfaces from hierarchical grids"};
    app.set_version_flag("--version", "nestgrid " NESTGRID_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Examples:\n"
        "  nestgrid isosurface head.nii.gz --value 60 --threshold 2% -o head.vtp\n"
        "  nestgrid isosurface head.nii.gz --value 60 --threshold 0 --threshold 5 --image "
        "head.png\n"
        "  nestgrid isosurface ct.raw --dims 512,512,300 --type int16 --spacing 0.5,0.5,1 \\\n"
        "           --value 300 -o bone.stl\n"
        "  nestgrid slice head.nii.gz --axis z --at 90 --threshold 2% --image slice.png\n"
        "  nestgrid probe head.nii.gz --line 0,90,90,180,90,90 --count 200 -o line.csv\n"
        "  nestgrid info head.nii.gz\n"
        "  nestgrid view head.nii.gz\n"
        "  nestgrid mesh part.poly --family bisection --field front --tolerance 0.01 -o "
        "part.nestgrid");
    const std::vector<Command> commands{add_isosurface(app), add_slice(app),   add_isolines(app),
                                        add_height(app),     add_surface(app), add_boundary(app),
                                        add_probe(app),      add_info(app),    add_mesh(app),
                                        add_pack(app),       add_view(app)};

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        // Who misspells an option that is required has left it out, too.
        const std::vector<std::string> unknown = app.remaining(true);
        const std::string what =
            unknown.empty() ? error.what() : unknown.front() + " was not expected";
        std::fprintf(stderr, "nestgrid: %s (see nestgrid --help)\n", what.c_str());
        return 2;
    }
    try {
        for (const Command& command : commands) {
            if (*command.options) command.run();
        }
        return 0;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "nestgrid: not enough memory\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "nestgrid: %s\n", error.what());
    }
    return 1;
}
