# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields on hierarchies, and what is drawn of them."""

from __future__ import annotations

import math
from typing import Any, Iterable, Literal, Sequence, Union

import numpy as np

from . import _html, _nestgrid
from ._arguments import (
    Cuts,
    Indicator,
    InvalidType,
    SurfaceIndicator,
    flag,
    name_of,
    not_negative,
    number,
    numbers,
    optional,
    several,
    shape,
    takes,
)
from ._lens import Lens, LensLike
from ._nestgrid import InvalidInput
from ._results import Lines, Surface

Numbers = Union[Sequence[float], np.ndarray]


class Field:
    """A field on a hierarchy of elements: a Volume, an Octree, Blocks, a loaded file, a time of Frames.

    What an indicator needs is computed once and kept. Methods may be called by several threads at
    once, release the lock of Python while they work, and end with KeyboardInterrupt on Ctrl-C.
    """

    __module__ = "nestgrid"
    _source: _nestgrid.Source
    _name: str
    _unit: str

    def __init__(self) -> None:
        raise InvalidType("a Field is a Volume, an Octree, Blocks, what load() gives, or Frames.at(t)")

    def _set(self, source: _nestgrid.Source, name: str, unit: str) -> None:
        self._source = source
        self._name = name
        self._unit = unit

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._source.dimension

    @property
    def name(self) -> str:
        """The name of the data, "" where none is known."""
        return self._name

    @property
    def unit(self) -> str:
        """The unit of length, such as "mm"; "" where none is known."""
        return self._unit

    @property
    def range(self) -> tuple[float, float]:
        """The least and the greatest value. Raises InvalidInput where a value is not finite."""
        least, greatest = self._source.range(0)
        return least, greatest

    def changed(self) -> None:
        """Forgets what was computed of the values: call it after changing the array."""
        self._source.clear()

    @takes(
        level=number,
        indicator=name_of(SurfaceIndicator),
        distance=optional(not_negative),
        distance_field=flag,
        collapse=flag,
        cap=flag,
        at_nodes=flag,
        cuts=optional(name_of(Cuts)),
    )
    def isosurface(
        self,
        level: float,
        threshold: float | None = None,
        max_triangles: int | None = None,
        *,
        indicator: SurfaceIndicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        error: float | None = None,
        distance: float | None = None,
        distance_field: bool = False,
        collapse: bool = False,
        normals: bool = True,
        cap: bool = False,
        at_nodes: bool = False,
        cuts: Cuts | None = None,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """The surface on which the field has a value. No gap opens where the level changes.

        level     the value, in the units of the data
        indicator as elsewhere, or "cut": the error of this surface alone; "slope": the distance,
                  which with max_triangles draws the nearest surface where data are noisy
        error     here of this surface alone: |data - level| on it, and where what is drawn leaves
                  out a part of the data, is at most this
        distance  about how far what is drawn may be from the surface of all data, in units of
                  length: an estimate, and given alone
        distance_field  whether to keep distance, which must be given: no point of what is drawn is
                  farther from the surface of all data, and none of that from what is drawn. Some
                  times the time
        collapse  whether to take edges away while error, or distance there and back, is kept, or
                  down to max_triangles of the least error, or by indicator="slope" of the least
                  distance: one of these must be given. Some times fewer triangles, some times the
                  time
        cap       whether to close the surface along the boundary of the domain, around what is at
                  least the level
        at_nodes  whether to draw no slivers around nodes at which the field has the value
        cuts      where edges of coarse elements are cut: "linear" between their ends, which keeps
                  the error that is asked for; "finest" where the finest data have the value, which
                  lies nearer to the data (not at nodes, nor on octrees). None: "finest" where
                  max_triangles or distance is given, but for the indicators "deviation" and "cut"

        Raises InvalidInput where an argument makes no sense, a value is not finite, or even the
        coarsest surface has more than max_triangles; GridError where the grid cannot be drawn.
        """
        projection = _surface_projection(
            threshold, max_triangles, indicator, blend, lens, error, distance, collapse
        )
        if collapse:
            kept = error is not None or distance is not None or max_triangles is not None
            nearest = max_triangles is not None and indicator == "slope"
            other = indicator != "offset" and not nearest
            if not kept or cap or at_nodes or lens is not None or other:
                raise InvalidInput(
                    "collapse needs an error, a distance or max_triangles, and neither cap, "
                    "at_nodes, lens nor indicator, but for slope beside max_triangles"
                )
        if distance_field and (distance is None or lens is not None):
            raise InvalidInput("distance_field needs a distance, and no lens")
        if cuts is None:
            nearer = distance is not None or (max_triangles is not None and not collapse)
            by_slope = collapse and indicator == "slope"
            finest = by_slope or (nearer and indicator not in ("deviation", "cut"))
        else:
            finest = cuts == "finest"
        keeps_distance = distance_field or (
            collapse and (distance is not None or indicator == "slope")
        )
        options = (normals, cap, elements, at_nodes, finest, collapse, keeps_distance)
        return Surface._of(
            _nestgrid.isosurface(self._source, level, *options, projection, threads), self
        )

    @takes(low=number, high=number, indicator=name_of(SurfaceIndicator))
    def isoband(
        self,
        low: float,
        high: float,
        threshold: float | None = None,
        *,
        indicator: SurfaceIndicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        error: float | None = None,
        normals: bool = True,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """The surface around low <= field < high: both level sets, oriented away from the band.

        low   the lower value, in the units of the data
        high  the upper value, above low

        It is open on the boundary of the domain only. Raises InvalidInput also unless low < high,
        and for a field of dimension 2.
        """
        projection = _projection(threshold, None, indicator, blend, lens, error)
        options = (low, high, normals, elements)
        return Surface._of(_nestgrid.isoband(self._source, *options, projection, threads), self)

    @takes()
    def boundary(
        self,
        threshold: float | None = None,
        max_triangles: int | None = None,
        *,
        indicator: Indicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        error: float | None = None,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """The boundary of the domain, closed, with the field at its vertices as attributes[:, 0].

        Hidden data are outside. Raises InvalidInput also for a field of dimension 2.
        """
        projection = _projection(threshold, max_triangles, indicator, blend, lens, error)
        return Surface._of(
            _nestgrid.boundary(self._source, elements, projection, threads), self
        )

    @takes(
        plane=optional(shape(("the point", 3), ("the normal", 3))),
        sphere=optional(shape(("the centre", 3), ("the radius", 0))),
        cylinder=optional(shape(("the point", 3), ("the axis", 3), ("the radius", 0))),
        distance=optional(number),
        collapse=flag,
    )
    def slice(
        self,
        *,
        plane: tuple[Numbers, Numbers] | None = None,
        sphere: tuple[Numbers, float] | None = None,
        cylinder: tuple[Numbers, Numbers, float] | None = None,
        threshold: float | None = None,
        max_triangles: int | None = None,
        indicator: Indicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        error: float | None = None,
        distance: float | None = None,
        collapse: bool = False,
        normals: bool = False,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """A slice, with the field at its vertices as attributes[:, 0], continuous everywhere.

        plane     (point, normal), 3 numbers each; the normal of any length
        sphere    (centre, radius), 3 numbers and one, in units of length
        cylinder  (point on the axis, axis, radius), 3 numbers, 3 of any length, and one
        distance  of a sphere or a cylinder with collapse: no point of what is left is farther from
                  the slice of all data, and none of that from what is left, in units of length.
                  None: the slice keeps its place
        collapse  whether to take edges away while error, which must be given, is kept

        Raises InvalidInput unless there is one of plane, sphere and cylinder, and as isosurface().
        """
        given = {"plane": plane, "sphere": sphere, "cylinder": cylinder}
        shapes = [(name, each) for name, each in given.items() if each is not None]
        if len(shapes) != 1:
            raise InvalidInput("slice(): a slice needs one of plane, sphere and cylinder")
        ((name, parts),) = shapes
        function = getattr(_nestgrid, name)(*parts)
        _require_error(collapse, error, lens)
        if distance is not None:
            if not collapse or plane is not None:
                raise InvalidInput("distance needs collapse, and a sphere or a cylinder")
            if not distance > 0:
                raise InvalidInput("distance is not a number > 0: leave it out to keep the place")
        projection = _projection(threshold, max_triangles, indicator, blend, lens, error)
        options = (normals, elements, collapse, distance or 0)
        return Surface._of(
            _nestgrid.slice(self._source, function, *options, projection, threads), self
        )

    @takes(values=numbers)
    def isolines(
        self,
        values: float | Iterable[float] | np.ndarray,
        threshold: float | None = None,
        *,
        indicator: Indicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        error: float | None = None,
        threads: int = 0,
    ) -> Lines:
        """Lines on which a two-dimensional field has the given values, in one pass.

        values  one number or several, in the units of the data

        Raises InvalidInput also for a field of dimension 3: its slices have isolines().
        """
        projection = _projection(threshold, None, indicator, blend, lens, error)
        return Lines._of(
            _nestgrid.isolines(self._source, several(values), projection, threads), self
        )

    @takes(scale=optional(number), flatness=not_negative, collapse=flag)
    def height_field(
        self,
        scale: float | None = 1,
        threshold: float | None = None,
        max_triangles: int | None = None,
        *,
        flatness: float = math.inf,
        indicator: Indicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        error: float | None = None,
        collapse: bool = False,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """The graph z = scale * field of a two-dimensional field, with it as attributes[:, 0].

        scale     units of length per unit of the data; None: the triangles stay in the plane
        flatness  at least 0, in the units of the data: quadrilaterals that differ by more from two
                  triangles get a vertex in their middle
        collapse  whether to take edges away while error, which must be given, is kept

        Raises InvalidInput also for a field of dimension 3, and where even the coarsest triangles
        are more than max_triangles.
        """
        _require_error(collapse, error, lens)
        projection = _projection(threshold, max_triangles, indicator, blend, lens, error)
        options = (scale, flatness, elements, collapse)
        return Surface._of(
            _nestgrid.height_field(self._source, *options, projection, threads), self
        )

    @takes(points=numbers)
    def probe(
        self,
        points: Any,
        threshold: float | None = None,
        *,
        indicator: Indicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        error: float | None = None,
        threads: int = 0,
    ) -> np.ndarray:
        """The field at points, float64 of their shape without the last axis; nan outside.

        points  of shape (..., 3), or (..., 2) for a field of dimension 2, in units of length

        Raises InvalidInput where points have another shape, and as isosurface().
        """
        width = points.shape[-1] if points.ndim else 0
        if width != 3 and (width != 2 or self.dimension != 2):
            raise InvalidInput(f"probe(): points have {width} coordinates, not {self.dimension}")
        at = np.zeros((*points.shape[:-1], 3))
        at[..., :width] = points
        projection = _projection(threshold, None, indicator, blend, lens, error)
        return _nestgrid.probe(self._source, at, projection, threads).reshape(points.shape[:-1])

    def _size(self) -> str:
        """How large it is, for people."""
        return f"dimension {self.dimension}"

    def _range_text(self) -> str:
        try:
            least, greatest = self.range
        except InvalidInput:
            return "with values that are not finite"
        return f"from {least:.6g} to {greatest:.6g}"

    def __repr__(self) -> str:
        name = f" {self.name!r}" if self.name else ""
        return f"<nestgrid.{type(self).__name__}{name}: {self._size()}, {self._range_text()}>"

    def _rows(self) -> list[tuple[str, str]]:
        return [("size", self._size()), ("values", self._range_text())]

    def _repr_html_(self) -> str:
        rows = [("name", self.name)] if self.name else []
        rows += self._rows()
        if self.unit:
            rows.append(("unit of length", self.unit))
        return _html.table(f"nestgrid.{type(self).__name__}", rows)


def _surface_projection(
    threshold: float | None,
    max_triangles: int | None,
    indicator: SurfaceIndicator,
    blend: float,
    lens: LensLike | None,
    error: float | None,
    distance: float | None,
    collapse: bool,
) -> _nestgrid.Projection:
    """The projection of an isosurface, which has an error and a distance of its own."""
    if collapse and max_triangles is not None and (threshold, error, distance) == (None,) * 3:
        least: Literal["error", "slope"] = "slope" if indicator == "slope" else "error"
        return _nestgrid.Projection(None, max_triangles, least, blend, None)
    if error is None and distance is None:
        return _projection(threshold, max_triangles, indicator, blend, lens, None)
    name = "distance" if error is None else "error"
    value = distance if error is None else error
    alone = (threshold, max_triangles, indicator) == (None, None, "offset")
    if not alone or (error is not None and distance is not None):
        raise InvalidInput(f"{name} is given alone: beside it no other says how fine to draw")
    if value is None or not value > 0:
        raise InvalidInput(f"{name} is not a number > 0: leave it out to draw all detail")
    compiled = lens._lens if isinstance(lens, Lens) else None
    measured: Literal["error", "slope"] = "slope" if error is None else "error"
    return _nestgrid.Projection(value, None, measured, blend, compiled)


def _require_error(collapse: bool, error: float | None, lens: LensLike | None) -> None:
    if collapse and (error is None or lens is not None):
        raise InvalidInput("collapse needs an error, and no lens")


def _projection(
    threshold: float | None,
    max_triangles: int | None,
    indicator: SurfaceIndicator,
    blend: float,
    lens: LensLike | None,
    error: float | None,
) -> _nestgrid.Projection:
    if threshold is not None and max_triangles is not None:
        raise InvalidInput("max_triangles is given alone: it finds the threshold")
    if error is not None:
        if threshold is not None or max_triangles is not None or indicator != "offset":
            raise InvalidInput("error is given alone: it is the threshold of the deviation")
        threshold, indicator = error, "deviation"
    compiled = lens._lens if isinstance(lens, Lens) else None
    return _nestgrid.Projection(threshold, max_triangles, indicator, blend, compiled)
