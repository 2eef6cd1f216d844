# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Lenses: fine in a domain, coarser with the distance from it."""

from __future__ import annotations

import math
from typing import Sequence, Union

from . import _nestgrid
from ._nestgrid import Domain

Numbers = Sequence[float]


def ball(centre: Numbers, radius: float) -> Domain:
    """The points no farther than radius from centre (3 numbers). Domains join by | and &."""
    return _nestgrid.ball(centre, radius)


def box(low: Numbers, high: Numbers) -> Domain:
    """A box with sides along the axes, between two corners of 3 numbers."""
    return _nestgrid.box(low, high)


def half_space(through: Numbers, normal: Numbers) -> Domain:
    """What lies behind the plane through a point; the normal, of any length, points out."""
    return _nestgrid.half_space(through, normal)


def cone(apex: Numbers, towards: Numbers, angle: float) -> Domain:
    """An infinite circular cone; angle, between axis and cone, in radians below pi / 2."""
    return _nestgrid.cone(apex, towards, angle)


def polygon(corners: Sequence[Numbers]) -> Domain:
    """The column above and below a polygon, (n, 2) corners in the plane of x and y."""
    return _nestgrid.polygon(corners)


def view(
    eye: Numbers,
    towards: Numbers,
    up: Numbers = (0, 1, 0),
    angle: float = math.pi / 6,
    aspect: float = 1,
    nearest: float = 0,
    farthest: float = 1e9,
) -> Domain:
    """What a perspective camera shows: angle from the lower to the upper side, in radians."""
    return _nestgrid.frustum(eye, towards, up, angle, aspect, nearest, farthest)


class Lens(_nestgrid.Lens):
    """Elements are at most finest large in the domain, and may grow by slope with the distance
    from it, up to coarsest; all three in the units of the spacing.

    Raises InvalidInput where a number is out of range.
    """

    def __init__(
        self,
        domain: Domain,
        finest: float = 0,
        coarsest: float = math.inf,
        slope: float = 0.5,
    ) -> None:
        super().__init__(domain, finest, coarsest, slope)


#: A lens, a domain, or a ball as (centre, radius).
LensLike = Union[Lens, Domain, "tuple[Numbers, float]"]


def as_lens(lens: LensLike | None) -> Lens | None:
    """The lens of a domain, or of a pair (centre, radius)."""
    if lens is None or isinstance(lens, Lens):
        return lens
    return Lens(lens if isinstance(lens, Domain) else ball(*lens))
