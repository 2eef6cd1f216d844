# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of its own, which reads boxes of cells: .vthb and data of Enzo and FLASH by VTK, those
of Chombo and Athena++ by h5py.

Arguments: the file, and the name of a field or nothing. Answers as _answer.py says, with the
numbers of all boxes one after the other, x fastest.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from _answer import Refused, answer, listed
from _read_vtk import check_whole
from _vtk_amr import boxes_of

Boxes = list[tuple[int, list[int], np.ndarray]]


def chosen(path: str, name: str, names: list[str]) -> str:
    if not names:
        raise Refused(f"{path} has no data of cells")
    if not name and len(names) > 1:
        raise Refused(
            f"{path} has several fields, choose one by array: {listed(names)}", True, names
        )
    if name and name not in names:
        raise Refused(f"{path} has no field '{name}'", True, names)
    return name or names[0]


class Complaints:
    """The first error or warning of any reader of VTK."""

    CallDataType = "string0"

    def __init__(self) -> None:
        from vtkmodules.vtkCommonCore import vtkOutputWindow

        self.first = ""
        for event in ("ErrorEvent", "WarningEvent"):
            vtkOutputWindow.GetInstance().AddObserver(event, self)

    def __call__(self, _caller: Any, _event: str, message: str = "") -> None:
        if "no tracer particles" in message:  # which need not be there
            return
        if "Inconsistent types of vtkUniformGrid" in message:
            message = "it lies in the plane, where VTK reads .vthb alone"
        lines = [line.strip() for line in message.splitlines() if line.strip()]
        self.first = self.first or (lines[-1] if lines else "VTK gives no reason")

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


def read_by_name(path: str, name: str, reader: Any) -> tuple[Any, str]:
    """By a reader that reads the fields that it is told to."""
    reader.SetEnableCaching(0)
    reader.SetFileName(path)
    names = [reader.GetCellArrayName(i) for i in range(reader.GetNumberOfCellArrays())]
    wanted = chosen(path, name, names)
    for each in names:
        reader.SetCellArrayStatus(each, int(each == wanted))
    reader.SetMaxLevel(max(0, reader.GetNumberOfLevels() - 1))
    reader.Update()
    return reader.GetOutput(), wanted


def read_with_vtk(path: str, name: str, kind: str) -> tuple[Boxes, dict[str, Any]]:
    complaints = Complaints()
    if kind == "vthb":
        amr, wanted = read_vthb(path, name)
    elif kind == "enzo":
        from vtkmodules.vtkIOAMR import vtkAMREnzoReader

        reader = vtkAMREnzoReader()
        reader.SetConvertToCGS(0)
        amr, wanted = read_by_name(path, name, reader)
    else:
        from vtkmodules.vtkIOAMR import vtkAMRFlashReader

        amr, wanted = read_by_name(path, name, vtkAMRFlashReader())
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
    return [(level, low, each) for (level, low, _), each in zip(boxes, stacked)], place


def read_chombo(path: str, name: str, file: Any) -> tuple[Boxes, dict[str, Any]]:
    """Each level has the numbers of its boxes, box by box, field by field, with ghost cells."""
    dim = int(file["Chombo_global"].attrs["SpaceDim"])
    fields = int(file.attrs["num_components"])
    names = [file.attrs[f"component_{i}"].decode() for i in range(fields)]
    wanted = chosen(path, name, names)
    number = names.index(wanted)
    levels = [file[f"level_{i}"] for i in range(int(file.attrs["num_levels"]))]
    boxes: Boxes = []
    for number_of_level, level in enumerate(levels):
        ghosts = [0] * dim
        if "outputGhost" in level.get("data_attributes", level).attrs:
            ghosts = list(level["data_attributes"].attrs["outputGhost"].tolist())
        data, begin = level["data:datatype=0"], 0
        for box in level["boxes"][()].tolist():
            shape = [h - l + 1 + 2 * g for l, h, g in zip(box[:dim], box[dim:], ghosts)]
            cells = int(np.prod(shape))
            numbers = data[begin + number * cells : begin + (number + 1) * cells]
            begin += fields * cells
            inside = tuple(slice(g, n - g) for g, n in zip(ghosts, shape))
            array = numbers.reshape(shape, order="F")[inside]
            boxes.append((number_of_level, [int(a) for a in box[:dim]], array))
        if begin != data.shape[0]:
            raise Refused(f"{path}: a level has another number of values than its boxes")
    step = np.ones(dim) * levels[0].attrs["vec_dx" if "vec_dx" in levels[0].attrs else "dx"]
    start = np.min([low for level, low, _ in boxes if level == 0], axis=0)
    ratios = [np.ravel(level.attrs["ref_ratio"])[0] for level in levels[:-1]]
    place = {"ratio": [int(each) for each in ratios], "spacing": step.tolist()}
    return boxes, place | {"origin": (start * step).tolist(), "name": wanted}


def read_athena(path: str, name: str, file: Any) -> tuple[Boxes, dict[str, Any]]:
    """Leaves alone: the blocks that they replaced are added, with one array that nobody reads."""
    coordinates = np.ravel(file.attrs["Coordinates"])[0].decode()
    if coordinates not in ("cartesian", "minkowski"):
        raise Refused(f"{path} has {coordinates} coordinates, not cartesian ones")
    extent = np.array([file.attrs[f"RootGridX{d + 1}"] for d in range(3)], float)
    size = [int(n) for n in file.attrs["MeshBlockSize"]]
    dim = 2 if size[2] == 1 else 3
    if size[1] == 1 or (extent[:dim, 2] != 1).any():
        raise Refused(f"{path} has one dimension, or cells of several sizes")
    names = [each.decode() for each in file.attrs["VariableNames"]]
    wanted = chosen(path, name, names)
    sets = [each.decode() for each in file.attrs["DatasetNames"]]
    members = [(s, v) for s, n in zip(sets, file.attrs["NumVariables"]) for v in range(n)]
    data_set, variable = members[names.index(wanted)]
    data = file[data_set][variable]
    levels = [int(level) for level in file["Levels"]]
    places = [tuple(int(a) for a in each[:dim]) for each in file["LogicalLocations"]]
    step = (extent[:, 1] - extent[:, 0]) / file.attrs["RootGridSize"]
    begin = extent[0, 0] + places[0][0] * size[0] * step[0] / 2 ** levels[0]
    if abs(file["x1f"][0, 0] - begin) > 0.1 * step[0] / 2 ** levels[0]:
        raise Refused(f"{path}: its blocks do not lie at their places: ghost zones are not read")
    boxes: Boxes = []
    for block, (level, where) in enumerate(zip(levels, places)):
        low = [a * n for a, n in zip(where, size)]
        boxes.append((level, low, data[block].T.reshape(size[:dim])))
    replaced = {
        (upper, tuple(a >> (level - upper) for a in where))
        for level, where in zip(levels, places)
        for upper in range(level)
    }
    unread = np.full(size[:dim], np.nan, data.dtype)
    boxes += [(level, [a * n for a, n in zip(where, size)], unread) for level, where in replaced]
    place = {"ratio": [2] * max(levels), "spacing": step[:dim].tolist()}
    return boxes, place | {"origin": extent[:dim, 0].tolist(), "name": wanted}


def read(path: str, name: str) -> tuple[dict[str, Any], bytes]:
    try:
        if path.lower().endswith(".vthb"):
            boxes, place = read_with_vtk(path, name, "vthb")
        elif path.lower().endswith(".hierarchy"):
            boxes, place = read_with_vtk(path, name, "enzo")
        else:
            boxes, place = read_hdf5(path, name)
    except (ValueError, KeyError, IndexError, AttributeError, OSError, TypeError) as error:
        raise Refused(f"{path} cannot be read: {error}") from None
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
    with h5py.File(path, "r") as file:
        if "Chombo_global" in file:
            return read_chombo(path, name, file)
        if "MeshBlockSize" in file.attrs:
            return read_athena(path, name, file)
        is_flash = "gid" in file and "unknown names" in file
    if not is_flash:
        raise Refused(f"{path} is HDF5, but none of Athena++, Chombo or FLASH")
    return read_with_vtk(path, name, "flash")


if __name__ == "__main__":
    answer(read)
