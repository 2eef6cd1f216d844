# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Results are those of C++, to the last bit."""
import math
import os
import pickle

import numpy as np
import pytest

import nestgrid

SHAPE = (20, 17, 23)
PLACE = {"spacing": (1, 0.5, 2), "origin": (-3, 1, 0.25)}
FLAT = {"spacing": (1, 0.5), "origin": (-3, 1)}
CENTRE = (4, 4, 20)
TYPES = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64"]
TYPES += ["float32", "float64"]


def samples(reference, name, dtype, shape, order):
    return reference.array(name + ".samples", dtype).reshape(shape, order=order.upper())


@pytest.fixture(params=["c", "f"])
def order(request):
    return request.param


@pytest.fixture
def volume(reference, order):
    return nestgrid.Volume(samples(reference, order, np.float32, SHAPE, order), **PLACE)


ISOSURFACES = {
    "full": {},
    "coarse": {"threshold": 12},
    "cap": {"threshold": 12, "cap": True, "at_nodes": True, "normals": False},
    "budget": {"max_triangles": 1500},
    "finest": {"threshold": 12, "cuts": "finest"},
    "blend": {"threshold": 9, "blend": 2},
    "visual": {"threshold": 0.4, "indicator": "visual"},
    "numerical": {"threshold": 30, "indicator": "numerical"},
    "wavelet": {"threshold": 8, "indicator": "wavelet"},
    "lens": {"lens": nestgrid.Lens(nestgrid.ball(CENTRE, 3), finest=1)},
}


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("name", ISOSURFACES)
def test_isosurface(reference, volume, order, name, threads):
    surface = volume.isosurface(40, threads=threads, **ISOSURFACES[name])
    reference.same_surface(f"{order}_{name}", surface)


SLICES = {
    "plane": {"plane": (CENTRE, (1, 2, 0.5))},
    "sphere": {"sphere": (CENTRE, 5), "threshold": 12},
    "cylinder": {"cylinder": (CENTRE, (0, 0, 1), 2), "threshold": 12, "normals": True},
    "budget_slice": {"plane": (CENTRE, (1, 2, 0.5)), "max_triangles": 300},
}


@pytest.mark.parametrize("name", SLICES)
def test_slice(reference, volume, order, name):
    reference.same_surface(f"{order}_{name}", volume.slice(**SLICES[name]))


def test_isolines_on_a_slice(reference, volume, order):
    surface = volume.slice(**SLICES["budget_slice"])
    reference.same_lines(f"{order}_slice_lines", surface.isolines([-50, 0, 50]))


def test_outlines(reference, volume, order):
    edges = volume.isosurface(40, 12, normals=False, elements=True).outlines()
    name = f"{order}_outlines"
    vertices = reference.array(name + ".vertices", float, -1, 3)
    assert len(vertices) > 0
    np.testing.assert_array_equal(edges.vertices, vertices)
    segments = reference.array(name + ".segments", np.uint32, -1, 2)
    np.testing.assert_array_equal(edges.segments, segments)


def test_probe(reference, volume, order):
    points = reference.array(f"{order}_probe.points", float, -1, 3)
    exact = reference.array(f"{order}_probe.values", float)
    assert np.isnan(exact).any() and not np.isnan(exact).all()
    np.testing.assert_array_equal(volume.probe(points), exact)
    coarse = reference.array(f"{order}_probe_coarse.values", float)
    np.testing.assert_array_equal(volume.probe(points, 12), coarse)
    np.testing.assert_array_equal(
        volume.probe(points.reshape(4, 25, 3), 12), coarse.reshape(4, 25)
    )


@pytest.mark.parametrize("cubic", [False, True])
def test_frames(reference, order, cubic):
    first, later = [
        samples(reference, name, np.float32, SHAPE, order) for name in (order, order + "_later")
    ]
    frames = nestgrid.Frames([first, later, first], **PLACE)
    name = order + ("_cubic" if cubic else "_between")
    surface = frames.at(0.7, cubic=cubic).isosurface(40, 12)
    reference.same_surface(name, surface)
    wavelet = frames.at(0.7, cubic=cubic).isosurface(40, 8, indicator="wavelet")
    reference.same_surface(name + "_wavelet", wavelet)


@pytest.mark.parametrize("dtype", TYPES)
def test_types(reference, order, dtype):
    middle = 100 if dtype.startswith("u") else 0
    name = f"{dtype}_{order}"
    volume = nestgrid.Volume(samples(reference, name, dtype, SHAPE, order), **PLACE)
    reference.same_surface(name, volume.isosurface(middle + 9.5, 3))
    flat = nestgrid.Volume(samples(reference, name + "_flat", dtype, SHAPE[:2], order), **FLAT)
    assert flat.dimension == 2
    reference.same_lines(name + "_lines", flat.isolines([middle, middle + 9.5], 2))
    reference.same_surface(name + "_height", flat.height_field(0.1, 2))
    reference.same_surface(name + "_shading", flat.height_field(None, 2))


def octree_arrays(reference):
    leaves = reference.array("octree.leaves", np.int64, -1, 4)
    return leaves, reference.array("octree.samples", float, -1, 8)


@pytest.mark.parametrize("shuffled", [False, True])
def test_octree(reference, shuffled):
    leaves, values = octree_arrays(reference)
    if shuffled:
        order = np.random.default_rng(1).permutation(len(leaves))
        leaves, values = leaves[order], values[order]
    octree = nestgrid.Octree(leaves, values, spacing=(0.5, 1, 0.25), origin=(1, 2, 3))
    reference.same_triangles("octree", octree.isosurface(0.3, 0.05))


def test_octree_of_means(reference):
    """Linear functions come back from cells, and the order of leaves does not matter."""
    leaves, _ = octree_arrays(reference)
    random = np.random.default_rng(2)
    spacing, slope = np.array([0.5, 1, 0.25]), np.array([0.3, -0.7, 0.4])
    centres = spacing * (leaves[:, :3] + 2.0 ** (4 - leaves[:, 3:]))
    points = 32 * spacing * random.random((500, 3))
    octree = nestgrid.Octree(leaves, centres @ slope, spacing=spacing)
    np.testing.assert_allclose(octree.probe(points), points @ slope, atol=1e-12)
    values = np.sin(np.arange(len(leaves)))
    order = random.permutation(len(leaves))
    drawn = [
        nestgrid.Octree(leaves[i], values[i], spacing=spacing).probe(points)
        for i in (slice(None), order)
    ]
    np.testing.assert_array_equal(*drawn)


def thirds(random, dimension, deepest=3):
    """Leaves of 2 x 1 (x 2) roots, divided by three at random, by up to as many levels."""
    leaves = []

    def add(low, level):
        if level == deepest or (level > 0 and random.random() < 0.7):
            leaves.append([*low, level])
            return
        width = 3 ** (deepest - level - 1)
        for c in range(3**dimension):
            add([x + width * (c // 3**d % 3) for d, x in enumerate(low)], level + 1)

    roots = (2, 1, 2)[:dimension]
    for i in range(int(np.prod(roots))):
        add([3**deepest * x for x in np.unravel_index(i, roots)], 0)
    return np.array(leaves)


@pytest.mark.parametrize("dimension", [2, 3])
def test_leaves_divided_by_three(dimension):
    """Linear functions come back, and surfaces are closed where levels jump."""
    for seed in range(3):
        random = np.random.default_rng(seed)
        leaves = random.permutation(thirds(random, dimension))
        low, level = leaves[:, :-1], leaves[:, -1:]
        centres = low + 3.0 ** (3 - level) / 2
        spacing, slope = np.array([0.5, 1, 0.25])[:dimension], np.array([0.3, -0.7, 0.4])[:dimension]
        points = spacing * random.uniform(0, 27, (200, dimension)) * [2, 1, 2][:dimension]
        given = {"factor": 3, "max_level": 3, "spacing": spacing}
        octree = nestgrid.Octree(leaves, spacing * centres @ slope, **given)
        np.testing.assert_allclose(octree.probe(points), points @ slope, atol=1e-11)
        distance = np.linalg.norm((centres - [27, 13, 28][:dimension]) / [27, 13, 27][:dimension], axis=1)
        if dimension == 2:
            continue
        octree = nestgrid.Octree(leaves, distance, **given)
        for threshold in (0, 0.02, 0.2):
            report = octree.isosurface(0.6, threshold).report()
            assert report["open_edges"] == 0 and report["triangles"] > 50, (seed, threshold)
    with pytest.raises(nestgrid.InvalidInput, match="max_level is 14, not 0 to 13"):
        nestgrid.Octree(leaves, level[:, 0], factor=3, max_level=14)
    with pytest.raises(nestgrid.InvalidInput, match="do not fill it"):
        nestgrid.Octree(leaves[1:], level[1:, 0], **given)
    with pytest.raises(nestgrid.InvalidInput, match="overlaps"):
        nestgrid.Octree(np.vstack([leaves, leaves[:1]]), np.zeros(len(leaves) + 1), **given)


def test_forest_and_mask():
    """Two roots beside each other are one domain; a masked leaf leaves a hole."""
    leaves = [[x, y, z, 1] for x in range(4) for y in range(2) for z in range(2)]
    leaves = np.array(leaves)
    volume = nestgrid.Volume(np.arange(5.0)[:, None, None] + np.zeros((5, 3, 3)))
    corners = np.array([[c & 1, c >> 1 & 1, c >> 2] for c in range(8)])
    values = (leaves[:, None, 0] + corners[:, 0]).astype(float)
    octree = nestgrid.Octree(leaves, values)
    area = octree.isosurface(1.5).report()["area"]
    assert math.isclose(area, volume.isosurface(1.5).report()["area"]) and math.isclose(area, 4)
    masked = leaves[:, 0] + 4 * leaves[:, 1] == 1
    hole = nestgrid.Octree(leaves, values, masked=masked).isosurface(1.5).report()
    assert math.isclose(hole["area"], 2)
    cells = [np.where(masked, hidden, leaves[:, 0] + 0.5) for hidden in (0, 1000)]
    drawn = [nestgrid.Octree(leaves, v, masked=masked).isosurface(2.2).vertices for v in cells]
    np.testing.assert_array_equal(*drawn)
    assert len(drawn[0]) > 0
    for hidden in (math.nan, 1.5, 1000):  # at corners, which other leaves may contradict
        beside = np.where(masked[:, None], hidden, values)
        assert nestgrid.Octree(leaves, beside, masked=masked).isosurface(1.5).report() == hole
    missing = nestgrid.Octree(leaves, np.where(masked, math.nan, cells[0]))
    np.testing.assert_array_equal(missing.isosurface(2.2).vertices, drawn[0])
    again = pickle.loads(pickle.dumps(missing))
    np.testing.assert_array_equal(again.isosurface(2.2).vertices, drawn[0])
    with pytest.raises(nestgrid.InvalidInput, match="leaf 3 is not finite"):
        nestgrid.Octree(leaves, np.where(np.arange(len(leaves)) == 3, math.inf, cells[0]))
    with pytest.raises(nestgrid.InvalidInput, match="no leaf has a value"):
        nestgrid.Octree(leaves, np.full(len(leaves), math.nan))
    moved = nestgrid.Octree(leaves, values, coordinates=[(0, 1, 5), (0, 2), (0, 4)])
    assert math.isclose(moved.isosurface(1.5).report()["area"], 8)


def test_octrees_with_missing_nodes():
    """Leaves with a corner that has no value are hidden, and capped surfaces are closed."""
    random = np.random.default_rng(5)
    fine = np.array([[x, y, z, 3] for x in range(4) for y in range(8) for z in range(8)])
    coarse = np.array([[x, y, z, 2] for x in (4, 6) for y in (0, 2, 4, 6) for z in (0, 2, 4, 6)])
    leaves = np.vstack([fine, coarse])
    corners = np.array([[c & 1, c >> 1 & 1, c >> 2] for c in range(8)])
    at = leaves[:, None, :3] + corners * (2 ** (3 - leaves[:, 3]))[:, None, None]
    number = np.ravel_multi_index(at.transpose(2, 0, 1), (9, 9, 9))
    values = 5.1 - np.linalg.norm(at - 4.2, axis=2)
    # At x = 4 nodes hang on the coarse leaves, whose values they take.
    inside = np.arange(729) // 81
    missing = (random.random(729) < 0.05) & (inside != 4)
    holes = np.where(missing[number], math.nan, values)
    hidden = np.isnan(holes).any(axis=1)
    assert 0 < hidden.sum() < len(leaves)
    octree = nestgrid.Octree(leaves, holes)
    masked = nestgrid.Octree(leaves, values, masked=hidden)
    for threshold in 0, 0.1:
        ours = octree.isosurface(0.5, threshold=threshold)
        theirs = masked.isosurface(0.5, threshold=threshold)
        np.testing.assert_array_equal(ours.vertices, theirs.vertices)
        np.testing.assert_array_equal(ours.triangles, theirs.triangles)
    again = pickle.loads(pickle.dumps(octree))
    np.testing.assert_array_equal(again.isosurface(0.5).vertices, octree.isosurface(0.5).vertices)
    differs = holes.copy()
    differs[0, 7] = math.nan if math.isfinite(differs[0, 7]) else 1
    with pytest.raises(nestgrid.InvalidInput, match="another leaf has"):
        nestgrid.Octree(leaves, differs)


def same_bits(ours, theirs):
    assert len(ours.triangles) > 0
    for part in ("vertices", "triangles", "normals"):
        assert getattr(ours, part).tobytes() == getattr(theirs, part).tobytes(), part


def test_stored_frames(reference):
    """Encoded frames of one file are the files of the frames, and fields lie between them."""
    stored, later, frames = [
        nestgrid.load(os.path.join(reference.folder, name + ".nestgrid"), "wave")
        for name in ("stored", "later", "frames")
    ]
    assert isinstance(frames, nestgrid.Frames) and frames.times == [1, 3]
    for time, alone in ((1, stored), (3, later)):
        same_bits(frames.at(time).isosurface(0.3, 0.05), alone.isosurface(0.3, 0.05))
    point = [(0.3, 0.4, 0.45)]
    mean = (stored.probe(point) + later.probe(point)) / 2
    np.testing.assert_allclose(frames.at(2).probe(point), mean, rtol=1e-12)


def test_between_frames(reference):
    """Budgets, blending, lenses and all indicators are there between frames, too."""
    frames = nestgrid.load(os.path.join(reference.folder, "frames.nestgrid"))
    between = frames.at(1.7)
    finest = len(between.isosurface(0.3).triangles)
    surface = between.isosurface(0.3, max_triangles=finest // 2)
    assert 0 < len(surface.triangles) <= finest // 2 and surface.threshold > 0
    plane = ((0.5, 0.5, 0.4), (0, 0.1, 1))
    cut = between.slice(plane=plane, max_triangles=400, lens=((0.2, 0.5, 0.5), 0.1))
    assert 0 < len(cut.triangles) <= 400 and cut.threshold >= 0
    chosen = ({"blend": 1.5}, {"indicator": "visual"}, {"indicator": "numerical", "blend": 1.2})
    for options in chosen:
        drawn = between.isosurface(0.3, 0.1, **options)
        assert drawn.report()["open_edges"] == 0 and len(drawn.triangles) <= finest


def test_stored(reference):
    path = os.path.join(reference.folder, "stored.nestgrid")
    reference.same_surface("stored", nestgrid.load(path, "wave").isosurface(0.3, 0.05))
    with pytest.raises(nestgrid.InvalidInput, match="several fields.*'wave', 'again'"):
        nestgrid.load(path)
    with pytest.raises(nestgrid.InvalidInput, match="no field 'other'"):
        nestgrid.load(path, "other")


def test_any_order_of_indices(reference):
    """The arrays of transposed indices lie in the same memory and have the same values."""
    array = samples(reference, "c", np.float32, SHAPE, "c")
    points = np.random.default_rng(3).random((200, 3)) * (19, 16, 22)
    values = nestgrid.Volume(array).probe(points)
    expected = nestgrid.Volume(array).isosurface(40, cap=True).report()["volume"]
    for axes in ((0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)):
        turned = nestgrid.Volume(array.transpose(axes))
        report = turned.isosurface(40, cap=True).report()
        assert report["closed"] and math.isclose(report["volume"], expected, rel_tol=0.02)
        at_samples = np.floor(points)
        np.testing.assert_array_equal(
            turned.probe(at_samples[:, axes]), array[tuple(at_samples.astype(int).T)]
        )
    assert not np.isnan(values).any()
