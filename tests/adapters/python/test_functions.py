# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Slices along functions that are written in Python."""
import math

import numpy as np
import pytest

import nestgrid

CENTRE = np.array([7.5, 8, 8.5])


@pytest.fixture(scope="module")
def volume():
    x, y, z = np.meshgrid(*3 * [np.arange(17)], indexing="ij")
    return nestgrid.Volume((np.sin(x / 3) + y * z / 100).astype(np.float32))


def distance_from_sphere(x, y, z):
    return math.hypot(x - CENTRE[0], y - CENTRE[1], z - CENTRE[2]) - 5


def same(ours, theirs):
    assert len(theirs.triangles) > 0
    np.testing.assert_array_equal(ours.triangles, theirs.triangles)
    np.testing.assert_array_equal(ours.attributes, theirs.attributes)
    np.testing.assert_allclose(ours.vertices, theirs.vertices, rtol=0, atol=1e-12)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("finely", [{}, {"threshold": 0.05}, {"error": 0.1}, {"max_triangles": 300}])
def test_a_function_gives_the_slice_of_its_zero(volume, finely, threads):
    theirs = volume.slice(sphere=(CENTRE, 5), **finely)
    same(volume.slice(function=distance_from_sphere, threads=threads, **finely), theirs)
    same(volume.slice(function=(distance_from_sphere, 1), threads=threads, **finely), theirs)


def test_a_steepness_spares_calls(volume):
    calls = []

    def counted(x, y, z):
        calls.append(1)
        return distance_from_sphere(x, y, z)

    volume.slice(function=counted)
    all_calls = len(calls)
    calls.clear()
    volume.slice(function=(counted, 1))
    assert len(calls) < 0.7 * all_calls


def test_a_collapsed_slice_keeps_a_distance(volume):
    how = {"error": 0.1, "collapse": True, "distance": 0.05}
    ours = volume.slice(function=(distance_from_sphere, 1), **how)
    assert 0 < len(ours.triangles) < 0.7 * len(volume.slice(sphere=(CENTRE, 5), threshold=0).triangles)
    centres = ours.vertices[ours.triangles].mean(axis=1)
    assert np.abs(np.linalg.norm(centres - CENTRE, axis=1) - 5).max() < 0.05 + 0.1


def test_what_a_function_raises_is_raised(volume):
    class Mine(Exception):
        pass

    def raising(x, y, z):
        if x > 6:
            raise Mine("here")
        return x - 8

    for threads in (1, 3):
        with pytest.raises(Mine, match="here"):
            volume.slice(function=raising, threads=threads)
    with pytest.raises(TypeError, match="must be real number, not str"):
        volume.slice(function=lambda x, y, z: "near")
    with pytest.raises(TypeError, match="positional argument"):
        volume.slice(function=lambda x: x)
    with pytest.raises((nestgrid.GridError, nestgrid.InvalidInput)):
        volume.slice(function=lambda x, y, z: math.nan)


@pytest.mark.parametrize("function", [3, "x", (distance_from_sphere, "steep"), (distance_from_sphere, -1), (1, 2)])
def test_what_is_no_function_is_refused(volume, function):
    with pytest.raises(nestgrid.InvalidInput, match="function"):
        volume.slice(function=function)
