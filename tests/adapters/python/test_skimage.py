# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""marching_cubes() does what scikit-image's does."""
import inspect

import numpy as np
import pytest

import nestgrid

measure = pytest.importorskip("skimage.measure")

SPACING = (1.0, 0.5, 2.0)


def areas(verts, faces):
    corners = verts[faces]
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2


def agreement(verts, faces, normals):
    """The part of the triangles whose winding agrees with the normals of their corners."""
    return (np.einsum("ij,ij->i", areas(verts, faces), normals[faces].sum(axis=1)) > 0).mean()


def volume_of(verts, faces):
    return np.einsum("ij,ij->i", areas(verts, faces), verts[faces].mean(axis=1)).sum() / 3


def test_signature():
    ours = list(inspect.signature(nestgrid.marching_cubes).parameters.items())
    theirs = list(inspect.signature(measure.marching_cubes).parameters.items())
    for (name, parameter), (expected, other) in zip(ours, theirs):
        assert name == expected
        assert parameter.kind == other.kind
        assert parameter.default == other.default


@pytest.mark.parametrize("order", "CF")
@pytest.mark.parametrize("threshold", [0, 0.05])
def test_area(gyroid, order, threshold):
    array = np.asarray(gyroid, order=order)
    verts, faces, _, _ = nestgrid.marching_cubes(array, 0.1, spacing=SPACING, threshold=threshold)
    expected, expected_faces, _, _ = measure.marching_cubes(gyroid, 0.1, spacing=SPACING)
    area = np.linalg.norm(areas(verts, faces), axis=1).sum()
    assert area == pytest.approx(measure.mesh_surface_area(expected, expected_faces), rel=0.01)


@pytest.mark.parametrize("direction", ["descent", "ascent"])
@pytest.mark.parametrize("order", "CF")
def test_winding_and_normals(order, direction):
    """A ball off the centre: what encloses a positive volume there does so here."""
    x, y, z = np.meshgrid(np.arange(30.0), np.arange(26.0), np.arange(22.0), indexing="ij")
    ball = np.asarray(9 - np.sqrt((x - 12) ** 2 + (y - 13) ** 2 + (z - 10) ** 2), order=order)
    ours = nestgrid.marching_cubes(ball, 0, spacing=SPACING, gradient_direction=direction)
    theirs = measure.marching_cubes(ball, 0, spacing=SPACING, gradient_direction=direction)
    assert volume_of(*ours[:2]) == pytest.approx(volume_of(*theirs[:2]), rel=0.01)
    # Normals of scikit-image are not scaled by the spacing, so that some triangles disagree.
    assert agreement(*ours[:3]) == round(agreement(*theirs[:3]))
    for end in (np.min, np.max):
        np.testing.assert_allclose(end(ours[0], axis=0), end(theirs[0], axis=0), atol=0.05)
    # Values are the greatest in the cell around a vertex.
    inside = ours[3].max()
    assert 0 <= ours[3].min() and inside <= np.sqrt(3)


def test_defaults_and_steps(gyroid):
    verts, faces, normals, values = nestgrid.marching_cubes(gyroid)
    assert len(verts) == len(normals) == len(values) and faces.dtype == np.int32
    verts, faces, _, _ = nestgrid.marching_cubes(gyroid, 0.1, step_size=2)
    expected, expected_faces, _, _ = measure.marching_cubes(gyroid, 0.1, step_size=2)
    area = np.linalg.norm(areas(verts, faces), axis=1).sum()
    assert area == pytest.approx(measure.mesh_surface_area(expected, expected_faces), rel=0.03)
    assert len(nestgrid.marching_cubes(gyroid, 0.1, max_triangles=5000)[1]) <= 5000


def test_what_it_does_not_do(gyroid):
    for wrong in ({"mask": gyroid > 0}, {"method": "lorensen"}, {"gradient_direction": "up"}):
        with pytest.raises(nestgrid.InvalidInput):
            nestgrid.marching_cubes(gyroid, 0.1, **wrong)
    with pytest.raises(nestgrid.InvalidInput, match="step_size is 0"):
        nestgrid.marching_cubes(gyroid, 0.1, step_size=0)
    with pytest.raises(nestgrid.InvalidInput, match="2 indices, not 3"):
        nestgrid.marching_cubes(gyroid[0], 0.1)
