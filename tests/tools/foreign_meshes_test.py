# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes that meshio, assimp, gmsh, admesh and VTK write, and variants that the formats allow, are
read as they are meant: nodes, elements, area, and the box around them.

Argument: the program.
"""

import itertools
import json
import os
import struct
import subprocess
import sys
import tempfile

try:
    import meshio
except ImportError:
    print("skipped: meshio is missing")
    sys.exit(77)
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
from vtkmodules.vtkIOPLY import vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

PROGRAM = os.path.abspath(sys.argv[1])
failures = 0
cases = 0


def fail(text):
    global failures
    failures += 1
    print("FAILED:", text)


def ball(centre, radius=2.0, refinements=3):
    """Vertices and triangles of a subdivided icosahedron."""
    golden = (1 + 5**0.5) / 2
    vertices = [
        np.roll(corner, shift)
        for shift in range(3)
        for corner in ([0, s, t * golden] for s in (-1, 1) for t in (-1, 1))
    ]
    vertices = [v / np.linalg.norm(v) for v in vertices]
    edge = min(np.linalg.norm(vertices[0] - v) for v in vertices[1:])
    triangles = [
        t
        for t in itertools.combinations(range(12), 3)
        if all(
            np.linalg.norm(vertices[a] - vertices[b]) < 1.01 * edge
            for a, b in itertools.combinations(t, 2)
        )
    ]
    triangles = [
        t if np.linalg.det([vertices[v] for v in t]) > 0 else (t[0], t[2], t[1]) for t in triangles
    ]
    for _ in range(refinements):
        middle = {}

        def between(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                x = vertices[a] + vertices[b]
                vertices.append(x / np.linalg.norm(x))
                middle[key] = len(vertices) - 1
            return middle[key]

        finer = []
        for a, b, c in triangles:
            ab, bc, ca = between(a, b), between(b, c), between(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    return np.array(centre) + radius * np.array(vertices), np.array(triangles)


def area(vertices, triangles):
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


NEAR = ball((11.0, -7.0, 31.0))
FAR = ball((500000.25, -7.0, 31.0))


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


def check(name, mesh, *options, digits=6, nodes=None):
    """The file holds this mesh, in so many digits of a coordinate."""
    global cases
    cases += 1
    vertices, triangles = mesh
    fields = [word for axis in "xyz" for word in ("--field", axis)]
    done = program(
        "mesh", name, "--family", "bisection", *fields, *options, "-o", "x.nestgrid", "--json"
    )
    if done.returncode != 0 or done.stderr:
        return fail(f"{name}: {done.stderr.strip()}")
    found = json.loads(done.stdout)
    if found["coarse_elements"] != len(triangles):
        fail(f"{name}: {found['coarse_elements']} elements")
    if found["nodes"] != (nodes or len(vertices)):
        fail(f"{name}: {found['nodes']} nodes")
    step = 10.0**-digits * np.abs(vertices).max()
    expected = area(vertices, triangles)
    if abs(found["measure"] - expected) > 1e-9 * expected + 100 * step:
        fail(f"{name}: area {found['measure']}, not {expected}")
    for axis, row in enumerate(found["fields"]):
        least, greatest = vertices[:, axis].min(), vertices[:, axis].max()
        if abs(row["least_value"] - least) > step or abs(row["greatest_value"] - greatest) > step:
            fail(f"{name}: {row}, not {least} to {greatest}")


def refused(name, words, *options):
    global cases
    cases += 1
    done = program("mesh", name, "--family", "bisection", *options, "-o", "no.nestgrid")
    lines = done.stderr.strip().split("\n")
    if done.returncode != 1 or len(lines) != 1 or words not in lines[0]:
        fail(f"{name}: {done.returncode}, {done.stderr.strip()}, not '{words}'")
    if os.path.exists("no.nestgrid"):
        fail(f"{name}: a file was left")


def write(name, content):
    with open(name, "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())


def lines_of(rows, form):
    return "".join(form % tuple(row) + "\n" for row in rows)


def test_off():
    vertices, triangles = FAR
    counts = f"{len(vertices)} {len(triangles)}"
    points = lines_of(vertices, "%.17g %.17g %.17g")
    faces = lines_of(triangles, "3 %d %d %d")
    body = points + faces
    n = len(vertices)

    def extended(*columns):
        return lines_of(np.hstack([vertices, np.tile(columns, (n, 1))]), " ".join(["%.17g"] * (3 + len(columns))))

    files = {
        "plain": f"OFF\n{counts} 0\n{body}",
        "one_line": f"OFF {counts} 0\n{body}",
        "joined": f"OFF{counts} 0\n{body}",
        "no_keyword": f"{counts} 0\n{body}",
        "no_edges": f"OFF\n{counts}\n{body}",
        "no_keyword_no_edges": f"{counts}\n{body}",
        "comments": f"# a\nOFF # b\n\n# c\n{counts} 0 # d\n# e\n{body}",
        "windows": f"OFF\n{counts} 0\n{body}".replace("\n", "\r\n"),
        "indented": f"  OFF\n  {counts} 0\n" + body.replace("\n", "\n  "),
        "blank_lines": f"OFF\n\n{counts} 0\n\n{points}\n{faces}\n\n",
        "colours": f"COFF\n{counts} 0\n" + extended(255, 0, 0, 255) + faces,
        "normals": f"NOFF\n{counts} 0\n" + extended(0, 0, 1) + faces,
        "textures": f"STOFF\n{counts} 0\n" + extended(0.5, 0.25) + faces,
        "coloured_faces": f"OFF\n{counts} 0\n{points}" + lines_of(triangles, "3 %d %d %d 255 0 0"),
        "float_colours": f"OFF\n{counts} 0\n{points}"
        + lines_of(triangles, "3 %d %d %d 0.5 0.25 1 1"),
    }
    for kind, content in files.items():
        write(f"{kind}.off", content)
        check(f"{kind}.off", FAR, digits=12)
    write("CAPITAL.OFF", files["plain"])
    check("CAPITAL.OFF", FAR, digits=12)
    write("four.off", f"4OFF\n{counts} 0\n{body}")
    refused("four.off", "other dimensions")
    write("binary.off", b"OFF BINARY\n" + struct.pack(">3i", 8, 12, 0))
    refused("binary.off", "binary .off, which is not read")
    write("cut.off", files["plain"][:-400])
    refused("cut.off", "truncated")
    write("points.off", f"OFF\n{len(vertices)} 0 0\n{points}")
    refused("points.off", "has no faces")


def ply(form, properties, faces, vertex_bytes, face_bytes, extra="", first=b""):
    vertices, triangles = FAR
    return (
        f"ply\nformat {form} 1.0\ncomment made by hand\n{extra}element vertex {len(vertices)}\n"
        f"{properties}element face {len(triangles)}\n{faces}end_header\n"
    ).encode() + first + vertex_bytes + face_bytes


def test_ply():
    vertices, triangles = FAR
    xyz = "".join(f"property double {axis}\n" for axis in "xyz")
    corners = "property list uchar int vertex_indices\n"
    points = lines_of(vertices, "%.17g %.17g %.17g").encode()
    little = vertices.astype("<f8").tobytes()

    def text(form):
        return lines_of(triangles, form).encode()

    def packed(byte_order="<", before=b"", behind=b"", count="B", index="i"):
        form = struct.Struct(f"{byte_order}{count}3{index}")
        return b"".join(before + form.pack(3, *t) + behind for t in triangles)

    texture = "property list uchar float texcoord\n"
    flags = "property int flags\n"
    coordinates = struct.pack("<B6f", 6, 0, 0, 1, 0, 1, 1)
    plain = ply("ascii", xyz, corners, points, text("3 %d %d %d"))
    files = {
        "text": plain,
        "windows": plain.replace(b"\n", b"\r\n"),
        "little": ply("binary_little_endian", xyz, corners, little, packed()),
        "big": ply("binary_big_endian", xyz, corners, vertices.astype(">f8").tobytes(), packed(">")),
        "index": ply("binary_little_endian", xyz, corners.replace("indices", "index"), little, packed()),
        "unsigned": ply("binary_little_endian", xyz, "property list uint uint vertex_indices\n",
                        little, packed(count="I", index="I")),
        "sized_types": ply("binary_little_endian", xyz.replace("double", "float64"),
                           "property list uint8 int32 vertex_indices\n", little, packed()),
        "textures_in_front": ply("ascii", xyz, texture + corners, points,
                                 text("6 0 0 1 0 1 1 3 %d %d %d")),
        "textures_in_front_packed": ply("binary_little_endian", xyz, texture + corners, little,
                                        packed(before=coordinates)),
        "textures_behind": ply("binary_little_endian", xyz, corners + texture + flags, little,
                               packed(behind=coordinates + struct.pack("<i", 7))),
        "flags_in_front": ply("ascii", xyz, flags + corners, points, text("7 3 %d %d %d")),
        "flags_in_front_packed": ply("binary_little_endian", xyz, flags + corners, little,
                                     packed(before=struct.pack("<i", 7))),
        "colours_behind": ply("ascii", xyz,
                              corners + "".join(f"property uchar {c}\n" for c in ("red", "green", "blue")),
                              points, text("3 %d %d %d 1 2 3")),
        "normals_in_front": ply("ascii", "".join(f"property double n{a}\n" for a in "xyz") + xyz, corners,
                                lines_of(vertices, "0 0 1 %.17g %.17g %.17g").encode(), text("3 %d %d %d")),
        "list_at_vertices": ply("ascii", xyz + "property list uchar int more\n", corners,
                                lines_of(vertices, "%.17g %.17g %.17g 2 5 6").encode(), text("3 %d %d %d")),
        "order": ply("ascii", "".join(f"property double {a}\n" for a in "zyx"), corners,
                     lines_of(vertices[:, ::-1], "%.17g %.17g %.17g").encode(), text("3 %d %d %d")),
        "short_indices": ply("ascii", xyz, "property list uchar ushort vertex_indices\n", points,
                             text("3 %d %d %d")),
        "camera": ply("ascii", xyz, corners, points, text("3 %d %d %d"),
                      extra="element camera 1\nproperty float a\nproperty float b\n", first=b"1 2\n"),
        "obj_info": plain.replace(b"comment made by hand", b"obj_info num_cols 3"),
    }
    for kind, content in files.items():
        write(f"{kind}.ply", content)
        check(f"{kind}.ply", FAR, digits=12)
    write("short_packed.ply", ply("binary_little_endian", xyz, "property list uchar ushort vertex_indices\n",
                                  little, packed(index="H")))
    refused("short_packed.ply", "in ushort")
    write("cloud.ply", f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n{xyz}end_header\n".encode()
          + points)
    refused("cloud.ply", "has no faces")
    write("strips.ply", f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n{xyz}element tristrips 1\n"
          "property list int int vertex_indices\nend_header\n".encode() + points + b"4 0 1 2 3\n")
    refused("strips.ply", "strips of triangles, which are not read")
    write("nameless.ply", ply("ascii", xyz, "property list uchar int corners\n", points, text("3 %d %d %d")))
    refused("nameless.ply", "faces without a list 'vertex_indices'")


def test_obj():
    vertices, triangles = FAR
    points = lines_of(vertices, "v %.17g %.17g %.17g")
    faces = lines_of(triangles + 1, "f %d %d %d")
    rows = (triangles + 1).tolist()
    files = {
        "plain": points + faces,
        "windows": (points + faces).replace("\n", "\r\n"),
        "tabs": (points + faces).replace(" ", "\t"),
        "textured": points + "vt 0 0\n" + "".join("f %d/1 %d/1 %d/1\n" % tuple(t) for t in rows),
        "full": points + "vt 0 0\nvn 0 0 1\n"
        + "".join("f %d/1/1 %d/1/1 %d/1/1\n" % tuple(t) for t in rows),
        "normals": points + "vn 0 0 1\n" + "".join("f %d//1 %d//1 %d//1\n" % tuple(t) for t in rows),
        "negative": points + lines_of(triangles - len(vertices), "f %d %d %d"),
        "groups": "# c\nmtllib x.mtl\no ball\ng a b\n" + points + "usemtl m\ns off\n" + faces
        + "l 1 2\np 1\n",
        "coloured": lines_of(vertices, "v %.17g %.17g %.17g 0.1 0.2 0.3") + faces,
        "weighted": lines_of(vertices, "v %.17g %.17g %.17g 1") + faces,
        "continued": points + "".join("f %d \\\n%d %d\n" % tuple(t) for t in rows),
        "late_comment": points + "".join("f %d %d %d # face\n" % tuple(t) for t in rows),
    }
    for kind, content in files.items():
        write(f"{kind}.obj", content)
        check(f"{kind}.obj", FAR, digits=12)
    corners = np.arange(3 * len(triangles)).reshape(-1, 3)
    soup = lines_of(vertices[triangles].reshape(-1, 3), "v %.17g %.17g %.17g") + lines_of(corners + 1, "f %d %d %d")
    write("soup.obj", soup)
    refused("soup.obj", "--weld TOLERANCE makes such nodes one")
    check("soup.obj", FAR, "--weld", "0", digits=12)
    check("soup.obj", FAR, "--weld", "1e-6", digits=12)
    moved = vertices[triangles].reshape(-1, 3) + 1e-7 * np.sin(np.arange(9 * len(triangles))).reshape(-1, 3)
    write("near.obj", lines_of(moved, "v %.17g %.17g %.17g") + lines_of(corners + 1, "f %d %d %d"))
    check("near.obj", FAR, "--weld", "1e-5", digits=10)
    refused("soup.obj", "--weld is negative", "--weld", "-1")


def test_stl():
    vertices, triangles = NEAR
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + lines_of(vertices[t], "vertex %.9g %.9g %.9g")
        + "endloop\nendfacet\n"
        for t in triangles
    )
    text = f"solid ball of mine\n{facets}endsolid ball of mine\n"
    numbers = b"".join(
        struct.pack("<12fH", 0, 0, 0, *vertices[t].ravel(), 0) for t in triangles
    )
    packed = struct.pack("<I", len(triangles)) + numbers
    half = facets.split("endfacet\n")
    first = "endfacet\n".join(half[:100]) + "endfacet\n"
    second = "endfacet\n".join(half[100:])
    files = {
        "text": text,
        "capitals": text.upper(),
        "windows": text.replace("\n", "\r\n"),
        "indented": "  " + text.replace("\n", "\n  "),
        "named_solid": text.replace("ball of mine", "solid facet"),
        "two_solids": f"solid a\n{first}endsolid a\nsolid b\n{second}endsolid b\n",
        "packed": b"x".ljust(80) + packed,
        "packed_solid": b"solid".ljust(80) + packed,
        "longer": b"x".ljust(80) + packed + b"more",
    }
    for kind, content in files.items():
        write(f"{kind}.stl", content)
        check(f"{kind}.stl", NEAR)
    write("no_end.stl", text.split("endsolid")[0])
    refused("no_end.stl", "truncated")


def poly_data(vertices, triangles):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(vertices, deep=True))
    cells = vtkCellArray()
    padded = np.hstack([np.full((len(triangles), 1), 3), triangles]).ravel().astype(np.int64)
    cells.SetCells(len(triangles), numpy_to_vtkIdTypeArray(padded, deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def test_writers():
    data = poly_data(*NEAR)
    for name, writer in (
        ("vtk.obj", vtkOBJWriter()),
        ("vtk.ply", vtkPLYWriter()),
        ("vtk.stl", vtkSTLWriter()),
        ("vtk.vtp", vtkXMLPolyDataWriter()),
    ):
        writer.SetInputData(data)
        writer.SetFileName(name)
        writer.Write()
        check(name, NEAR)
    for packed in (False, True):
        for ending in (".ply", ".stl"):
            name = f"meshio_{packed}{ending}"
            meshio.write(name, meshio.Mesh(NEAR[0], [("triangle", NEAR[1])]), binary=packed)
            check(name, NEAR)
    for ending in (".off", ".obj"):
        meshio.write(f"meshio{ending}", meshio.Mesh(NEAR[0], [("triangle", NEAR[1])]))
        check(f"meshio{ending}", NEAR)
    # assimp writes corners of their own for each face.
    for ending in ("obj", "ply", "stl"):
        name = f"assimp.{ending}"
        if run_tool("assimp", "export", "vtk.stl", name):
            check(name, NEAR, "--weld", "0")
    for name, form in (("gmsh.stl", "stl"), ("gmsh.ply2", "ply2")):
        if run_tool("gmsh", "vtk.stl", "-save", "-format", form, "-o", name) and form != "ply2":
            check(name, NEAR)
    os.rename("gmsh.ply2", "gmsh.ply")
    refused("gmsh.ply", "no complete header of the format .ply")
    for option, name in (
        ("-a", "admesh.stl"),
        ("-b", "admesh_packed.stl"),
        ("--write-off=", "admesh.off"),
    ):
        command = [option, name] if not option.endswith("=") else [option + name]
        if run_tool("admesh", *command, "vtk.stl"):
            check(name, NEAR)


def run_tool(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    written = [word.split("=")[-1] for word in command if word.split("=")[-1] != "vtk.stl"]
    if not any(os.path.exists(name) for name in written if "." in name):
        fail(f"{command}: {done.stdout[-200:]} {done.stderr[-200:]}")
        return False
    return True


def test_solids():
    """The same surfaces as domains of lenses, and no mesh at all."""
    global cases
    write("x.txt", "nothing")
    refused("x.txt", "is of no format for meshes")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for test in (test_off, test_ply, test_obj, test_stl, test_writers, test_solids):
        test()
    os.chdir("/")
print(f"{cases} files, {failures} failures")
sys.exit(1 if failures else 0)
