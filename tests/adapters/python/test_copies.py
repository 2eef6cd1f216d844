# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields and results are copied and pickled without a change in one bit."""
import copy
import os
import pickle
import shutil

import numpy as np
import pytest

import nestgrid

PROTOCOLS = range(pickle.HIGHEST_PROTOCOL + 1)
PARTS = ["vertices", "triangles", "normals", "attributes", "points", "first", "values", "segments"]
COPIES = [copy.copy, copy.deepcopy]
COPIES += [lambda x, p=p: pickle.loads(pickle.dumps(x, p)) for p in PROTOCOLS]
NAMED = {"name": "heat", "unit": "mm"}
NAMES = ["copy", "deepcopy", *(f"protocol {p}" for p in PROTOCOLS)]


def same(a, b):
    assert type(a) is type(b)
    parts = [part for part in PARTS if hasattr(a, part)]
    assert parts
    for part in parts:
        x, y = getattr(a, part), getattr(b, part)
        assert x.dtype == y.dtype and x.shape == y.shape and x.tobytes() == y.tobytes(), part
    for number in ("error_bound", "threshold", "counts", "name", "unit"):
        if hasattr(a, number):
            np.testing.assert_equal(getattr(a, number), getattr(b, number))


@pytest.mark.parametrize("make", COPIES, ids=NAMES)
def test_results(make, gyroid):
    volume = nestgrid.Volume(gyroid, **NAMED)
    surface = volume.isosurface(0.1, 0.1, elements=True)
    again = make(surface)
    same(surface, again)
    assert surface.report() == again.report()
    same(surface.outlines(), make(surface.outlines()))
    same(surface.outlines(), again.outlines())
    cut = volume.slice(plane=((32, 32, 32), (1, 1, 0)))
    same(cut, make(cut))
    same(cut.isolines(0.2), make(cut.isolines(0.2)))
    same(cut.isolines(0.2), make(cut).isolines(0.2))
    empty = volume.isosurface(100)
    same(empty, make(empty))


@pytest.mark.parametrize("make", COPIES, ids=NAMES)
@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 0, 2)])
def test_volumes(make, gyroid, order):
    turn = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1.0]])
    array = gyroid[:33, :20].transpose(order).copy().transpose(np.argsort(order))
    volume = nestgrid.Volume(array, (1, 2, 0.5), (3, 4, 5), direction=turn, **NAMED)
    again = make(volume)
    assert again.array.strides == array.strides
    assert (again.spacing, again.origin, again.name, again.unit) == (
        (1, 2, 0.5),
        (3, 4, 5),
        "heat",
        "mm",
    )
    same(volume.isosurface(0.1, 0.1), again.isosurface(0.1, 0.1))
    assert np.shares_memory(again.array, array) == (make is copy.copy)


@pytest.mark.parametrize("make", COPIES, ids=NAMES)
def test_frames(make, gyroid):
    frames = nestgrid.Frames([gyroid, gyroid + 1], [2, 5], **NAMED)
    again = make(frames)
    assert again.times == [2, 5]
    same(frames.at(3).isosurface(0.1), again.at(3).isosurface(0.1))
    same(frames.at(3).isosurface(0.1), make(frames.at(3)).isosurface(0.1))


@pytest.mark.parametrize("make", COPIES, ids=NAMES)
def test_octrees(make, reference):
    leaves = reference.array("octree.leaves", np.int64, -1, 4)
    for values in (reference.array("octree.samples", float, -1, 8), np.sin(np.arange(len(leaves)))):
        masked = np.arange(len(leaves)) % 7 == 3
        octree = nestgrid.Octree(leaves, values, spacing=(0.5, 1, 0.25), masked=masked, **NAMED)
        same(octree.isosurface(0.3, 0.05), make(octree).isosurface(0.3, 0.05))


@pytest.mark.parametrize("make", COPIES, ids=NAMES)
def test_loaded(make, reference):
    field = nestgrid.load(os.path.join(reference.folder, "stored.nestgrid"), "wave")
    assert field.name == "wave"
    same(field.isosurface(0.3), make(field).isosurface(0.3))
    frames = nestgrid.load(os.path.join(reference.folder, "frames.nestgrid"))
    same(frames.at(2).isosurface(0.3), make(frames.at(2)).isosurface(0.3))
    assert "2 frames" in repr(make(frames))


def test_loaded_from_a_file_that_has_changed(reference, tmp_path):
    """What was pickled is a path: another file there is refused."""
    path = shutil.copy(os.path.join(reference.folder, "stored.nestgrid"), tmp_path)
    pickled = pickle.dumps(nestgrid.load(path, "wave"))
    shutil.copy(os.path.join(reference.folder, "later.nestgrid"), path)
    with pytest.raises(nestgrid.IoError, match="has changed since"):
        pickle.loads(pickled)


@pytest.mark.parametrize("make", COPIES, ids=NAMES)
def test_lenses(make, gyroid):
    domain = nestgrid.ball((32, 32, 32), 5) | nestgrid.box((0, 0, 0), (9, 9, 9))
    domain = domain & nestgrid.half_space((0, 0, 20), (0, 0, 1)) | nestgrid.view((0, 0, 0), (1, 0, 0))
    lens = nestgrid.Lens(domain, finest=1, coarsest=8)
    volume = nestgrid.Volume(gyroid)
    again = make(lens)
    assert repr(again) == repr(lens)
    same(volume.isosurface(0.1, lens=lens), volume.isosurface(0.1, lens=again))
