# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every public function says in a sentence which argument is wrong, and help() tells them all."""
import inspect
import re
from typing import get_args

import numpy as np
import pytest

import nestgrid
from nestgrid._arguments import documented

CUBE = np.arange(27, dtype=float).reshape(3, 3, 3)
LEAVES = np.array([[x, y, z, 1] for z in (0, 1) for y in (0, 1) for x in (0, 1)])


IN_SPACE = ("isosurface", "isosurfaces", "isoband", "slice", "boundary", "measure")


class Nothing:
    """An object of a type that no argument takes."""


WRONG = [Nothing(), "abc", b"abc", None, 3.5, -7, [], {}, {1}, [[1], [2, 3]], [None], 1j, print]
WRONG += [True, float("nan"), np.zeros((2, 2, 2, 2)), np.array(["a"]), np.zeros(0), ("x", 1)]


def callables():
    """Each public function and method with arguments that are right, of one kind of each class."""
    volume = nestgrid.Volume(CUBE)
    flat = nestgrid.Volume(CUBE[0])
    frames = nestgrid.Frames([CUBE, CUBE + 1])
    cut = volume.slice(plane=((1, 1, 1), (0, 0, 1)), elements=True)
    budget = nestgrid.FrameBudget(1, 1)
    lens = nestgrid.Lens(nestgrid.ball((0, 0, 0), 1))
    region = nestgrid.Region(nestgrid.ball((0, 0, 0), 1))
    one = (0.0, 0.0, 1.0)
    yield nestgrid.Volume, {"array": CUBE}
    yield nestgrid.Octree, {"leaves": LEAVES, "values": np.zeros(8)}
    yield nestgrid.Blocks, {"boxes": [(0, (0, 0, 0), CUBE)]}
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    yield nestgrid.Cells, {
        "points": square,
        "types": np.array([9]),
        "offsets": np.array([0, 4]),
        "connectivity": np.arange(4),
        "values": np.arange(4.0),
    }
    yield nestgrid.Frames, {"arrays": [CUBE, CUBE]}
    yield nestgrid.FrameBudget, {"goal": 1, "greatest": 1}
    yield nestgrid.Lens, {"domain": nestgrid.ball((0, 0, 0), 1)}
    yield nestgrid.Region, {"domain": nestgrid.ball((0, 0, 0), 1)}
    yield nestgrid.ball, {"centre": one, "radius": 1}
    yield nestgrid.box, {"low": (0, 0, 0), "high": (1, 1, 1)}
    yield nestgrid.half_space, {"through": one, "normal": one}
    yield nestgrid.cone, {"apex": one, "towards": one, "angle": 0.5}
    yield nestgrid.polygon, {"corners": [(0, 0), (1, 0), (0, 1)]}
    yield nestgrid.view, {"eye": one, "towards": (1, 0, 0)}
    yield nestgrid.load, {"path": "x.nestgrid"}
    yield nestgrid.marching_cubes, {"volume": CUBE, "level": 3.5}
    right = {"isosurface": {"level": 3.5}, "slice": {"plane": ((1, 1, 1), one)}}
    right |= {"probe": {"points": one}, "isolines": {"values": [3.5]}, "height_field": {}}
    right |= {"isoband": {"low": 1.5, "high": 3.5}, "isosurfaces": {"levels": [3.5]}}
    right |= {"measure": {"surface": volume.isosurface(3.5), "level": 3.5}}
    right |= {"at": {"t": 0.5}, "drawn": {"cost": 1}, "settle": {"fits": lambda t: True}}
    right |= {"save": {"path": "x.png"}}
    for thing in (volume, flat, frames, cut, cut.isolines([3.5]), cut.outlines(), budget, lens, region):
        for name, method in inspect.getmembers(thing, inspect.ismethod):
            if not name.startswith("_") and name != "to_pyvista":
                if name in ("isolines", "height_field") and thing is volume:
                    continue  # for two dimensions
                if name in IN_SPACE and thing is flat:
                    continue
                yield method, right.get(name, {})


CALLABLES = {f.__qualname__: (f, right) for f, right in callables()}


def test_nothing_public_is_left_out():
    tried = {f.__qualname__ for f, _ in CALLABLES.values()}
    for name in nestgrid.__all__:
        thing = getattr(nestgrid, name)
        if inspect.isfunction(thing):
            assert name in tried
        elif inspect.isclass(thing) and not issubclass(thing, Exception):
            if inspect.signature(thing).parameters:
                assert name in tried
            for each, member in inspect.getmembers(thing, inspect.isfunction):
                if not each.startswith("_") and each != "to_pyvista":
                    assert member.__qualname__ in tried, f"{name}.{each}"


def is_sentence(error, where, name):
    text = str(error)
    assert "incompatible function arguments" not in text and "pybind" not in text, text
    assert "\n" not in text and len(text) < 300, text
    return text


@pytest.mark.parametrize("key", CALLABLES)
def test_wrong_types(key, tmp_path, monkeypatch):
    """Whatever is handed over, the error is ours, names the place and the argument, and is short."""
    monkeypatch.chdir(tmp_path)
    function, right = CALLABLES[key]
    ours = (nestgrid.InvalidInput, nestgrid.IoError, nestgrid.GridError)
    refused = 0
    for name in inspect.signature(function).parameters:
        for wrong in WRONG:
            try:
                function(**(right | {name: wrong}))
            except ours as error:
                is_sentence(error, function, name)
                if isinstance(error, nestgrid.InvalidType):
                    refused += 1
                    where = function.__name__
                    assert str(error).startswith(f"{where}(): {name} "), str(error)
            except (RuntimeError, NotImplementedError) as error:
                assert function is nestgrid.marching_cubes, repr(error)
    if inspect.signature(function).parameters:
        assert refused > 0


@pytest.mark.parametrize("key", CALLABLES)
def test_wrong_names_and_counts(key):
    function, right = CALLABLES[key]
    names = list(inspect.signature(function).parameters)
    if not names:
        return
    misspelt = names[0][:-1] + "x" + names[0][-1:] if len(names[0]) > 2 else "tt"
    with pytest.raises(nestgrid.InvalidType, match=f"no argument '{misspelt}', it has .*{names[0]}"):
        function(**(right | {misspelt: 1}))
    with pytest.raises(TypeError):
        function(*[1] * (len(names) + 1))
    for name in right:
        if inspect.signature(function).parameters[name].default is inspect.Parameter.empty:
            rest = {key: value for key, value in right.items() if key != name}
            with pytest.raises(nestgrid.InvalidType, match=f"'{name}' is missing"):
                function(**rest)


@pytest.mark.parametrize("key", CALLABLES)
def test_help_tells_all_arguments(key):
    function, _ = CALLABLES[key]
    doc = inspect.getdoc(function)
    parameters = set(inspect.signature(function).parameters)
    assert parameters <= documented(doc), parameters - documented(doc)
    assert parameters == set() or re.search("Raises|Returns", doc)
    assert max(len(line) for line in doc.splitlines()) <= 100


def test_encodings_of_files_are_refused_where_a_format_has_none(tmp_path):
    surface = nestgrid.Volume(CUBE).isosurface(3)
    for suffix in ("ply", "stl", "obj", "gltf"):
        with pytest.raises(nestgrid.InvalidInput, match="compress is for .vtp, not for '.*x." + suffix):
            surface.save(tmp_path / f"x.{suffix}", compress="zlib")
    for suffix in ("stl", "obj", "gltf"):
        with pytest.raises(nestgrid.InvalidInput, match="double=False is for .vtp and .ply, not for"):
            surface.save(tmp_path / f"x.{suffix}", double=False)
    with pytest.raises(nestgrid.InvalidInput, match="'lz4' is none of none and zlib"):
        surface.save(tmp_path / "x.vtp", compress="lz4")
    assert not list(tmp_path.iterdir())


def test_suggestions():
    volume = nestgrid.Volume(CUBE)
    with pytest.raises(nestgrid.InvalidInput, match="did you mean 'wavelet'?"):
        volume.isosurface(3, indicator="wavelett")
    with pytest.raises(nestgrid.InvalidInput, match="did you mean 'threshold'?"):
        volume.isosurface(3, treshold=1)
    with pytest.raises(nestgrid.InvalidInput, match="did you mean '.ply'?"):
        volume.isosurface(3).save("x.plly")
    with pytest.raises(nestgrid.InvalidInput, match="did you mean '.nrrd'?"):
        nestgrid.load("x.nrd")
    with pytest.raises(nestgrid.InvalidInput, match="did you mean 'float32'?"):
        nestgrid.load("x.raw", dims=(2, 2, 2), type="float")


def test_classes_that_are_not_made_by_hand():
    for kind in (nestgrid.Field, nestgrid.Surface, nestgrid.Lines, nestgrid.Segments, nestgrid.Domain):
        with pytest.raises(nestgrid.InvalidType, match="is (made by|a Volume)"):
            kind()
    with pytest.raises(TypeError, match="unsupported operand"):
        nestgrid.ball((0, 0, 0), 1) | 3


def test_numbers_of_other_types_are_taken():
    volume = nestgrid.Volume(CUBE.tolist(), spacing=[1, 1, 1])
    expected = volume.isosurface(3.5, max_triangles=50).vertices
    for level in (np.float32(3.5), np.array(3.5)):
        same = volume.isosurface(level, max_triangles=50.0, cap=np.False_, threads=np.int8(1))
        np.testing.assert_array_equal(same.vertices, expected)


def test_what_things_say_of_themselves():
    assert re.fullmatch(r"\d+\.\d+\.\d+", nestgrid.__version__)
    volume = nestgrid.Volume(CUBE, name="<b>heat</b>", unit="mm")
    surface = volume.slice(plane=((1, 1, 1), (0, 0, 1)), elements=True)
    assert "3 x 3 x 3 samples of float64, from 0 to 26" in repr(volume)
    assert "8 leaves" in repr(nestgrid.Octree(LEAVES, np.arange(8.0)))
    assert "from -3.5 to 10.5" in repr(nestgrid.Octree(LEAVES, np.arange(8.0)))  # at corners
    frames = nestgrid.Frames([CUBE, CUBE + 1])
    assert "2 frames" in repr(frames) and "from 0 to 27" in repr(frames)
    assert "time 0.5" in repr(frames.at(0.5)) and "from 0.5 to 26.5" in repr(frames.at(0.5))
    assert "triangles, error at most 0, from (0, 0, 1) to (2, 2, 1)" in repr(surface)
    assert "1 lines" in repr(surface.isolines(10))
    assert "segments" in repr(surface.outlines())
    assert repr(nestgrid.ball((0, 0, 0), 1)) == "nestgrid.ball([0.0, 0.0, 0.0], 1.0)"
    lines = surface.isolines(10)
    for thing in (volume, frames, frames.at(0), surface, lines, surface.outlines()):
        table = thing._repr_html_()
        assert table.startswith("<table>") and "<b>" not in table
    assert "&lt;b&gt;heat" in volume._repr_html_() and "mm" in volume._repr_html_()
    broken = nestgrid.Volume(np.full((2, 2, 2), np.inf))
    assert "not finite" in repr(broken)
    with pytest.raises(nestgrid.InvalidInput, match="no sample has a value"):
        nestgrid.Volume(np.full((2, 2, 2), np.nan))


def test_indicators_are_those_of_the_library():
    """The names that Python's types list are those of the compiled list, with their units."""
    from nestgrid import _arguments, _nestgrid

    listed = _nestgrid.indicators()
    assert get_args(_arguments.Indicator) == tuple(n for n, _, _, of_level in listed if not of_level)
    assert set(get_args(_arguments.SurfaceIndicator)) == {name for name, _, _, _ in listed}
    help = _arguments.SHARED["indicator"].help
    for name, measures, unit, of_level in listed:
        assert measures and unit in ("data", "length", "none")
        assert of_level or f'"{name}"' in help
