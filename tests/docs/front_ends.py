#!/usr/bin/env python3
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes or checks the table of docs/front_ends.md: what each front end has, and by which name.

Each name must occur in what the front end tells its users: public headers, the program's help, the
keys of the page's requests, Python's signatures, the properties of ParaView's filters. Each hole has
a reason. Every option of Python's isosurface(), of C's options, of the page and of VTK's sources
must be in the table.

Usage: front_ends.py SOURCE PROGRAM [--write]
"""
import re
import subprocess
import sys
from pathlib import Path

REASONS = {
    "b": "VTK's filters do it with the surface",
    "c": "a file holds no such data",
    "d": "two-dimensional fields are not explored",
    "e": "always all threads",
    "g": "by C++ only: it is a function of the caller's own types",
    "h": "by Ctrl-C, by the next request, or as ParaView ends any filter",
    "i": "printed with every surface",
    "j": "what is made for a field is kept with it, so that all calls are a series",
    "k": "the pointer tells the value, the place and the error",
    "l": "the field of the caller gives the values between its frames",
    "m": "elements have no names outside the code that made them",
    "n": "formulas are read by muparser, which is not in the page's WebAssembly",
}
FRONT_ENDS = ["C++", "C, Fortran", "program", "page", "Python", "VTK", "ParaView"]
# Of each feature one cell for each front end: a name, or the letter of a reason.
TABLE = {
    "What is drawn": {
        "an isosurface": "isosurface nestgrid_isosurface_with isosurface isovalue isosurface IsosurfaceSource "
        "NestgridIsosurface",
        "several in one walk": "isosurfaces nestgrid_isosurfaces --value isovalue isosurfaces SetMoreIsovalues MoreIsovalues",
        "a series of them": "IsosurfaceSeries prerolls --value j j j j",
        "a band between two": "isoband nestgrid_isoband band band isoband IsobandSource NestgridBand",
        "a slice by a plane": "Plane nestgrid_slice --plane plane plane SliceSource NestgridSlice",
        "by a sphere, a cylinder": "Sphere nestgrid_slice_along --sphere sphere sphere SetCutFunction Shape",
        "by any function": "LevelFunction nestgrid_slice_along --function n function SetCutFunction Function",
        "isolines in the plane": "isolines nestgrid_isolines isolines d isolines IsolinesSource NestgridIsolines",
        "isolines on a surface": "surface_isolines nestgrid_surface_isolines --on-surface lines isolines b b",
        "a height field, a shading": "height_field nestgrid_height_field height d height_field "
        "HeightFieldSource NestgridHeightField",
        "the boundary of the domain": "boundary_surface nestgrid_boundary_surface boundary boundary boundary BoundarySource "
        "NestgridBoundary",
        "data that jump": "DiscontinuousData nestgrid_leaf_data c c c DiscontinuousSource c",
        "values at points": "probe nestgrid_probe probe k probe b b",
        "edges of elements": "outlines elements --outlines outlines outlines SetOutlines Outlines",
        "cracks, area, volume": "surface_report nestgrid_measure_surface i report report b b",
        "measured errors": "measure_error nestgrid_measure --measure measure measure SetMeasurePoints Measure",
    },
    "How finely": {
        "a threshold": "threshold threshold --threshold threshold threshold SetThreshold Threshold",
        "an error that is kept": "error_indicator error --error error error SetError Error",
        "an error of positions": "position_error position_error --position-error position_error position_error SetProjection "
        "PositionError",
        "a distance, estimated": "slope_deviations NESTGRID_SLOPE --distance distance distance SetIndicator "
        "Distance",
        "a distance that is kept": "isosurface_within keep_distance --distance-field distance_field distance_field SetDistance "
        "DistanceField",
        "a number of triangles": "max_triangles max_triangles --max-triangles triangles max_triangles "
        "SetMaxTriangles MaxTriangles",
        "collapsed edges": "collapse collapse --collapse collapse collapse SetCollapse Collapse",
        "curved slices, collapsed": "slice_distance slice_distance --distance slice_distance distance SetProjection SliceDistance",
        "an indicator by name": "indicators indicator --indicator indicator indicator SetIndicator Indicator",
        "nodes that move": "Blended blend --blend blend blend SetBlend Blend",
        "a lens": "Lens lens --lens lens lens SetLens LensRadius",
        "a region": "Region region --box box region SetProjection RegionBounds",
        "a criterion of one's own": "Criterion g g g g g g",
        "times between frames": "Frames l --time time Frames SetFrames TimestepValues",
    },
    "How, and what is kept": {
        "normals": "normals normals --no-normals normals normals SetNormals Normals",
        "caps": "cap cap --cap cap cap SetCap Cap",
        "vertices at nodes": "at_nodes at_nodes --at-nodes at_nodes at_nodes SetAtNodes AtNodes",
        "cuts on finest data": "Cuts finest_cuts --cuts cuts cuts SetFinestCuts Cuts",
        "the element of a triangle": "elements elements --elements outlines elements SetElements Outlines",
        "places in elements": "reference reference m m m SetReference m",
        "colours that follow the data": "refine_colours colour_tolerance --colour-tolerance colour_tolerance colour_tolerance SetProjection ColourTolerance",
        "threads": "Executor threads --threads e threads SetExecutor e",
        "work that is ended": "Watch progress h h h SetAbortExecute h",
    },
}
# Names that a front end has beside those of the table: data, places, and the like.
OTHERS = {
    "page": {"axis", "at", "finest", "coarsest", "slope", "motion", "box_threshold"},
    "Python": {"level", "self"},
    "C, Fortran": {"size", "attributes", "attribute_count", "progress_data", "prerolls", "ranks"},
    "VTK": {"SetGrid", "SetOrigin", "SetNormal", "SetIsovalue", "SetScale", "SetValues", "SetLow", "SetHigh",
            "SetProjection"},
}
MARKED_BEGIN = "<!-- made by tests/docs/front_ends.py -->\n"


def text_of(folder, *patterns):
    return "\n".join(p.read_text() for pattern in patterns for p in sorted(folder.glob(pattern)))


def python_arguments(source):
    """The parameters of isosurface() in Python."""
    text = (source / "adapters/python/nestgrid/_fields.py").read_text()
    signature = re.search(r"def isosurface\((.*?)\) ->", text, re.S).group(1)
    return set(re.findall(r"^\s*(\w+)\s*:", signature, re.M)) | {"self"}


def public_text(source, program):
    """What each front end tells its users."""
    commands = ["isosurface", "band", "slice", "isolines", "height", "boundary", "probe"]
    run = [subprocess.run([program, c, "--help-all"], capture_output=True, text=True) for c in commands]
    helps = "\n".join(done.stdout for done in run)
    request = (source / "tools/view/frame_request.cpp").read_text()
    keys = "".join(re.findall(r'"([^"]*)"', request.split("known_keys", 1)[1].split(";", 1)[0]))
    return {
        "C++": text_of(source / "algorithms/nestgrid/algorithms", "*.hpp"),
        "C, Fortran": text_of(source / "algorithms/c/nestgrid/algorithms", "*.h"),
        "program": " ".join(commands) + helps,
        "page": keys,
        "Python": text_of(source / "adapters/python/nestgrid", "_fields.py", "_sources.py", "_results.py"),
        "VTK": text_of(source / "adapters/vtk/nestgrid/adapters", "*_source.hpp"),
        "ParaView": text_of(source / "adapters/python/nestgrid/paraview/plugin", "*.py"),
    }


def options_of(source, texts):
    """What a front end offers of which nothing may be missing in the table."""
    struct = texts["C, Fortran"].split("typedef struct nestgrid_options {", 1)[1].split("}", 1)[0]
    struct = re.sub(r"/\*.*?\*/", "", struct, flags=re.S)
    struct = re.sub(r"\(\*(\w+)\)\([^)]*\)", r"\1", struct)
    return {
        "page": set(re.findall(r"\w+", texts["page"])) - {"and"},
        "Python": python_arguments(source),
        "C, Fortran": set(re.findall(r"(\w+);", struct)),
        "VTK": set(re.findall(r"void (Set\w+)\(", texts["VTK"])),
    }


def rows():
    for features in TABLE.values():
        for feature, cells in features.items():
            yield feature, dict(zip(FRONT_ENDS, cells.split(), strict=True))


def faults(source, texts):
    found = []
    named = {front_end: set() for front_end in FRONT_ENDS}
    for feature, cells in rows():
        for front_end, cell in cells.items():
            if cell in REASONS:
                continue
            named[front_end].add(cell)
            if not re.search(rf"(?<![\w-]){re.escape(cell)}(?![\w-])", texts[front_end]):
                found.append(f"{feature}: {front_end} tells nobody of '{cell}'")
    for front_end, options in options_of(source, texts).items():
        for option in sorted(options - named[front_end] - OTHERS[front_end]):
            found.append(f"the table lacks '{option}' of {front_end}")
    return found


def table():
    lines = []
    for title, features in TABLE.items():
        lines += [f"## {title}", "", "| | " + " | ".join(FRONT_ENDS) + " |"]
        lines.append("|---" * (len(FRONT_ENDS) + 1) + "|")
        for feature, cells in features.items():
            shown = (f"({c})" if c in REASONS else f"`{c}`" for c in cells.split())
            lines.append(f"| {feature} | " + " | ".join(shown) + " |")
        lines.append("")
    used = {c for _, cells in rows() for c in cells.values() if c in REASONS}
    lines += [f"- ({letter}) {REASONS[letter]}" for letter in sorted(used)]
    return "\n".join(lines) + "\n"


def main():
    source, program = Path(sys.argv[1]), sys.argv[2]
    found = faults(source, public_text(source, program))
    page = source / "docs/front_ends.md"
    before, _, after = page.read_text().partition(MARKED_BEGIN)
    if "--write" in sys.argv:
        page.write_text(before + MARKED_BEGIN + "\n" + table())
    elif after != "\n" + table():
        found.append("docs/front_ends.md is not what tests/docs/front_ends.py --write makes")
    print(*found, f"{sum(1 for _ in rows())} features, {len(found)} faults", sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
