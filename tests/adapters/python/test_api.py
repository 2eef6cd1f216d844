# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Wrong arguments get a sentence; what the functions have in common."""
import inspect
import os
import subprocess
import sys
import threading

import numpy as np
import pytest

import nestgrid

CUBE = np.arange(27, dtype=float).reshape(3, 3, 3)


def refused(sentence, kind=nestgrid.InvalidInput):
    return pytest.raises(kind, match=sentence)


@pytest.mark.parametrize(
    "array",
    [CUBE[::2], CUBE[:, ::2], CUBE[:, :, ::-1], np.zeros((3, 4, 8))[..., :4], CUBE[::-1]],
)
def test_gaps(array):
    with refused("has gaps.*numpy.ascontiguousarray"):
        nestgrid.Volume(array)
    nestgrid.Volume(np.ascontiguousarray(array))


def test_wrong_volumes():
    for array in (np.zeros(3), np.zeros((2, 2, 2, 2)), np.float64(1)):
        with refused("is no volume: it needs 2 or 3"):
            nestgrid.Volume(array)
    with refused("2 to 2\\^20 samples along each index, not 1"):
        nestgrid.Volume(np.zeros((3, 1, 3)))
    for dtype in (bool, np.float16, complex, ">f4", object, "U3"):
        with refused("are not taken: convert them"):
            nestgrid.Volume(np.zeros((3, 3, 3), dtype))
    with refused("are not taken: convert them"):
        nestgrid.Volume(np.ma.masked_array(CUBE.astype(complex), CUBE > 2))
    with refused("spacing has 2 numbers, but the array 3 indices"):
        nestgrid.Volume(CUBE, spacing=(1, 1))
    for wrong in ((1, 0, 1), (1, -1, 1), (1, np.inf, 1)):
        with refused("spacing has a number that is not finite and > 0"):
            nestgrid.Volume(CUBE, spacing=wrong)
    with refused("origin has a number that is not finite"):
        nestgrid.Volume(CUBE, origin=(1, np.nan, 1))
    with refused("max_triangles is given alone"):
        nestgrid.Volume(CUBE).isosurface(0.5, 1, 2)


def test_values_that_are_no_numbers():
    broken = CUBE.copy()
    broken[1, 1, 1] = np.inf
    with refused("not a usable number"):
        nestgrid.Volume(broken).isosurface(3)
    with refused("not a usable number"):
        nestgrid.Volume(broken).range


def test_holes():
    """Nothing is drawn beside samples that are missing, whatever says so, alone and between frames."""
    places = np.indices((17, 15, 16))
    ball = (100 - np.sqrt(((places - 7.3) ** 2).sum(axis=0))).astype(np.float32)
    outside = places[0] > 9
    holes = np.where(outside, np.float32(np.nan), ball)
    expected = nestgrid.Volume(holes).isosurface(95)
    whole = nestgrid.Volume(ball).isosurface(95)
    assert 0 < len(expected.triangles) < len(whole.triangles)
    assert expected.vertices[:, 0].max() <= 9
    integers = np.rint(ball * 8).astype(np.int16)
    masked = nestgrid.Volume(np.ma.masked_array(integers, outside))
    assert masked.array.dtype == np.float32 and np.isnan(masked.array).sum() == outside.sum()
    assert masked.isosurface(760).vertices[:, 0].max() <= 9
    assert f"{outside.sum()} of them missing" in repr(nestgrid.Volume(holes))
    volume = nestgrid.Volume(holes)
    assert volume.range == (np.nanmin(holes), np.nanmax(holes))
    for options in {"error": 0.5}, {"threshold": 0.2}, {"max_triangles": 500}, {"threshold": 0.1, "indicator": "wavelet"}:
        assert volume.isosurface(95, **options).vertices[:, 0].max() <= 9
    assert np.isnan(volume.probe([(12, 7, 7)]))[0] and not np.isnan(volume.probe([(5, 7, 7)]))[0]
    assert (volume.slice(plane=((0, 0, 7), (0, 0, 1))).vertices[:, 0] <= 9).all()
    frames = nestgrid.Frames([ball, holes, ball + 1], [0, 1, 2])
    for time in 0, 0.5, 1.5:
        assert frames.at(time).isosurface(95, threshold=0.1).vertices[:, 0].max() <= 9


def test_wrong_arguments():
    volume = nestgrid.Volume(CUBE)
    with refused("isovalue is not a finite number"):
        volume.isosurface(np.nan)
    with refused("threshold is not a number >= 0"):
        volume.isosurface(3, threshold=-1)
    with refused("is none of offset, deviation, visual"):
        volume.isosurface(3, indicator="ofset")
    with refused("for curved grids"):
        volume.isosurface(3, indicator="geometry")
    with refused("blend is not a finite number of at least 1"):
        volume.isosurface(3, blend=0.5)
    with refused("max_triangles is 0"):
        volume.isosurface(3, max_triangles=0)
    with refused("even the coarsest|coarsest surface"):
        volume.isosurface(3, max_triangles=1)
    with refused("threads is -1"):
        volume.isosurface(3, threads=-1)
    with refused("one of plane, sphere, cylinder and function"):
        volume.slice()
    with refused("one of plane, sphere, cylinder and function"):
        volume.slice(plane=((0, 0, 0), (1, 0, 0)), sphere=((0, 0, 0), 1))
    with refused("the normal has 2 numbers, not 3"):
        volume.slice(plane=((0, 0, 0), (1, 0)))
    with refused("normal"):
        volume.slice(plane=((0, 0, 0), (0, 0, 0)))
    with refused("dimension"):
        volume.isolines(3)
    with refused("dimension"):
        volume.height_field()
    with refused("points have 2 coordinates, not 3"):
        volume.probe([[1, 2]])
    with refused("keep|elements"):
        volume.isosurface(3).outlines()
    with refused("attribute"):
        volume.isosurface(3).isolines(1)
    with refused("radius is not a number >= 0"):
        volume.isosurface(3, lens=((0, 0, 0), -1))
    with refused("slope is not a number >= 0"):
        volume.isosurface(3, lens=nestgrid.Lens(nestgrid.ball((0, 0, 0), 1), slope=-1))
    with refused("even the coarsest"):
        volume.slice(plane=((1, 1, 1), (1, 0, 0)), max_triangles=1, blend=2)
    with pytest.raises(TypeError):
        volume.isosurface("3")


def test_wrong_octrees():
    leaves = np.array([[x, y, z, 1] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    nestgrid.Octree(leaves, np.zeros(8))
    with refused("no array of integers"):
        nestgrid.Octree(leaves.astype(float), np.zeros(8))
    with refused("has no leaves"):
        nestgrid.Octree(leaves[:0], np.zeros(0))
    with refused("there are 7 values for 8 leaves"):
        nestgrid.Octree(leaves, np.zeros(7))
    with refused("do not fill it|leaves a gap"):
        nestgrid.Octree(leaves[:7], np.zeros(7))
    with refused("overlaps"):
        nestgrid.Octree(np.vstack([leaves, leaves[:1]]), np.zeros(9))
    with refused("not aligned to its level"):
        nestgrid.Octree([[1, 0, 0, 0]], np.zeros(1), max_level=1)
    with refused("outside all trees"):
        nestgrid.Octree([[-1, 0, 0, 0]], np.zeros(1))
    with refused("has the level -1|max_level is -1"):
        nestgrid.Octree([[0, 0, 0, -1]], np.zeros(1))
    with refused("not finite"):
        nestgrid.Octree(leaves, np.full(8, np.inf))
    with refused("at the same place"):
        nestgrid.Octree(leaves, np.arange(64.0).reshape(8, 8))
    with refused("mask has 3 entries for 8 leaves"):
        nestgrid.Octree(leaves, np.zeros(8), masked=[0, 0, 1])


def test_wrong_frames():
    with refused("there are no frames"):
        nestgrid.Frames([])
    with refused("1 times, but 2 frames"):
        nestgrid.Frames([CUBE, CUBE], times=[0])
    with refused("frame 1 has another shape"):
        nestgrid.Frames([CUBE, np.zeros((3, 3, 4))])
    with refused("frame 1 has another order"):
        nestgrid.Frames([CUBE, np.asfortranarray(CUBE)])
    with refused("ascend"):
        nestgrid.Frames([CUBE, CUBE], times=[1, 1])
    frames = nestgrid.Frames([CUBE, CUBE + 1])
    with refused("between|first and the last"):
        frames.at(1.5)
    with refused("even the coarsest"):
        frames.at(0.5).isosurface(13, max_triangles=1)
    with refused("none of offset"):
        frames.at(0.5).isosurface(13, indicator="sharpest")


def test_errors_are_those_of_python(tmp_path):
    assert issubclass(nestgrid.InvalidInput, ValueError)
    assert issubclass(nestgrid.GridError, RuntimeError)
    assert issubclass(nestgrid.IoError, OSError)
    with refused("x.nestgrid", nestgrid.IoError):
        nestgrid.load(tmp_path / "x.nestgrid")
    (tmp_path / "damaged.nestgrid").write_bytes(b"nothing of the kind")
    with refused("damaged.nestgrid", nestgrid.IoError):
        nestgrid.load(tmp_path / "damaged.nestgrid")


def test_saving_what_cannot_be_saved(tmp_path):
    surface = nestgrid.Volume(CUBE).isosurface(3.5)
    with refused("ends in none of .vtp, .ply, .stl, .obj, .gltf"):
        surface.save(tmp_path / "surface.png")
    with refused("cannot be written", nestgrid.IoError):
        surface.save(tmp_path / "nowhere" / "surface.ply")
    assert list(tmp_path.iterdir()) == []


def test_changed_values():
    array = CUBE.copy()
    volume = nestgrid.Volume(array)
    assert volume.range == (0, 26)
    array += 100
    volume.changed()
    assert volume.range == (100, 126)


def test_frame_budget_keeps_a_number_of_triangles(gyroid):
    noise = np.random.default_rng(4).normal(0, 0.2, gyroid.shape)
    volume = nestgrid.Volume(gyroid + noise)
    least, greatest = volume.range
    budget = nestgrid.FrameBudget(8000, greatest - least)
    for level in np.linspace(0, 0.5, 20):
        surface = volume.isosurface(level, budget.threshold, normals=False)
        budget.drawn(len(surface.triangles))
    assert 0.9 * 8000 < len(surface.triangles) < 1.1 * 8000

    def fits(threshold):
        return len(volume.isosurface(0.5, threshold, normals=False).triangles) <= 8000

    exact = volume.isosurface(0.5, max_triangles=8000).threshold
    assert budget.settle(fits) == pytest.approx(exact, rel=0.01)
    with refused("positive"):
        nestgrid.FrameBudget(0, 1)


def test_budgets_that_are_not_filled_say_why(gyroid):
    volume = nestgrid.Volume(gyroid)
    finest = len(volume.isosurface(0.5).triangles)
    plane = ((16, 16, 16), (1, 2, 3))
    assert volume.isosurface(0.5, max_triangles=finest // 2).budget_reason == ""
    assert volume.isosurface(0.5).budget_reason == ""
    all_of_it = f"{finest} of {2 * finest} triangles: nothing is left out"
    assert volume.isosurface(0.5, max_triangles=2 * finest).budget_reason == all_of_it
    assert "nothing" in volume.slice(plane=plane, max_triangles=10**9).budget_reason
    # Many nodes have one of two indicators.
    bits = nestgrid.Volume(np.random.default_rng(3).integers(0, 2, (33, 33, 33)).astype("uint8"))
    surface = bits.isosurface(0.5, max_triangles=3000)
    assert len(surface.triangles) < 2700
    assert "share one indicator, and the next lesser threshold" in surface.budget_reason


def test_an_error_that_is_asked_for_is_kept(gyroid):
    volume = nestgrid.Volume(gyroid)
    before = len(volume.isosurface(0.5).triangles)
    for error in (0.02, 0.1, 0.5):
        surface = volume.isosurface(0.5, error=error)
        assert 0 < surface.error_bound <= error
        assert surface.report()["open_edges"] == 0
        assert 0 < len(surface.triangles) < before
        before = len(surface.triangles)
        assert surface.error_bound <= surface.surface_error <= error
        everywhere = volume.isosurface(0.5, error, indicator="deviation")
        assert len(surface.triangles) < len(everywhere.triangles)
        fewer = volume.isosurface(0.5, error=error, collapse=True)
        assert fewer.surface_error <= error
        assert fewer.report()["closed"] == surface.report()["closed"]
        assert fewer.report()["euler"] == volume.isosurface(0.5, error=0.75 * error).report()["euler"]
        assert len(fewer.triangles) < 0.7 * len(surface.triangles)
        plane = ((16, 16, 16), (1, 2, 3))
        assert volume.slice(plane=plane, error=error).error_bound <= error
        exact = volume.slice(plane=plane)
        projected = volume.probe(exact.vertices, error=error)
        assert np.abs(projected - exact.attributes[:, 0]).max() <= error * (1 + 1e-6)
    budget = volume.isosurface(0.5, max_triangles=5000, indicator="deviation")
    assert budget.error_bound <= budget.threshold
    for others in ({"threshold": 1}, {"max_triangles": 9}, {"indicator": "visual"}):
        for asked in ("error", "distance"):
            with refused(f"{asked} is given alone"):
                volume.isosurface(0.5, **{asked: 0.1}, **others)
    for wrong in (-1, 0, np.nan):
        for asked in ("error", "distance"):
            with refused(asked):
                volume.isosurface(0.5, **{asked: wrong})
    with refused("error is given alone"):
        volume.isosurface(0.5, error=0.1, distance=0.1)
    few = volume.isosurface(0.5, max_triangles=600, collapse=True)
    assert 500 < len(few.triangles) <= 600
    assert few.error_bound == few.surface_error <= few.threshold
    again = volume.isosurface(0.5, error=few.threshold, collapse=True)
    assert np.array_equal(few.vertices, again.vertices)
    assert volume.isosurface(0.5, max_triangles=10**6, collapse=True).threshold == 0
    for wrong in (
        {},
        {"error": 0.1, "cap": True},
        {"error": 0.1, "at_nodes": True},
        {"threshold": 0.1},
        {"max_triangles": 600, "indicator": "visual"},
    ):
        with refused("collapse needs an error"):
            volume.isosurface(0.5, collapse=True, **wrong)


def test_collapsed_colours_keep_their_place_and_error() -> None:
    at = np.linspace(0, 1, 33)
    x, y, z = np.meshgrid(at, at, at, indexing="ij")
    samples = np.sin(5 * x) + y * z
    volume = nestgrid.Volume(samples)
    whole = volume.slice(plane=((16, 16, 16), (1, 2, 3)))
    few = volume.slice(plane=((16, 16, 16), (1, 2, 3)), error=0.05, collapse=True)
    assert len(few.triangles) < len(whole.triangles) / 10
    assert few.error_bound <= 0.05
    corners = few.vertices[few.triangles]
    colours = few.attributes[few.triangles, 0]
    off = volume.probe(corners.mean(axis=1)) - colours.mean(axis=1)
    assert np.abs(off).max() <= 0.05 + 1e-9
    assert np.abs((few.vertices - 16) @ np.array((1, 2, 3))).max() < 1e-9

    ball = {"sphere": ((16, 15, 17), 11), "error": 0.05, "collapse": True}
    still = volume.slice(**ball)
    moved = volume.slice(**ball, distance=0.5)
    assert len(moved.triangles) < len(still.triangles) / 10
    for middle in moved.vertices[moved.triangles].mean(axis=1), moved.vertices:
        assert np.abs(np.linalg.norm(middle - (16, 15, 17), axis=1) - 11).max() <= 0.6
    off = volume.probe(moved.vertices) - moved.attributes[:, 0]
    assert np.abs(off).max() <= 0.05 + 1e-9 and moved.error_bound <= 0.05
    for wrong in ({"sphere": ((16, 15, 17), 11)}, {"plane": ((1, 1, 1), (1, 0, 0))}):
        with refused("distance needs collapse"):
            volume.slice(**wrong, error=0.05, distance=1, collapse="plane" in wrong)
    for wrong in (0, -1, float("nan")):
        with refused("distance is not a number"):
            volume.slice(**ball, distance=wrong)

    picture = nestgrid.Volume(np.ascontiguousarray(samples[:, :, 16]))
    for scale in (None, 2.5):
        graph = picture.height_field(scale, error=0.05, collapse=True)
        assert len(graph.triangles) < len(picture.height_field(scale, error=0.05).triangles)
        lift = 0 if scale is None else scale * graph.attributes[:, 0]
        assert np.abs(graph.vertices[:, 2] - lift).max() < 1e-9
        assert graph.error_bound <= 0.05
    with refused("collapse needs an error"):
        volume.slice(plane=((16, 16, 16), (1, 2, 3)), collapse=True)
    with refused("collapse needs an error"):
        picture.height_field(collapse=True)
    for scale in (None, 2.5):
        budget = picture.height_field(scale, max_triangles=300)
        assert 0 < len(budget.triangles) <= 300 and budget.threshold > 0
        again = picture.height_field(scale, budget.threshold)
        assert np.array_equal(again.vertices, budget.vertices)
    with refused("even the coarsest"):
        picture.height_field(max_triangles=1)


def test_a_distance_that_is_asked_for_is_kept_about():
    x, y, z = np.mgrid[-1:1:33j, -1:1:33j, -1:1:33j]
    radius = np.sqrt(x * x + y * y + z * z).astype("float32")
    volume = nestgrid.Volume(radius, spacing=(1 / 16,) * 3, origin=(-1, -1, -1))
    before = len(volume.isosurface(0.6).triangles)
    for distance in (0.01, 0.03, 0.1):
        surface = volume.isosurface(0.6, distance=distance)
        off = np.abs(np.linalg.norm(surface.vertices, axis=1) - 0.6).max()
        assert off < 1.5 * distance
        assert len(surface.triangles) < before
        before = len(surface.triangles)


def test_a_distance_is_kept_there_and_back():
    reference = pytest.importorskip("vtkmodules.vtkCommonCore").reference
    data_model = pytest.importorskip("vtkmodules.vtkCommonDataModel")

    def farthest(points, surface):
        locator = data_model.vtkStaticCellLocator()
        locator.SetDataSet(surface.to_vtk())
        locator.BuildLocator()
        found, square = [0.0] * 3, reference(0.0)
        worst = 0.0
        for point in points:
            locator.FindClosestPoint(point, found, reference(0), reference(0), square)
            worst = max(worst, square.get())
        return np.sqrt(worst)

    noise = np.random.default_rng(5).normal(size=(17, 17, 17))
    noise = (noise + np.roll(noise, 1, 0) + np.roll(noise, 1, 1) + np.roll(noise, 1, 2)) / 4
    volume = nestgrid.Volume(noise.astype("float32"))
    whole = volume.isosurface(0.4)
    estimated = volume.isosurface(0.4, distance=1)
    kept = volume.isosurface(0.4, distance=1, distance_field=True)
    assert farthest(whole.vertices, estimated) > 1
    assert farthest(whole.vertices, kept) <= 1 + 1e-6
    assert farthest(kept.vertices, whole) <= 1 + 1e-6
    assert len(estimated.triangles) < len(kept.triangles) < len(whole.triangles)
    collapsed = volume.isosurface(0.4, distance=1, collapse=True)
    assert farthest(whole.vertices, collapsed) <= 1 + 1e-6
    assert farthest(collapsed.vertices, whole) <= 1 + 1e-6
    assert len(collapsed.triangles) < len(kept.triangles) / 4
    assert collapsed.report()["open_edges"] == 0
    nearest = volume.isosurface(
        0.4, max_triangles=len(kept.triangles) // 4, indicator="slope", collapse=True
    )
    assert 0 < len(nearest.triangles) <= len(kept.triangles) // 4
    assert farthest(whole.vertices, nearest) <= nearest.threshold * (1 + 1e-6)
    assert farthest(nearest.vertices, whole) <= nearest.threshold * (1 + 1e-6)
    everything = volume.isosurface(0.4, max_triangles=10**6, indicator="slope", collapse=True)
    assert everything.threshold == 0 and len(everything.triangles) > len(kept.triangles)
    for wrong in ({}, {"distance": 1, "lens": nestgrid.Lens(nestgrid.ball((8, 8, 8), 2), 1)}):
        with refused("distance_field needs a distance"):
            volume.isosurface(0.4, distance_field=True, **wrong)


def test_indicators_of_one_surface(gyroid):
    volume = nestgrid.Volume(gyroid)
    assert np.array_equal(
        volume.isosurface(0.5, 0.1, indicator="cut").vertices,
        volume.isosurface(0.5, error=0.1).vertices,
    )
    assert np.array_equal(
        volume.isosurface(0.5, 0.3, indicator="slope", cuts="finest").vertices,
        volume.isosurface(0.5, distance=0.3).vertices,
    )
    for indicator in ("cut", "slope"):
        surface = volume.isosurface(0.5, max_triangles=3000, indicator=indicator)
        assert 2000 < len(surface.triangles) <= 3000
        assert np.isfinite(surface.surface_error) == (indicator == "cut")
        with refused("indicator"):
            volume.slice(plane=((16, 16, 16), (1, 2, 3)), threshold=0.1, indicator=indicator)


def test_two_threads_at_once(gyroid):
    expected = [nestgrid.Volume(gyroid).isosurface(0.1 * i, 0.1, threads=1) for i in range(8)]
    volume = nestgrid.Volume(gyroid)
    results = [None] * 8

    def draw(first):
        for i in range(first, 8, 2):
            results[i] = volume.isosurface(0.1 * i, 0.1, threads=1 + first)

    threads = [threading.Thread(target=draw, args=(first,)) for first in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for ours, theirs in zip(results, expected):
        np.testing.assert_array_equal(ours.vertices, theirs.vertices)
        np.testing.assert_array_equal(ours.triangles, theirs.triangles)


def test_surfaces_are_closed_and_bounded(gyroid):
    volume = nestgrid.Volume(gyroid)
    for threshold in (0, 0.05, 0.2, 0.8):
        surface = volume.isosurface(0.1, threshold, cap=True)
        report = surface.report()
        assert report["closed"] and report["manifold"] and report["volume"] > 0
        on_level = volume.isosurface(0.1, threshold)
        # Vertices lie on edges, whose ends are off by the bound at most.
        values = volume.probe(on_level.vertices)
        assert np.abs(values - 0.1).max() <= on_level.error_bound * (1 + 1e-6) + 1e-6
        length = np.linalg.norm(on_level.normals, axis=1)
        np.testing.assert_allclose(length, 1, atol=1e-12)


def test_bands_lie_between_their_values(gyroid):
    volume = nestgrid.Volume(gyroid)
    for options in {}, {"threshold": 0.1}, {"error": 0.1}, {"threshold": 0.1, "indicator": "cut"}:
        band = volume.isoband(-0.2, 0.3, **options)
        values = volume.probe(band.vertices)
        off = np.minimum(np.abs(values + 0.2), np.abs(values - 0.3))
        assert off.max() <= band.error_bound * (1 + 1e-6) + 1e-5
        sides = [volume.isosurface(level, **options) for level in (-0.2, 0.3)]
        if "error" not in options and "indicator" not in options:
            assert len(band.triangles) == sum(len(side.triangles) for side in sides)
    most = len(volume.isoband(-0.2, 0.3, 0.05).triangles)
    assert 0.9 * most < len(volume.isoband(-0.2, 0.3, max_triangles=most).triangles) <= most
    lines = nestgrid.Volume(gyroid[0]).isolines([-0.2, 0.3], max_segments=100)
    assert 0 < sum(len(line) - 1 for line in lines) <= 100
    with refused("the lower isovalue is not below the upper one"):
        volume.isoband(0.3, -0.2)
    with refused("dimension 2, not 3"):
        nestgrid.Volume(gyroid[0]).isoband(-0.2, 0.3)


def test_the_boundary_is_closed_around_the_domain(gyroid):
    volume = nestgrid.Volume(gyroid)
    for options in {}, {"threshold": 0.1}, {"error": 0.1}, {"max_triangles": 4000}:
        boundary = volume.boundary(**options)
        report = boundary.report()
        assert report["closed"] and report["manifold"]
        assert report["volume"] == pytest.approx(np.prod(np.array(gyroid.shape) - 1.0))
        assert len(boundary.triangles) <= options.get("max_triangles", np.inf)
        assert boundary.attributes.shape == (len(boundary.vertices), 1)
    with refused("dimension 2, not 3"):
        nestgrid.Volume(gyroid[0]).boundary()


def test_lens_is_fine_inside_and_coarse_outside(gyroid):
    volume = nestgrid.Volume(gyroid)
    centre, radius = (32, 32, 32), 10
    surface = volume.isosurface(0, lens=(centre, radius))
    full = volume.isosurface(0)
    assert len(surface.triangles) < len(full.triangles) / 2

    def inside(which):
        middles = which.vertices[which.triangles].mean(axis=1)
        return (np.linalg.norm(middles - centre, axis=1) < radius - 2).sum()

    assert inside(surface) == inside(full)
    two = nestgrid.ball(centre, 5) | nestgrid.box((0, 0, 0), (5, 5, 5))
    assert len(volume.isosurface(0, lens=two).triangles) > 0


def test_another_threshold_holds_in_a_region(gyroid):
    volume, level = nestgrid.Volume(gyroid), 0.3
    everywhere = nestgrid.box((-1e9,) * 3, (1e9,) * 3)
    coarse, fine = volume.isosurface(level, 0.5), volume.isosurface(level, 0.01)
    in_all = volume.isosurface(level, 0.5, region=nestgrid.Region(everywhere, 0.01))
    assert np.array_equal(in_all.triangles, fine.triangles)
    corner = tuple(fine.vertices[0])
    some = volume.isosurface(level, 0.5, region=nestgrid.ball(corner, 3))
    assert len(coarse.triangles) < len(some.triangles) < len(volume.isosurface(level).triangles)
    report = some.report()
    assert report["open_edges"] == report["boundary_edges"] or report["open_edges"] == 0
    with refused("in the region|threshold is not a number >= 0"):
        nestgrid.Region(everywhere, -1)
    with refused("nor indicator"):
        volume.isosurface(level, error=0.1, collapse=True, region=everywhere)


def test_several_isosurfaces_are_those_of_each_value(gyroid):
    volume, level = nestgrid.Volume(gyroid), 0.3
    values = [level, level + 0.1]
    for value, drawn in zip(values, volume.isosurfaces(values, 0.05)):
        alone = volume.isosurface(value, 0.05)
        assert np.array_equal(drawn.vertices, alone.vertices)
        assert np.array_equal(drawn.triangles, alone.triangles)
        assert drawn.threshold == 0.05


def test_measured_errors_keep_to_the_promised_ones(gyroid):
    volume, level = nestgrid.Volume(gyroid), 0.3
    drawn = volume.isosurface(level, error=0.1)
    measured = volume.measure(drawn, level, points=10_000)
    assert 0 < measured["error"] <= 0.1
    assert measured["error_mean"] <= measured["error_rms"] <= measured["error"]
    assert measured["distance"] > 0 and measured["distance_back"] > 0
    assert volume.measure(volume.isosurface(level), level, points=10_000)["distance"] < 1e-6


def test_colours_follow_the_field():
    octree = nestgrid.Octree(
        np.array([[x, y, z, 1] for z in (0, 1) for y in (0, 1) for x in (0, 1)]),
        np.arange(8.0) ** 2,
    )
    plane = ((1, 1, 1), (1, 2, 3))
    followed = octree.slice(plane=plane, colour_tolerance=0.25)
    assert len(followed.triangles) > len(octree.slice(plane=plane).triangles)
    middles = followed.vertices[followed.triangles].mean(axis=1)
    colours = followed.attributes[followed.triangles, 0].mean(axis=1)
    assert np.abs(octree.probe(middles) - colours).max() <= 0.25
    with refused("a number of triangles"):
        octree.slice(plane=plane, colour_tolerance=0.25, max_triangles=100)


def test_colours_collapse_to_a_number_of_triangles(gyroid):
    volume = nestgrid.Volume(gyroid)
    plane = ((0, 0, 31.3), (0, 0, 1))
    few = volume.slice(plane=plane, max_triangles=300, collapse=True)
    assert 270 <= len(few.triangles) <= 300
    assert few.error_bound <= few.threshold
    assert few.error_bound < volume.slice(plane=plane, max_triangles=300).error_bound
    assert len(volume.boundary(error=0.2, collapse=True).triangles) < len(
        volume.boundary(error=0.2).triangles
    )


def test_hints_and_help():
    for name in nestgrid.__all__:
        assert inspect.getdoc(getattr(nestgrid, name)), name
    for kind in (nestgrid.Field, nestgrid.Frames, nestgrid.Surface, nestgrid.Lines):
        for name, member in inspect.getmembers(kind):
            if name.startswith("_"):
                continue
            assert inspect.getdoc(member), f"{kind.__name__}.{name}"
            function = member.fget if isinstance(member, property) else member
            assert "return" in function.__annotations__, f"{kind.__name__}.{name}"


def test_paraview_is_started_where_it_finds_the_plugin():
    program = "import inspect, os, nestgrid; inspect.getargspec; "
    program += "print(os.environ['PV_PLUGIN_PATH'])"
    start = [sys.executable, "-m", "nestgrid.paraview"]
    out = subprocess.run([*start, sys.executable, "-c", program], capture_output=True, check=True)
    assert os.listdir(out.stdout.decode().strip()) == ["nestgrid_filters.py"]
    failed = subprocess.run([*start, "no such program"], capture_output=True)
    assert failed.returncode != 0 and b"cannot be run" in failed.stderr
