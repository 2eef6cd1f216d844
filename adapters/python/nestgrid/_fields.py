# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields on hierarchies, and what is drawn of them."""

from __future__ import annotations

import math
import os
from typing import Any, Iterable, Sequence

import numpy as np

from . import _nestgrid
from ._lens import LensLike, as_lens
from ._nestgrid import InvalidInput
from ._results import Lines, Surface

Numbers = Sequence[float]


class Field:
    """A field on a hierarchy of elements: a Volume, an Octree, a loaded file, a time of Frames.

    Arguments that all methods share:

    threshold      detail up to it is left out, in the units of the indicator; default: 0, or with a
                   lens infinity, so that the lens decides alone
    indicator      what the threshold limits: "offset", |data - mean| in units of the data;
                   "visual", folds, 2 sin(angle / 2), from 0 to 2; "numerical", jumps of the
                   gradient times the diameter, in units of the data; "wavelet", coefficients in
                   units of the data; "geometry", |position - mean| on curved grids, in units of length
    blend          at least 1: nodes move from their mean to their value as the indicator grows from
                   the threshold to this many times it; 1: they jump
    lens           draws finely in a domain: a Lens, a domain (ball, box, ...) or (centre, radius)
    threads        how many threads work; 0: as many as the machine has. Results do not depend on it

    What an indicator needs is computed once and kept. Methods may be called by several threads at
    once, release the lock of Python while they work, and end with KeyboardInterrupt on Ctrl-C.
    """

    def __init__(self, source: _nestgrid.Source) -> None:
        self._source = source

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._source.dimension

    @property
    def range(self) -> tuple[float, float]:
        """The least and the greatest value. Raises InvalidInput where a value is not finite."""
        least, greatest = self._source.range(0)
        return least, greatest

    def changed(self) -> None:
        """Forgets what was computed of the values: call it after changing the array."""
        self._source.clear()

    def isosurface(
        self,
        level: float,
        threshold: float | None = None,
        max_triangles: int | None = None,
        *,
        indicator: str = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        normals: bool = True,
        cap: bool = False,
        at_nodes: bool = False,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """The surface on which the field has a value. No gap opens where the level changes.

        level          the value, in the units of the data
        max_triangles  finds the least threshold with no more triangles; threshold is then not used
        normals        unit normals at the vertices, from gradients of the data
        cap            closes the surface along the boundary of the domain, around field >= level
        at_nodes       no slivers around nodes at which the field has the value
        elements       keeps what Surface.outlines() needs

        Raises InvalidInput where an argument makes no sense, a value is not finite, or even the
        coarsest surface has more than max_triangles; GridError where the grid cannot be drawn.
        """
        projection = _projection(threshold, max_triangles, indicator, blend, lens)
        options = (normals, cap, elements, at_nodes)
        return Surface(_nestgrid.isosurface(self._source, level, *options, projection, threads))

    def slice(
        self,
        *,
        plane: tuple[Numbers, Numbers] | None = None,
        sphere: tuple[Numbers, float] | None = None,
        cylinder: tuple[Numbers, Numbers, float] | None = None,
        threshold: float | None = None,
        max_triangles: int | None = None,
        indicator: str = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        normals: bool = False,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """A slice, with the field at its vertices as attributes[:, 0], continuous everywhere.

        plane     a point and the normal, of any length
        sphere    the centre and the radius
        cylinder  a point on the axis, the axis, of any length, and the radius

        Raises InvalidInput unless there is one of plane, sphere and cylinder, and as isosurface().
        """
        given = {"plane": plane, "sphere": sphere, "cylinder": cylinder}
        shapes = [(name, shape) for name, shape in given.items() if shape is not None]
        if len(shapes) != 1:
            raise InvalidInput("a slice needs one of plane, sphere and cylinder")
        ((name, shape),) = shapes
        function = getattr(_nestgrid, name)(*shape)
        projection = _projection(threshold, max_triangles, indicator, blend, lens)
        return Surface(
            _nestgrid.slice(self._source, function, normals, elements, projection, threads)
        )

    def isolines(
        self,
        values: float | Iterable[float],
        threshold: float | None = None,
        *,
        indicator: str = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        threads: int = 0,
    ) -> Lines:
        """Lines on which a two-dimensional field has the given values, in one pass.

        Raises InvalidInput also for a field of dimension 3: its slices have isolines().
        """
        values = np.atleast_1d(np.asarray(values, float)).ravel()
        projection = _projection(threshold, None, indicator, blend, lens)
        return Lines(_nestgrid.isolines(self._source, values, projection, threads))

    def height_field(
        self,
        scale: float | None = 1,
        threshold: float | None = None,
        *,
        flatness: float = math.inf,
        indicator: str = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """The graph z = scale * field of a two-dimensional field, with it as attributes[:, 0].

        scale     None: the triangles stay in the plane
        flatness  quadrilaterals that differ by more from two triangles get a vertex in their middle

        Raises InvalidInput also for a field of dimension 3.
        """
        projection = _projection(threshold, None, indicator, blend, lens)
        return Surface(
            _nestgrid.height_field(self._source, scale, flatness, elements, projection, threads)
        )

    def probe(
        self,
        points: Any,
        threshold: float | None = None,
        *,
        indicator: str = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        threads: int = 0,
    ) -> np.ndarray:
        """The field at points, float64 of their shape without the last axis; nan outside.

        points  of shape (..., 3), or (..., 2) for a field of dimension 2
        """
        points = np.asarray(points, float)
        width = points.shape[-1] if points.ndim else 0
        if width != 3 and (width != 2 or self.dimension != 2):
            raise InvalidInput(f"points have {width} coordinates, not {self.dimension}")
        at = np.zeros((*points.shape[:-1], 3))
        at[..., :width] = points
        projection = _projection(threshold, None, indicator, blend, lens)
        return _nestgrid.probe(self._source, at, projection, threads).reshape(points.shape[:-1])


class Volume(Field):
    """Samples on a regular lattice, in an array that is borrowed and not copied.

    array    2 or 3 indices; index d runs along coordinate d. Integers of 8 to 64 bits, float32 or
             float64, in C or Fortran order, or with any other order of the indices, without gaps
    spacing  distance of samples along each index
    origin   position of array[0, 0, 0]

    Raises InvalidInput where the array has gaps (numpy.ascontiguousarray copies it), another type,
    or fewer than 2 samples along an index.
    """

    def __init__(
        self, array: np.ndarray, spacing: Numbers | None = None, origin: Numbers | None = None
    ) -> None:
        array = np.asanyarray(array)
        super().__init__(_nestgrid.volume(array, *_placed(array.ndim, spacing, origin)))


class Octree(Field):
    """Leaves of an octree (quadtree), or of a forest of them; they are copied and sorted.

    leaves       (n, 4) integers x, y, z, level ((n, 3): x, y, level): the lowest corner of each
                 leaf in cells of max_level, and its level, that of a root being 0
    values       (n,): of the leaves, from which nodes get means; or (n, 8) ((n, 4)): at the corners
                 of the leaves, x fastest, equal where leaves meet. From numbered nodes:
                 values_at_nodes[nodes_of_leaves]
    max_level    a root is 2**max_level cells wide; default: the greatest level
    spacing      size of a cell of max_level; origin: position of the corner (0, 0, 0)
    coordinates  in their place: of the corners of roots, one ascending sequence for each direction
    masked       (n,): leaves that are not drawn

    Raises InvalidInput where leaves overlap or leave gaps in a root, and where values differ.
    """

    def __init__(
        self,
        leaves: np.ndarray,
        values: np.ndarray,
        *,
        max_level: int | None = None,
        spacing: Numbers | None = None,
        origin: Numbers | None = None,
        coordinates: Sequence[Numbers] | None = None,
        masked: np.ndarray | None = None,
    ) -> None:
        leaves = np.asarray(leaves)
        if leaves.ndim != 2 or leaves.shape[1] not in (3, 4) or leaves.dtype.kind not in "iu":
            raise InvalidInput("leaves are no array of integers of the shape (n, 4) or (n, 3)")
        if not len(leaves):
            raise InvalidInput("the octree has no leaves")
        leaves = np.ascontiguousarray(leaves, np.int64)
        dimension = leaves.shape[1] - 1
        if max_level is None:
            max_level = int(leaves[:, -1].max())
        if not 0 <= max_level <= 20:
            raise InvalidInput(f"max_level is {max_level}, not 0 to 20")
        if coordinates is None:
            step, start = _placed(dimension, spacing, origin)
            roots = np.maximum(leaves[:, :-1].max(axis=0) >> max_level, 0) + 1
            coordinates = [
                start[d] + step[d] * 2.0**max_level * np.arange(roots[d] + 1)
                for d in range(dimension)
            ]
        elif len(coordinates) < dimension:
            raise InvalidInput(f"there are coordinates for {len(coordinates)} directions only")
        along = [np.asarray(x, float) for x in coordinates] + [np.zeros(1)] * (3 - len(coordinates))
        masked = np.zeros(0) if masked is None else np.asarray(masked)
        super().__init__(
            _nestgrid.octree(
                leaves, np.asarray(values, float), masked.astype(np.uint8), max_level, along
            )
        )


class Frames:
    """Frames of one field at several times; fields between them need no computation of their own.

    Made of arrays here, and of .nestgrid files by load().

    arrays  of one shape, type and order, as for Volume; borrowed
    times   ascending, one for each; default: 0, 1, 2, ...

    Raises InvalidInput where arrays differ, or times do not ascend.
    """

    def __init__(
        self,
        arrays: Sequence[np.ndarray],
        times: Sequence[float] | None = None,
        spacing: Numbers | None = None,
        origin: Numbers | None = None,
    ) -> None:
        arrays = [np.asanyarray(array) for array in arrays]
        if not arrays:
            raise InvalidInput("there are no frames")
        times = range(len(arrays)) if times is None else times
        place = _placed(arrays[0].ndim, spacing, origin)
        self._frames = _nestgrid.Frames(arrays, [float(t) for t in times], *place)

    @classmethod
    def _of(cls, frames: _nestgrid.Frames) -> Frames:
        loaded = cls.__new__(cls)
        loaded._frames = frames
        return loaded

    @property
    def times(self) -> list[float]:
        """Those of the frames."""
        return self._frames.times

    def at(self, t: float, cubic: bool = False, threads: int = 0) -> Field:
        """The field at a time from the first to the last one, with bounds from those of the frames.

        cubic  cubic polynomials (Catmull and Rom) in the place of lines

        Other indicators than "offset" are computed anew at each time.
        """
        return Field(self._frames.at(t, cubic, threads))

    def changed(self) -> None:
        """Forgets what was computed of the values: call it after changing an array."""
        self._frames.clear()


def load(path: str | os.PathLike, array: str = "") -> Field | Frames:
    """The field of a .nestgrid file, or its Frames where it has several.

    array  its name, where the file has several

    Raises IoError where the file cannot be read or is damaged, InvalidInput where there is no such
    field.
    """
    loaded = _nestgrid.load(os.fspath(path), array)
    return Frames._of(loaded) if isinstance(loaded, _nestgrid.Frames) else Field(loaded)


def _placed(
    dimension: int, spacing: Numbers | None, origin: Numbers | None
) -> tuple[Numbers, Numbers]:
    return (
        (1.0,) * dimension if spacing is None else spacing,
        (0.0,) * dimension if origin is None else origin,
    )


def _projection(
    threshold: float | None,
    max_triangles: int | None,
    indicator: str,
    blend: float,
    lens: LensLike | None,
) -> _nestgrid.Projection:
    return _nestgrid.Projection(threshold, max_triangles, indicator, blend, as_lens(lens))
