# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of boxes of cells on levels."""

from __future__ import annotations

from typing import Any, Sequence

import numpy as np

from . import _arguments as kinds
from . import _nestgrid
from ._arguments import Unfit, name_of, not_a, optional, sequence, takes, whole
from ._fields import Field
from ._nestgrid import InvalidInput
from ._sources import Frames, Numbers, Rule, _placed

Box = tuple[int, Sequence[int], np.ndarray]


def _box(value: Any) -> tuple[int, list[int], np.ndarray]:
    """Level, lowest cell and array of a box."""
    if not isinstance(value, (tuple, list)) or len(value) != 3:
        raise not_a("a level, a lowest cell and an array", value)
    try:
        level = whole(0, 30)(value[0])
        lower = sequence(whole(-(1 << 30), 1 << 30), "the lowest cell")(value[1])
        array = kinds.array(value[2])
    except Unfit as unfit:
        raise Unfit(f"is no box: a part of it {unfit}", unfit.error) from None
    return level, lower, array


def _ratio(value: Any) -> int | list[int]:
    if isinstance(value, (list, tuple, np.ndarray)):
        return sequence(whole(2, 1 << 20), "whole numbers")(value)
    return whole(2, 1 << 20)(value)


class Blocks(Field):
    """Boxes of cells on levels, as codes for block-structured AMR have them; arrays are borrowed.

    boxes    a sequence of (level, lower, array): array[i, j, k] (array[i, j]) is the value of the
             cell lower + (i, j, k) of the level, counted over the whole domain. Cells that a finer
             box covers may hold anything. Level 0 fills a box, and each further level lies within
             the boxes of the one before. Arrays of float32 stay so where all are; others that are
             not float64 are copied
    ratio    how many cells of the next level there are along a side of a cell, a power of two; or
             one number for each level but the first
    spacing  size of the cells of level 0, in units of length; None: 1
    origin   where the first cell of level 0 begins, by index, or three numbers; None: 0
    axes     of space along which the indices go, ascending: (1, 2) is a plane across x; None: the
             first ones
    rule     of the values at nodes: "smooth" means, or sharper ones that take the values for those
             at "centres", or for "means" over cells, as finite volumes have them
    name     of the data, for files and tables
    unit     of length, such as "mm"

    Leaves with the value nan, or masked ones, are not drawn. Raises InvalidInput where boxes
    overlap, are not aligned to the ratio or do not lie in the level before.
    """

    __module__ = "nestgrid"

    @takes(
        boxes=sequence(_box, "a sequence of boxes"),
        ratio=_ratio,
        axes=optional(sequence(whole(0, 2), "axes from 0 to 2")),
        rule=name_of(Rule),
    )
    def __init__(
        self,
        boxes: Sequence[Box],
        *,
        ratio: int | Sequence[int] = 2,
        spacing: Numbers | None = None,
        origin: Numbers | None = None,
        axes: Sequence[int] | None = None,
        rule: Rule = "smooth",
        name: str = "",
        unit: str = "",
    ) -> None:
        if not boxes:
            raise InvalidInput("Blocks(): there are no boxes")
        dimension = boxes[0][2].ndim
        for i, (_, lower, array) in enumerate(boxes):
            if array.ndim not in (2, 3) or array.ndim != dimension or len(lower) != dimension:
                raise InvalidInput(
                    f"Blocks(): box {i} has an array of {array.ndim} indices and a lowest cell of "
                    f"{len(lower)} numbers: all boxes need 2 of both, or 3"
                )
            if array.size == 0 or max(array.shape) > 1 << 20:
                raise InvalidInput(f"Blocks(): box {i} has no cells, or more than 2^20 on a side")
        levels = 1 + max(level for level, _, _ in boxes)
        ratios = [ratio] * (levels - 1) if isinstance(ratio, int) else list(ratio)
        if len(ratios) != levels - 1:
            raise InvalidInput(
                f"Blocks(): there are {len(ratios)} ratios for {levels} levels: one for each but "
                "the first is needed"
            )
        step, start, _ = _placed(dimension, spacing, origin)
        along = list(range(dimension)) if axes is None else list(axes)
        if len(along) != dimension or along != sorted(set(along)):
            raise InvalidInput(f"Blocks(): axes are {along}, not {dimension} that ascend")
        single = all(array.dtype == np.float32 for _, _, array in boxes)
        kind = np.float32 if single else np.float64
        arrays = [np.asarray(array, kind) for _, _, array in boxes]
        if all(np.isnan(array).all() for array in arrays):
            raise InvalidInput("Blocks(): no cell has a value")
        self._built_of = (
            [
                (level, lower, array.copy() if 0 in array.strides else array)  # as broadcast ones
                for (level, lower, _), array in zip(boxes, arrays)
            ],
            ratios,
            step,
            start,
            along,
            rule,
        )
        place = (step, start, along, rule)
        self._set(_nestgrid.blocks(self._built_of[0], [1, *ratios], *place), name, unit)

    def _size(self) -> str:
        boxes, ratios = self._built_of[:2]
        return f"{len(boxes)} boxes of dimension {self.dimension} on {len(ratios) + 1} levels"

    def __reduce__(self) -> tuple[Any, ...]:
        return _blocks_of, (*self._built_of, self._name, self._unit)


class BlockFrames(Frames):
    """Blocks of one grid and type at several times, from files."""

    _blocks: list[Blocks]

    @classmethod
    def _of(cls, blocks: list[Blocks], times: list[float], names: list[str]) -> BlockFrames:
        """names are those of files, for sentences."""
        frames = cls.__new__(cls)
        built = [
            (boxes, [1, *ratios], step, start, along, rule)
            for boxes, ratios, step, start, along, rule in (each._built_of for each in blocks)
        ]
        frames._frames = _nestgrid.block_frames(built, times, names)
        frames._blocks = blocks
        frames._name = blocks[0].name
        frames._unit = blocks[0].unit
        return frames

    def _size(self) -> str:
        return self._blocks[0]._size()

    def _range_text(self) -> str:
        ranges = [each.range for each in self._blocks]
        return f"from {min(r[0] for r in ranges):.6g} to {max(r[1] for r in ranges):.6g}"

    def __reduce__(self) -> tuple[Any, ...]:
        names = [f"frame {i}" for i in range(len(self))]
        return BlockFrames._of, (self._blocks, self.times, names)


def _blocks_of(
    boxes: list[Box],
    ratios: list[int],
    spacing: np.ndarray,
    origin: np.ndarray,
    axes: list[int],
    rule: Rule,
    name: str,
    unit: str,
) -> Blocks:
    place: dict[str, Any] = {"spacing": spacing, "origin": origin, "axes": axes}
    return Blocks(boxes, ratio=ratios, **place, rule=rule, name=name, unit=unit)
