// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/error.hpp>

#include "commands/make_hierarchy.hpp"
#include "expression/expression.hpp"
#include "input/hierarchy.hpp"
#include "options/command_line.hpp"
#include "output/print.hpp"
#include "output/surface_file.hpp"

namespace {

void run_mesh(MeshRequest& o, Report& report) {
    require_hierarchy_name(o.output);
    check_writable(o.output);
    std::size_t welded = 0;
    {
        ProgressLine progress;
        o.progress = [&](const std::string& text) { progress.show(text); };
        welded = make_hierarchy(o);
    }
    const HierarchyInfo info = hierarchy_info(o.output);
    report_info(info, report);
    if (o.weld) report.say("nodes of the mesh that became others: " + grouped(welded));
    report.wrote(o.output, {{"elements", info.leaves}});
}

void add_field_options(CLI::App& command, MeshRequest& o) {
    command
        .add_option("--field", o.fields,
                    "keep the values of an expression in x, y and z, with --times also in t, or "
                    "of a name (see --help-all); again for several")
        ->type_name("TEXT")
        ->take_all();
    command
        .add_option("--tolerance", o.tolerance,
                    "refine until the first field is interpolated up to this, in all frames")
        ->type_name("NUMBER");
    command.add_option("--times", o.times, "keep the fields at these times, ascending")
        ->type_name("T,T,...")
        ->delimiter(',');
}

void add_refinement_options(CLI::App& command, MeshRequest& o) {
    command.add_option("--refine", o.refine, "refine everything so often")->type_name("COUNT");
    command
        .add_option("--levels", o.levels, "how often --tolerance refines an element at most [30]")
        ->type_name("COUNT");
    command.add_option("--max-elements", o.maximum_elements, "refuse to make more than these")
        ->type_name("COUNT")
        ->capture_default_str();
    command.add_flag("--unbalanced", o.unbalanced,
                     "let neighbours in an octree differ by more than one level");
    command
        .add_option("--max-volume", o.maximum_volume,
                    "of the tetrahedra that fill a .poly or .smesh")
        ->type_name("VOLUME");
    command
        .add_option("--layers", o.layers,
                    "thicknesses of layers of prisms on a surface, for --family prism")
        ->type_name("D,D,...")
        ->delimiter(',');
    command
        .add_option("--direction", o.direction,
                    "that of the layers [along the normals of the surface]")
        ->type_name("X,Y,Z")
        ->delimiter(',')
        ->expected(3);
}

void add_mesh_options(CLI::App& command, MeshRequest& o) {
    command
        .add_option("INPUT", o.input,
                    "a surface, .off, .obj, .ply, .stl or .vtp; tetrahedra, .node and .ele; or a "
                    "piecewise linear complex to be filled, .poly or .smesh")
        ->required();
    command
        .add_option("--family", o.family,
                    "how elements are refined: red-green, bisection, octree or prism")
        ->type_name("NAME")
        ->check(one_of({"red-green", "bisection", "octree", "prism"}))
        ->required();
    command.add_option("-o,--output", o.output, "write this .nestgrid")
        ->type_name("FILE")
        ->required();
    add_field_options(command, o);
    add_refinement_options(command, o);
    add_encoding_options(command, o.encoding);
    command
        .add_option("--weld", o.weld,
                    "make nodes one that are no farther from each other than this, as where each "
                    "face has corners of its own")
        ->type_name("TOLERANCE")
        ->group("Input");
    add_read_limit(command, o.read_limit);
    command.footer(
        "Examples:\n"
        "  nestgrid mesh part.poly --family bisection --field front --tolerance 0.05 \\\n"
        "           -o part.nestgrid\n"
        "\n"
        "Names of fields:\n" +
        Expression::names());
}

Command add_mesh(CLI::App& program) {
    auto request = std::make_shared<MeshRequest>();
    CLI::App* mesh = program.add_subcommand("mesh", "build a hierarchy on a mesh and refine it");
    add_mesh_options(*mesh, *request);
    return {mesh, [request](Report& report) { run_mesh(*request, report); }};
}

const RegisteredCommand mesh_command(100, add_mesh);

}  // namespace
