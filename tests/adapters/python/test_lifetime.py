# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Arrays outlive what they were made of, in both directions."""
import gc
import sys

import numpy as np

import nestgrid


def samples():
    x, y, z = np.meshgrid(*[np.linspace(-1, 1, 33)] * 3, indexing="ij")
    return 1 - np.sqrt(x * x + y * y + z * z)


def fill_memory():
    """Takes the place of what was freed too early."""
    gc.collect()
    return [np.full(200000, 7.0) for _ in range(30)]


def test_results_outlive_everything():
    volume = nestgrid.Volume(samples())
    surface = volume.isosurface(0.4)
    arrays = [surface.vertices, surface.triangles, surface.normals]
    copies = [array.copy() for array in arrays]
    for array in arrays:
        assert not array.flags.owndata
    del volume, surface
    fill_memory()
    for array, copy in zip(arrays, copies):
        np.testing.assert_array_equal(array, copy)


def test_lines_and_outlines_outlive_everything():
    volume = nestgrid.Volume(samples())
    surface = volume.slice(plane=((16, 16, 16), (0, 0, 1)), elements=True)
    lines, edges = surface.isolines(0.4), surface.outlines()
    arrays = [lines.vertices, lines.points, lines.first, lines.values]
    arrays += [edges.vertices, edges.segments, surface.attributes]
    copies = [array.copy() for array in arrays]
    del volume, surface, lines, edges
    fill_memory()
    for array, copy in zip(arrays, copies):
        np.testing.assert_array_equal(array, copy)


def test_nothing_is_copied():
    surface = nestgrid.Volume(samples()).isosurface(0.4)
    assert np.shares_memory(surface.vertices, surface.vertices)
    surface.vertices[0] = 5
    assert (surface.vertices[0] == 5).all()


def test_volumes_keep_their_arrays():
    for make in (nestgrid.Volume, lambda array: nestgrid.Frames([array, array]).at(0.5)):
        expected = make(samples()).isosurface(0.4).vertices.copy()
        volume = make(samples())
        kept = fill_memory()
        np.testing.assert_allclose(volume.isosurface(0.4).vertices, expected)
        del kept


def test_volumes_let_their_arrays_go():
    array = samples()
    before = sys.getrefcount(array)
    volume = nestgrid.Volume(array)
    frames = nestgrid.Frames([array, array])
    at = frames.at(0.5)
    assert sys.getrefcount(array) > before
    del frames
    at.isosurface(0.4)
    del volume, at
    gc.collect()
    assert sys.getrefcount(array) == before


def test_octrees_copy():
    leaves = np.array([[x, y, z, 1] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    values = np.arange(8.0)
    octree = nestgrid.Octree(leaves, values)
    expected = octree.isosurface(3.5).vertices.copy()
    leaves[:] = values[:] = 0
    np.testing.assert_array_equal(octree.isosurface(3.5).vertices, expected)
