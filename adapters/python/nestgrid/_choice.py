# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The numbers that are chosen where a file has several for each place."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass

import numpy as np

from ._nestgrid import InvalidInput


@dataclass(frozen=True)
class Choice:
    """Which numbers of a file with several for each place are wanted."""

    frame: int | None = None
    component: int | None = None
    magnitude: bool = False


def numbered(path: str, what: str, number: int, count: int) -> int:
    if number < count:
        return number
    raise InvalidInput(f"{path} has no {what} {number}: {what} is from 0 to {count - 1}")


def chosen(
    path: str, choice: Choice, numbers: np.ndarray, slope: float, intercept: float
) -> np.ndarray:
    """The values of one frame.

    numbers: one index for the component, three for the place, one for the frame
    """
    components, frames = numbers.shape[0], numbers.shape[4]
    if choice.component is not None and choice.magnitude:
        raise InvalidInput("load(): component and magnitude exclude each other")
    if frames == 1 and choice.frame is not None:
        raise InvalidInput(f"load(): frame chooses nothing: {path} has one frame only")
    if components == 1 and (choice.component is not None or choice.magnitude):
        given = "magnitude" if choice.magnitude else "component"
        raise InvalidInput(f"load(): {given} chooses nothing: {path} has one number per sample")
    if components > 1 and choice.component is None and not choice.magnitude:
        raise InvalidInput(
            f"{path} has {components} numbers per sample, not one: choose by component, "
            f"from 0 to {components - 1}, or by magnitude=True"
        )
    if frames > 1 and choice.frame is None:
        warnings.warn(
            f"frame 0 of the {frames} in {os.path.basename(path)} is read; frame= chooses "
            f"another, from 0 to {frames - 1}",
            stacklevel=4,
        )
    values = numbers[..., numbered(path, "frame", choice.frame or 0, frames)]
    if choice.component is not None:
        part = numbered(path, "component", choice.component, components)
        values = values[part : part + 1]
    if slope != 1 or intercept != 0 or choice.magnitude:
        # Of a type that keeps the digits, as the program's.
        small = numbers.dtype.itemsize <= 2 and abs(intercept) <= 8e6 * abs(slope)
        result = np.float32 if small or numbers.dtype == np.float32 else np.float64
        values = values * np.float64(slope) + np.float64(intercept)
        if choice.magnitude:
            values = np.linalg.norm(values, axis=0, keepdims=True)
        values = values.astype(result)
    return np.asfortranarray(values[0])
