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
    """The part of the triangles whose winding agrees with the normals of their corners.

    Triangles that are points as float32 are not counted.
    """
    area = areas(verts, faces)
    agrees = np.einsum("ij,ij->i", area, normals[faces].sum(axis=1)) > 0
    return agrees[np.linalg.norm(area, axis=1) > 1e-5].mean()


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


@pytest.fixture(scope="module")
def ball():
    x, y, z = np.meshgrid(np.arange(15.0), np.arange(13.0), np.arange(11.0), indexing="ij")
    return 4.3 - np.sqrt((x - 7) ** 2 + (y - 6) ** 2 + (z - 5) ** 2)


def same_surface(ours, theirs, dtype):
    """Asserts one type and size. Steps of two values are drawn rougher by tetrahedra."""
    rel = 0.25 if dtype == "?" else 0.05
    assert volume_of(*ours[:2]) == pytest.approx(volume_of(*theirs[:2]), rel=rel)
    area = np.linalg.norm(areas(*ours[:2]), axis=1).sum()
    assert area == pytest.approx(measure.mesh_surface_area(*theirs[:2]), rel=rel)
    assert [part.dtype for part in ours] == [part.dtype for part in theirs]


DTYPES = ["?", "f2", "f4", "f8", ">f4", ">i2", "longdouble", "O"]
DTYPES += ["i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8"]


@pytest.mark.parametrize("dtype", DTYPES)
def test_types(ball, dtype):
    scaled = ball > 0 if dtype == "?" else 9 * np.maximum(ball + 8, 0)
    array = scaled.astype(dtype)
    for spacing in ((1, 1, 1), SPACING):
        ours = nestgrid.marching_cubes(array, spacing=spacing)
        same_surface(ours, measure.marching_cubes(array, spacing=spacing), dtype)


VIEWS = {
    "every second": lambda a: a[::2, :, ::2],
    "backwards": lambda a: a[::-1, :, ::-1],
    "transposed": lambda a: a.transpose(1, 2, 0),
    "inner": lambda a: a[1:-1, 1:, 2:],
    "broadcast": lambda a: np.broadcast_to(a[:, :, 5:6], a.shape),
    "read-only": lambda a: np.frombuffer(a.tobytes()).reshape(a.shape),
    "Fortran": np.asfortranarray,
}


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("dtype", ["?", "f4", "f8"])
def test_views(ball, view, dtype):
    array = VIEWS[view](ball)
    array = array > 0 if dtype == "?" else array.astype(dtype, copy=False)
    ours = nestgrid.marching_cubes(array)
    same_surface(ours, measure.marching_cubes(array), dtype)


@pytest.mark.parametrize("step", [1, 2, 3])
def test_masks_and_steps(gyroid, step):
    mask = np.random.default_rng(1).random(gyroid.shape) > 0.4
    mask[:20] = True
    ours = nestgrid.marching_cubes(gyroid, 0.1, mask=mask, step_size=step)
    theirs = measure.marching_cubes(gyroid, 0.1, mask=mask, step_size=step)
    area = [np.linalg.norm(areas(*each[:2]), axis=1).sum() for each in (ours, theirs)]
    assert area[0] == pytest.approx(area[1], rel=0.03)
    whole = nestgrid.marching_cubes(gyroid, 0.1, step_size=step)
    assert len(ours[0]) < len(whole[0]) and ours[1].max() == len(ours[0]) - 1
    as_numbers = nestgrid.marching_cubes(gyroid, 0.1, mask=mask.astype(int), step_size=step)
    np.testing.assert_array_equal(ours[0], as_numbers[0])


def test_what_equals_the_level_lies_outside(ball):
    """Labels: at a level that samples have, both draw around what is greater."""
    labels = (ball > 0).astype(np.int16) + (ball > 2)
    for level in (0, 1):
        ours = nestgrid.marching_cubes(labels, level)
        theirs = measure.marching_cubes(labels, level)
        volumes = [volume_of(*each[:2]) for each in (ours, theirs)]
        assert volumes[0] == pytest.approx(volumes[1], rel=0.35)


def test_degenerate_triangles(ball):
    labels = (ball > 0).astype(np.float32)
    verts, faces, normals, values = nestgrid.marching_cubes(labels, 0, allow_degenerate=False)
    assert verts.dtype == np.float32 and len(verts) == len(normals) == len(values)
    corners = verts[faces]
    for i in range(3):
        assert not (corners[:, i] == corners[:, i - 1]).all(axis=1).any()
    again = nestgrid.marching_cubes(labels, 0)
    expected = volume_of(again[0].astype(float), again[1])
    assert volume_of(verts.astype(float), faces) == pytest.approx(expected, rel=1e-4)


def test_cells_that_are_not_finite_have_no_surface(ball):
    broken = ball.copy()
    broken[7, 6, 5:] = np.nan
    broken[0, 0, 0] = -np.inf
    verts, faces, normals, values = nestgrid.marching_cubes(broken, 0)
    for part in (verts, normals, values):
        assert np.isfinite(part).all()
    whole = nestgrid.marching_cubes(ball, 0)
    assert 0.8 * len(whole[1]) < len(faces) < len(whole[1])


ZEROS = np.zeros((5, 5, 5))
RAMP = np.arange(125.0).reshape(5, 5, 5)
REFUSED = {
    "a list": ((RAMP.tolist(), 3), {}),
    "two indices": ((RAMP[0], 3), {}),
    "one sample": ((RAMP[:1], 3), {}),
    "a level below": ((RAMP, -1), {}),
    "a level above": ((RAMP, 200), {}),
    "no surface": ((ZEROS, 0), {}),
    "a flat volume": ((ZEROS,), {}),
    "the greatest value": ((RAMP, 124), {}),
    "spacing of two": ((RAMP, 3), {"spacing": (1, 2)}),
    "a step of 0": ((RAMP, 3), {"step_size": 0}),
    "a negative step": ((RAMP, 3), {"step_size": -2}),
    "a long step": ((RAMP, 3), {"step_size": 9}),
    "a wrong direction": ((RAMP, 3), {"gradient_direction": "up"}),
    "a wrong method": ((RAMP, 3), {"method": "dual"}),
    "a small mask": ((RAMP, 3), {"mask": np.ones((4, 5, 5), bool)}),
    "an empty mask": ((RAMP, 3), {"mask": np.array([])}),
    "all masked": ((RAMP, 3), {"mask": np.zeros((5, 5, 5), bool)}),
    "a mask of _lorensen": ((RAMP, 3), {"method": "_lorensen", "mask": RAMP > 3}),
    "a text for a level": ((RAMP, "a"), {}),
    "a list for a level": ((RAMP, [1, 2]), {}),
    "a text for a step": ((RAMP, 3), {"step_size": "a"}),
    "a number for spacing": ((RAMP, 3), {"spacing": 1}),
    "an unknown argument": ((RAMP, 3), {"depth": 1}),
    "nothing": ((), {}),
}


@pytest.mark.parametrize("name", REFUSED)
def test_raises_what_scikit_image_raises(name):
    arguments, options = REFUSED[name]
    with pytest.raises(Exception) as theirs:
        measure.marching_cubes(*arguments, **options)
    with pytest.raises(type(theirs.value)) as ours:
        nestgrid.marching_cubes(*arguments, **options)
    assert str(ours.value).startswith("marching_cubes(): ")


def own_tests():
    """scikit-image's own tests, which Debian's package ships."""
    tests = pytest.importorskip("skimage.measure.tests.test_marching_cubes")
    return [name for name in vars(tests) if name.startswith("test_")]


# Their surfaces of different methods must differ; ours is the same by every method.
OF_THEIR_METHODS = {"test_both_algs_same_result_donut"}


@pytest.mark.parametrize("name", own_tests())
def test_own_tests_of_scikit_image(name, monkeypatch):
    from skimage.measure.tests import test_marching_cubes as tests

    monkeypatch.setattr(tests, "marching_cubes", nestgrid.marching_cubes)
    if name not in OF_THEIR_METHODS:
        getattr(tests, name)()
        return
    with pytest.raises(AssertionError):
        getattr(tests, name)()
