# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of files of cells: meshes of VTK, and boxes of cells on levels."""

from __future__ import annotations

import numpy as np

from ._ask import ask
from ._blocks import Blocks, Rule
from ._cells import Cells
from ._choice import Choice, chosen, numbered
from ._nestgrid import InvalidInput


def load_mesh(path: str, array: str, choice: Choice) -> Cells:
    if choice.frame is not None or choice.magnitude:
        given = "magnitude" if choice.magnitude else "frame"
        raise InvalidInput(f"load(): {given} chooses nothing of a .vtu: one of component alone")
    place, data = ask("_read_cells.py", path, array)
    parts, begin = {}, 0
    for name, kind, shape in place["arrays"]:
        size = int(np.prod(shape)) * np.dtype(kind).itemsize
        parts[name] = data[begin : begin + size].view(kind).reshape(shape)
        begin += size
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


def load_boxes(path: str, array: str, choice: Choice, rule: Rule) -> Blocks:
    if choice.frame is not None or choice.magnitude:
        given = "magnitude" if choice.magnitude else "frame"
        raise InvalidInput(f"load(): {given} chooses nothing of boxes: one of component alone")
    place, data = ask("_read_amr.py", path, array)
    components, kind = place["components"], np.dtype(place["kind"])
    if components == 1 and choice.component is not None:
        raise InvalidInput(f"load(): component chooses nothing: {path} has one number per cell")
    if components > 1 and choice.component is None:
        raise InvalidInput(
            f"{path} has {components} numbers per cell, not one: choose by component, from 0 to "
            f"{components - 1}"
        )
    part = numbered(path, "component", choice.component or 0, components)
    boxes, begin = [], 0
    for level, lower, shape in place["boxes"]:
        count = components * int(np.prod(shape))
        numbers = data[begin : begin + count * kind.itemsize].view(kind)
        begin += count * kind.itemsize
        boxes.append((level, lower, numbers.reshape((*shape, components), order="F")[..., part]))
    try:
        return Blocks(
            boxes,
            ratio=place["ratio"],
            spacing=place["spacing"],
            origin=place["origin"],
            rule=rule,
            name=place["name"],
        )
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {str(error).removeprefix('Blocks(): ')}") from None
