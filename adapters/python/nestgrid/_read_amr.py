# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of its own, which reads boxes of cells: .vthb by VTK, other files by h5py.

Arguments: the file, and the name of a field or nothing. Answers as _answer.py says, with the
numbers of all boxes one after the other, x fastest.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from _answer import Refused, answer
from _hdf5_boxes import Boxes, chosen, read_athena, read_chombo, read_enzo, read_flash, told
from _read_vtk import check_whole, reason
from _vtk_amr import boxes_of


class Complaints:
    """The first error or warning of any reader of VTK."""

    CallDataType = "string0"

    def __init__(self) -> None:
        from vtkmodules.vtkCommonCore import vtkOutputWindow

        self.first = ""
        for event in ("ErrorEvent", "WarningEvent"):
            vtkOutputWindow.GetInstance().AddObserver(event, self)

    def __call__(self, _caller: Any, _event: str, message: str = "") -> None:
        self.first = self.first or reason(message)

    def check(self, path: str) -> None:
        if self.first:
            raise Refused(f"{path} cannot be read: {self.first}")


def read_vthb(path: str, name: str) -> tuple[Any, str]:
    from vtkmodules.vtkIOXML import vtkXMLUniformGridAMRReader

    reader = vtkXMLUniformGridAMRReader()
    check_whole(path, reader, "overlapping AMR")
    reader.SetFileName(path)
    reader.SetMaximumLevelsToReadByDefault(0)
    reader.Update()
    amr = reader.GetOutputDataObject(0)
    if not amr.IsA("vtkOverlappingAMR") or not amr.GetNumberOfLevels() or not amr.GetDataSet(0, 0):
        raise Refused(f"{path} holds no overlapping AMR")
    cells = amr.GetDataSet(0, 0).GetCellData()
    names = [cells.GetArrayName(i) for i in range(cells.GetNumberOfArrays())]
    return amr, chosen(path, name, [each for each in names if each != "vtkGhostType"])


def read_with_vtk(path: str, name: str) -> tuple[Boxes, dict[str, Any]]:
    complaints = Complaints()
    amr, wanted = read_vthb(path, name)
    complaints.check(path)
    if amr.GetNumberOfLevels() == 0 or amr.GetDataSet(0, 0) is None:
        raise Refused(f"{path} holds no overlapping AMR")
    components = amr.GetDataSet(0, 0).GetCellData().GetArray(wanted).GetNumberOfComponents()
    parts = []
    for c in range(components):
        boxes, place = boxes_of(amr, wanted, c)
        parts.append([numbers for _, _, numbers in boxes])
    stacked = [np.stack(each, axis=-1) for each in zip(*parts)]
    place["name"] = wanted
    time = amr.GetFieldData().GetArray("TimeValue")
    place |= told(time.GetTuple1(0) if time is not None and time.GetNumberOfValues() else None)
    return [(level, low, each) for (level, low, _), each in zip(boxes, stacked)], place


def read(path: str, name: str) -> tuple[dict[str, Any], bytes]:
    try:
        if path.lower().endswith(".vthb"):
            boxes, place = read_with_vtk(path, name)
        else:
            boxes, place = read_hdf5(path, name)
    except (ValueError, KeyError, IndexError, AttributeError, OSError, TypeError) as error:
        told_by_h5py = error.args[0] if isinstance(error, KeyError) and error.args else error
        raise Refused(f"{path} cannot be read: {told_by_h5py}") from None
    single = all(array.dtype.newbyteorder("=") == np.float32 for _, _, array in boxes)
    kind = "float32" if single else "float64"
    dimension = len(boxes[0][1])
    packed = [
        np.moveaxis(array.reshape((*array.shape[:dimension], -1)), -1, 0).astype(kind)
        for _, _, array in boxes
    ]
    data = b"".join(component.tobytes("F") for each in packed for component in each)
    place["boxes"] = [(level, low, array.shape[:dimension]) for level, low, array in boxes]
    place["components"] = packed[0].shape[0]
    place["kind"] = kind
    return place | {"shape": [len(data)], "type": "uint8"}, data


def read_hdf5(path: str, name: str) -> tuple[Boxes, dict[str, Any]]:
    try:
        import h5py
    except ImportError as error:
        raise Refused(f"{path}: reading it needs the package h5py: {error}") from None
    if path.lower().endswith(".hierarchy"):
        return read_enzo(path, name, h5py.File)
    with h5py.File(path, "r") as file:
        if "Chombo_global" in file:
            return read_chombo(path, name, file)
        if "MeshBlockSize" in file.attrs:
            return read_athena(path, name, file)
        if "gid" in file and "unknown names" in file:
            return read_flash(path, name, file)
    raise Refused(f"{path} is HDF5, but none of Athena++, Chombo or FLASH")


if __name__ == "__main__":
    answer(read)
