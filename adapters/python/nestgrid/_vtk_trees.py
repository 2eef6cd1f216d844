# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The leaves of VTK's hyper tree grids: for load()'s reader, a program, and for ParaView."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Trees:
    """What Octree() takes; values of the leaves are numbers_of_cells[index].

    ghosts  which leaves are ghost cells: masked here, and leaves of other pieces
    """

    leaves: np.ndarray
    index: np.ndarray
    masked: np.ndarray
    ghosts: np.ndarray
    max_level: int
    factor: int
    coordinates: list[np.ndarray]


def trees_of(grid: Any) -> Trees:
    """The leaves of a grid; masked cells and ghost cells are masked.

    Deeper leaves than the grid's limit of the depth are put together, as VTK's own filters have it.

    Raises ValueError with a sentence where trees lie on a line or in a point.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy

    points = np.zeros(3, np.int64)
    grid.GetDimensions(points)
    along = [d for d in range(3) if points[d] > 1]
    factor = grid.GetBranchFactor()
    if len(along) < 2:
        raise ValueError(
            f"its trees have dimension {len(along)}: trees in space or in a plane across an axis "
            "are read"
        )
    max_level = min(grid.GetNumberOfLevels() - 1, grid.GetDepthLimiter())
    number = grid.GetMaxNumberOfTrees()
    parts = [_leaves(grid, i, max_level, factor, along) for i in range(number)]
    found = [part for part in parts if part]
    if not found:
        raise ValueError("it has no trees")
    leaves, index = (np.concatenate(each) for each in zip(*found))
    masked, ghosts = np.zeros((2, len(index)), bool)
    hidden = [(masked, _numbers(grid.GetMask()))] if grid.HasMask() else []
    if grid.GetGhostCells() is not None:
        hidden.append((ghosts, vtk_to_numpy(grid.GetGhostCells())))
    for those, each in hidden:
        if len(each) <= index.max():
            raise ValueError("its mask or its ghost array has fewer entries than cells")
        those |= each[index] != 0
    masked |= ghosts
    axes = (grid.GetXCoordinates(), grid.GetYCoordinates(), grid.GetZCoordinates())
    if None in axes or [axis.GetNumberOfTuples() for axis in axes] != points.tolist():
        raise ValueError("its trees have another number of coordinates than points")
    coordinates = [vtk_to_numpy(axis).astype(float) for axis in axes]
    return Trees(leaves, index, masked, ghosts, max_level, factor, coordinates)


def _numbers(bits: Any) -> np.ndarray:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

    numbers = vtkUnsignedCharArray()
    numbers.DeepCopy(bits)
    return vtk_to_numpy(numbers)


def _leaves(
    grid: Any, number: int, max_level: int, factor: int, along: list[int]
) -> tuple[np.ndarray, np.ndarray] | None:
    """Leaves of one tree, (n, 3 or 4), and their places in the arrays of cells.

    along  the directions in which there is more than one point
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import reference, vtkBitArray, vtkIdList, vtkTypeInt64Array

    tree = grid.GetTree(number)
    if tree is None:
        return None
    corner = [reference(0) for _ in range(3)]
    grid.GetLevelZeroCoordinatesFromIndex(number, *corner)
    dimension = len(along)
    low = np.array([[int(corner[d]) * factor**max_level for d in along]], np.int64)
    counts, splits, ids = vtkTypeInt64Array(), vtkBitArray(), vtkIdList()
    # Below masked cells nothing is drawn: they are leaves.
    mask = grid.GetMask() if grid.HasMask() else None
    tree.ComputeBreadthFirstOrderDescriptor(mask, counts, splits, ids)
    index = np.array([ids.GetId(i) for i in range(ids.GetNumberOfIds())], np.int64)
    is_split = np.zeros(len(index), bool)
    is_split[: splits.GetNumberOfTuples()] = _numbers(splits)
    leaves, indices = [], []
    begin = 0
    number_of = range(factor**dimension)
    children = np.array([[c // factor**d % factor for d in range(dimension)] for c in number_of])
    for level, count in enumerate(vtk_to_numpy(counts)):
        here = is_split[begin : begin + count] & (level < max_level)
        indices.append(index[begin : begin + count][~here])
        begin += count
        leaf = low[~here]
        leaves.append(np.column_stack([leaf, np.full(len(leaf), level)]))
        part = factor ** (max_level - level - 1) if here.any() else 0
        low = (low[here, None] + children * part).reshape(-1, dimension)
        if not here.any():
            break
    return np.concatenate(leaves), np.concatenate(indices)
