# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Boxes of cells in HDF5 files of Chombo, Athena++, FLASH and Enzo, for load()'s reader, a program of its own."""

from __future__ import annotations

import os
from itertools import takewhile
from typing import Any

import numpy as np
from _answer import Refused, listed

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


def text(value: Any) -> str:
    """A text of a file, of any encoding, without what fills it up."""
    first = np.ravel(value)[0]
    decoded = first.decode("utf-8", "replace") if isinstance(first, bytes) else str(first)
    return decoded.strip(" \0")


def numbers(value: Any) -> list[Any]:
    """The numbers of an attribute: one, an array, or a vector with names."""
    return np.ravel(value.tolist() if isinstance(value, np.generic) else value).tolist()


def told(time: Any) -> dict[str, float]:
    """The time of a file, where it tells one."""
    return {} if time is None else {"time": float(np.ravel(time)[0])}


def read_chombo(path: str, name: str, file: Any) -> tuple[Boxes, dict[str, Any]]:
    """Each level has the numbers of its boxes, box by box, field by field, with ghost cells."""
    dim = int(file["Chombo_global"].attrs["SpaceDim"])
    if dim not in (2, 3):
        raise Refused(f"{path} has {dim} dimensions, not 2 or 3")
    fields = int(file.attrs["num_components"])
    names = [text(file.attrs[f"component_{i}"]) for i in range(fields)]
    wanted = chosen(path, name, names)
    number = names.index(wanted)
    levels = [file[f"level_{i}"] for i in range(int(file.attrs["num_levels"]))]
    levels = list(takewhile(lambda level: level["boxes"].shape[0] > 0, levels))
    if not levels:
        raise Refused(f"{path}: level_0 has no boxes")
    coarse = levels[0].attrs
    if "domBeg1" in coarse and (coarse.get("geometry", 1) != 1 or coarse.get("logr", 0) != 0):
        raise Refused(f"{path} has curved or logarithmic coordinates, not cartesian ones")
    boxes: Boxes = []
    for number_of_level, level in enumerate(levels):
        ghosts = [0] * dim
        if "outputGhost" in level.get("data_attributes", level).attrs:
            ghosts = (numbers(level["data_attributes"].attrs["outputGhost"]) * dim)[:dim]
        data, begin = level["data:datatype=0"], 0
        for box in level["boxes"][()].tolist():
            shape = [h - l + 1 + 2 * g for l, h, g in zip(box[:dim], box[dim:], ghosts)]
            cells = int(np.prod(shape))
            of_box = data[begin + number * cells : begin + (number + 1) * cells]
            begin += fields * cells
            inside = tuple(slice(g, n - g) for g, n in zip(ghosts, shape))
            array = of_box.reshape(shape, order="F")[inside]
            boxes.append((number_of_level, [int(a) for a in box[:dim]], array))
        if begin != data.shape[0]:
            raise Refused(f"{path}: a level has another number of values than its boxes")
    step = np.ones(dim) * numbers(coarse["vec_dx" if "vec_dx" in coarse else "dx"])
    step *= [float(coarse.get(f"g_x{d + 1}stretch", 1)) for d in range(dim)]  # as PLUTO has it
    start = np.min([low for level, low, _ in boxes if level == 0], axis=0) * step
    start += [float(coarse.get(f"domBeg{d + 1}", 0)) for d in range(dim)]
    ratios = [set(numbers(level.attrs["ref_ratio"])) for level in levels[:-1]]
    if any(len(each) > 1 for each in ratios):
        raise Refused(f"{path}: its ratios differ by direction: one power of two is read")
    place = {"ratio": [int(each.pop()) for each in ratios], "spacing": step.tolist()}
    time = file.attrs.get("time", coarse.get("time"))
    return boxes, place | {"origin": start.tolist(), "name": wanted} | told(time)


def levels_in(stored: Any, path: str, coarsest: int = 0) -> list[int]:
    """The levels of blocks, from 0."""
    levels = [int(level) - coarsest for level in stored]
    if not levels:
        raise Refused(f"{path} has no blocks")
    for level in levels:
        if not 0 <= level <= 25:
            raise Refused(f"{path}: a block has level {level + coarsest}")
    return levels


def replaced(boxes: Boxes) -> Boxes:
    """The blocks that finer ones replace and the file does not have, with an array nobody reads.

    Raises ValueError where finer ones replace a part of such a block.
    """
    size = boxes[0][2].shape
    places = [(level, tuple(a // n for a, n in zip(low, size))) for level, low, _ in boxes]
    all_replaced = {
        (upper, tuple(a >> (level - upper) for a in where))
        for level, where in places
        for upper in range(level)
    }
    added = sorted(all_replaced.difference(places))
    here = all_replaced.union(places)
    for level, where in added:
        if not all((level + 1, tuple(2 * np.array(where) + c)) in here for c in np.ndindex((2,) * len(size))):
            raise ValueError(f"its blocks do not fill block {where} of level {level}, which it has not")
    unread = np.full(size, np.nan, boxes[0][2].dtype)
    return [(level, [a * n for a, n in zip(where, size)], unread) for level, where in added]


def check_blocks(levels: list[int], places: Any, data: np.ndarray, path: str) -> None:
    if not len(levels) == len(places) == len(data):
        raise Refused(f"{path} has not one level, one place and numbers for each block")


def read_athena(path: str, name: str, file: Any) -> tuple[Boxes, dict[str, Any]]:
    """Leaves alone: the blocks that they replaced are added."""
    coordinates = text(file.attrs["Coordinates"])
    if coordinates not in ("cartesian", "minkowski"):
        raise Refused(f"{path} has {coordinates} coordinates, not cartesian ones")
    extent = np.array([file.attrs[f"RootGridX{d + 1}"] for d in range(3)], float)
    size = [int(n) for n in file.attrs["MeshBlockSize"]]
    dim = 2 if size[2] == 1 else 3
    if size[1:] == [1, 1]:
        raise Refused(f"{path} has 1 dimension, not 2 or 3")
    if 1 in size[:2]:
        thin = "its blocks are one cell thick along x or y: of slices, those across z are read"
        raise Refused(f"{path}: {thin}")
    if (extent[:, 2] != 1).any():
        raise Refused(f"{path}: its cells are not of one size")
    sets = [text(each) for each in file.attrs["DatasetNames"]]
    members = [(s, v) for s, n in zip(sets, file.attrs["NumVariables"]) for v in range(n)]
    names = [text(each) for each in file.attrs["VariableNames"]]
    if len(names) < len(members):
        raise Refused(f"{path}: a variable has no name")
    names = names[: len(members)]
    wanted = chosen(path, name, names)
    data_set, variable = members[names.index(wanted)]
    data = file[data_set][variable]
    levels = levels_in(file["Levels"], path)
    places = [tuple(int(a) for a in each[:dim]) for each in file["LogicalLocations"]]
    step = (extent[:, 1] - extent[:, 0]) / file.attrs["RootGridSize"]
    check_blocks(levels, places, data, path)
    finer = step / 2 ** levels[0]
    for d in range(dim):
        begin = extent[d, 0] + places[0][d] * size[d] * finer[d]
        if abs(file[f"x{d + 1}f"][0, 0] - begin) > 0.1 * finer[d]:
            raise Refused(f"{path}: its blocks do not lie at their places: ghost zones are not read")
    boxes: Boxes = []
    for block, (level, where) in enumerate(zip(levels, places)):
        low = [a * n for a, n in zip(where, size)]
        boxes.append((level, low, data[block].T.reshape(size[:dim])))
    boxes += replaced(boxes)
    place = {"ratio": [2] * max(levels), "spacing": step[:dim].tolist()}
    told_time = told(file.attrs.get("Time"))
    return boxes, place | {"origin": extent[:dim, 0].tolist(), "name": wanted} | told_time


def whole(numbers: np.ndarray, path: str) -> list[int]:
    """Places in whole cells or blocks."""
    rounded = np.rint(numbers)
    if np.abs(numbers - rounded).max() > 1e-2:
        raise Refused(f"{path}: a box does not lie on cells of its level")
    return [int(n) for n in rounded]


def value_in(file: Any, rows: str, wanted: str) -> Any:
    """The value of a name in FLASH's rows of names and values; None where there is none."""
    for key, value in file[rows][()] if rows in file else []:
        if text(key) == wanted:
            return value
    return None


def read_flash(path: str, name: str, file: Any) -> tuple[Boxes, dict[str, Any]]:
    """Blocks of one size, with those that finer ones replace or without them."""
    geometry = value_in(file, "string runtime parameters", "geometry")
    if geometry is not None and text(geometry).lower() != "cartesian":
        raise Refused(f"{path} has {text(geometry)} coordinates, not cartesian ones")
    names = [text(each) for each in np.ravel(file["unknown names"][()])]
    wanted = chosen(path, name, names)
    padded = wanted.ljust(4)
    data = file[padded if padded in file else wanted][()]
    size = np.array([n for n in data.shape[:0:-1] if n > 1])
    if len(size) not in (2, 3):
        raise Refused(f"{path} has {len(size)} dimensions, not 2 or 3")
    levels = levels_in(file["refine level"], path, 1)
    ends = file["bounding box"][()][:, : len(size)].astype(float)
    check_blocks(levels, ends, data, path)
    start = ends[:, :, 0].min(axis=0)
    coarsest = levels.index(min(levels))
    length = (ends[coarsest, :, 1] - ends[coarsest, :, 0]) * 2.0 ** levels[coarsest]
    boxes: Boxes = []
    for block, level in enumerate(levels):
        low = np.array(whole((ends[block, :, 0] - start) / length * 2**level, path)) * size
        boxes.append((level, low.tolist(), data[block].T.reshape(size)))
    boxes += replaced(boxes)
    place = {"ratio": [2] * max(levels), "spacing": (length / size).tolist()}
    told_time = told(value_in(file, "real scalars", "time"))
    return boxes, place | {"origin": start.tolist(), "name": wanted} | told_time


def grids_of(path: str) -> list[dict[str, str]]:
    """What Enzo's text says of each grid."""
    grids: list[dict[str, str]] = []
    with open(path, encoding="utf-8", errors="replace") as text:
        for line in text:
            key, equals, value = line.partition("=")
            if equals and key.strip() == "Grid":
                grids.append({})
            if equals and grids:
                grids[-1][key.strip()] = value.strip()
    if not grids:
        raise Refused(f"{path} names no grids")
    return grids


def read_enzo(path: str, name: str, open_file: Any) -> tuple[Boxes, dict[str, Any]]:
    """A text lists the grids, whose levels follow from the sizes of their cells."""
    grids = grids_of(path)
    row = lambda grid, key: np.array(grid[key].split(), float)  # noqa: E731
    start = np.min([row(grid, "GridLeftEdge") for grid in grids], axis=0)
    found: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for grid in grids:
        low = row(grid, "GridLeftEdge")
        size = row(grid, "GridEndIndex") - row(grid, "GridStartIndex") + 1
        file = os.path.join(os.path.dirname(path), os.path.basename(grid["BaryonFileName"]))
        with open_file(file, "r") as opened:
            group = opened.get(f"Grid{int(grid['Grid']):08d}", opened)  # old Enzo has no groups
            shape = tuple(int(n) for n in size[::-1])
            shapes = {each: getattr(group[each], "shape", None) for each in group}
            name = chosen(path, name, [each for each in group if shapes[each] == shape])
            found.append((low, (row(grid, "GridRightEdge") - low) / size, group[name][()].T))
    steps: list[np.ndarray] = []
    for step in sorted((step for _, step, _ in found), key=lambda step: -float(step[0])):
        if not steps or step[0] < 0.75 * steps[-1][0]:
            steps.append(step)
    level_of = lambda step: int(np.argmin([abs(s[0] - step[0]) for s in steps]))  # noqa: E731
    boxes = [(level_of(step), whole((low - start) / step, path), a) for low, step, a in found]
    boxes.sort(key=lambda box: box[0])
    ratios = [whole(coarse / fine, path)[0] for coarse, fine in zip(steps, steps[1:])]
    place = {"ratio": ratios, "spacing": steps[0].tolist(), "origin": start.tolist()}
    return boxes, place | {"name": name} | told(grids[0].get("Time"))
