# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields on meshes of linear, quadratic and Lagrange cells."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _arguments as kinds
from . import _nestgrid
from ._arguments import numbers, optional, takes
from ._fields import Field
from ._nestgrid import InvalidInput


class Cells(Field):
    """A mesh as VTK keeps it, with a value at each point; everything is copied.

    points        (n, 3): coordinates. Cells share points or have their own: corners at one place
                  are one node
    types         (m,): of the cells, by VTK's numbers: linear, quadratic and Lagrange ones of
                  degrees to 8; of pyramids linear and quadratic ones
    offsets       (m + 1,): where the points of each cell begin in connectivity, and the end
    connectivity  the points of all cells, in VTK's order
    values        (n,): at the points
    degrees       (m, 3): VTK's array HigherOrderDegrees; None: as the numbers of points say
    name          of the data, for files and tables
    unit          of length, such as "mm"

    What is drawn of degrees above 1 is within an error of the polynomials themselves: that of
    error=, or a thousandth of their range. Curved cells are drawn where they are, within the same
    share of the domain as the error is of the range.

    Raises InvalidInput for cells that are not drawn, with the first of them, and where a face of a
    cell is divided on its other side.
    """

    __module__ = "nestgrid"
    _cells: _nestgrid.CellSource

    @takes(
        points=numbers,
        types=kinds.array,
        offsets=kinds.array,
        connectivity=kinds.array,
        values=numbers,
        degrees=optional(numbers),
    )
    def __init__(
        self,
        points: np.ndarray,
        types: np.ndarray,
        offsets: np.ndarray,
        connectivity: np.ndarray,
        values: np.ndarray,
        *,
        degrees: np.ndarray | None = None,
        name: str = "",
        unit: str = "",
    ) -> None:
        if points.ndim != 2 or points.shape[1] != 3:
            raise InvalidInput("Cells(): points are no array of the shape (n, 3)")
        if values.ndim != 1:
            raise InvalidInput("Cells(): values are not one number for each point")
        whole = {"types": types, "offsets": offsets, "connectivity": connectivity}
        for what, array in whole.items():
            if array.ndim != 1 or array.dtype.kind not in "iu":
                raise InvalidInput(f"Cells(): {what} is no array of integers with one index")
        if types.size and not 0 <= types.min() <= types.max() < 256:
            raise InvalidInput("Cells(): types has a number that is not from 0 to 255")
        self._arrays = (
            np.array(points, float),
            types.astype(np.uint8),
            offsets.astype(np.int64),
            connectivity.astype(np.int64),
            np.array(values, float),
            np.zeros(0) if degrees is None else np.array(degrees, float),
        )
        self._cells = _nestgrid.cells(*self._arrays)
        self._set(self._cells, name, unit)

    @property
    def degree(self) -> int:
        """The greatest degree of a cell."""
        return self._cells.degree

    def _size(self) -> str:
        return f"{len(self._arrays[1])} cells of dimension {self.dimension}, degree {self.degree}"

    def __reduce__(self) -> tuple[Any, ...]:
        return _cells_of, (self._arrays, self._name, self._unit)


def _cells_of(arrays: tuple[np.ndarray, ...], name: str, unit: str) -> Cells:
    *mesh, degrees = arrays
    return Cells(*mesh, degrees=degrees if degrees.size else None, name=name, unit=unit)
