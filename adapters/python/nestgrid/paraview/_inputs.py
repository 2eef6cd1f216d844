# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""VTK's image data, hyper tree grids, unstructured grids and overlapping AMR as fields."""
from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import (
    reference,
    vtkBitArray,
    vtkDataArray,
    vtkIdList,
    vtkTypeInt64Array,
    vtkUnsignedCharArray,
)
from vtkmodules.vtkCommonDataModel import (
    vtkDataObject,
    vtkHyperTreeGrid,
    vtkImageData,
    vtkOverlappingAMR,
    vtkUnstructuredGrid,
)

import nestgrid

from .._vtk_amr import boxes_of


def field_of(data: vtkDataObject, array: vtkDataArray | None) -> nestgrid.Field:
    """The field of image data or of an unstructured grid at points, or of a hyper tree grid or an
    overlapping AMR in cells. Image data and AMR are not copied.

    Raises InvalidInput where the data are not of dimension 3 or the array does not fit.
    """
    if array is None:
        raise nestgrid.InvalidInput("the input has no array with the chosen name")
    if array.GetNumberOfComponents() != 1:
        raise nestgrid.InvalidInput(
            f"'{array.GetName()}' has {array.GetNumberOfComponents()} components, not 1"
        )
    if isinstance(data, vtkOverlappingAMR):
        return _blocks(data, array)
    if isinstance(data, vtkHyperTreeGrid):
        return _octree(data, array)
    if isinstance(data, vtkUnstructuredGrid):
        return _cells(data, array)
    return _volume(data, array)


def _blocks(amr: vtkOverlappingAMR, array: vtkDataArray) -> nestgrid.Blocks:
    try:
        boxes, place = boxes_of(amr, array.GetName())
    except ValueError as error:
        raise nestgrid.InvalidInput(str(error)) from None
    return nestgrid.Blocks(boxes, **place)


def _cells(grid: vtkUnstructuredGrid, array: vtkDataArray) -> nestgrid.Cells:
    values = vtk_to_numpy(array)
    if len(values) != grid.GetNumberOfPoints():
        raise nestgrid.InvalidInput(f"'{array.GetName()}' is no array of points")
    if not grid.GetNumberOfCells():
        raise nestgrid.InvalidInput("the unstructured grid has no cells")
    degrees = grid.GetCellData().GetHigherOrderDegrees()
    return nestgrid.Cells(
        vtk_to_numpy(grid.GetPoints().GetData()),
        vtk_to_numpy(grid.GetCellTypesArray()),
        vtk_to_numpy(grid.GetCells().GetOffsetsArray()),
        vtk_to_numpy(grid.GetCells().GetConnectivityArray()),
        values,
        degrees=None if degrees is None else vtk_to_numpy(degrees),
    )


def _volume(image: vtkImageData, array: vtkDataArray) -> nestgrid.Volume:
    samples = vtk_to_numpy(array)
    if len(samples) != image.GetNumberOfPoints():
        raise nestgrid.InvalidInput(f"'{array.GetName()}' is no array of points")
    extent = image.GetExtent()
    origin = [0.0, 0.0, 0.0]
    image.TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], origin)
    matrix = image.GetDirectionMatrix()
    return nestgrid.Volume(
        samples.reshape(image.GetDimensions(), order="F"),
        image.GetSpacing(),
        origin,
        direction=[[matrix.GetElement(r, c) for c in range(3)] for r in range(3)],
    )


def _octree(grid: vtkHyperTreeGrid, array: vtkDataArray) -> nestgrid.Octree:
    if grid.GetDimension() != 3 or grid.GetBranchFactor() != 2:
        raise nestgrid.InvalidInput("hyper tree grids need dimension 3 and branch factor 2")
    max_level = grid.GetNumberOfLevels() - 1
    parts = [_tree_leaves(grid, i, max_level) for i in range(grid.GetMaxNumberOfTrees())]
    parts = [part for part in parts if part]
    if not parts:
        raise nestgrid.InvalidInput("the hyper tree grid has no trees")
    leaves, index = (np.concatenate(each) for each in zip(*parts))
    masked = None
    if grid.HasMask():
        masked = _numbers(grid.GetMask())[index]
    axes = (grid.GetXCoordinates(), grid.GetYCoordinates(), grid.GetZCoordinates())
    coordinates = [vtk_to_numpy(axis) for axis in axes]
    values = vtk_to_numpy(array)[index]
    return nestgrid.Octree(
        leaves, values, max_level=max_level, coordinates=coordinates, masked=masked
    )


def _numbers(bits: vtkBitArray) -> np.ndarray:
    numbers = vtkUnsignedCharArray()
    numbers.DeepCopy(bits)
    return vtk_to_numpy(numbers)


def _tree_leaves(
    grid: vtkHyperTreeGrid, number: int, max_level: int
) -> tuple[np.ndarray, np.ndarray] | None:
    """Leaves of one tree, (n, 4), and their places in the arrays of cells."""
    tree = grid.GetTree(number)
    if tree is None:
        return None
    corner = [reference(0) for _ in range(3)]
    grid.GetLevelZeroCoordinatesFromIndex(number, *corner)
    low = np.array([[int(x) << max_level for x in corner]], np.int64)
    counts, splits, ids = vtkTypeInt64Array(), vtkBitArray(), vtkIdList()
    # Below masked cells nothing is drawn: they are leaves.
    mask = grid.GetMask() if grid.HasMask() else None
    tree.ComputeBreadthFirstOrderDescriptor(mask, counts, splits, ids)
    index = np.array([ids.GetId(i) for i in range(ids.GetNumberOfIds())], np.int64)
    is_split = np.zeros(len(index), bool)
    is_split[: splits.GetNumberOfTuples()] = _numbers(splits)
    leaves = []
    begin = 0
    octants = np.array([[c & 1, c >> 1 & 1, c >> 2] for c in range(8)], np.int64)
    for level, count in enumerate(vtk_to_numpy(counts)):
        here = is_split[begin : begin + count]
        begin += count
        leaf = low[~here]
        leaves.append(np.column_stack([leaf, np.full(len(leaf), level)]))
        half = 1 << (max_level - level - 1) if here.any() else 0
        low = (low[here, None] + octants * half).reshape(-1, 3)
    return np.concatenate(leaves), index[~is_split]
