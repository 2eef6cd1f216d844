# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of files of cells: meshes and trees of VTK, and boxes of cells on levels."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._ask import ask
from ._blocks import Blocks, Rule
from ._cells import Cells
from ._choice import Choice, chosen, numbered
from ._nestgrid import InvalidInput
from ._sources import Octree


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


def load_trees(path: str, array: str, choice: Choice) -> Octree:
    _refuse_frame(choice)
    place, parts = _arrays("_read_trees.py", path, array)
    part = _component(path, choice, parts["values"].shape[1])
    try:
        return Octree(
            parts["leaves"],
            parts["values"][:, part],
            max_level=place["max_level"],
            coordinates=place["coordinates"],
            masked=parts["masked"],
            name=place["name"],
        )
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {str(error).removeprefix('Octree(): ')}") from None


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
