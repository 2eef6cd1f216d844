# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of its own, which reads .htg by VTK.

Arguments: the file, and the name of a field or nothing. Answers as _answer.py says, with leaves,
values and masks one after the other.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from _answer import Refused, answer, packed
from _hdf5_boxes import chosen
from _read_amr import Complaints
from _read_vtk import check_whole, names_of
from _vtk_trees import trees_of


def read(path: str, name: str) -> tuple[dict[str, Any], bytes]:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLHyperTreeGridReader

    complaints = Complaints()
    reader = vtkXMLHyperTreeGridReader()
    check_whole(path, reader, "hyper tree grid")
    reader.SetFileName(path)
    reader.Update()
    complaints.check(path)
    grid = reader.GetOutputDataObject(0)
    cells = grid.GetCellData()
    names = [each for each in names_of(cells) if cells.GetArray(each) is not None]
    wanted = chosen(path, name, [each for each in names if each != "vtkGhostType"])
    numbers = vtk_to_numpy(cells.GetArray(wanted))
    try:
        trees = trees_of(grid)
    except ValueError as error:
        raise Refused(f"{path}: {error}") from None
    if len(numbers) <= trees.index.max():
        raise Refused(f"{path}: the field '{wanted}' has fewer numbers than the trees have cells")
    arrays = {
        "leaves": (trees.leaves, "int64"),
        "values": (numbers[trees.index].reshape(len(trees.index), -1), "float64"),
        "masked": (trees.masked, "uint8"),
    }
    place, data = packed(arrays)
    place |= {"name": wanted, "max_level": trees.max_level, "factor": trees.factor}
    return place | {"coordinates": [axis.tolist() for axis in trees.coordinates]}, data


if __name__ == "__main__":
    answer(read)
