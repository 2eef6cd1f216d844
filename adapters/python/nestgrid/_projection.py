# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""How finely a field is drawn: the arguments of its methods as one value."""

from __future__ import annotations

from typing import Literal

from . import _nestgrid
from ._arguments import Indicator, SurfaceIndicator
from ._lens import Lens, LensLike, Region, RegionLike
from ._nestgrid import InvalidInput


def surface_projection_of(
    threshold: float | None,
    max_triangles: int | None,
    indicator: SurfaceIndicator,
    blend: float,
    lens: LensLike | None,
    error: float | None,
    distance: float | None,
    collapse: bool,
    region: RegionLike | None,
    position_error: float | None,
) -> _nestgrid.Projection:
    """The projection of an isosurface, which has an error and a distance of its own."""
    if collapse and max_triangles is not None and (threshold, error, distance) == (None,) * 3:
        least: Literal["error", "slope"] = "slope" if indicator == "slope" else "error"
        return _nestgrid.Projection(
            None, max_triangles, least, blend, None, None, 0, position_error
        )
    if error is None and distance is None:
        return projection_of(
            threshold, max_triangles, indicator, blend, lens, None, region, 0, position_error
        )
    name = "distance" if error is None else "error"
    value = distance if error is None else error
    alone = (threshold, max_triangles, indicator) == (None, None, "offset")
    if not alone or (error is not None and distance is not None):
        raise InvalidInput(f"{name} is given alone: beside it no other says how fine to draw")
    if value is None or not value > 0:
        raise InvalidInput(f"{name} is not a number > 0: leave it out to draw all detail")
    measured: Literal["error", "slope"] = "slope" if error is None else "error"
    where = _where(lens, region)
    return _nestgrid.Projection(value, None, measured, blend, *where, 0, position_error)


def coloured_projection_of(
    threshold: float | None,
    max_triangles: int | None,
    indicator: Indicator,
    blend: float,
    lens: LensLike | None,
    error: float | None,
    region: RegionLike | None,
    collapse: bool,
    colour_tolerance: float,
    position_error: float | None,
) -> _nestgrid.Projection:
    """The projection of a surface in the colours of the field."""
    if not collapse:
        return projection_of(
            threshold, max_triangles, indicator, blend, lens, error, region, colour_tolerance,
            position_error,
        )
    kept = (error is None) != (max_triangles is None)
    if not kept or lens is not None or region is not None or indicator != "offset":
        raise InvalidInput(
            "collapse needs an error or max_triangles, and neither lens, region nor indicator"
        )
    if max_triangles is None:
        return projection_of(
            threshold, None, indicator, blend, None, error, None, colour_tolerance,
            position_error,
        )
    if threshold is not None:
        raise InvalidInput("max_triangles is given alone: it finds the threshold")
    return _nestgrid.Projection(
        None, max_triangles, "error", blend, None, None, colour_tolerance, position_error
    )


def _where(
    lens: LensLike | None, region: RegionLike | None
) -> tuple[_nestgrid.Lens | None, _nestgrid.Region | None]:
    return (
        lens._lens if isinstance(lens, Lens) else None,
        region._region if isinstance(region, Region) else None,
    )


def projection_of(
    threshold: float | None,
    max_triangles: int | None,
    indicator: SurfaceIndicator,
    blend: float,
    lens: LensLike | None,
    error: float | None,
    region: RegionLike | None,
    colour_tolerance: float = 0,
    position_error: float | None = None,
) -> _nestgrid.Projection:
    if threshold is not None and max_triangles is not None:
        raise InvalidInput("max_triangles is given alone: it finds the threshold")
    if error is not None:
        if threshold is not None or max_triangles is not None or indicator != "offset":
            raise InvalidInput("error is given alone: it is the threshold of the deviation")
        threshold, indicator = error, "deviation"
    where = _where(lens, region)
    return _nestgrid.Projection(
        threshold, max_triangles, indicator, blend, *where, colour_tolerance, position_error
    )
