# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Frames at one cost while a slider is dragged."""

from __future__ import annotations

from typing import Any, Callable

from . import _nestgrid
from ._arguments import Unfit, function, not_negative, number, takes


class FrameBudget:
    """Keeps frames at one cost while a slider is dragged, by correcting the last threshold.

    goal      cost of a frame that is aimed at, more than 0, in any unit: triangles, seconds
    greatest  the greatest threshold that makes a difference: the range of the data

    Raises InvalidInput where one of them is not a positive finite number.
    """

    __module__ = "nestgrid"

    @takes(goal=number, greatest=number)
    def __init__(self, goal: float, greatest: float) -> None:
        self._greatest = greatest
        self._budget = _nestgrid.FrameBudget(goal, greatest)

    @property
    def threshold(self) -> float:
        """For the next frame, in the units of the data."""
        return self._budget.threshold

    @property
    def goal(self) -> float:
        """The cost that is aimed at; may be set. Raises InvalidInput as FrameBudget()."""
        return self._budget.goal

    @goal.setter
    def goal(self, goal: Any) -> None:
        try:
            self._budget.goal = number(goal)
        except Unfit as unfit:
            raise unfit.error(f"FrameBudget: goal {unfit}") from None

    @takes(cost=not_negative)
    def drawn(self, cost: float) -> None:
        """Tells what the frame at threshold cost.

        cost  at least 0, in the unit of the goal

        Raises InvalidInput where it is negative or not a number.
        """
        self._budget.drawn(cost)

    @takes(fits=function)
    def settle(self, fits: Callable[[float], bool]) -> float:
        """The least threshold at which a frame fits, of 8 significant bits: after the motion.

        fits  called with thresholds; returns whether a frame drawn there keeps within the goal

        Raises what fits raises.
        """
        return self._budget.settle(lambda threshold: bool(fits(threshold)))

    def __repr__(self) -> str:
        return f"<nestgrid.FrameBudget: goal {self.goal:g}, next threshold {self.threshold:.6g}>"
