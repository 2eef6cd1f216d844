# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields on hierarchies, and what is drawn of them."""

from __future__ import annotations

import math
from typing import Any, Callable, Iterable, Sequence, Union

import numpy as np

from . import _html, _nestgrid
from ._arguments import (
    Cuts,
    Indicator,
    InvalidType,
    SurfaceIndicator,
    flag,
    function_of_place,
    name_of,
    not_a,
    not_negative,
    number,
    numbers,
    optional,
    several,
    shape,
    takes,
    whole,
)
from ._lens import LensLike, RegionLike
from ._nestgrid import InvalidInput
from ._projection import coloured_projection_of, projection_of, surface_projection_of
from ._results import Lines, Surface

Numbers = Union[Sequence[float], np.ndarray]
Function = Callable[[float, float, float], float]


def _surface(value: Any) -> Surface:
    if not isinstance(value, Surface):
        raise not_a("a Surface, such as isosurface() returns", value)
    return value


class Field:
    """A field on a hierarchy: a Volume, an Octree, Blocks, a loaded file, a time of Frames.

    What an indicator needs is computed once and kept. Methods may be called by several threads at
    once, release the lock of Python while they work, and end with KeyboardInterrupt on Ctrl-C.
    """

    __module__ = "nestgrid"
    _source: _nestgrid.Source
    _name: str
    _unit: str

    def __init__(self) -> None:
        raise InvalidType(
            "a Field is a Volume, an Octree, Blocks, what load() gives, or Frames.at(t)"
        )

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
        region: RegionLike | None = None,
        error: float | None = None,
        position_error: float | None = None,
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
        projection = surface_projection_of(
            threshold, max_triangles, indicator, blend, lens, error, distance, collapse, region,
            position_error,
        )
        if collapse:
            kept = error is not None or distance is not None or max_triangles is not None
            nearest = max_triangles is not None and indicator == "slope"
            other = indicator != "offset" and not nearest
            if not kept or cap or at_nodes or lens is not None or region is not None or other:
                raise InvalidInput(
                    "collapse needs an error, a distance or max_triangles, and neither cap, "
                    "at_nodes, lens, region nor indicator, but for slope beside max_triangles"
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

    @takes(
        levels=numbers,
        indicator=name_of(SurfaceIndicator),
        cap=flag,
        at_nodes=flag,
        cuts=name_of(Cuts),
    )
    def isosurfaces(
        self,
        levels: float | Iterable[float] | np.ndarray,
        threshold: float | None = None,
        *,
        indicator: SurfaceIndicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        region: RegionLike | None = None,
        error: float | None = None,
        position_error: float | None = None,
        normals: bool = True,
        cap: bool = False,
        at_nodes: bool = False,
        cuts: Cuts = "linear",
        elements: bool = False,
        threads: int = 0,
    ) -> list[Surface]:
        """The surfaces of several values, in one pass: what isosurface() draws of each.

        levels    one number or several, in the units of the data
        indicator as elsewhere, or "cut": the error of these surfaces alone; "slope": the distance
        cap       whether to close the surfaces along the boundary of the domain, around what is
                  at least the level
        at_nodes  whether to draw no slivers around nodes at which the field has the value
        cuts      where edges of coarse elements are cut: "linear" between their ends, or "finest",
                  where the finest data have the value

        Raises InvalidInput as isosurface().
        """
        if error is None:
            projection = projection_of(
                threshold, None, indicator, blend, lens, None, region, 0, position_error
            )
        else:
            projection = surface_projection_of(
                threshold, None, indicator, blend, lens, error, None, False, region,
                position_error,
            )
        options = (normals, cap, elements, at_nodes, cuts == "finest")
        drawn = _nestgrid.isosurfaces(
            self._source, several(levels), *options, projection, threads
        )
        return [Surface._of(each, self) for each in drawn]

    @takes(surface=_surface, level=number, points=whole(1, 2**40))
    def measure(
        self, surface: Surface, level: float, points: int = 200_000, threads: int = 0
    ) -> dict[str, float]:
        """How far an isosurface is from the field and from the surface of all its data.

        surface  an isosurface of this field, however coarse
        level    its value
        points   about how many to measure at, on it and on the surface of all data

        Returns the greatest, "..._mean" and "..._rms" of "error": |data - level| on the surface, in
        the units of the data; "distance": from it to the surface of all data, in units of length;
        "distance_back": from that to it; "reach": no point is farther from those that were
        measured; "points": how many these were.

        Raises InvalidInput also for a field of dimension 2.
        """
        return _nestgrid.measure(self._source, surface._data, level, points, threads)

    @takes(low=number, high=number, indicator=name_of(SurfaceIndicator))
    def isoband(
        self,
        low: float,
        high: float,
        threshold: float | None = None,
        max_triangles: int | None = None,
        *,
        indicator: SurfaceIndicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        region: RegionLike | None = None,
        error: float | None = None,
        position_error: float | None = None,
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
        projection = projection_of(
            threshold, max_triangles, indicator, blend, lens, error, region, 0, position_error
        )
        options = (low, high, normals, elements)
        return Surface._of(_nestgrid.isoband(self._source, *options, projection, threads), self)

    @takes(collapse=flag, colour_tolerance=not_negative)
    def boundary(
        self,
        threshold: float | None = None,
        max_triangles: int | None = None,
        *,
        indicator: Indicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        region: RegionLike | None = None,
        error: float | None = None,
        position_error: float | None = None,
        collapse: bool = False,
        colour_tolerance: float = 0,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """The boundary of the domain, closed, with the field at its vertices as attributes[:, 0].

        collapse  whether to take edges away while error is kept, or down to max_triangles of the
                  least error: one of these must be given
        colour_tolerance  split triangles until colours follow the field within this, in the units
                  of the data; 0: not at all

        Hidden data are outside. Raises InvalidInput also for a field of dimension 2.
        """
        projection = coloured_projection_of(
            threshold, max_triangles, indicator, blend, lens, error, region, collapse,
            colour_tolerance, position_error
        )
        options = (elements, collapse)
        return Surface._of(
            _nestgrid.boundary(self._source, *options, projection, threads), self
        )

    @takes(
        plane=optional(shape(("the point", 3), ("the normal", 3))),
        sphere=optional(shape(("the centre", 3), ("the radius", 0))),
        cylinder=optional(shape(("the point", 3), ("the axis", 3), ("the radius", 0))),
        function=optional(function_of_place),
        distance=optional(number),
        collapse=flag,
        colour_tolerance=not_negative,
    )
    def slice(
        self,
        *,
        plane: tuple[Numbers, Numbers] | None = None,
        sphere: tuple[Numbers, float] | None = None,
        cylinder: tuple[Numbers, Numbers, float] | None = None,
        function: Function | tuple[Function, float] | None = None,
        threshold: float | None = None,
        max_triangles: int | None = None,
        indicator: Indicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        region: RegionLike | None = None,
        error: float | None = None,
        position_error: float | None = None,
        distance: float | None = None,
        collapse: bool = False,
        colour_tolerance: float = 0,
        normals: bool = False,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """A slice, with the field at its vertices as attributes[:, 0], continuous everywhere.

        plane     (point, normal), 3 numbers each; the normal of any length
        sphere    (centre, radius), 3 numbers and one, in units of length
        cylinder  (point on the axis, axis, radius), 3 numbers, 3 of any length, and one
        function  whose zero it is: continuous, of three numbers x, y, z; or (function, steepness),
                  where its values at two points differ by at most steepness times their distance:
                  without one, it is called for all elements
        distance  of what is no plane, with collapse: no point of what is left is farther from the
                  slice of all data, and none of that from what is left, in units of length.
                  None: the slice keeps its place
        collapse  whether to take edges away while error is kept, or down to max_triangles of the
                  least error: one of these must be given
        colour_tolerance  split triangles until colours follow the field within this, in the units
                  of the data; 0: not at all

        Raises InvalidInput unless there is one of plane, sphere, cylinder and function, and as
        isosurface(); what the function raises, and TypeError where it gives no number.
        """
        given = {"plane": plane, "sphere": sphere, "cylinder": cylinder, "function": function}
        shapes = [(name, each) for name, each in given.items() if each is not None]
        if len(shapes) != 1:
            raise InvalidInput("slice(): a slice needs one of plane, sphere, cylinder and function")
        ((name, parts),) = shapes
        along = getattr(_nestgrid, name)(*parts)
        if distance is not None:
            if not collapse or plane is not None:
                raise InvalidInput("distance needs collapse, and a slice that is no plane")
            if not distance > 0:
                raise InvalidInput("distance is not a number > 0: leave it out to keep the place")
        projection = coloured_projection_of(
            threshold, max_triangles, indicator, blend, lens, error, region, collapse,
            colour_tolerance, position_error
        )
        options = (normals, elements, collapse, distance or 0)
        return Surface._of(
            _nestgrid.slice(self._source, along, *options, projection, threads), self
        )

    @takes(values=numbers, max_segments=optional(whole(1)))
    def isolines(
        self,
        values: float | Iterable[float] | np.ndarray,
        threshold: float | None = None,
        max_segments: int | None = None,
        *,
        indicator: Indicator = "offset",
        blend: float = 1,
        lens: LensLike | None = None,
        region: RegionLike | None = None,
        error: float | None = None,
        position_error: float | None = None,
        threads: int = 0,
    ) -> Lines:
        """Lines on which a two-dimensional field has the given values, in one pass.

        values        one number or several, in the units of the data
        max_segments  the least threshold at which all lines together have so many segments

        Raises InvalidInput also for a field of dimension 3: its slices have isolines().
        """
        projection = projection_of(
            threshold, max_segments, indicator, blend, lens, error, region, 0, position_error
        )
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
        region: RegionLike | None = None,
        error: float | None = None,
        position_error: float | None = None,
        collapse: bool = False,
        elements: bool = False,
        threads: int = 0,
    ) -> Surface:
        """The graph z = scale * field of a two-dimensional field, with it as attributes[:, 0].

        scale     units of length per unit of the data; None: the triangles stay in the plane
        flatness  at least 0, in the units of the data: quadrilaterals that differ by more from two
                  triangles get a vertex in their middle
        collapse  whether to take edges away while error is kept, or down to max_triangles of the
                  least error: one of these must be given

        Raises InvalidInput also for a field of dimension 3, and where even the coarsest triangles
        are more than max_triangles.
        """
        projection = coloured_projection_of(
            threshold, max_triangles, indicator, blend, lens, error, region, collapse, 0,
            position_error,
        )
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
        region: RegionLike | None = None,
        error: float | None = None,
        position_error: float | None = None,
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
        projection = projection_of(
            threshold, None, indicator, blend, lens, error, region, 0, position_error
        )
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
