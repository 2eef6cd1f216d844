# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of NumPy arrays: on lattices, at several times, and on octrees."""

from __future__ import annotations

from typing import Any, Literal, Sequence, Union

import numpy as np

from . import _arguments as kinds
from . import _html, _nestgrid
from ._arguments import (
    flag,
    name_of,
    number,
    numbers,
    optional,
    samples,
    sequence,
    takes,
    whole,
)
from ._fields import Field
from ._nestgrid import InvalidInput

Numbers = Union[Sequence[float], np.ndarray]
#: How values of cells become values at nodes.
Rule = Literal["smooth", "centres", "means"]


class Volume(Field):
    """Samples on a regular lattice, in an array that is borrowed and not copied.

    array      2 or 3 indices; index d runs along coordinate d. Integers of 8 to 64 bits, float32
               or float64, in C or Fortran order, or with any other order of the indices, without
               gaps. Nothing is drawn beside samples that are nan, or masked (numpy.ma; copied)
    spacing    distance of samples along each index, in units of length; None: 1
    origin     position of array[0, 0, 0]; None: 0
    direction  (d, d) for d indices: column i is the axis of index i in space, such as that of a
               scanner; (3, 2) for 2 indices, with an origin of 3 numbers; None: coordinate i
    name       of the data, for files and tables
    unit       of length, such as "mm"

    Raises InvalidInput where the array has gaps (numpy.ascontiguousarray copies it), another type,
    or fewer than 2 samples along an index.
    """

    __module__ = "nestgrid"

    @takes(array=samples)
    def __init__(
        self,
        array: np.ndarray,
        spacing: Numbers | None = None,
        origin: Numbers | None = None,
        *,
        direction: Numbers | None = None,
        name: str = "",
        unit: str = "",
    ) -> None:
        self._array = array
        self._place = _placed(array.ndim, spacing, origin, direction)
        self._set(_nestgrid.volume(array, *self._place), name, unit)

    @property
    def array(self) -> np.ndarray:
        """The samples, borrowed."""
        return self._array

    @property
    def spacing(self) -> tuple[float, ...]:
        """The distance of samples along each index, in units of length."""
        return tuple(self._place[0].tolist())

    @property
    def origin(self) -> tuple[float, ...]:
        """The position of the first sample."""
        return tuple(self._place[1].tolist())

    @property
    def direction(self) -> np.ndarray:
        """(d, d) for d indices: column i is the axis of index i in space."""
        return self._place[2].copy()

    def _size(self) -> str:
        return f"{' x '.join(str(n) for n in self._array.shape)} samples of {self._array.dtype}"

    def _range_text(self) -> str:
        missing = 0
        if self._array.dtype.kind == "f":
            missing = np.count_nonzero(np.isnan(self._array))
        least, greatest = np.nanmin(self._array), np.nanmax(self._array)
        if not np.isfinite(float(least)) or not np.isfinite(float(greatest)):
            return "with values that are not finite"
        text = f"from {float(least):.6g} to {float(greatest):.6g}"
        return text + (f", {missing} of them missing" if missing else "")

    def _rows(self) -> list[tuple[str, str]]:
        place = [
            (what, ", ".join(f"{x:.6g}" for x in numbers))
            for what, numbers in (("spacing", self.spacing), ("origin", self.origin))
        ]
        return super()._rows() + place

    def __reduce__(self) -> tuple[Any, ...]:
        return _volume_of, (_ordered(self._array), self._place, self._name, self._unit)


class Octree(Field):
    """Leaves of an octree (quadtree), or of a forest of them; they are copied and sorted.

    leaves       (n, 4) integers x, y, z, level ((n, 3): x, y, level): the lowest corner of each
                 leaf in cells of max_level, and its level, that of a root being 0
    values       (n,): of the leaves, from which nodes get means that are exact for linear
                 functions; or (n, 8) ((n, 4)): at the corners of the leaves, x fastest,
                 equal where leaves meet. From numbered nodes: values_at_nodes[nodes_of_leaves]
    factor       2, or 3 where elements are divided by three along each direction
    max_level    0 to 20 (13): a root is factor**max_level cells wide; None: the greatest level
    spacing      size of a cell of max_level, in units of length; None: 1
    origin       position of the corner (0, 0, 0); None: 0
    coordinates  in the place of spacing and origin: of the corners of roots, one ascending sequence
                 for each direction. Those of a plane in space are three, one of a single number
    masked       (n,): leaves that are not drawn, as those with a value that is nan; None: all are
    rule         of values of leaves, (n,): what Blocks() has
    name         of the data, for files and tables
    unit         of length, such as "mm"

    Raises InvalidInput where leaves overlap or leave gaps in a root, and where values differ.
    """

    __module__ = "nestgrid"
    _octree: _nestgrid.OctreeFrames

    @takes(
        leaves=kinds.array,
        values=numbers,
        factor=whole(2, 3),
        max_level=optional(whole(0, 20)),
        coordinates=optional(sequence(numbers, "one sequence of numbers for each direction")),
        masked=optional(kinds.array),
        rule=name_of(Rule),
    )
    def __init__(
        self,
        leaves: np.ndarray,
        values: np.ndarray,
        *,
        factor: int = 2,
        max_level: int | None = None,
        spacing: Numbers | None = None,
        origin: Numbers | None = None,
        coordinates: Sequence[Numbers] | None = None,
        masked: np.ndarray | None = None,
        rule: Rule = "smooth",
        name: str = "",
        unit: str = "",
    ) -> None:
        if leaves.ndim != 2 or leaves.shape[1] not in (3, 4) or leaves.dtype.kind not in "iu":
            raise InvalidInput(
                "Octree(): leaves are no array of integers of the shape (n, 4) or (n, 3)"
            )
        if not len(leaves):
            raise InvalidInput("Octree(): the octree has no leaves")
        if rule != "smooth" and values.size != len(leaves):
            raise InvalidInput("Octree(): rule is for one value for each leaf")
        leaves = np.ascontiguousarray(leaves, np.int64)
        dimension = leaves.shape[1] - 1
        if max_level is None:
            max_level = int(leaves[:, -1].max())
        most = 20 if factor == 2 else 13
        if not 0 <= max_level <= most:
            raise InvalidInput(f"Octree(): max_level is {max_level}, not 0 to {most}")
        if coordinates is None:
            step, start, _ = _placed(dimension, spacing, origin)
            for what, given in (("spacing", step), ("origin", start)):
                if given.shape != (dimension,):
                    raise InvalidInput(
                        f"Octree(): {what} has {given.size} numbers, but leaves {dimension} "
                        "coordinates"
                    )
            width = factor**max_level
            roots = np.maximum(leaves[:, :-1].max(axis=0) // width, 0) + 1
            coordinates = [
                start[d] + step[d] * float(width) * np.arange(roots[d] + 1)
                for d in range(dimension)
            ]
        elif len(coordinates) < dimension:
            raise InvalidInput(
                f"Octree(): there are coordinates for {len(coordinates)} directions only"
            )
        along = [np.ravel(x) for x in coordinates] + [np.zeros(1)] * (3 - len(coordinates))
        hidden = np.zeros(0, np.uint8) if masked is None else (masked != 0).astype(np.uint8)
        self._built_of = (max_level, factor, along)
        self._count = len(leaves)
        self._octree = _nestgrid.octree(leaves, [values], [0], hidden, *self._built_of, [], rule)
        self._set(self._octree.first(), name, unit)

    def _size(self) -> str:
        level = self._built_of[0]
        return f"{self._count} leaves of dimension {self.dimension}, up to level {level}"

    def __reduce__(self) -> tuple[Any, ...]:
        leaves, values, masked = self._octree.leaves()
        hidden = masked if len(masked) else None
        return _octree_of, (leaves, values[0], hidden, *self._built_of, self._name, self._unit)


class Frames:
    """Frames of one field at several times; fields between them need no computation of their own.

    Made of arrays here, and of .nestgrid files by load().

    arrays     of one shape, type and order, as for Volume; borrowed
    times      ascending, one for each; None: 0, 1, 2, ...
    spacing    distance of samples along each index, in units of length; None: 1
    origin     position of the first sample; None: 0
    direction  as for Volume
    name       of the data, for files and tables
    unit       of length, such as "mm"

    Raises InvalidInput where arrays differ, or times do not ascend.
    """

    __module__ = "nestgrid"
    _frames: _nestgrid.Frames
    _arrays: list[np.ndarray]

    @takes(
        arrays=sequence(samples, "a sequence of arrays"),
        times=optional(numbers),
    )
    def __init__(
        self,
        arrays: Sequence[np.ndarray],
        times: Sequence[float] | None = None,
        spacing: Numbers | None = None,
        origin: Numbers | None = None,
        *,
        direction: Numbers | None = None,
        name: str = "",
        unit: str = "",
    ) -> None:
        if not arrays:
            raise InvalidInput("Frames(): there are no frames")
        at = np.arange(float(len(arrays))) if times is None else np.ravel(times)
        self._arrays = list(arrays)
        self._place = _placed(arrays[0].ndim, spacing, origin, direction)
        self._name = name
        self._unit = unit
        self._frames = _nestgrid.Frames(self._arrays, at.tolist(), *self._place)

    @property
    def times(self) -> list[float]:
        """Those of the frames."""
        return self._frames.times

    @property
    def name(self) -> str:
        """The name of the data, "" where none is known."""
        return self._name

    @property
    def unit(self) -> str:
        """The unit of length, such as "mm"; "" where none is known."""
        return self._unit

    @takes(t=number, cubic=flag)
    def at(self, t: float, cubic: bool = False, threads: int = 0) -> Field:
        """The field at a time from the first to the last one, with bounds from those of the frames.

        t      in the units of times
        cubic  whether values follow cubic polynomials (Catmull and Rom) in the place of lines

        Other indicators than "offset" are computed anew at each time.

        Raises InvalidInput where the time is not between those of the frames.
        """
        return FrameField._of(self, t, cubic, threads)

    def changed(self) -> None:
        """Forgets what was computed of the values: call it after changing an array."""
        self._frames.clear()

    def __len__(self) -> int:
        return len(self.times)

    def _size(self) -> str:
        shape = " x ".join(str(n) for n in self._arrays[0].shape)
        return f"{shape} samples of {self._arrays[0].dtype}"

    def _range_text(self) -> str:
        least = min(float(each.min()) for each in self._arrays)
        return f"from {least:.6g} to {max(float(each.max()) for each in self._arrays):.6g}"

    def __repr__(self) -> str:
        return (
            f"<nestgrid.Frames: {len(self)} frames, times {self.times[0]:.6g} to "
            f"{self.times[-1]:.6g}, {self._size()}, {self._range_text()}>"
        )

    def _repr_html_(self) -> str:
        rows = [
            ("frames", str(len(self))),
            ("times", f"{self.times[0]:.6g} to {self.times[-1]:.6g}"),
            ("size", self._size()),
            ("values", self._range_text()),
        ]
        return _html.table("nestgrid.Frames", rows)

    def __reduce__(self) -> tuple[Any, ...]:
        arrays = [_ordered(each) for each in self._arrays]
        return _frames_of, (arrays, self.times, self._place, self._name, self._unit)


class OctreeFrames(Frames):
    """The leaves of an octree at several times, from files."""

    _frames: _nestgrid.OctreeFrames

    @classmethod
    def _of(
        cls,
        leaves: np.ndarray,
        values: list[np.ndarray],
        times: list[float],
        masked: np.ndarray,
        built_of: tuple[int, int, list[np.ndarray]],
        names: list[str],
        name: str,
        unit: str = "",
        rule: Rule = "smooth",
    ) -> OctreeFrames:
        """names are those of files, for sentences; the rest is as for Octree."""
        frames = cls.__new__(cls)
        frames._frames = _nestgrid.octree(leaves, values, times, masked, *built_of, names, rule)
        frames._count = len(leaves)
        frames._built_of = built_of
        frames._name = name
        frames._unit = unit
        return frames

    def _size(self) -> str:
        dimension, level = self.at(self.times[0]).dimension, self._built_of[0]
        return f"{self._count} leaves of dimension {dimension}, up to level {level}"

    def _range_text(self) -> str:
        ranges = [self.at(t).range for t in self.times]
        return f"from {min(r[0] for r in ranges):.6g} to {max(r[1] for r in ranges):.6g}"

    def __reduce__(self) -> tuple[Any, ...]:
        leaves, values, masked = self._frames.leaves()
        names: list[str] = []
        place = (self._built_of, names, self._name, self._unit)
        return OctreeFrames._of, (leaves, values, self.times, masked, *place)

    _count: int
    _built_of: tuple[int, int, list[np.ndarray]]


class FrameField(Field):
    """The field of Frames at a time."""

    @classmethod
    def _of(cls, frames: Frames, t: float, cubic: bool, threads: int = 0) -> FrameField:
        field = cls.__new__(cls)
        field._at = (frames, t, cubic)
        field._set(frames._frames.at(t, cubic, threads), frames.name, frames.unit)
        return field

    def _size(self) -> str:
        frames, t, _ = self._at
        return f"time {t:.6g}, {frames._size()}"

    def __reduce__(self) -> tuple[Any, ...]:
        return FrameField._of, self._at

    _at: tuple[Frames, float, bool]


Place = tuple[np.ndarray, np.ndarray, np.ndarray]


def _placed(
    dimension: int,
    spacing: Numbers | None,
    origin: Numbers | None,
    direction: Numbers | None = None,
) -> Place:
    steps = np.ones(dimension) if spacing is None else np.asarray(spacing, float)
    start = np.zeros(dimension) if origin is None else np.asarray(origin, float)
    axes = np.eye(dimension) if direction is None else np.asarray(direction, float)
    wrong = steps[~(np.isfinite(steps) & (steps > 0))]
    if wrong.size:
        raise InvalidInput(f"spacing has a number that is not finite and > 0: {wrong[0]:g}")
    for what, numbers in (("origin", start), ("direction", axes)):
        if not np.isfinite(numbers).all():
            raise InvalidInput(f"{what} has a number that is not finite")
    return steps, start, axes


def _ordered(array: np.ndarray) -> tuple[np.ndarray, list[int]]:
    """The array in C order, and the permutation of its indices that gives it back."""
    order = sorted(range(array.ndim), key=lambda d: -array.strides[d])
    return array.transpose(order), np.argsort(order).tolist()


def _volume_of(ordered: tuple[np.ndarray, list[int]], place: Place, name: str, unit: str) -> Volume:
    array, order = ordered
    spacing, origin, direction = place
    return Volume(
        array.transpose(order), spacing, origin, direction=direction, name=name, unit=unit
    )


def _frames_of(
    arrays: list[tuple[np.ndarray, list[int]]],
    times: list[float],
    place: Place,
    name: str,
    unit: str,
) -> Frames:
    spacing, origin, direction = place
    restored = [array.transpose(order) for array, order in arrays]
    return Frames(restored, times, spacing, origin, direction=direction, name=name, unit=unit)


def _octree_of(
    leaves: np.ndarray,
    values: np.ndarray,
    masked: np.ndarray | None,
    max_level: int,
    factor: int,
    coordinates: list[np.ndarray],
    name: str,
    unit: str,
) -> Octree:
    return Octree(
        leaves,
        values,
        max_level=max_level,
        factor=factor,
        coordinates=coordinates,
        masked=masked,
        name=name,
        unit=unit,
    )
