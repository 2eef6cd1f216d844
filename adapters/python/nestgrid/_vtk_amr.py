# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The boxes of VTK's overlapping AMR: for load()'s reader, a program of its own, and for ParaView."""

from __future__ import annotations

from typing import Any

import numpy as np

HIDDEN = 32  # the bit of vtkGhostType for blanked cells

# Boxes with their numbers along x, y and z, and the options of Blocks() that place them.
Boxes = tuple[list[tuple[int, list[int], np.ndarray]], dict[str, Any]]


def _steps(lengths: np.ndarray, step: np.ndarray, what: str) -> list[int]:
    """Lengths in whole steps."""
    counts = np.rint(lengths / step)
    if np.abs(lengths / step - counts).max() > 1e-2:
        raise ValueError(f"{what} does not lie on cells of its level")
    return [int(n) for n in counts]


def _numbers(grid: Any, name: str, component: int, what: str) -> np.ndarray:
    """The numbers of the cells of a block; blanked cells have none."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    data = grid.GetCellData().GetArray(name)
    if data is None:
        raise ValueError(f"{what} has no array '{name}' of its cells")
    numbers = vtk_to_numpy(data)
    if numbers.ndim > 1:
        numbers = numbers[:, component]
    ghosts = grid.GetCellData().GetArray("vtkGhostType")
    if ghosts is not None:
        is_hidden = vtk_to_numpy(ghosts) & HIDDEN != 0
        if is_hidden.any():
            numbers = numbers.astype(np.float32 if numbers.dtype == np.float32 else np.float64)
            numbers[is_hidden] = np.nan
    return numbers


def boxes_of(amr: Any, name: str, component: int = 0) -> Boxes:
    """The boxes of an array of cells.

    Raises ValueError with a sentence where a block has no data, or does not lie in its level.
    """
    boxes: list[tuple[int, list[int], np.ndarray]] = []
    ratios: list[int] = []
    spacings: list[np.ndarray] = []
    begins = [amr.GetDataSet(0, b) for b in range(amr.GetNumberOfDataSets(0))]
    if not begins or None in begins:
        raise ValueError("level 0 has no data, or in part")
    origin = np.min([grid.GetOrigin() for grid in begins], axis=0)
    along: list[int] = []
    for level in range(amr.GetNumberOfLevels()):
        for block in range(amr.GetNumberOfDataSets(level)):
            what = f"block {block} of level {level}"
            grid = amr.GetDataSet(level, block)
            if grid is None:
                raise ValueError(f"{what} has no data")
            points = grid.GetDimensions()
            along = along or [d for d in range(3) if points[d] > 1]
            step = np.array(grid.GetSpacing())[along]
            if level == len(spacings):
                spacings.append(step)
                if level:
                    ratio = _steps(spacings[-2], step, f"level {level}")
                    if len(set(ratio)) > 1:
                        raise ValueError(f"the ratio of level {level} differs by direction")
                    ratios.append(ratio[0])
            if np.abs(step - spacings[level]).max() > 1e-3 * step.min():
                raise ValueError(f"{what} has cells of another size than its level")
            lower = _steps(np.array(grid.GetOrigin())[along] - origin[along], step, what)
            shape = [points[d] - 1 for d in along]
            numbers = _numbers(grid, name, component, what)
            if len(numbers) != np.prod(shape):
                raise ValueError(f"{what} has {len(numbers)} values for {np.prod(shape)} cells")
            boxes.append((level, lower, numbers.reshape(shape, order="F")))
        if level == len(spacings):
            raise ValueError(f"level {level} has no data")
    if not boxes or len(along) < 2:
        raise ValueError("the overlapping AMR does not lie in space, or in a plane across an axis")
    place = {"ratio": ratios, "spacing": spacings[0].tolist(), "origin": origin.tolist()}
    return boxes, place | {"axes": along}
