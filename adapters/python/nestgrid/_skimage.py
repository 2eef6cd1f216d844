# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""marching_cubes() with the signature of scikit-image."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from ._fields import Volume
from ._nestgrid import InvalidInput


def marching_cubes(
    volume: np.ndarray,
    level: float | None = None,
    *,
    spacing: Sequence[float] = (1.0, 1.0, 1.0),
    gradient_direction: str = "descent",
    step_size: int = 1,
    allow_degenerate: bool = True,
    method: str = "lewiner",
    mask: np.ndarray | None = None,
    threshold: float | None = None,
    max_triangles: int | None = None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """An isosurface with the arguments, results and winding of skimage.measure.marching_cubes.

    level               default: halfway between the least and the greatest value
    gradient_direction  "descent": objects are greater than the level; "ascent": less
    step_size           takes each step_size-th sample, of a copy
    allow_degenerate    accepted; no triangle is a point
    method, mask        only "lewiner" and None
    threshold           detail up to it is left out, in the units of the data
    max_triangles       finds the least threshold with no more triangles

    Returns vertices, float64 (n, 3); faces, int32 (m, 3); normals, float64 (n, 3); and the greatest
    value of the data around each vertex, (n,).
    Raises InvalidInput as Volume and isosurface().
    """
    volume = np.asanyarray(volume)
    if volume.ndim != 3:
        raise InvalidInput(f"the volume has {volume.ndim} indices, not 3")
    if gradient_direction not in ("descent", "ascent"):
        raise InvalidInput(f"gradient_direction is '{gradient_direction}', not descent or ascent")
    if method != "lewiner" or mask is not None:
        raise InvalidInput("method is 'lewiner', and there is no mask")
    if step_size < 1:
        raise InvalidInput(f"step_size is {step_size}, below 1")
    if step_size > 1:
        volume = np.ascontiguousarray(volume[(slice(None, None, step_size),) * 3])
    steps = np.asarray(spacing, float) * step_size
    field = Volume(volume, steps)
    surface = field.isosurface(
        0.5 * sum(field.range) if level is None else level, threshold, max_triangles
    )
    faces = surface.triangles.astype(np.int32)
    if gradient_direction == "descent":
        faces = np.ascontiguousarray(faces[:, ::-1])
    values = _greatest_around(volume, surface.vertices / steps)
    return surface.vertices, faces, surface.normals, values


def _greatest_around(volume: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The greatest sample of the cell around each position, in units of samples."""
    low = np.floor(at).astype(np.int64)
    high = np.ceil(at).astype(np.int64)
    greatest = volume[tuple(low.T)]
    for corner in range(1, 8):
        index = tuple((high if corner >> d & 1 else low)[:, d] for d in range(3))
        greatest = np.maximum(greatest, volume[index])
    return greatest
