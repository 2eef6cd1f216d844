# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of files of cells: meshes and trees of VTK, and boxes of cells on levels."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ._ask import ask
from ._blocks import Blocks
from ._cells import Cells
from ._choice import Choice, chosen, numbered
from ._nestgrid import InvalidInput
from ._sources import Octree, OctreeFrames, Rule


def load_mesh(path: str, array: str, choice: Choice) -> Cells:
    if choice.frame is not None or choice.magnitude:
        given = "magnitude" if choice.magnitude else "frame"
        raise InvalidInput(f"load(): {given} chooses nothing of a .vtu: one of component alone")
    place, parts = _arrays("_read_cells.py", path, array)
    values = parts["values"]
    if values.ndim == 1:
        values = values[:, None]
    values = chosen(path, choice, values.T[:, :, None, None, None], 1, 0)[:, 0, 0]
    degrees = parts["degrees"] if parts["degrees"].size else None
    places, types = parts["points"], parts["types"]
    offsets, connectivity = parts["offsets"], parts["connectivity"]
    try:
        return Cells(
            places, types, offsets, connectivity, values, degrees=degrees, name=place["name"]
        )
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {error}") from None


def load_trees(path: str, array: str, choice: Choice, rule: Rule) -> Octree:
    trees = _trees_of(path, array, choice)
    try:
        return Octree(
            trees.leaves,
            trees.values,
            max_level=trees.max_level,
            factor=trees.factor,
            coordinates=trees.coordinates,
            masked=trees.masked,
            rule=rule,
            name=trees.name,
        )
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {str(error).removeprefix('Octree(): ')}") from None


def load_tree_frames(
    paths: list[str], array: str, choice: Choice, rule: Rule, times: list[float]
) -> OctreeFrames:
    first = _trees_of(paths[0], array, choice)
    values = [first.values]
    for path in paths[1:]:
        other = _trees_of(path, first.name, choice)
        if not first.has_grid_of(other):
            raise InvalidInput(f"load(): '{path}' has another grid than '{paths[0]}'")
        values.append(other.values)
    along = [np.array(x) for x in first.coordinates]
    built_of = (first.max_level, first.factor, along)
    masked = first.masked if first.masked.any() else np.zeros(0, np.uint8)
    try:
        place = (masked, built_of, paths, first.name)
        return OctreeFrames._of(first.leaves, values, times, *place, rule=rule)
    except InvalidInput as error:
        raise InvalidInput(f"load(): {error}") from None


class _Trees(NamedTuple):
    """What is in a file of hyper trees, as Octree() takes it."""

    leaves: np.ndarray
    values: np.ndarray
    masked: np.ndarray
    max_level: int
    factor: int
    coordinates: list[list[float]]
    name: str

    def has_grid_of(self, other: _Trees) -> bool:
        return (
            self.max_level == other.max_level
            and self.factor == other.factor
            and self.coordinates == other.coordinates
            and np.array_equal(self.leaves, other.leaves)
            and np.array_equal(self.masked, other.masked)
        )


def _trees_of(path: str, array: str, choice: Choice) -> _Trees:
    _refuse_frame(choice)
    place, parts = _arrays("_read_trees.py", path, array)
    part = _component(path, choice, parts["values"].shape[1])
    return _Trees(parts["leaves"], parts["values"][:, part], parts["masked"], **place)


def load_boxes(path: str, array: str, choice: Choice, rule: Rule) -> tuple[Blocks, float | None]:
    """The field of a file, and its time where the file tells one."""
    _refuse_frame(choice)
    place, data = ask("_read_amr.py", path, array)
    components, kind = place["components"], np.dtype(place["kind"])
    part = _component(path, choice, components)
    boxes, begin = [], 0
    for level, lower, shape in place["boxes"]:
        count = components * int(np.prod(shape))
        numbers = data[begin : begin + count * kind.itemsize].view(kind)
        begin += count * kind.itemsize
        boxes.append((level, lower, numbers.reshape((*shape, components), order="F")[..., part]))
    try:
        field = Blocks(
            boxes,
            ratio=place["ratio"],
            spacing=place["spacing"],
            origin=place["origin"],
            axes=place.get("axes"),
            rule=rule,
            name=place["name"],
        )
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {str(error).removeprefix('Blocks(): ')}") from None
    return field, place.get("time")


def _refuse_frame(choice: Choice) -> None:
    if choice.frame is not None or choice.magnitude:
        given = "magnitude" if choice.magnitude else "frame"
        raise InvalidInput(f"load(): {given} chooses nothing of cells: one of component alone")


def _component(path: str, choice: Choice, components: int) -> int:
    """The number of the component that is chosen, of so many."""
    if components == 1 and choice.component is not None:
        raise InvalidInput(f"load(): component chooses nothing: {path} has one number per cell")
    if components > 1 and choice.component is None:
        raise InvalidInput(
            f"{path} has {components} numbers per cell, not one: choose by component, from 0 to "
            f"{components - 1}"
        )
    return numbered(path, "component", choice.component or 0, components)


def _arrays(
    reader_program: str, path: str, array: str
) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """What a reader tells of a file, and the arrays that it packed."""
    place, data = ask(reader_program, path, array)
    parts, begin = {}, 0
    for name, kind, shape in place.pop("arrays"):
        size = int(np.prod(shape)) * np.dtype(kind).itemsize
        parts[name] = data[begin : begin + size].view(kind).reshape(shape)
        begin += size
    return place, parts
