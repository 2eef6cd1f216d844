# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""What extractions return. Arrays lie in the memory of the library and keep it alive."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, ClassVar, Iterable, Iterator, Sequence, TypeVar

import numpy as np

from . import _files, _html, _nestgrid
from ._arguments import InvalidType, flag, name_of, numbers, several, takes, whole
from ._arguments import path as path_kind
from ._files import Compression

if TYPE_CHECKING:
    import pyvista
    from vtkmodules.vtkCommonDataModel import vtkPolyData


Self = TypeVar("Self", bound="_Extracted")


class _Extracted:
    """What is kept in the memory of the library, and can be copied and pickled."""

    _data: Any
    _compiled: ClassVar[Any]
    _name: str
    _unit: str

    def __init__(self) -> None:
        raise InvalidType(f"a {type(self).__name__} is made by the methods of fields and results")

    @classmethod
    def _of(cls: type[Self], data: Any, origin: Any) -> Self:
        """The compiled data, with the name and unit of what they were made of."""
        result = cls.__new__(cls)
        result._data = data
        result._name = origin._name
        result._unit = origin._unit
        return result

    @classmethod
    def _restored(cls: type[Self], state: tuple[Any, ...], name: str, unit: str) -> Self:
        result = cls.__new__(cls)
        result._data = cls._compiled.restored(state)
        result._name = name
        result._unit = unit
        return result

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._restored, (self._data.state(), self._name, self._unit)

    def __copy__(self: Self) -> Self:
        """Another result on the same arrays."""
        return type(self)._of(self._data, self)

    @property
    def vertices(self) -> np.ndarray:
        """Positions, float64 of shape (n, 3), in units of length."""
        return self._data.vertices

    @property
    def name(self) -> str:
        """The name of the data that it was made of, "" where none is known."""
        return self._name

    @property
    def unit(self) -> str:
        """The unit of length, such as "mm"; "" where none is known."""
        return self._unit

    def to_vtk(self) -> vtkPolyData:
        """The same as vtkPolyData, copied."""
        raise NotImplementedError

    def to_pyvista(self) -> pyvista.PolyData:
        """The same as pyvista.PolyData, copied. Raises ImportError where PyVista is missing."""
        import pyvista

        return pyvista.wrap(self.to_vtk())

    def _size(self) -> str:
        raise NotImplementedError

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("of", self._name)] if self._name else []
        rows.append(("size", self._size()))
        if len(self.vertices):
            unit = f" {self._unit}" if self._unit else ""
            low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
            ends = [f"{a:.6g} to {b:.6g}" for a, b in zip(low, high)]
            rows.append(("x, y, z", ", ".join(ends) + unit))
        return rows

    def __repr__(self) -> str:
        name = f" of {self._name!r}" if self._name else ""
        return f"<nestgrid.{type(self).__name__}{name}: {self._size()}{_between(self.vertices)}>"

    def _repr_html_(self) -> str:
        return _html.table(f"nestgrid.{type(self).__name__}", self._rows())


def _between(vertices: np.ndarray) -> str:
    """The box around vertices, for people."""
    if not len(vertices):
        return ""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    ends = [", ".join(f"{x:.4g}" for x in end) for end in (low, high)]
    return f", from ({ends[0]}) to ({ends[1]})"


class _Result(_Extracted):
    """Numbers that every extraction has."""

    @property
    def error_bound(self) -> float:
        """The drawn function and the data, interpolated on the finest grid, differ by no more.

        In the units of the data; never more than range_bound.
        """
        bound: float = self._data.error_bound
        return bound

    @property
    def range_bound(self) -> float:
        """What the least and the greatest value alone promise of any drawing.

        In the units of the data: on isosurfaces the greatest |data - level| anywhere, else the
        greatest value minus the least; infinite where these are not known.
        """
        bound: float = self._data.range_bound
        return bound

    @property
    def bound_says_nothing(self) -> bool:
        """Whether error_bound promises no more than range_bound."""
        return bool(self._data.bound_says_nothing)

    @property
    def position_bound(self) -> float:
        """On curved cells no point is farther from its place, in units of length.

        Of a height field, before it is lifted; 0 where all cells are straight.
        """
        bound: float = self._data.position_bound
        return bound

    @property
    def threshold(self) -> float:
        """The threshold that was used, found or given."""
        return self._data.threshold

    @property
    def counts(self) -> dict[str, int]:
        """How many elements were looked at (calls), visited, and extracted."""
        return self._data.counts

    @property
    def attributes(self) -> np.ndarray:
        """Values at the vertices, float64 of shape (n, c); c is 0 where there are none."""
        return self._data.attributes

    def _rows(self) -> list[tuple[str, str]]:
        rows = super()._rows()
        bound = "the bound says nothing" if self.bound_says_nothing else f"{self.error_bound:.3g}"
        rows.append(("error at most", bound))
        rows.append(("threshold", f"{self.threshold:.6g}"))
        return rows

    def _size(self) -> str:
        if self.bound_says_nothing:
            return f"{self._counted()}, the error bound says nothing"
        return f"{self._counted()}, error at most {self.error_bound:.3g}"

    def _counted(self) -> str:
        raise NotImplementedError


class Surface(_Result):
    """A triangle surface: an isosurface, a slice, a height field or a shading."""

    __module__ = "nestgrid"
    _compiled = _nestgrid.Surface

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

    @property
    def surface_error(self) -> float:
        """What is kept of an error that was asked for, in the units of the data.

        On every triangle |data - level| is at most this. Where nothing was collapsed, no part of
        the surface of all data differs more from what is drawn. Infinite where nothing is
        promised: where neither an error nor, with collapses, a number of triangles was asked for.
        """
        return self._data.surface_error

    @property
    def budget_reason(self) -> str:
        """Why there are less than nine tenths of max_triangles, as a sentence; empty elsewhere."""
        return self._data.budget_reason

    def report(self) -> dict[str, int | float | bool]:
        """Counts, area, enclosed volume, and whether the surface is closed and a manifold.

        area_behind is that of triangles whose backs a normal of their vertices shows.
        """
        return self._data.report()

    def outlines(self) -> Segments:
        """The edges of the extracted elements on the surface: where it is coarse, where fine.

        Raises InvalidInput where the surface was not extracted with elements=True.
        """
        return Segments._of(self._data.outlines(), self)

    @takes(values=numbers, attribute=whole(0))
    def isolines(self, values: float | Iterable[float] | np.ndarray, attribute: int = 0) -> Lines:
        """Lines on the surface on which an attribute has the given values.

        values     one number or several, in the units of the attribute
        attribute  the column of attributes, from 0

        Raises InvalidInput where there is no such attribute.
        """
        return Lines._of(self._data.isolines(several(values), attribute), self)

    def to_vtk(self) -> vtkPolyData:
        """The same as vtkPolyData, copied, with normals and attributes as data of points."""
        cells = np.hstack([np.full((len(self.triangles), 1), 3), self.triangles])
        return _poly_data(self.vertices, "SetPolys", cells, len(cells), self._point_data())

    @takes(path=path_kind, compress=name_of(Compression), double=flag)
    def save(
        self,
        path: str | os.PathLike[str],
        *,
        compress: Compression = "none",
        double: bool = True,
    ) -> None:
        """Writes a file, which appears when it is complete.

        path      ends in .vtp, .ply, .stl, .obj or .gltf. All but .stl have normals, .vtp and
                  .gltf attributes
        compress  how a .vtp is packed: "none", or "zlib", which takes longer and makes it smaller
        double    whether numbers in .vtp and .ply are of double precision, or of single

        Raises InvalidInput for another suffix, and for a choice that its format does not have,
        IoError where writing fails.
        """
        _files.write(
            path,
            {
                ".vtp": lambda f: _files.vtp(
                    f,
                    self.vertices,
                    [("Polys", self.triangles)],
                    self._point_data(),
                    compress=compress,
                    double=double,
                ),
                ".ply": lambda f: _files.ply(
                    f, self.vertices, self.normals, self.triangles, double
                ),
                ".stl": lambda f: _files.stl(f, self.vertices, self.triangles),
                ".obj": lambda f: _files.obj(f, self.vertices, self.normals, self.triangles),
                ".gltf": lambda f: _files.gltf(
                    f, self.vertices, self._point_data(), self.triangles
                ),
            },
            compress,
            double,
        )

    def _point_data(self) -> list[tuple[str, np.ndarray]]:
        normals = [("Normals", self.normals)] if len(self.normals) else []
        return normals + _columns(self.attributes, self._name)

    def _counted(self) -> str:
        return f"{len(self.vertices)} vertices, {len(self.triangles)} triangles"


class Lines(_Result):
    """Joined lines: isolines. Iterating gives each line as an array of positions, (k, 3)."""

    __module__ = "nestgrid"
    _compiled = _nestgrid.Lines

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
        attributes = _columns(self.attributes, self._name)
        data = _poly_data(self.vertices, "SetLines", cells, len(self), attributes)
        _add_arrays(data.GetCellData(), [("value", self.values)])
        return data

    @takes(path=path_kind, compress=name_of(Compression), double=flag)
    def save(
        self,
        path: str | os.PathLike[str],
        *,
        compress: Compression = "none",
        double: bool = True,
    ) -> None:
        """Writes a file, which appears when it is complete.

        path      ends in .vtp, .obj or .gltf; .vtp has the value of each line, .vtp and .gltf
                  attributes
        compress  how a .vtp is packed: "none", or "zlib", which takes longer and makes it smaller
        double    whether numbers in a .vtp are of double precision, or of single

        Raises InvalidInput for another suffix, and for a choice that its format does not have,
        IoError where writing fails.
        """
        cells = [("Lines", self.points.astype(np.int64)), ("offsets", self.first[1:].astype(int))]
        attributes = _columns(self.attributes, self._name)
        values = [("value", self.values)]
        parts = [self.points[a:b] for a, b in zip(self.first[:-1], self.first[1:])]
        none = np.zeros((0, 3))
        _files.write(
            path,
            {
                ".vtp": lambda f: _files.vtp(
                    f, self.vertices, cells, attributes, values, compress=compress, double=double
                ),
                ".obj": lambda f: _files.obj(f, self.vertices, none, lines=parts),
                ".gltf": lambda f: _files.gltf(f, self.vertices, attributes, _pairs(parts)),
            },
            compress,
            double,
        )

    def _counted(self) -> str:
        return f"{len(self)} lines of {len(self.points)} points"


class Segments(_Extracted):
    """Single segments: outlines of elements."""

    __module__ = "nestgrid"
    _compiled = _nestgrid.Segments

    @property
    def segments(self) -> np.ndarray:
        """Vertices of each segment, uint32 of shape (m, 2)."""
        return self._data.segments

    def to_vtk(self) -> vtkPolyData:
        """The same as vtkPolyData, copied."""
        cells = np.hstack([np.full((len(self.segments), 1), 2), self.segments])
        return _poly_data(self.vertices, "SetLines", cells, len(cells), [])

    @takes(path=path_kind, compress=name_of(Compression), double=flag)
    def save(
        self,
        path: str | os.PathLike[str],
        *,
        compress: Compression = "none",
        double: bool = True,
    ) -> None:
        """Writes a file, which appears when it is complete.

        path      ends in .vtp, .obj or .gltf
        compress  how a .vtp is packed: "none", or "zlib", which takes longer and makes it smaller
        double    whether numbers in a .vtp are of double precision, or of single

        Raises InvalidInput for another suffix, and for a choice that its format does not have,
        IoError where writing fails.
        """
        cells = [("Lines", self.segments)]
        none = np.zeros((0, 3))
        _files.write(
            path,
            {
                ".vtp": lambda f: _files.vtp(
                    f, self.vertices, cells, compress=compress, double=double
                ),
                ".obj": lambda f: _files.obj(f, self.vertices, none, lines=list(self.segments)),
                ".gltf": lambda f: _files.gltf(f, self.vertices, [], self.segments),
            },
            compress,
            double,
        )

    def _size(self) -> str:
        return f"{len(self.segments)} segments"


def _pairs(lines: Sequence[np.ndarray]) -> np.ndarray:
    """The segments of lines."""
    pairs = [np.stack([line[:-1], line[1:]], axis=1) for line in lines]
    return np.concatenate(pairs) if pairs else np.zeros((0, 2), np.uint32)


def _columns(attributes: np.ndarray, name: str) -> list[tuple[str, np.ndarray]]:
    """The attributes with names, of which the first is that of the data."""
    name = name or "value"
    names = [name, *(f"{name} {i}" for i in range(1, attributes.shape[1]))]
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
