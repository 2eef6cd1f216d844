# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Adaptive isosurfaces, slices and lines of NumPy arrays and octrees, without cracks or copies.

    import nestgrid
    volume = nestgrid.Volume(array, spacing=(1, 1, 2))
    surface = volume.isosurface(0.5, max_triangles=50_000)
    surface.vertices, surface.triangles, surface.normals, surface.error_bound
"""

from __future__ import annotations

from ._fields import Field, Frames, Octree, Volume, load
from ._lens import Domain, Lens, ball, box, cone, half_space, polygon, view
from ._nestgrid import FrameBudget, GridError, InvalidInput, IoError
from ._results import Lines, Segments, Surface
from ._skimage import marching_cubes

__all__ = [
    "Domain",
    "Field",
    "FrameBudget",
    "Frames",
    "GridError",
    "InvalidInput",
    "IoError",
    "Lens",
    "Lines",
    "Octree",
    "Segments",
    "Surface",
    "Volume",
    "ball",
    "box",
    "cone",
    "half_space",
    "load",
    "marching_cubes",
    "polygon",
    "view",
]
