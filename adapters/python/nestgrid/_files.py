# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of surfaces and lines, written with NumPy alone. A file appears when it is complete."""

from __future__ import annotations

import base64
import json
import os
import re
import tempfile
import zlib
from typing import IO, Callable, Literal, Sequence
from xml.sax.saxutils import quoteattr

import numpy as np

from ._arguments import suggestion
from ._nestgrid import InvalidInput, IoError

Pieces = Sequence[tuple[str, np.ndarray]]
#: How a file is packed.
Compression = Literal["none", "zlib"]


def write(
    path: str | os.PathLike,
    writers: dict[str, Callable[[IO[bytes]], None]],
    compress: Compression,
    double: bool,
) -> None:
    """Writes a file by the writer of its suffix.

    compress, double  those that the writers were given

    Raises InvalidInput for a suffix that has none, or whose writer does not know what is asked for,
    IoError where writing fails.
    """
    path = os.fspath(path)
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in writers:
        near = suggestion(suffix, writers)
        raise InvalidInput(f"save(): '{path}' ends in none of {', '.join(writers)}{near}")
    if compress != "none" and suffix != ".vtp":
        raise InvalidInput(f"save(): compress is for .vtp, not for '{path}'")
    if not double and suffix not in (".vtp", ".ply"):
        raise InvalidInput(f"save(): double=False is for .vtp and .ply, not for '{path}'")
    part = None
    try:
        folder = os.path.dirname(path) or "."
        with tempfile.NamedTemporaryFile(dir=folder, delete=False) as file:
            part = file.name
            writers[suffix](file.file)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(part, 0o666 & ~mask)
        os.replace(part, path)
    except OSError as error:
        raise IoError(f"'{path}' cannot be written: {error.strerror}") from error
    finally:
        if part and os.path.exists(part):
            os.remove(part)


def put(file: IO[bytes], array: np.ndarray) -> None:
    """Writes the bytes of an array in parts, so that signals are heard between two of them."""
    data = np.ascontiguousarray(array).reshape(-1).view(np.uint8).data
    for begin in range(0, len(data), 1 << 24):
        file.write(data[begin : begin + (1 << 24)])


def ply(
    file: IO[bytes],
    vertices: np.ndarray,
    normals: np.ndarray,
    triangles: np.ndarray,
    double: bool,
) -> None:
    """Writes a binary PLY file with positions and normals of type double or float."""
    names = ["x", "y", "z"] + (["nx", "ny", "nz"] if len(normals) else [])
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property {'double' if double else 'float'} {name}" for name in names]
    header += [f"element face {len(triangles)}", "property list uchar uint vertex_indices"]
    file.write(("\n".join(header) + "\nend_header\n").encode())
    rows = np.hstack([vertices, normals]) if len(normals) else vertices
    put(file, rows.astype("<f8" if double else "<f4", copy=False))
    faces = np.empty(len(triangles), [("count", "u1"), ("corners", "<u4", 3)])
    faces["count"] = 3
    faces["corners"] = triangles
    put(file, faces)


def stl(file: IO[bytes], vertices: np.ndarray, triangles: np.ndarray) -> None:
    """Writes a binary STL file, whose numbers are float."""
    file.write(b"nestgrid".ljust(80) + np.array(len(triangles), "<u4").tobytes())
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    for begin in range(0, len(triangles), 1 << 16):
        corners = vertices[triangles[begin : begin + (1 << 16)]]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(across, axis=1, keepdims=True)
        facets = np.zeros(len(corners), facet)
        facets["normal"] = np.divide(across, length, out=np.zeros_like(across), where=length > 0)
        facets["corners"] = corners
        put(file, facets)


def obj(
    file: IO[bytes],
    vertices: np.ndarray,
    normals: np.ndarray,
    triangles: np.ndarray | None = None,
    lines: Sequence[np.ndarray] = (),
) -> None:
    """Writes a Wavefront file, which is text: triangles, or lines by the numbers of points."""
    rows(file, "v {:.9g} {:.9g} {:.9g}\n", vertices)
    rows(file, "vn {:.6g} {:.6g} {:.6g}\n", normals)
    if triangles is not None:
        form = "f {0}//{0} {1}//{1} {2}//{2}\n" if len(normals) else "f {} {} {}\n"
        rows(file, form, triangles.astype(np.int64) + 1)
    for line in lines:
        file.write(("l " + " ".join(str(i + 1) for i in line.tolist()) + "\n").encode())


def rows(file: IO[bytes], form: str, array: np.ndarray) -> None:
    """Writes each row of an array as text."""
    for begin in range(0, len(array), 1 << 14):
        part = array[begin : begin + (1 << 14)].tolist()
        file.write("".join(form.format(*row) for row in part).encode())


def gltf(
    file: IO[bytes],
    vertices: np.ndarray,
    data: Pieces,
    indices: np.ndarray,
) -> None:
    """Writes glTF 2.0 with everything in one file: triangles, or segments, as indices has 3 or 2
    columns. Numbers are float; "Normals" are those of glTF, others attributes of their own name.
    """
    blocks: list[np.ndarray] = []
    views: list[dict[str, int]] = []
    accessors: list[dict[str, object]] = []

    def accessor(values: np.ndarray, kind: str, target: int, bounds: bool = False) -> int:
        values = np.ascontiguousarray(values, "<f4" if values.dtype.kind == "f" else "<u4")
        offset = sum(block.nbytes for block in blocks)
        blocks.append(values)
        views.append(
            {"buffer": 0, "byteOffset": offset, "byteLength": values.nbytes, "target": target}
        )
        is_float = values.dtype.kind == "f"
        entry: dict[str, object] = {"bufferView": len(views) - 1, "type": kind}
        entry |= {"componentType": 5126 if is_float else 5125}
        entry |= {"count": values.size if kind == "SCALAR" else len(values)}
        if bounds:
            entry |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        accessors.append(entry)
        return len(accessors) - 1

    scene: dict[str, object] = {"asset": {"version": "2.0", "generator": "nestgrid"}, "scene": 0}
    if len(indices):
        attributes = {"POSITION": accessor(vertices, "VEC3", 34962, bounds=True)}
        for name, values in data:
            if name == "Normals":
                attributes["NORMAL"] = accessor(values, "VEC3", 34962)
            else:
                own = "_" + re.sub("[^A-Z0-9]", "_", name.upper())
                attributes[own] = accessor(values, "SCALAR", 34962)
        mode = 4 if indices.shape[1] == 3 else 1
        drawn = {"attributes": attributes, "mode": mode}
        drawn["indices"] = accessor(indices, "SCALAR", 34963)
        content = base64.b64encode(b"".join(block.tobytes() for block in blocks)).decode()
        size = sum(block.nbytes for block in blocks)
        uri = "data:application/octet-stream;base64," + content
        scene |= {"scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]}
        scene |= {"meshes": [{"primitives": [drawn]}], "accessors": accessors}
        scene |= {"bufferViews": views, "buffers": [{"byteLength": size, "uri": uri}]}
    else:
        scene |= {"scenes": [{}]}
    put(file, np.frombuffer(json.dumps(scene).encode(), np.uint8))


def vtp(
    file: IO[bytes],
    vertices: np.ndarray,
    cells: Pieces,
    point_data: Pieces = (),
    cell_data: Pieces = (),
    *,
    compress: Compression,
    double: bool,
) -> None:
    """Writes VTK's XML poly data, binary, with numbers of 32 bits for corners where they suffice.

    cells: one of ("Polys", (n, 3)), ("Lines", (n, 2)) or ("Lines", the connectivity of several
    lines) with ("offsets", the end of each).
    """
    blocks: list[np.ndarray] = []
    kinds = {"f8": "Float64", "f4": "Float32", "i8": "Int64", "i4": "Int32"}
    offset = 0

    def array(name: str, data: np.ndarray) -> str:
        nonlocal offset
        is_float = data.dtype.kind == "f"
        wide = double if is_float else data.size > 0 and data.max() > np.iinfo(np.int32).max
        kind = ("f" if is_float else "i") + ("8" if wide else "4")
        data = np.ascontiguousarray(data, "<" + kind)
        begin = offset
        parts = [np.array([data.nbytes], "<u8"), data] if compress == "none" else packed(data)
        blocks.extend(parts)
        offset += sum(part.nbytes for part in parts)
        columns = data.shape[1] if data.ndim == 2 else 1
        return (
            f'<DataArray type="{kinds[kind]}" Name={quoteattr(name)} '
            f'NumberOfComponents="{columns}" format="appended" offset="{begin}"/>'
        )

    kind, corners = cells[0]
    ends = cells[1][1] if len(cells) > 1 else (1 + np.arange(len(corners))) * corners.shape[1]
    number = f'NumberOf{kind}="{len(ends)}"'
    xml = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"'
        + (' compressor="vtkZLibDataCompressor">' if compress == "zlib" else ">"),
        f'<PolyData><Piece NumberOfPoints="{len(vertices)}" {number}>',
        "<Points>" + array("Points", vertices) + "</Points>",
        "<PointData>" + "".join(array(*piece) for piece in point_data) + "</PointData>",
        "<CellData>" + "".join(array(*piece) for piece in cell_data) + "</CellData>",
        f"<{kind}>" + array("connectivity", corners.reshape(-1)) + array("offsets", ends),
        f'</{kind}></Piece></PolyData><AppendedData encoding="raw">_',
    ]
    file.write("\n".join(xml).encode())
    for block in blocks:
        put(file, block)
    file.write(b"</AppendedData></VTKFile>\n")


def packed(array: np.ndarray) -> list[np.ndarray]:
    """An array as VTK packs it: the number of parts, the size of all but the last before they were
    packed, that of the last unless it is whole, the size of each after it, and the parts."""
    data = array.reshape(-1).view(np.uint8).data
    size = 1 << 18
    parts = [zlib.compress(data[begin : begin + size]) for begin in range(0, len(data), size)]
    sizes = [len(parts), size, len(data) % size] + [len(part) for part in parts]
    return [np.array(sizes, "<u8"), np.frombuffer(b"".join(parts), np.uint8)]
