# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Lenses and regions: fine in a domain, coarser outside."""

from __future__ import annotations

import math
from typing import Any, Sequence, Union

import numpy as np

from . import _nestgrid
from ._arguments import (
    SHARED,
    Argument,
    InvalidType,
    Unfit,
    not_a,
    not_negative,
    number,
    numbers,
    optional,
    point,
    shape,
    takes,
)

Numbers = Union[Sequence[float], np.ndarray]


class Domain:
    """Where a lens or a region is fine.

    ball(), box(), half_space(), cone(), polygon() and view() return domains;
    a | b is the union of two domains, a & b what they share.
    """

    __module__ = "nestgrid"
    _domain: _nestgrid.Domain
    _made_by: tuple[str, tuple[Any, ...]]

    def __init__(self) -> None:
        raise InvalidType(
            "a Domain is made by ball(), box(), half_space(), cone(), polygon() or view()"
        )

    @classmethod
    def _of(cls, function: str, *arguments: Any) -> Domain:
        """The domain that a function of this module, "|" or "&" makes of arguments."""
        if function in ("|", "&"):
            a, b = (each._domain for each in arguments)
            domain = a.union_with(b) if function == "|" else a.intersection(b)
        else:
            domain = getattr(_nestgrid, function)(*arguments)
        made = cls.__new__(cls)
        made._domain = domain
        made._made_by = (function, arguments)
        return made

    def __or__(self, other: Domain) -> Domain:
        return Domain._of("|", self, other) if isinstance(other, Domain) else NotImplemented

    def __and__(self, other: Domain) -> Domain:
        return Domain._of("&", self, other) if isinstance(other, Domain) else NotImplemented

    def __reduce__(self) -> tuple[Any, ...]:
        function, arguments = self._made_by
        return Domain._of, (function, *arguments)

    def __repr__(self) -> str:
        function, arguments = self._made_by
        if function in ("|", "&"):
            return f"({arguments[0]!r} {function} {arguments[1]!r})"
        shown = [each.tolist() if isinstance(each, np.ndarray) else each for each in arguments]
        name = "view" if function == "frustum" else function
        return f"nestgrid.{name}({', '.join(str(each) for each in shown)})"


def _polygon(value: Any) -> np.ndarray:
    corners = numbers(value)
    if corners.ndim != 2 or corners.shape[1] != 2:
        raise not_a("corners of the shape (n, 2)", corners)
    return corners


@takes(centre=point, radius=not_negative)
def ball(centre: Numbers, radius: float) -> Domain:
    """The points no farther than radius from centre. Domains join by | and &.

    centre  3 numbers, in units of length
    radius  at least 0, in units of length

    Raises InvalidInput where the radius is negative.
    """
    return Domain._of("ball", centre, radius)


@takes(low=point, high=point)
def box(low: Numbers, high: Numbers) -> Domain:
    """A box with sides along the axes.

    low   the corner with the least coordinates, 3 numbers in units of length
    high  the corner with the greatest coordinates

    Raises InvalidInput where the box is empty.
    """
    return Domain._of("box", low, high)


@takes(through=point, normal=point)
def half_space(through: Numbers, normal: Numbers) -> Domain:
    """What lies behind a plane.

    through  a point of the plane, 3 numbers in units of length
    normal   of any length, 3 numbers; it points out

    Raises InvalidInput where the normal is 0.
    """
    return Domain._of("half_space", through, normal)


@takes(apex=point, towards=point, angle=number)
def cone(apex: Numbers, towards: Numbers, angle: float) -> Domain:
    """An infinite circular cone.

    apex     3 numbers, in units of length
    towards  the direction of the axis, of any length, 3 numbers
    angle    between axis and cone, in radians, more than 0 and below pi / 2

    Raises InvalidInput where the direction is 0 or the angle out of range.
    """
    return Domain._of("cone", apex, towards, angle)


@takes(corners=_polygon)
def polygon(corners: Any) -> Domain:
    """The column above and below a polygon in the plane of x and y.

    corners  (n, 2) numbers, in units of length; n at least 3

    Raises InvalidInput for fewer than 3 corners.
    """
    return Domain._of("polygon", corners)


@takes(
    eye=point,
    towards=point,
    up=point,
    angle=number,
    aspect=number,
    nearest=not_negative,
    farthest=not_negative,
)
def view(
    eye: Numbers,
    towards: Numbers,
    up: Numbers = (0, 1, 0),
    angle: float = math.pi / 6,
    aspect: float = 1,
    nearest: float = 0,
    farthest: float = 1e9,
) -> Domain:
    """What a perspective camera shows.

    eye       where the camera is, 3 numbers in units of length
    towards   the direction in which it looks, of any length, 3 numbers
    up        the direction that is up in the picture, 3 numbers
    angle     from the lower to the upper side of the picture, in radians below pi
    aspect    width of the picture divided by its height
    nearest   distance from the eye at which the domain begins, in units of length
    farthest  distance at which it ends

    Raises InvalidInput where a direction is 0 or a number out of range.
    """
    return Domain._of("frustum", eye, towards, up, angle, aspect, nearest, farthest)


def _domain(value: Any) -> Domain:
    if not isinstance(value, Domain):
        raise not_a("a Domain, such as nestgrid.ball(centre, radius)", value)
    return value


class Lens:
    """Elements are at most finest large in the domain, and may grow with the distance from it.

    domain    where to draw finely: ball(), box(), ..., joined by | and &
    finest    greatest size of elements in the domain, in units of length; 0: as fine as there are
    coarsest  greatest size anywhere, in units of length
    slope     at least 0: how fast sizes may grow, in lengths per length of distance

    Raises InvalidInput where a number is out of range.
    """

    __module__ = "nestgrid"

    @takes(domain=_domain, finest=not_negative, coarsest=not_negative, slope=not_negative)
    def __init__(
        self,
        domain: Domain,
        finest: float = 0,
        coarsest: float = math.inf,
        slope: float = 0.5,
    ) -> None:
        self._arguments = (domain, finest, coarsest, slope)
        self._lens = _nestgrid.Lens(domain._domain, finest, coarsest, slope)

    @property
    def domain(self) -> Domain:
        """Where it is fine."""
        return self._arguments[0]

    @property
    def finest(self) -> float:
        """The greatest size of elements in the domain, in units of length."""
        return self._arguments[1]

    @property
    def coarsest(self) -> float:
        """The greatest size of elements anywhere, in units of length."""
        return self._arguments[2]

    @property
    def slope(self) -> float:
        """How fast sizes may grow, in lengths per length of distance."""
        return self._arguments[3]

    def __reduce__(self) -> tuple[Any, ...]:
        return Lens, self._arguments

    def __repr__(self) -> str:
        return (
            f"nestgrid.Lens({self.domain!r}, finest={self.finest:g}, "
            f"coarsest={self.coarsest:g}, slope={self.slope:g})"
        )


#: A lens, a domain, or a ball as (centre, radius).
LensLike = Union[Lens, Domain, "tuple[Numbers, float]"]


def as_lens(value: Any) -> Lens:
    """The lens of a domain, or of a pair (centre, radius)."""
    if isinstance(value, Lens):
        return value
    if isinstance(value, Domain):
        return Lens(value)
    try:
        centre, radius = shape(("the centre", 3), ("the radius", 0))(value)
    except Unfit as unfit:
        raise Unfit(f"{unfit}; it is a Lens, a Domain, or (centre, radius)", unfit.error) from None
    return Lens(ball(centre, radius))


class Region:
    """A domain in which another threshold holds.

    domain     where: ball(), box(), ..., joined by | and &
    threshold  at least 0, in the units of the indicator; 0: all detail

    Raises InvalidInput where the threshold is negative.
    """

    __module__ = "nestgrid"

    @takes(domain=_domain, threshold=not_negative)
    def __init__(self, domain: Domain, threshold: float = 0) -> None:
        self._arguments = (domain, threshold)
        self._region = _nestgrid.Region(domain._domain, threshold)

    @property
    def domain(self) -> Domain:
        """Where the threshold holds."""
        return self._arguments[0]

    @property
    def threshold(self) -> float:
        """The threshold inside, in the units of the indicator."""
        return self._arguments[1]

    def __reduce__(self) -> tuple[Any, ...]:
        return Region, self._arguments

    def __repr__(self) -> str:
        return f"nestgrid.Region({self.domain!r}, threshold={self.threshold:g})"


#: A region, or a domain in which everything is drawn.
RegionLike = Union[Region, Domain]


def as_region(value: Any) -> Region:
    """The region of a domain."""
    if isinstance(value, Region):
        return value
    if isinstance(value, Domain):
        return Region(value)
    raise not_a("a Region or a Domain, such as nestgrid.box(low, high)", value)


SHARED["region"] = Argument(
    optional(as_region),
    "where another threshold holds: a Region, or a Domain (ball(), box(), ...) for all detail",
)
SHARED["lens"] = Argument(
    optional(as_lens),
    "where to draw finely: a Lens, a Domain (ball(), box(), ...) or (centre, radius)",
)
