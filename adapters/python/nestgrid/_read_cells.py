# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of its own, which reads .vtu and .pvtu by VTK.

Arguments: the file, and the name of a point data array or nothing. Answers as _answer.py says, with
the arrays of the mesh one after the other.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from _answer import Refused, answer, listed, packed
from _read_vtk import Errors, check_whole, names_of


def chosen(path: str, name: str, data: Any) -> Any:
    names = [each for each in names_of(data) if data.GetArray(each) is not None]
    if not names:
        raise Refused(f"{path} has no values at points", True)
    if not name and len(names) > 1:
        raise Refused(
            f"{path} has several arrays, choose one by array: {listed(names)}", True, names
        )
    found = data.GetArray(name or names[0])
    if found is None:
        raise Refused(f"{path} has no point data array '{name}'", True, names)
    return found


def read(path: str, name: str) -> tuple[dict[str, Any], bytes]:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader

    pieces = path.lower().endswith(".pvtu")
    reader = vtkXMLPUnstructuredGridReader() if pieces else vtkXMLUnstructuredGridReader()
    errors = Errors(path, reader)
    check_whole(path, reader, "unstructured grid")
    reader.SetFileName(path)
    reader.Update()
    errors.check()
    grid = reader.GetOutput()
    values = chosen(path, name, grid.GetPointData())
    if not grid.GetNumberOfCells():
        raise Refused(f"{path} has no cells")
    degrees = grid.GetCellData().GetHigherOrderDegrees()
    types = vtk_to_numpy(grid.GetCellTypesArray())
    ghosts = grid.GetCellGhostArray()
    if ghosts is not None:  # duplicate, refined and hidden ones become empty cells
        types = np.where(vtk_to_numpy(ghosts) & 41, 0, types)
    arrays = {
        "points": (vtk_to_numpy(grid.GetPoints().GetData()), "float64"),
        "types": (types, "uint8"),
        "offsets": (vtk_to_numpy(grid.GetCells().GetOffsetsArray()), "int64"),
        "connectivity": (vtk_to_numpy(grid.GetCells().GetConnectivityArray()), "int64"),
        "values": (vtk_to_numpy(values), "float64"),
        "degrees": (np.zeros(0) if degrees is None else vtk_to_numpy(degrees), "float64"),
    }
    place, data = packed(arrays)
    return place | {"name": values.GetName() or ""}, data


if __name__ == "__main__":
    answer(read)
