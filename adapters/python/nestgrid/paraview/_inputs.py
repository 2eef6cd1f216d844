# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""VTK's image data, hyper tree grids, unstructured grids and overlapping AMR as fields."""
from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkCommonDataModel import (
    vtkDataObject,
    vtkHyperTreeGrid,
    vtkImageData,
    vtkOverlappingAMR,
    vtkUnstructuredGrid,
)

import nestgrid

from .._load import plane_of
from .._vtk_amr import boxes_of
from .._vtk_trees import trees_of


def field_of(data: vtkDataObject, array: vtkDataArray | None) -> nestgrid.Field:
    """The field of image data or of an unstructured grid at points, or of a hyper tree grid or an
    overlapping AMR in cells. Image data and AMR are not copied.

    What has one sample along an axis, or boxes with no cells along it, is a field in a plane.

    Raises InvalidInput where the data are not of dimension 2 or 3 or the array does not fit.
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
    types = vtk_to_numpy(grid.GetCellTypesArray())
    ghosts = grid.GetCellGhostArray()
    if ghosts is not None:  # duplicate, refined and hidden ones become empty cells
        types = np.where(vtk_to_numpy(ghosts) & 41, 0, types)
    return nestgrid.Cells(
        vtk_to_numpy(grid.GetPoints().GetData()),
        types,
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
    place = {
        "array": samples.reshape(image.GetDimensions(), order="F"),
        "spacing": image.GetSpacing(),
        "origin": origin,
        "direction": [[matrix.GetElement(r, c) for c in range(3)] for r in range(3)],
    }
    flat = [d for d in range(3) if image.GetDimensions()[d] == 1]
    return plane_of(**place, across=flat[0]) if len(flat) == 1 else nestgrid.Volume(**place)


def _octree(grid: vtkHyperTreeGrid, array: vtkDataArray) -> nestgrid.Octree:
    try:
        trees = trees_of(grid)
    except ValueError as error:
        raise nestgrid.InvalidInput(f"the hyper tree grid cannot be drawn: {error}") from None
    return nestgrid.Octree(
        trees.leaves,
        vtk_to_numpy(array)[trees.index],
        max_level=trees.max_level,
        factor=trees.factor,
        coordinates=trees.coordinates,
        masked=trees.masked,
    )
