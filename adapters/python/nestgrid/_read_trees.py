# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of its own, which reads .htg by VTK.

Arguments: the file, and the name of a field or nothing. Answers as _answer.py says, with leaves,
values and masks one after the other.
"""

from __future__ import annotations

import html
import re
from typing import Any

import numpy as np
from _answer import Refused, answer, packed
from _hdf5_boxes import chosen
from _read_amr import Complaints
from _read_vtk import check_whole, names_of
from _vtk_trees import trees_of

GHOSTS = "vtkGhostType"


class TreeFile:
    """What is in a file: the trees, and the arrays of their cells.

    Files of version 2 have each array in one piece, of which VTK asks for the numbers of one tree
    after the other, and VTK 9.1 for as many as there are cells where each has several. Here VTK
    reads the trees alone, and then an array as that of an image.
    """

    def __init__(self, path: str) -> None:
        from vtkmodules.vtkIOXML import vtkXMLHyperTreeGridReader

        reader = vtkXMLHyperTreeGridReader()
        check_whole(path, reader, "hyper tree grid")
        with open(path, "rb") as file:
            head, appended, data = file.read().partition(b"<AppendedData")
        self._end = appended + data if appended else b"</VTKFile>"
        first = re.search(rb"<VTKFile\b[^>]*>", head)
        self._first_line = first[0] if first else b""
        cells = re.search(rb"<CellData\b[^>]*>(.*?)</CellData>", head, re.DOTALL)
        self._arrays: dict[str, bytes] = {}
        reader.SetFileName(path)
        if cells and attribute(self._first_line, "version").startswith("2"):
            each_array = rb"<DataArray\b[^>]*?(?:/>|>.*?</DataArray>)"
            for array in re.findall(each_array, cells[1], re.DOTALL):
                self._arrays[attribute(array, "Name")] = array
            reader.ReadFromInputStringOn()
            reader.SetInputString(head[: cells.start(1)] + head[cells.end(1) :] + appended + data)
        reader.Update()
        self.grid = reader.GetOutputDataObject(0)
        if GHOSTS in self._arrays:
            self.grid.GetCellData().AddArray(self._read(GHOSTS))
        cell_data = self.grid.GetCellData()
        found = [each for each in names_of(cell_data) if cell_data.GetArray(each) is not None]
        self.names = [each for each in self._arrays or found if each != GHOSTS]

    def numbers(self, name: str) -> np.ndarray:
        """The numbers of an array, one row a cell."""
        from vtkmodules.util.numpy_support import vtk_to_numpy

        array = self._read(name) if self._arrays else self.grid.GetCellData().GetArray(name)
        return vtk_to_numpy(array).reshape(-1, array.GetNumberOfComponents())

    def _read(self, name: str) -> Any:
        from vtkmodules.vtkIOXML import vtkXMLImageDataReader

        line = re.sub(rb'\bversion="[^"]*"', b'version="1.0"', self._first_line)
        extent = b'Extent="0 %d 0 0 0 0"' % self.grid.GetGlobalNodeIndexMax()
        image = b'<ImageData Whole%s Origin="0 0 0" Spacing="1 1 1"><Piece %s>' % (extent, extent)
        image += b"<PointData>%s</PointData></Piece></ImageData>" % self._arrays[name]
        reader = vtkXMLImageDataReader()
        reader.ReadFromInputStringOn()
        reader.SetInputString(line.replace(b"HyperTreeGrid", b"ImageData") + image + self._end)
        reader.Update()
        array = reader.GetOutput().GetPointData().GetArray(name)
        if array is None:
            raise ValueError(f"the field '{name}' has fewer numbers than the trees have cells")
        return array


def attribute(tag: bytes, name: str) -> str:
    """The value of an attribute of the first tag."""
    found = re.search(rb'^<[^>]*?\s' + name.encode() + rb'="([^"]*)"', tag)
    return html.unescape(found[1].decode()) if found else ""


def read(path: str, name: str) -> tuple[dict[str, Any], bytes]:
    complaints = Complaints()
    try:
        file = TreeFile(path)
        complaints.check(path)
        wanted = chosen(path, name, file.names)
        numbers = file.numbers(wanted)
        complaints.check(path)
        trees = trees_of(file.grid)
    except ValueError as error:
        raise Refused(f"{path}: {error}") from None
    if len(numbers) <= trees.index.max():
        raise Refused(f"{path}: the field '{wanted}' has fewer numbers than the trees have cells")
    arrays = {
        "leaves": (trees.leaves, "int64"),
        "values": (numbers[trees.index], "float64"),
        "masked": (trees.masked, "uint8"),
    }
    place, data = packed(arrays)
    place |= {"name": wanted, "max_level": trees.max_level, "factor": trees.factor}
    return place | {"coordinates": [axis.tolist() for axis in trees.coordinates]}, data


if __name__ == "__main__":
    answer(read)
