# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Adaptive isosurfaces, slices and lines of NumPy arrays and octrees, without cracks or copies.

    import nestgrid
    volume = nestgrid.Volume(array, spacing=(1, 1, 2))      # or nestgrid.load("scan.nii.gz")
    surface = volume.isosurface(0.5, max_triangles=50_000)
    surface.vertices, surface.triangles, surface.normals, surface.error_bound
    surface.save("surface.ply")
"""

from __future__ import annotations

from ._arguments import InvalidType
from ._blocks import Blocks
from ._budget import FrameBudget
from ._cells import Cells
from ._fields import Field
from ._lens import Domain, Lens, Region, ball, box, cone, half_space, polygon, view
from ._load import load
from ._nestgrid import GridError, InvalidInput, IoError, __version__
from ._results import Lines, Segments, Surface
from ._skimage import marching_cubes
from ._sources import Frames, Octree, Volume

__all__ = [
    "Blocks",
    "Cells",
    "Domain",
    "Field",
    "FrameBudget",
    "Frames",
    "GridError",
    "InvalidInput",
    "InvalidType",
    "IoError",
    "Lens",
    "Lines",
    "Octree",
    "Region",
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
