# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""marching_cubes() with the signature of scikit-image."""

from __future__ import annotations

from typing import Any, Literal, Sequence, Union, get_args

import numpy as np

from ._arguments import SampleType, Unfit, flag, name_of, not_a, number, numbers, optional, takes
from ._arguments import whole
from ._nestgrid import InvalidInput
from ._sources import Volume

Direction = Literal["descent", "ascent"]
Method = Literal["lewiner", "lorensen", "_lorensen"]


def _volume(value: Any) -> np.ndarray:
    if not isinstance(value, np.ndarray):
        raise not_a("a NumPy array of 3 indices", value)
    if value.ndim != 3:
        raise Unfit(f"has {value.ndim} indices, not 3", InvalidInput)
    if min(value.shape) < 2:
        raise Unfit(f"has the shape {value.shape}: it needs 2 along each index", InvalidInput)
    return value


def _spacing(value: Any) -> np.ndarray:
    three = numbers(value)
    if three.ndim == 0:
        raise not_a("3 numbers", value)
    if three.shape != (3,):
        raise Unfit(f"has {three.size} numbers, not 3", InvalidInput)
    return three


def _mask(value: Any) -> np.ndarray:
    if not isinstance(value, np.ndarray) or value.dtype.kind not in "biuf":
        raise not_a("a NumPy array of the volume's shape", value)
    return value.astype(bool, copy=False)


@takes(
    volume=_volume,
    level=optional(number),
    spacing=_spacing,
    gradient_direction=name_of(Direction),
    step_size=whole(1),
    allow_degenerate=flag,
    method=name_of(Method),
    mask=optional(_mask),
)
def marching_cubes(
    volume: np.ndarray,
    level: float | None = None,
    *,
    spacing: Union[Sequence[float], np.ndarray] = (1.0, 1.0, 1.0),
    gradient_direction: Direction = "descent",
    step_size: int = 1,
    allow_degenerate: bool = True,
    method: Method = "lewiner",
    mask: np.ndarray | None = None,
    threshold: float | None = None,
    max_triangles: int | None = None,
) -> tuple[np.ndarray, ...]:
    """An isosurface with the arguments, results and winding of skimage.measure.marching_cubes.

    volume              NumPy array of 3 indices. Integers of 8 to 64 bits, float32 and float64
                        without gaps in memory are borrowed; views with gaps or strides are copied;
                        booleans and float16 are copied as uint8 and float32, other types as float32
    level               what is greater lies inside; None: halfway between the least and the
                        greatest value
    spacing             distance of samples along each index, 3 numbers in units of length
    gradient_direction  "descent": objects are greater than the level; "ascent": less
    step_size           at least 1: takes each step_size-th sample, of a copy
    allow_degenerate    False: triangles of which two corners are equal as float32 are left out
    method              "lewiner", "lorensen" or "_lorensen": the same surface, with the last as
                        (vertices, faces) alone
    mask                of the shape of the volume: of the cell from sample (i, j, k) to (i + 1,
                        j + 1, k + 1) the surface is kept where mask[i + 1, j + 1, k + 1] is true
    threshold           at least 0: detail up to it is left out, in the units of the data

    Returns vertices (n, 3), float32, or float64 with a spacing; faces (m, 3), int32; normals (n,
    3), float32; and the greatest value of the data around each vertex (n,), float32. Cells with a
    sample that is not finite have no surface.

    Raises InvalidInput, a ValueError, where an argument makes no sense or the level is outside the
    range of the data, and its InvalidType, also a TypeError, where one has a wrong type;
    RuntimeError where there is no surface; NotImplementedError for a mask with "_lorensen".
    """
    if mask is not None and method == "_lorensen":
        raise NotImplementedError("marching_cubes(): there is no mask with '_lorensen'")
    if mask is not None and mask.shape != volume.shape:
        raise InvalidInput(
            f"marching_cubes(): the mask has the shape {mask.shape}, the volume {volume.shape}"
        )
    samples = _borrowable(volume)
    least, greatest = _range(samples)
    if level is None:
        level = 0.5 * (least + greatest)
    elif not least <= level <= greatest:
        raise InvalidInput(
            f"marching_cubes(): the level {level:g} is outside the values of the volume, "
            f"{least:g} to {greatest:g}"
        )
    if step_size > 1:
        samples = np.ascontiguousarray(samples[(slice(None, None, step_size),) * 3])
        if min(samples.shape) < 2:
            raise RuntimeError(f"marching_cubes(): there is no cell with step_size {step_size}")
    samples, kept = _finite(samples, least)
    if mask is not None:
        masked = mask[(slice(step_size, None, step_size),) * 3]
        kept = masked if kept is None else kept & masked
    steps = np.asarray(spacing) * step_size
    at, faces, normals = _surface(samples, level, steps, threshold, max_triangles)
    if kept is not None:
        faces = faces[_inside(at[faces].mean(axis=1), kept)]
    if not len(faces):
        raise RuntimeError(f"marching_cubes(): there is no surface at the level {level:g}")
    values = _greatest_around(samples, at).astype(np.float32)
    positions = at.astype(np.float32) * np.float32(step_size)
    verts, faces, normals, values = _used(positions, faces, normals, values)
    if not allow_degenerate:
        verts, faces, normals, values = _without_degenerate(verts, faces, normals, values)
    if gradient_direction == "descent":
        faces = np.ascontiguousarray(faces[:, ::-1])
    if not np.array_equal(spacing, (1, 1, 1)):
        verts = verts * np.asarray(spacing)
        verts = verts if allow_degenerate else verts.astype(np.float32)
    return (verts, faces) if method == "_lorensen" else (verts, faces, normals, values)


def _borrowable(volume: np.ndarray) -> np.ndarray:
    """The volume, or a copy, as Volume takes it."""
    if volume.dtype == bool:
        volume = volume.view(np.uint8)
    elif volume.dtype.newbyteorder("=").name not in get_args(SampleType):
        volume = volume.astype(np.float32)
    strides = sorted(volume.strides)
    size = volume.itemsize
    for stride, d in zip(strides, np.argsort(volume.strides, kind="stable")):
        if stride != size or not volume.dtype.isnative:
            return np.ascontiguousarray(volume, volume.dtype.newbyteorder("="))
        size *= volume.shape[d]
    return volume


def _range(samples: np.ndarray) -> tuple[float, float]:
    """The least and the greatest of the finite samples."""
    least, greatest = float(samples.min()), float(samples.max())
    if not np.isfinite(least) or not np.isfinite(greatest):
        finite = samples[np.isfinite(samples)]
        if not len(finite):
            raise InvalidInput("marching_cubes(): no sample of the volume is finite")
        return float(finite.min()), float(finite.max())
    return least, greatest


def _finite(samples: np.ndarray, filling: float) -> tuple[np.ndarray, np.ndarray | None]:
    """Samples of which those that are not finite were replaced, and which cells had none of these.

    The second is None where no sample was replaced.
    """
    if samples.dtype.kind != "f":
        return samples, None
    finite = np.isfinite(samples)
    if finite.all():
        return samples, None
    kept = np.ones([n - 1 for n in samples.shape], bool)
    for corner in range(8):
        kept &= finite[tuple(slice(1, None) if corner >> d & 1 else slice(-1) for d in range(3))]
    return np.where(finite, samples, samples.dtype.type(filling)), kept


def _surface(
    samples: np.ndarray,
    level: float,
    steps: np.ndarray,
    threshold: float | None,
    max_triangles: int | None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices in units of samples, faces and normals."""
    field = Volume(samples, steps)
    surface = field.isosurface(_just_above(level, samples.dtype), threshold, max_triangles)
    faces = surface.triangles.astype(np.int32)
    return surface.vertices / steps, faces, surface.normals.astype(np.float32)


def _just_above(level: float, dtype: np.dtype) -> float:
    """The least number greater than a level, for what is greater lies inside, and not what equals.

    In the type in which the library works with samples of a type.
    """
    if dtype == np.float32 or dtype.itemsize <= 2:
        single = np.float32(level)
        return float(single if single > level else np.nextafter(single, np.float32(np.inf)))
    return float(np.nextafter(level, np.inf))


def _inside(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Whether each point, in units of samples, is in a cell that is true."""
    cell = np.clip(np.floor(points).astype(np.int64), 0, np.array(cells.shape) - 1)
    return cells[tuple(cell.T)]


def _used(
    verts: np.ndarray, faces: np.ndarray, normals: np.ndarray, values: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Leaves out vertices of no face."""
    used = np.zeros(len(verts), bool)
    used[faces] = True
    if used.all():
        return verts, faces, normals, values
    number = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return verts[used], number[faces], normals[used], values[used]


def _without_degenerate(
    verts: np.ndarray, faces: np.ndarray, normals: np.ndarray, values: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Merges equal corners of faces, and leaves out the faces that lose one."""
    a, b, c = (verts[faces[:, i]] for i in range(3))
    if not any((x == y).all(axis=1).any() for x, y in ((a, b), (b, c), (c, a))):
        return verts, faces, normals, values
    _, first, same = np.unique(verts, axis=0, return_index=True, return_inverse=True)
    faces = first[same.reshape(-1)][faces].astype(np.int32)
    a, b, c = faces.T
    return _used(verts, faces[(a != b) & (b != c) & (c != a)], normals, values)


def _greatest_around(volume: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The greatest sample of the cell around each position, in units of samples."""
    most = np.array(volume.shape) - 1
    low = np.clip(np.floor(at).astype(np.int64), 0, most)
    high = np.clip(np.ceil(at).astype(np.int64), 0, most)
    greatest = volume[tuple(low.T)]
    for corner in range(1, 8):
        index = tuple((high if corner >> d & 1 else low)[:, d] for d in range(3))
        greatest = np.maximum(greatest, volume[index])
    return greatest
