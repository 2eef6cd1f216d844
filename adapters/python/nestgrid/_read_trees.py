# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of its own, which reads .htg and .phtg by VTK.

Arguments: the file, and the name of a field or nothing. Answers as _answer.py says, with leaves,
values and masks one after the other.
"""

from __future__ import annotations

import html
import os
import re
from typing import Any

import numpy as np
from _answer import Refused, answer, packed
from _hdf5_boxes import chosen
from _read_amr import Complaints
from _read_vtk import check_whole, names_of
from _vtk_trees import Trees, trees_of

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
        trees = range(self.grid.GetMaxNumberOfTrees())
        self.has_trees = any(self.grid.GetTree(i) is not None for i in trees)
        if GHOSTS in self._arrays and self.has_trees:
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


def pieces_of(path: str) -> list[str]:
    """The files that a list of pieces names, or the file alone."""
    if not path.lower().endswith(".phtg"):
        return [path]
    with open(path, "rb") as file:
        named = re.findall(rb"<Piece\b[^>]*>", file.read())
    if not named:
        raise Refused(f"{path} names no pieces")
    sources = [attribute(each, "Source") for each in named]
    for source in sources:
        if not source.endswith(".htg"):
            raise Refused(f"{path}: its piece '{source}' does not end in .htg")
        if not os.path.isfile(os.path.join(os.path.dirname(path), source)):
            raise Refused(f"{path}: its piece '{source}' does not exist")
    return [os.path.join(os.path.dirname(path), source) for source in sources]


def joined(parts: list[tuple[Trees, np.ndarray]]) -> tuple[Trees, np.ndarray]:
    """The leaves of all pieces and their numbers; ghost cells are leaves of other pieces."""
    first = parts[0][0]
    max_level = max(trees.max_level for trees, _ in parts)
    leaves = []
    for trees, _ in parts:
        own = trees.leaves[~trees.ghosts]
        own[:, :-1] *= trees.factor ** (max_level - trees.max_level)
        leaves.append(own)
        same = [np.array_equal(a, b) for a, b in zip(trees.coordinates, first.coordinates)]
        if trees.factor != first.factor or not all(same):
            raise ValueError("the trees of a piece lie elsewhere than those of the first one")
    masked = np.concatenate([trees.masked[~trees.ghosts] for trees, _ in parts])
    numbers = np.concatenate([numbers[~trees.ghosts] for trees, numbers in parts])
    none = np.zeros(0, np.int64)
    own = np.concatenate(leaves)
    return Trees(own, none, masked, none, max_level, first.factor, first.coordinates), numbers


def read_piece(path: str, name: str, complaints: Complaints) -> tuple[str, Trees, np.ndarray] | None:
    """The name of the field, the trees of a file, if any, and the numbers of their leaves."""
    file = TreeFile(path)
    complaints.check(path)
    if not file.has_trees:
        return None
    wanted = chosen(path, name, file.names)
    numbers = file.numbers(wanted)
    complaints.check(path)
    trees = trees_of(file.grid)
    if len(numbers) <= trees.index.max():
        raise ValueError(f"the field '{wanted}' has fewer numbers than the trees have cells")
    return wanted, trees, numbers[trees.index]


def read(path: str, name: str) -> tuple[dict[str, Any], bytes]:
    complaints = Complaints()
    parts: list[tuple[Trees, np.ndarray]] = []
    try:
        for piece in pieces_of(path):
            part = read_piece(piece, name, complaints)
            if part is not None:
                name, trees, numbers = part
                parts.append((trees, numbers))
        if not parts:
            raise ValueError("it has no trees")
        if len(parts) > 1:
            trees, numbers = joined(parts)
    except ValueError as error:
        raise Refused(f"{path}: {error}") from None
    arrays = {
        "leaves": (trees.leaves, "int64"),
        "values": (numbers, "float64"),
        "masked": (trees.masked, "uint8"),
    }
    place, data = packed(arrays)
    place |= {"name": name, "max_level": trees.max_level, "factor": trees.factor}
    return place | {"coordinates": [axis.tolist() for axis in trees.coordinates]}, data


if __name__ == "__main__":
    answer(read)
