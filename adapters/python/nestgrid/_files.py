# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of surfaces and lines, written with NumPy alone. A file appears when it is complete."""

from __future__ import annotations

import os
import tempfile
from typing import BinaryIO, Callable, Sequence

import numpy as np

from ._nestgrid import InvalidInput, IoError

Pieces = Sequence[tuple[str, np.ndarray]]


def write(path: str | os.PathLike, writers: dict[str, Callable[[BinaryIO], None]]) -> None:
    """Writes a file by the writer of its suffix.

    Raises InvalidInput for a suffix that has none, IoError where writing fails.
    """
    path = os.fspath(path)
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in writers:
        raise InvalidInput(f"'{path}' ends in none of {', '.join(writers)}")
    part = None
    try:
        folder = os.path.dirname(path) or "."
        with tempfile.NamedTemporaryFile(dir=folder, delete=False) as file:
            part = file.name
            writers[suffix](file)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(part, 0o666 & ~mask)
        os.replace(part, path)
    except OSError as error:
        raise IoError(f"'{path}' cannot be written: {error.strerror}") from error
    finally:
        if part and os.path.exists(part):
            os.remove(part)


def ply(file: BinaryIO, vertices: np.ndarray, normals: np.ndarray, triangles: np.ndarray) -> None:
    """Writes a binary PLY file with positions and normals of type double."""
    names = ["x", "y", "z"] + (["nx", "ny", "nz"] if len(normals) else [])
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property double {name}" for name in names]
    header += [f"element face {len(triangles)}", "property list uchar uint vertex_indices"]
    file.write(("\n".join(header) + "\nend_header\n").encode())
    rows = np.hstack([vertices, normals]) if len(normals) else vertices
    file.write(np.ascontiguousarray(rows, "<f8").tobytes())
    faces = np.empty(len(triangles), [("count", "u1"), ("corners", "<u4", 3)])
    faces["count"] = 3
    faces["corners"] = triangles
    file.write(faces.tobytes())


def stl(file: BinaryIO, vertices: np.ndarray, triangles: np.ndarray) -> None:
    """Writes a binary STL file, whose numbers are float."""
    corners = vertices[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    facets = np.zeros(
        len(triangles), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
    )
    facets["normal"] = np.divide(across, length, out=np.zeros_like(across), where=length > 0)
    facets["corners"] = corners
    file.write(b"nestgrid".ljust(80) + np.uint32(len(triangles)).tobytes() + facets.tobytes())


def vtp(
    file: BinaryIO,
    vertices: np.ndarray,
    cells: Pieces,
    point_data: Pieces = (),
    cell_data: Pieces = (),
) -> None:
    """Writes VTK's XML poly data, binary.

    cells: one of ("Polys", (n, 3)), ("Lines", (n, 2)) or ("Lines", the connectivity of several
    lines) with ("offsets", the end of each).
    """
    blocks: list[bytes] = []
    kinds = {"f": "Float64", "i": "Int64"}

    def array(name: str, data: np.ndarray) -> str:
        data = np.ascontiguousarray(data, "<f8" if data.dtype.kind == "f" else "<i8")
        offset = sum(len(block) for block in blocks)
        blocks.append(np.uint64(data.nbytes).tobytes() + data.tobytes())
        columns = data.shape[1] if data.ndim == 2 else 1
        return (
            f'<DataArray type="{kinds[data.dtype.kind]}" Name="{name}" '
            f'NumberOfComponents="{columns}" format="appended" offset="{offset}"/>'
        )

    kind, corners = cells[0]
    ends = cells[1][1] if len(cells) > 1 else (1 + np.arange(len(corners))) * corners.shape[1]
    number = f'NumberOf{kind}="{len(ends)}"'
    xml = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        f'<PolyData><Piece NumberOfPoints="{len(vertices)}" {number}>',
        "<Points>" + array("Points", vertices) + "</Points>",
        "<PointData>" + "".join(array(*piece) for piece in point_data) + "</PointData>",
        "<CellData>" + "".join(array(*piece) for piece in cell_data) + "</CellData>",
        f"<{kind}>" + array("connectivity", corners.reshape(-1)) + array("offsets", ends),
        f'</{kind}></Piece></PolyData><AppendedData encoding="raw">_',
    ]
    file.write("\n".join(xml).encode())
    for block in blocks:
        file.write(block)
    file.write(b"</AppendedData></VTKFile>\n")
