# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The compiled half. The other half checks arguments before it calls this one."""

from typing import Any, Callable, Literal, Sequence, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

_Indicator = Literal["offset", "deviation", "visual", "numerical", "wavelet", "norm", "geometry"]
_OfSurface = Literal["error", "cut", "slope"]

class InvalidInput(ValueError):
    """An argument that cannot be worked with; the sentence says which, and why."""

class GridError(RuntimeError):
    """A grid or a field that an algorithm cannot treat."""

class IoError(OSError):
    """A file that cannot be read or written."""

def watched(function: Callable[[], Any], look: Callable[[], Any]) -> Any: ...

class Source:
    @property
    def dimension(self) -> int: ...
    def range(self, threads: int) -> list[float]: ...
    def clear(self) -> None: ...

class CellSource(Source):
    @property
    def degree(self) -> int: ...

class Frames:
    def __init__(
        self,
        arrays: Sequence[np.ndarray],
        times: Sequence[float],
        spacing: ArrayLike,
        origin: ArrayLike,
        direction: ArrayLike,
    ) -> None: ...
    @property
    def times(self) -> list[float]: ...
    def clear(self) -> None: ...
    def at(self, t: float, cubic: bool, threads: int) -> Source: ...

class OctreeFrames(Frames):
    def leaves(
        self,
    ) -> tuple[NDArray[np.int64], list[NDArray[np.float64]], NDArray[np.uint8]]: ...
    def first(self) -> Source: ...

class _VolumeFile(TypedDict):
    numbers: np.ndarray
    slope: float
    intercept: float
    spacing: list[float]
    origin: list[float]
    direction: list[list[float]]
    name: str
    unit: str

def volume(
    array: np.ndarray, spacing: ArrayLike, origin: ArrayLike, direction: ArrayLike
) -> Source: ...
def blocks(
    boxes: Sequence[tuple[int, Sequence[int], np.ndarray]],
    ratios: Sequence[int],
    spacing: ArrayLike,
    origin: ArrayLike,
    axes: Sequence[int],
    rule: str,
) -> Source: ...
def block_frames(
    frames: Sequence[
        tuple[
            Sequence[tuple[int, Sequence[int], np.ndarray]],
            Sequence[int],
            ArrayLike,
            ArrayLike,
            Sequence[int],
            str,
        ]
    ],
    times: Sequence[float],
    names: Sequence[str],
) -> Frames: ...
def octree(
    leaves: NDArray[np.int64],
    values: Sequence[NDArray[np.float64]],
    times: Sequence[float],
    masked: NDArray[np.uint8],
    max_level: int,
    factor: int,
    coordinates: Sequence[ArrayLike],
    names: Sequence[str],
    rule: str,
) -> OctreeFrames: ...
def cells(
    points: NDArray[np.float64],
    types: NDArray[np.uint8],
    offsets: NDArray[np.int64],
    connectivity: NDArray[np.int64],
    values: NDArray[np.float64],
    degrees: NDArray[np.float64],
) -> CellSource: ...
def load(path: str, array: str) -> tuple[Source | Frames, str]: ...
def plotfiles(
    paths: Sequence[str], array: str, rule: str, times: Sequence[float]
) -> tuple[Source | Frames, str]: ...
def volume_file(path: str, is_meta: bool) -> _VolumeFile: ...

class Domain:
    def union_with(self, other: Domain) -> Domain: ...
    def intersection(self, other: Domain) -> Domain: ...

def ball(centre: ArrayLike, radius: float) -> Domain: ...
def box(low: ArrayLike, high: ArrayLike) -> Domain: ...
def half_space(through: ArrayLike, normal: ArrayLike) -> Domain: ...
def cone(apex: ArrayLike, towards: ArrayLike, angle: float) -> Domain: ...
def polygon(corners: ArrayLike) -> Domain: ...
def frustum(
    eye: ArrayLike,
    towards: ArrayLike,
    up: ArrayLike,
    angle: float,
    aspect: float,
    nearest: float,
    farthest: float,
) -> Domain: ...

class Lens:
    def __init__(
        self, domain: Domain, finest: float, coarsest: float, slope: float
    ) -> None: ...

class Region:
    def __init__(self, domain: Domain, threshold: float) -> None: ...

class Projection:
    def __init__(
        self,
        threshold: float | None,
        max_triangles: int | None,
        indicator: _Indicator | _OfSurface,
        blend: float,
        lens: Lens | None,
        region: Region | None,
        colour_tolerance: float,
        position_error: float | None,
    ) -> None: ...

def indicators() -> list[tuple[str, str, str, bool]]: ...

class LevelFunction: ...

def plane(through: ArrayLike, normal: ArrayLike) -> LevelFunction: ...
def sphere(centre: ArrayLike, radius: float) -> LevelFunction: ...
def cylinder(through: ArrayLike, axis: ArrayLike, radius: float) -> LevelFunction: ...
def function(call: Callable[[float, float, float], float], steepness: float) -> LevelFunction: ...

class _Counts(TypedDict):
    calls: int
    visited: int
    extracted: int

class Surface:
    @property
    def error_bound(self) -> float: ...
    @property
    def position_bound(self) -> float: ...
    @property
    def range_bound(self) -> float: ...
    @property
    def bound_says_nothing(self) -> bool: ...
    @property
    def threshold(self) -> float: ...
    @property
    def counts(self) -> _Counts: ...
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def normals(self) -> NDArray[np.float64]: ...
    @property
    def triangles(self) -> NDArray[np.uint32]: ...
    @property
    def surface_error(self) -> float: ...
    @property
    def budget_reason(self) -> str: ...
    @property
    def attributes(self) -> NDArray[np.float64]: ...
    def report(self) -> dict[str, Any]: ...
    def outlines(self) -> Segments: ...
    def isolines(self, values: Sequence[float], attribute: int) -> Lines: ...
    def state(self) -> tuple[Any, ...]: ...
    @staticmethod
    def restored(state: tuple[Any, ...]) -> Surface: ...

class Lines:
    @property
    def error_bound(self) -> float: ...
    @property
    def position_bound(self) -> float: ...
    @property
    def range_bound(self) -> float: ...
    @property
    def bound_says_nothing(self) -> bool: ...
    @property
    def threshold(self) -> float: ...
    @property
    def counts(self) -> _Counts: ...
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def attributes(self) -> NDArray[np.float64]: ...
    @property
    def points(self) -> NDArray[np.uint32]: ...
    @property
    def first(self) -> NDArray[np.uint64]: ...
    @property
    def values(self) -> NDArray[np.float64]: ...
    def state(self) -> tuple[Any, ...]: ...
    @staticmethod
    def restored(state: tuple[Any, ...]) -> Lines: ...

class Segments:
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def segments(self) -> NDArray[np.uint32]: ...
    def state(self) -> tuple[Any, ...]: ...
    @staticmethod
    def restored(state: tuple[Any, ...]) -> Segments: ...

def isosurface(
    source: Source,
    level: float,
    normals: bool,
    cap: bool,
    elements: bool,
    at_nodes: bool,
    finest_cuts: bool,
    collapses: bool,
    keeps_distance: bool,
    projection: Projection,
    threads: int,
) -> Surface: ...
def isosurfaces(
    source: Source,
    levels: Sequence[float],
    normals: bool,
    cap: bool,
    elements: bool,
    at_nodes: bool,
    finest_cuts: bool,
    projection: Projection,
    threads: int,
) -> list[Surface]: ...
def measure(
    source: Source, surface: Surface, level: float, points: int, threads: int
) -> dict[str, float]: ...
def isoband(
    source: Source,
    low: float,
    high: float,
    normals: bool,
    elements: bool,
    projection: Projection,
    threads: int,
) -> Surface: ...
def boundary(
    source: Source, elements: bool, collapses: bool, projection: Projection, threads: int
) -> Surface: ...
def slice(
    source: Source,
    function: LevelFunction,
    normals: bool,
    elements: bool,
    collapses: bool,
    distance: float,
    projection: Projection,
    threads: int,
) -> Surface: ...
def isolines(
    source: Source, values: Sequence[float], projection: Projection, threads: int
) -> Lines: ...
def height_field(
    source: Source,
    scale: float | None,
    flatness: float,
    elements: bool,
    collapses: bool,
    projection: Projection,
    threads: int,
) -> Surface: ...
def probe(
    source: Source, points: NDArray[np.float64], projection: Projection, threads: int
) -> NDArray[np.float64]: ...

class FrameBudget:
    goal: float
    def __init__(self, goal: float, greatest: float) -> None: ...
    @property
    def threshold(self) -> float: ...
    def drawn(self, cost: float) -> None: ...
    def settle(self, fits: Callable[[float], bool]) -> float: ...
