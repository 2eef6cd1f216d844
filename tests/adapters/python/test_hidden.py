# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""What is hidden is never looked at: whatever lies in masked samples and leaves, every drawing is
the same to the last bit."""
import numpy as np
import pytest

import nestgrid

PLACEHOLDERS = (0.0, 0.45, -1e6, 1e30, np.inf, -np.inf, np.nan)
INDICATORS = ("offset", "deviation", "visual", "numerical", "wavelet")
RANDOM = np.random.default_rng(7)


def smooth(*x):
    return np.sin(3 * x[0]) + x[1] - x[-1] * x[0]


def numbers(field):
    """The bytes of all that can be drawn of a field."""
    results = [np.array(field.range)]
    if field.dimension == 3:
        options = [{}, {"threshold": 0.02, "normals": True}, {"max_triangles": 3000}]
        options += [{"threshold": 0.1, "indicator": name} for name in INDICATORS]
        drawn = [field.isosurface(0.45, **each) for each in options]
        drawn.append(field.slice(plane=((0.4, 0.5, 0.6), (1, 0.5, -0.3)), threshold=0.01))
        for surface in drawn:
            results += [surface.vertices, surface.triangles, surface.normals, surface.attributes]
        assert all(len(surface.triangles) for surface in drawn)
    else:
        lines = field.isolines([0.2, 0.45], threshold=0.02)
        graph = field.height_field(threshold=0.02)
        results += [lines.vertices, lines.points, graph.vertices, graph.triangles]
        assert len(lines.points) and len(graph.triangles)
    points = np.random.default_rng(5).random((500, field.dimension))
    results.append(field.probe(points))
    return b"".join(np.ascontiguousarray(each).tobytes() for each in results)


def expect_nobody_looks(make):
    """make(placeholder) gives a field that has it wherever it is masked."""
    first = numbers(make(PLACEHOLDERS[0]))
    assert len(first) > 10000
    for placeholder in PLACEHOLDERS[1:]:
        assert numbers(make(placeholder)) == first, placeholder


def samples(dimension, time=0.0):
    n = 17 if dimension == 3 else 41
    return smooth(*np.meshgrid(*[np.linspace(0, 1, n)] * dimension, indexing="ij")) + time


def mask_of(array):
    return np.random.default_rng(3).random(array.shape) < 0.02


def masked_array(array, placeholder, dtype):
    mask = mask_of(array)
    return np.ma.masked_array(np.where(mask, placeholder, array).astype(dtype), mask)


def placed(array):
    return {"spacing": (1 / (array.shape[0] - 1),) * array.ndim}


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_masked_samples(dimension, dtype):
    array = samples(dimension)
    expect_nobody_looks(
        lambda placeholder: nestgrid.Volume(masked_array(array, placeholder, dtype), **placed(array))
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_masked_frames(dimension):
    """Also where frames are masked at other places."""
    arrays = [samples(dimension, time) for time in (0, 0.1, 0.3)]

    def between(placeholder):
        frames = [masked_array(array, placeholder, np.float32) for array in arrays]
        frames[1].mask = False
        frames[1].data[mask_of(arrays[1])] = np.nan
        return nestgrid.Frames(frames, [0, 1, 2], **placed(arrays[0])).at(1.25)

    expect_nobody_looks(between)


def random_leaves(dimension, depth):
    """Leaves of one root, refined at random."""
    leaves = []

    def refine(corner, level):
        if level == depth or (level > 2 and RANDOM.random() < 0.4):
            leaves.append((*corner, level))
            return
        half = 1 << (depth - level - 1)
        for child in range(1 << dimension):
            refine([c + half * (child >> d & 1) for d, c in enumerate(corner)], level + 1)

    refine([0] * dimension, 0)
    return np.array(leaves)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("at_corners", [False, True])
def test_masked_leaves(dimension, at_corners):
    depth = 7 - dimension
    leaves = random_leaves(dimension, depth)
    masked = RANDOM.random(len(leaves)) < 0.2
    lowest = leaves[:, :-1] / 2**depth
    width = 2.0 ** -leaves[:, -1]
    if at_corners:
        corner = np.arange(1 << dimension)[:, None] >> np.arange(dimension) & 1
        places = lowest[:, None, :] + width[:, None, None] * corner
    else:
        places = lowest + width[:, None] / 2
    values = smooth(*np.moveaxis(places, -1, 0))

    def octree(placeholder):
        hidden = values.copy()
        hidden[masked] = placeholder
        return nestgrid.Octree(
            leaves, hidden, max_level=depth, spacing=(2.0**-depth,) * dimension, masked=masked
        )

    expect_nobody_looks(octree)
