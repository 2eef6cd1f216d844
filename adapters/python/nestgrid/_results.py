# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""What extractions return. Arrays lie in the memory of the library and keep it alive."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Iterable, Iterator

import numpy as np

from . import _files

if TYPE_CHECKING:
    import pyvista
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from . import _nestgrid


class _Result:
    """Numbers that every extraction has."""

    def __init__(self, data: Any) -> None:
        self._data = data

    @property
    def error_bound(self) -> float:
        """The drawn function and the data, interpolated on the finest grid, differ by no more.

        In the units of the data. Infinite where nothing is known.
        """
        return self._data.error_bound

    @property
    def threshold(self) -> float:
        """The threshold that was used, found or given; nan for a slice within max_triangles."""
        return self._data.threshold

    @property
    def counts(self) -> dict[str, int]:
        """How many elements were looked at (calls), visited, and extracted."""
        return self._data.counts

    @property
    def vertices(self) -> np.ndarray:
        """Positions, float64 of shape (n, 3), in the units of the spacing."""
        return self._data.vertices

    @property
    def attributes(self) -> np.ndarray:
        """Values at the vertices, float64 of shape (n, c); c is 0 where there are none."""
        return self._data.attributes

    def to_pyvista(self) -> pyvista.PolyData:
        """The same as pyvista.PolyData, copied."""
        import pyvista

        return pyvista.wrap(self.to_vtk())

    def to_vtk(self) -> vtkPolyData:
        """The same as vtkPolyData."""
        raise NotImplementedError


class Surface(_Result):
    """A triangle surface: an isosurface, a slice, a height field or a shading."""

    @property
    def triangles(self) -> np.ndarray:
        """Vertices of each triangle, uint32 of shape (m, 3).

        Seen from where the field is below the level they run counterclockwise.
        """
        return self._data.triangles

    @property
    def normals(self) -> np.ndarray:
        """Unit normals at the vertices, float64 of shape (n, 3), to where the field falls.

        Of shape (0, 3) where they were not asked for.
        """
        return self._data.normals

    def report(self) -> dict[str, int | float | bool]:
        """Counts, area, enclosed volume, and whether the surface is closed and a manifold."""
        return self._data.report()

    def outlines(self) -> Segments:
        """The edges of the extracted elements on the surface: where it is coarse, where fine.

        Raises InvalidInput where the surface was not extracted with elements=True.
        """
        return Segments(self._data.outlines())

    def isolines(self, values: float | Iterable[float], attribute: int = 0) -> Lines:
        """Lines on the surface on which an attribute has the given values.

        Raises InvalidInput where there is no such attribute.
        """
        values = np.atleast_1d(np.asarray(values, float)).ravel()
        return Lines(self._data.isolines(values, attribute))

    def to_vtk(self) -> vtkPolyData:
        """The same as vtkPolyData, copied, with normals and attributes as data of points."""
        cells = np.hstack([np.full((len(self.triangles), 1), 3), self.triangles])
        return _poly_data(self.vertices, "SetPolys", cells, len(cells), self._point_data())

    def save(self, path: str | os.PathLike) -> None:
        """Writes .ply, .stl or .vtp; .ply and .vtp have normals, .vtp attributes.

        Raises InvalidInput for another suffix, IoError where writing fails.
        """
        _files.write(
            path,
            {
                ".ply": lambda f: _files.ply(f, self.vertices, self.normals, self.triangles),
                ".stl": lambda f: _files.stl(f, self.vertices, self.triangles),
                ".vtp": lambda f: _files.vtp(
                    f, self.vertices, [("Polys", self.triangles)], self._point_data()
                ),
            },
        )

    def _point_data(self) -> list[tuple[str, np.ndarray]]:
        normals = [("Normals", self.normals)] if len(self.normals) else []
        return normals + _columns(self.attributes)

    def __repr__(self) -> str:
        return (
            f"<nestgrid.Surface: {len(self.vertices)} vertices, {len(self.triangles)} triangles, "
            f"error at most {self.error_bound:.3g}>"
        )


class Lines(_Result):
    """Joined lines: isolines. Iterating gives each line as an array of positions, (k, 3)."""

    @property
    def points(self) -> np.ndarray:
        """The vertices of all lines, line by line, uint32; a ring names its first one again."""
        return self._data.points

    @property
    def first(self) -> np.ndarray:
        """Where each line begins in points, and the end: uint64 of shape (lines + 1,)."""
        return self._data.first

    @property
    def values(self) -> np.ndarray:
        """The value of the field on each line, float64."""
        return self._data.values

    def __len__(self) -> int:
        return len(self.values)

    def __iter__(self) -> Iterator[np.ndarray]:
        for begin, end in zip(self.first[:-1], self.first[1:]):
            yield self.vertices[self.points[begin:end]]

    def to_vtk(self) -> vtkPolyData:
        """The same as vtkPolyData, copied, with the value of each line as data of cells."""
        first = self.first.astype(np.int64)
        cells = np.insert(self.points.astype(np.int64), first[:-1], np.diff(first))
        data = _poly_data(
            self.vertices, "SetLines", cells, len(self), _columns(self.attributes)
        )
        _add_arrays(data.GetCellData(), [("value", self.values)])
        return data

    def save(self, path: str | os.PathLike) -> None:
        """Writes .vtp. Raises InvalidInput for another suffix, IoError where writing fails."""
        cells = [("Lines", self.points.astype(np.int64)), ("offsets", self.first[1:].astype(int))]
        attributes = _columns(self.attributes)
        values = [("value", self.values)]
        _files.write(
            path, {".vtp": lambda f: _files.vtp(f, self.vertices, cells, attributes, values)}
        )

    def __repr__(self) -> str:
        return f"<nestgrid.Lines: {len(self)} lines, error at most {self.error_bound:.3g}>"


class Segments:
    """Single segments: outlines of elements."""

    def __init__(self, data: _nestgrid.Segments) -> None:
        self._data = data

    @property
    def vertices(self) -> np.ndarray:
        """Positions, float64 of shape (n, 3)."""
        return self._data.vertices

    @property
    def segments(self) -> np.ndarray:
        """Vertices of each segment, uint32 of shape (m, 2)."""
        return self._data.segments

    def to_vtk(self) -> vtkPolyData:
        """The same as vtkPolyData, copied."""
        cells = np.hstack([np.full((len(self.segments), 1), 2), self.segments])
        return _poly_data(self.vertices, "SetLines", cells, len(cells), [])

    def save(self, path: str | os.PathLike) -> None:
        """Writes .vtp. Raises InvalidInput for another suffix, IoError where writing fails."""
        cells = [("Lines", self.segments)]
        _files.write(path, {".vtp": lambda f: _files.vtp(f, self.vertices, cells)})

    def __repr__(self) -> str:
        return f"<nestgrid.Segments: {len(self.segments)} segments>"


def _columns(attributes: np.ndarray) -> list[tuple[str, np.ndarray]]:
    names = ["value", *(f"value {i}" for i in range(1, attributes.shape[1]))]
    return [(name, attributes[:, i]) for i, name in enumerate(names[: attributes.shape[1]])]


def _poly_data(
    vertices: np.ndarray, setter: str, cells: np.ndarray, count: int, data: _files.Pieces
) -> vtkPolyData:
    """vtkPolyData of copies, which outlive everything of Python."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    points = vtkPoints()
    points.SetDataTypeToDouble()
    if len(vertices):
        points.SetData(numpy_to_vtk(vertices, deep=True))
    cell_array = vtkCellArray()
    if count:
        flat = np.ascontiguousarray(cells, np.int64).reshape(-1)
        cell_array.ImportLegacyFormat(numpy_to_vtkIdTypeArray(flat, deep=True))
    result = vtkPolyData()
    result.SetPoints(points)
    getattr(result, setter)(cell_array)
    _add_arrays(result.GetPointData(), data)
    return result


def _add_arrays(attributes: Any, data: _files.Pieces) -> None:
    from vtkmodules.util.numpy_support import numpy_to_vtk

    for name, values in data:
        if not len(values):
            continue
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        if name == "Normals":
            attributes.SetNormals(array)
        else:
            attributes.AddArray(array)
            if attributes.GetScalars() is None:
                attributes.SetActiveScalars(name)
