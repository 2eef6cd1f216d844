// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/error.hpp>

#include "command_line.hpp"
#include "expression.hpp"
#include "hierarchy.hpp"
#include "mesh.hpp"
#include "print.hpp"

namespace {

void run_mesh(MeshRequest& o) {
    require_hierarchy_name(o.output);
    check_writable(o.output);
    {
        ProgressLine progress;
        o.progress = [&](const std::string& text) { progress.show(text); };
        make_hierarchy(o);
    }
    print_info(hierarchy_info(o.output));
}

void add_mesh_options(CLI::App& command, MeshRequest& o) {
    command
        .add_option("INPUT", o.input,
                    "a surface, .off, .obj, .ply or .stl; tetrahedra, .node and .ele; or a "
                    "piecewise linear complex to be filled, .poly or .smesh")
        ->required();
    command.add_option("--family", o.family, "red-green, bisection, octree or prism")
        ->check(CLI::IsMember({"red-green", "bisection", "octree", "prism"}))
        ->required();
    command.add_option("--layers", o.layers, "thicknesses of layers of prisms on a surface")
        ->delimiter(',');
    command
        .add_option("--direction", o.direction,
                    "of the layers, x,y,z; default: along the normals of the surface")
        ->delimiter(',')
        ->expected(3);
    command.add_flag("--unbalanced", o.unbalanced,
                     "let neighbours in an octree differ by more than one level");
    command.add_option("--max-volume", o.maximum_volume,
                       "of the tetrahedra that fill a .poly or .smesh");
    command.add_option("--refine", o.refine, "uniform refinements");
    command
        .add_option("--field", o.fields,
                    "a name (see below) or an expression in x, y and z, kept at the nodes, with "
                    "--times also in t; give it again for several")
        ->take_all();
    command.add_option("--times", o.times, "frames of the fields at these times, ascending")
        ->delimiter(',');
    add_encoding_options(command, o.encoding);
    command.add_option("--tolerance", o.tolerance,
                       "refine until the first field is interpolated up to this, in all frames");
    command.add_option("--levels", o.levels, "refinements of an element at most")
        ->capture_default_str();
    command.add_option("--max-elements", o.maximum_elements, "refuse to make more than these")
        ->capture_default_str();
    add_read_limit(command, o.read_limit);
    command.add_option("-o,--output", o.output, ".nestgrid")->required();
    command.footer("Fields:\n" + Expression::names());
}

}  // namespace

Command add_mesh(CLI::App& program) {
    auto request = std::make_shared<MeshRequest>();
    CLI::App* mesh = program.add_subcommand("mesh", "build a hierarchy on a mesh and refine it");
    add_mesh_options(*mesh, *request);
    return {mesh, [request] { run_mesh(*request); }};
}
