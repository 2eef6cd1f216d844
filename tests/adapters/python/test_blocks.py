# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Boxes of cells on levels: of arrays, which are borrowed, and of plotfiles, which are mapped."""
import math
import os
import pickle
import re
import sys
from collections import Counter

import numpy as np
import pytest

import nestgrid

N = 8  # cells of level 0 along the unit cube


def centres(level, lower, shape, ratio=2):
    """The coordinates of the centres of a box."""
    width = 1 / N / ratio**level
    along = [(low + np.arange(n) + 0.5) * width for low, n in zip(lower, shape)]
    return np.meshgrid(*along, indexing="ij")


def ball(x, y, z):
    return np.sqrt((x - 0.5) ** 2 + (y - 0.45) ** 2 + (z - 0.5) ** 2) - 0.3


#: Level, lowest cell and size: level 1 covers a part of level 0, level 2 of that.
PLACES = [(0, (0, 0, 0), (4, 8, 8)), (0, (4, 0, 0), (4, 8, 8)), (1, (4, 4, 4), (8, 8, 8))]
PLACES += [(2, (12, 12, 12), (8, 4, 4)), (2, (20, 12, 16), (4, 8, 8))]


def boxes(f, dtype=float):
    return [(level, low, f(*centres(level, low, shape)).astype(dtype)) for level, low, shape in PLACES]


def blocks(f=ball, **options):
    return nestgrid.Blocks(boxes(f), spacing=[1 / N] * 3, **options)


def edges(surface):
    """How often each edge is used."""
    t = surface.triangles
    pairs = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    return Counter(map(tuple, pairs.tolist()))


@pytest.mark.parametrize("rule", ["smooth", "centres", "means"])
def test_linear_functions_are_reproduced(rule):
    field = blocks(lambda x, y, z: 1 + 2 * x - 3 * y + z, rule=rule)
    points = np.random.default_rng(1).uniform(0, 1, (200, 3))
    expected = 1 + 2 * points[:, 0] - 3 * points[:, 1] + points[:, 2]
    np.testing.assert_allclose(field.probe(points), expected, atol=1e-12)


def test_surfaces_are_closed():
    for threshold in (0, 0.01, 0.05):
        surface = blocks().isosurface(0, threshold)
        assert len(surface.triangles) > 50
        assert set(edges(surface).values()) == {2}


def test_covered_cells_are_not_looked_at():
    given = boxes(ball)
    level, lower, array = given[2]
    array[2:6, 2:4, 2:4] = np.nan  # below level 2
    surface = nestgrid.Blocks(given, spacing=[1 / N] * 3).isosurface(0)
    expected = blocks().isosurface(0)
    np.testing.assert_array_equal(surface.vertices, expected.vertices)
    given[0][2][1, 3, 3] = np.nan  # a leaf
    assert set(edges(nestgrid.Blocks(given, spacing=[1 / N] * 3).isosurface(0)).values()) == {1, 2}


def test_any_order_in_memory_and_types():
    expected = blocks().isosurface(0).vertices
    for order in ("C", "F"):
        given = [(level, low, np.array(a, order=order)) for level, low, a in boxes(ball)]
        np.testing.assert_array_equal(
            nestgrid.Blocks(given, spacing=[1 / N] * 3).isosurface(0).vertices, expected
        )
    backwards = [(level, low, a[::-1].copy()[::-1]) for level, low, a in boxes(ball)]
    ghosts = [(level, low, np.pad(a, 2, constant_values=np.nan)[2:-2, 2:-2, 2:-2]) for level, low, a in boxes(ball)]
    for given in (backwards, ghosts):
        field = nestgrid.Blocks(given, spacing=[1 / N] * 3)
        np.testing.assert_array_equal(field.isosurface(0).vertices, expected)
    single = nestgrid.Blocks(boxes(ball, np.float32), spacing=[1 / N] * 3)
    np.testing.assert_allclose(single.isosurface(0).vertices, expected, atol=1e-5)
    whole = nestgrid.Blocks([(0, (0, 0), [[0, 1], [2, 3]])])
    assert whole.probe([[1, 1]])[0] == 1.5


def test_masked_cells_have_no_number():
    """As nan has none, in boxes and trees; a mask without an entry changes nothing."""
    here = ball(*centres(0, (0, 0, 0), (8, 8, 8)))
    hidden = here > 0.2
    outside = [[0.95, 0.95, 0.95], [0.5, 0.5, 0.5]]
    leaves = np.column_stack([*(np.indices((8, 8, 8)).reshape(3, -1)), np.full(512, 3)])
    for array, finite in (
        (np.ma.masked_array(here, hidden), [False, True]),
        (np.ma.masked_array(here < 0, hidden), [False, True]),
        (np.ma.masked_array(here, np.zeros_like(hidden)), [True, True]),
    ):
        boxes_field = nestgrid.Blocks([(0, (0, 0, 0), array)], spacing=[1 / N] * 3)
        trees = nestgrid.Octree(leaves, array.ravel(), max_level=3, spacing=[1 / N] * 3)
        for field in (boxes_field, trees):
            assert np.isfinite(field.probe(outside)).ravel().tolist() == finite
    with pytest.raises(nestgrid.InvalidInput, match=r"Blocks\(\): no cell has a value"):
        nestgrid.Blocks([(0, (0, 0, 0), np.full((2, 2, 2), np.nan))])


def test_numbers_that_lie_in_one_place():
    """What NumPy repeats without a copy is as good as a copy."""
    layer = np.arange(4.0)
    repeated = nestgrid.Blocks([(0, (0, 0, 0), np.broadcast_to(layer, (4, 4, 4)))])
    copied = nestgrid.Blocks([(0, (0, 0, 0), np.broadcast_to(layer, (4, 4, 4)).copy())])
    np.testing.assert_array_equal(repeated.isosurface(1.7).vertices, copied.isosurface(1.7).vertices)
    assert len(copied.isosurface(1.7).vertices) > 8


def test_arrays_are_borrowed():
    given = boxes(ball)
    field = nestgrid.Blocks(given, spacing=[1 / N] * 3)
    before = field.isosurface(0).vertices
    for _, _, array in given:
        array -= 0.05
    field.changed()
    assert len(field.isosurface(0).vertices) != len(before)
    del given, array
    field.isosurface(0.01)


def test_pickle():
    field = blocks(name="distance", unit="m")
    again = pickle.loads(pickle.dumps(field))
    np.testing.assert_array_equal(field.isosurface(0).vertices, again.isosurface(0).vertices)
    assert repr(again) == repr(field) and "5 boxes of dimension 3 on 3 levels" in repr(field)


def write_plotfile(folder, given, name="distance", time=2.5):
    """A plotfile as AMReX writes it, of one field."""

    def text(low, shape):
        high = [a + n - 1 for a, n in zip(low, shape)]
        return "((%d,%d,%d) (%d,%d,%d) (0,0,0))" % (*low, *high)

    levels = 1 + max(level for level, _, _ in given)
    header = f"HyperCLaw-V1.1\n1\n{name}\n3\n{time}\n{levels - 1}\n0 0 0\n1 1 1\n" + "2 " * (levels - 1)
    header += "\n" + " ".join(text((0, 0, 0), [N * 2**k] * 3) for k in range(levels))
    header += "\n" + "0 " * levels + "\n"
    header += "".join("%.17g %.17g %.17g\n" % ((1 / (N * 2**k),) * 3) for k in range(levels)) + "0\n0\n"
    for k in range(levels):
        own = [(low, array) for level, low, array in given if level == k]
        header += f"{k} {len(own)} 2.5\n0\n"
        for low, array in own:
            for a, n in zip(low, array.shape):
                header += "%.17g %.17g\n" % (a / (N * 2**k), (a + n) / (N * 2**k))
        header += f"Level_{k}/Cell\n"
        os.makedirs(folder / f"Level_{k}")
        cells = f"1\n1\n1\n0\n({len(own)} 0\n"
        cells += "".join(text(low, array.shape) + "\n" for low, array in own) + f")\n{len(own)}\n"
        data = b""
        for low, array in own:
            cells += f"FabOnDisk: Cell_D_00000 {len(data)}\n"
            kind = "((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))"
            data += f"FAB {kind}{text(low, array.shape)} 1\n".encode() + array.tobytes(order="F")
        (folder / f"Level_{k}" / "Cell_D_00000").write_bytes(data)
        (folder / f"Level_{k}" / "Cell_H").write_text(cells + "\n")
    (folder / "Header").write_text(header)


def test_plotfiles(tmp_path):
    given = boxes(ball)
    folder = tmp_path / "plt00000"
    write_plotfile(folder, given)
    expected = blocks().isosurface(0).vertices
    for path in (folder, folder / "Header"):
        for array in ("", "distance"):
            field = nestgrid.load(path, array)
            np.testing.assert_array_equal(field.isosurface(0).vertices, expected)
    assert field.name == "distance" and field.dimension == 3
    again = pickle.loads(pickle.dumps(field))
    np.testing.assert_array_equal(again.isosurface(0).vertices, expected)
    with pytest.raises(nestgrid.InvalidInput, match="there is no field 'x', only 'distance'"):
        nestgrid.load(folder, "x")
    with pytest.raises(nestgrid.InvalidInput, match="frame, component and magnitude choose nothing"):
        nestgrid.load(folder, frame=1)
    with pytest.raises(nestgrid.InvalidInput, match="dims is for .raw files"):
        nestgrid.load(folder, dims=(1, 2, 3))
    for rule in ("smooth", "centres", "means"):
        field = nestgrid.load(folder, rule=rule)
        expected = blocks(rule=rule).isosurface(0).vertices
        for each in (field, pickle.loads(pickle.dumps(field))):
            np.testing.assert_array_equal(each.isosurface(0).vertices, expected, rule)
    data = folder / "Level_2" / "Cell_D_00000"
    data.write_bytes(data.read_bytes()[:-1])
    with pytest.raises(nestgrid.IoError, match="is truncated"):
        nestgrid.load(folder)


def moved(x, y, z):
    return ball(x - 0.1, y, z)


def test_plotfiles_are_frames(tmp_path):
    """At the time of a file they have its surface, between two the one of the mean."""
    write_plotfile(tmp_path / "plt0", boxes(ball), time=1)
    write_plotfile(tmp_path / "plt1", boxes(moved), time=3)
    paths = [tmp_path / "plt0", tmp_path / "plt1" / "Header"]
    frames = nestgrid.load(paths)
    assert frames.times == [1, 3] and frames.name == "distance" and len(frames) == 2
    mean = nestgrid.Blocks(boxes(lambda *x: (ball(*x) + moved(*x)) / 2), spacing=[1 / N] * 3)
    for each in (frames, pickle.loads(pickle.dumps(frames))):
        for t, field in ((1, blocks()), (3, blocks(moved)), (2, mean)):
            np.testing.assert_allclose(each.at(t).isosurface(0).vertices, field.isosurface(0).vertices, atol=1e-12)
    assert nestgrid.load(paths, times=[0, 10]).times == [0, 10]
    with pytest.raises(nestgrid.InvalidInput, match="times has 1, not one for each of the 2 files"):
        nestgrid.load(paths, times=[0])
    with pytest.raises(nestgrid.InvalidInput, match="plt0' alone is given no time"):
        nestgrid.load(paths[0], times=[0])
    with pytest.raises(nestgrid.InvalidInput, match="ascend"):
        nestgrid.load(paths[::-1])
    with pytest.raises(nestgrid.InvalidInput, match="there are no paths"):
        nestgrid.load([])
    write_plotfile(tmp_path / "plt2", boxes(ball)[:3], time=5)
    with pytest.raises(nestgrid.InvalidInput, match="plt2' has another grid than '.*plt0'"):
        nestgrid.load([paths[0], tmp_path / "plt2"])
    (tmp_path / "x.vti").write_text("")
    with pytest.raises(nestgrid.InvalidInput, match="of boxes of cells or of hyper trees, which '.*x.vti' is not"):
        nestgrid.load([paths[0], tmp_path / "x.vti"])


TOOLS = os.path.join(os.path.dirname(__file__), "..", "..", "tools")


@pytest.fixture(scope="module")
def amr_files(tmp_path_factory):
    """One grid of blocks in each format, as make_amr_files.py writes it, and its folder."""
    pytest.importorskip("h5py")
    pytest.importorskip("vtkmodules.vtkIOXML")
    folder = tmp_path_factory.mktemp("amr")
    sys.path.insert(0, TOOLS)
    try:
        import make_amr_files
    finally:
        sys.path.remove(TOOLS)
    make_amr_files.write_all(str(folder), 3, 0.5)
    make_amr_files.write_all(str(folder), 3, 1, "later_")
    make_amr_files.write_all(str(folder), 2, 0, "plane_")
    return folder


FORMATS = ["amr.vthb", "run_hdf5_plt_cnt_0000", "enzo/data0000.hierarchy", "chombo.hdf5", "athena.athdf"]
FORMATS += ["leaves_hdf5_plt_cnt_0000", "old_enzo/data0000.hierarchy"]


def test_formats_of_codes_have_one_surface(amr_files):
    """Whatever covered cells, ghost cells and blocks that are not stored hold."""
    surfaces = []
    for name in FORMATS:
        field = nestgrid.load(amr_files / name, "dist")
        assert field.name == "dist" and "80 boxes of dimension 3 on 3 levels" in repr(field), name
        surfaces.append(field.isosurface(0))
        assert set(edges(surfaces[-1]).values()) == {2}
        np.testing.assert_array_equal(
            np.sort(surfaces[-1].vertices, axis=0), np.sort(surfaces[0].vertices, axis=0), name
        )
        place = nestgrid.load(amr_files / name, "plac")
        points = np.random.default_rng(1).uniform(0, 1, (50, 3))
        np.testing.assert_allclose(place.probe(points), points[:, 0], atol=1e-12, err_msg=name)


def test_trees_have_the_surface_of_boxes(amr_files):
    expected = nestgrid.load(amr_files / "chombo.hdf5", "dist").isosurface(0)
    field = nestgrid.load(amr_files / "trees.htg", "dist")
    assert field.name == "dist" and field.dimension == 3
    surface = field.isosurface(0)
    assert set(edges(surface).values()) == {2}
    np.testing.assert_allclose(
        np.sort(surface.vertices, axis=0), np.sort(expected.vertices, axis=0), atol=1e-12
    )
    points = np.random.default_rng(1).uniform(0, 1, (50, 2))
    plane = nestgrid.load(amr_files / "plane_trees.htg", "plac")
    np.testing.assert_allclose(plane.probe(points), points[:, 0], atol=1e-12)
    np.testing.assert_array_equal(
        pickle.loads(pickle.dumps(field)).isosurface(0).vertices, surface.vertices
    )
    with pytest.raises(nestgrid.InvalidInput, match="several fields, choose one by array"):
        nestgrid.load(amr_files / "trees.htg")
    with pytest.raises(nestgrid.InvalidInput, match="did you mean 'dist'"):
        nestgrid.load(amr_files / "trees.htg", "dits")
    with pytest.raises(nestgrid.InvalidInput, match="component chooses nothing"):
        nestgrid.load(amr_files / "trees.htg", "dist", component=0)
    (amr_files / "cut.htg").write_bytes((amr_files / "trees.htg").read_bytes()[:-9])
    with pytest.raises(nestgrid.IoError, match="cut.htg is truncated"):
        nestgrid.load(amr_files / "cut.htg", "dist")


def test_masked_and_ghost_trees(tmp_path):
    """What is masked or belongs to another process is not drawn."""
    pytest.importorskip("vtkmodules.vtkIOXML")
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    def grid_of(factor=2, ghosts=None, mask=None):
        grid = vtk.vtkHyperTreeGrid()
        grid.SetDimensions([3, 3, 3])
        grid.SetBranchFactor(factor)
        for put in (grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates):
            put(numpy_to_vtk(np.array([0.0, 1.0, 3.0]), deep=True))
        cursor = vtk.vtkHyperTreeGridNonOrientedCursor()
        count = 0
        for tree in range(8):
            grid.InitializeNonOrientedCursor(cursor, tree, True)
            cursor.SetGlobalIndexStart(count)
            count += 1
            if tree == 0:
                cursor.SubdivideLeaf()
                count += factor**3
        places = np.arange(float(count))
        for name, numbers in (("number", places), ("vtkGhostType", ghosts)):
            if numbers is not None:
                array = numpy_to_vtk(np.array(numbers), deep=True)
                array.SetName(name)
                grid.GetCellData().AddArray(array)
        if mask is not None:
            bits = vtk.vtkBitArray()
            for each in mask:
                bits.InsertNextValue(int(each))
            grid.SetMask(bits)
        writer = vtk.vtkXMLHyperTreeGridWriter()
        writer.SetDataModeToBinary()
        writer.SetFileName(str(tmp_path / "x.htg"))
        writer.SetInputDataObject(grid)
        assert writer.Write()
        return nestgrid.load(tmp_path / "x.htg", "number")

    for factor in (2, 3):
        last = np.arange(8 + factor**3) == 7 + factor**3  # the last tree
        assert np.isfinite(grid_of(factor).probe([[2.5, 2.5, 2.5]])).all()
        for field in (grid_of(factor, mask=last), grid_of(factor, ghosts=last.astype(np.uint8))):
            assert np.isnan(field.probe([[2.5, 2.5, 2.5]])).all()
            assert np.isfinite(field.probe([[0.5, 0.5, 2.5]])).all()


@pytest.mark.parametrize("rule", ["smooth", "centres", "means"])
def test_rules_of_trees(amr_files, rule):
    """Trees and boxes have the same smooth values and much the same sharp ones, which bring spheres
    nearer, of trees by threes, too."""
    boxes = nestgrid.load(amr_files / "chombo.hdf5", "dist", rule=rule).isosurface(0).report()
    trees = nestgrid.load(amr_files / "trees.htg", "dist", rule=rule).isosurface(0).report()
    for what in ("area", "volume"):
        assert trees[what] == pytest.approx(boxes[what], rel=1e-12 if rule == "smooth" else 2e-3), what
    smooth, sharp = (
        nestgrid.load(amr_files / "thirds.htg", "dist", rule=each).isosurface(0).report()["volume"]
        for each in ("smooth", rule)
    )
    assert abs(sharp) > abs(smooth) if rule != "smooth" else sharp == smooth
    paths = [amr_files / "trees.htg", amr_files / "later_trees.htg"]
    frames = nestgrid.load(paths, "dist", rule=rule)
    assert frames.at(0).isosurface(0).report()["volume"] == trees["volume"]


@pytest.mark.parametrize("rule", ["centres", "means"])
def test_balls_beside_vtk(tmp_path, rule):
    """Area and volume of a ball in cells of which one half is finer: means are taken for what they
    are, so that sharp values are nearer than VTK's; those of centres are as near, but for a tenth."""
    n = 16
    filters = pytest.importorskip("vtkmodules.vtkFiltersHyperTree")
    import vtk

    sys.path.insert(0, TOOLS)
    try:
        import make_amr_files
    finally:
        sys.path.remove(TOOLS)

    def squared(x, y, z):  # less a constant: a mean over a cell of edge h is greater by h^2 / 4
        h = np.where(x < 0.5, 1, 0.5) / n
        return (x - 0.52) ** 2 + (y - 0.5) ** 2 + (z - 0.5) ** 2 - 0.31**2 + h**2 / 4 * (rule == "means")

    path = str(tmp_path / "half.htg")
    corners = [np.linspace(0, 1, n + 1)] * 3
    make_amr_files.write_trees(path, corners, 2, {"u": squared}, lambda level, x: level < 1 and x[0] > 0.5)
    report = nestgrid.load(path, "u", rule=rule).isosurface(0).report()
    reader = vtk.vtkXMLHyperTreeGridReader()
    reader.SetFileName(path)
    contour = filters.vtkHyperTreeGridContour()
    contour.SetInputConnection(reader.GetOutputPort())
    contour.SetInputArrayToProcess(0, 0, 0, 1, "u")
    contour.SetValue(0, 0)
    mass = vtk.vtkMassProperties()
    mass.SetInputConnection(contour.GetOutputPort())
    exact = {"area": 4 * math.pi * 0.31**2, "volume": 4 / 3 * math.pi * 0.31**3}
    for what, of_vtk in (("area", mass.GetSurfaceArea()), ("volume", mass.GetVolume())):
        ours, theirs = (abs(abs(each) / exact[what] - 1) for each in (report[what], of_vtk))
        assert ours < (0.8 if rule == "means" else 1.1) * theirs, (what, ours, theirs)


@pytest.mark.parametrize("kind", ["_2.htg", "_3.htg", ".vthb"])
def test_planes_across_axes(amr_files, kind):
    """Trees and boxes lie where they are in space, and have the lines of the plane across z."""
    lengths = []
    for axis, name in enumerate("xyz"):
        field = nestgrid.load(amr_files / f"plane_across_{name}{kind}", "dist")
        assert field.dimension == 2
        field = pickle.loads(pickle.dumps(field))
        lines = field.isolines(0, 0)
        assert (lines.vertices[:, axis] == 0.3).all()
        lengths.append(sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines))
    assert len(lengths) == 3 and np.ptp(lengths) < 1e-12 and lengths[0] > 1


def test_trees_end_at_the_limit_of_their_depth(amr_files):
    """As in VTK's own filters: a divided cell at the limit is a leaf with its own value."""
    vtk_xml = pytest.importorskip("vtkmodules.vtkIOXML")
    from nestgrid._vtk_trees import trees_of

    reader = vtk_xml.vtkXMLHyperTreeGridReader()
    reader.SetFileName(str(amr_files / "thirds.htg"))
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    counts = []
    for limit in (0, 1, 2, 9):
        grid.SetDepthLimiter(limit)
        trees = trees_of(grid)
        assert trees.leaves[:, -1].max() == trees.max_level == min(limit, 2)
        volume = (1.0 / 27) ** trees.leaves[:, -1].astype(float)
        assert volume.sum() == pytest.approx(512)
        assert len(np.unique(trees.index)) == len(trees.index)
        counts.append(len(trees.leaves))
    assert counts[0] == 512 < counts[1] < counts[2] == counts[3]


@pytest.mark.parametrize("name", ["trees.htg", "thirds.htg", "uneven.htg"])
def test_trees_of_all_kinds(amr_files, name):
    """Linear functions are reproduced, surfaces are closed, of files and of their pickles."""
    for prefix, dimension in (("", 3), ("plane_", 2)):
        place = nestgrid.load(amr_files / (prefix + name), "plac")
        points = np.random.default_rng(1).uniform(0, 1, (50, dimension))
        np.testing.assert_allclose(place.probe(points), points[:, 0], atol=1e-12)
    field = nestgrid.load(amr_files / name, "dist")
    for threshold in (0, 0.005, 0.05):
        surface = field.isosurface(0, threshold)
        assert set(edges(surface).values()) == {2}, threshold
    area = field.isosurface(0).report()["area"]
    assert 1.08 < area < 1.135  # 0.36 pi
    np.testing.assert_array_equal(
        pickle.loads(pickle.dumps(field)).isosurface(0).vertices, field.isosurface(0).vertices
    )


@pytest.mark.parametrize("name", ["thirds", "uneven", "even", "plane_thirds", "plane_even"])
def test_pieces_of_trees(amr_files, name):
    """Those of several processes are one grid, also where levels change between them."""
    whole = nestgrid.load(amr_files / f"{name}.htg", "dist")
    pieces = nestgrid.load(amr_files / f"{name}.phtg", "dist")
    points = np.random.default_rng(1).uniform(0, 1, (200, whole.dimension))
    np.testing.assert_array_equal(pieces.probe(points), whole.probe(points))
    assert np.isfinite(whole.probe(points)).all()
    if whole.dimension == 3:
        found, expected = (field.isosurface(0, 2e-3).report() for field in (pieces, whole))
        assert found["open_edges"] == 0 and found["area"] == pytest.approx(expected["area"], rel=1e-12)
    both = nestgrid.load(amr_files / f"{name}.phtg", "both", component=1)
    np.testing.assert_allclose(both.probe(points).ravel(), points[:, 0], atol=1e-12)


def test_pieces_that_do_not_fit(amr_files):
    text = (amr_files / "even.phtg").read_text()

    def refused(sentence, old, new, error=nestgrid.IoError):
        (amr_files / "wrong.phtg").write_text(text.replace(old, new))
        with pytest.raises(error, match=sentence):
            nestgrid.load(amr_files / "wrong.phtg", "dist")

    refused("its piece 'gone.htg' does not exist", "even_1", "gone")
    refused("its piece 'even.phtg' does not end in .htg", "even_1.htg", "even.phtg")
    refused("trees of a piece lie elsewhere than those of the first one", "even_1", "uneven_1")
    refused("overlaps leaf", "even_1", "even_2", nestgrid.InvalidInput)
    (amr_files / "none.phtg").write_text(re.sub("even_[012]", "even_3", text))
    for name in ("none.phtg", "even_3.htg"):
        with pytest.raises(nestgrid.IoError, match=f"{name}: it has no trees"):
            nestgrid.load(amr_files / name, "dist")


@pytest.mark.parametrize("version, mode", [(1, "Ascii"), (1, "Appended"), (2, "Ascii"), (2, "Binary")])
def test_arrays_of_several_numbers_in_trees(amr_files, version, mode):
    """They have all their numbers, however a file has them, and are refused without a part."""
    vtk_xml = pytest.importorskip("vtkmodules.vtkIOXML")
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    reader = vtk_xml.vtkXMLHyperTreeGridReader()
    reader.SetFileName(str(amr_files / "plane_thirds.htg"))
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    cells = grid.GetCellData()
    plac = vtk_to_numpy(cells.GetArray("plac"))
    both = numpy_to_vtk(np.stack([plac, 2 * plac, 3 * plac], axis=1), deep=True)
    both.SetName("b: 3 %")
    cells.AddArray(both)
    path = amr_files / f"{mode}_{version}.htg"
    writer = vtk_xml.vtkXMLHyperTreeGridWriter()
    writer.SetDataSetMajorVersion(version)
    getattr(writer, f"SetDataModeTo{mode}")()
    writer.SetFileName(str(path))
    writer.SetInputDataObject(grid)
    assert writer.Write()
    points = np.random.default_rng(1).uniform(0, 1, (50, 2))
    for c in range(3):
        field = nestgrid.load(path, "b: 3 %", component=c)
        np.testing.assert_allclose(field.probe(points), (c + 1) * points[:, 0], atol=1e-12)
    if (version, mode) == (2, "Ascii"):
        path.write_bytes(re.sub(rb"[-0-9. ]+\n( *<InformationKey)", rb"\1", path.read_bytes()))
        assert nestgrid.load(path, "plac").probe([[0.5, 0.5]]) == pytest.approx(0.5)
        with pytest.raises(nestgrid.IoError, match="fewer numbers than the trees have cells"):
            nestgrid.load(path, "b: 3 %", component=1)


@pytest.mark.parametrize("name", ["trees.htg", "thirds.htg", "uneven.htg"])
def test_trees_are_frames(amr_files, name):
    """At the time of a file they have its surface, between two that of the mean."""
    paths = [amr_files / name, amr_files / f"later_{name}"]
    frames = nestgrid.load(paths, "dist")
    assert frames.times == [0, 1] and frames.name == "dist" and "leaves of dimension 3" in repr(frames)
    alone = [nestgrid.load(path, "dist") for path in paths]
    points = np.random.default_rng(1).uniform(0, 1, (50, 3))
    mean = sum(field.probe(points) for field in alone) / 2
    for each in (frames, pickle.loads(pickle.dumps(frames))):
        for t, field in enumerate(alone):
            np.testing.assert_array_equal(each.at(t).isosurface(0).vertices, field.isosurface(0).vertices)
        np.testing.assert_allclose(each.at(0.5).probe(points), mean, atol=1e-12)
        assert set(edges(each.at(0.5).isosurface(0)).values()) == {2}
    assert nestgrid.load(paths, "dist", times=[2, 10]).times == [2, 10]
    with pytest.raises(nestgrid.InvalidInput, match="times has 3, not one for each of the 2 files"):
        nestgrid.load(paths, "dist", times=[0, 1, 2])
    with pytest.raises(nestgrid.InvalidInput, match="ascend"):
        nestgrid.load(paths, "dist", times=[1, 0])
    for other in {"trees.htg", "thirds.htg", "uneven.htg", "plane_trees.htg"} - {name}:
        with pytest.raises(nestgrid.InvalidInput, match=f"{other}' has another grid than '.*{name}'"):
            nestgrid.load([paths[0], amr_files / other], "dist")
    with pytest.raises(nestgrid.InvalidInput, match="amr.vthb' is of another format than"):
        nestgrid.load([paths[0], amr_files / "amr.vthb"], "dist")


def write_source(path, values, factor=3, descriptor="R.. | " + 27 * ".", missing=()):
    """The trees of VTK's own source, with values of their cells at the centres."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    source = vtk.vtkHyperTreeGridSource()
    source.SetDimensions([4, 2, 2])
    source.SetGridScale(1, 1, 1)
    source.SetBranchFactor(factor)
    source.SetMaxDepth(2)
    source.SetDescriptor(descriptor)
    source.Update()
    grid = source.GetHyperTreeGridOutput()
    numbers = np.full(grid.GetGlobalNodeIndexMax() + 1, np.nan)
    cursor = vtk.vtkHyperTreeGridNonOrientedGeometryCursor()

    def visit():
        low, high = np.reshape(cursor_bounds(cursor), (3, 2)).T
        numbers[cursor.GetGlobalNodeIndex()] = values(*(low + high) / 2)
        if not cursor.IsLeaf():
            for child in range(cursor.GetNumberOfChildren()):
                cursor.ToChild(child)
                visit()
                cursor.ToParent()

    for tree in range(3):
        grid.InitializeNonOrientedGeometryCursor(cursor, tree)
        visit()
    numbers[list(missing)] = np.nan
    array = numpy_to_vtk(numbers, deep=True)
    array.SetName("value")
    grid.GetCellData().Initialize()
    grid.GetCellData().AddArray(array)
    writer = vtk.vtkXMLHyperTreeGridWriter()
    writer.SetDataModeToBinary()
    writer.SetFileName(str(path))
    writer.SetInputDataObject(grid)
    assert writer.Write()


def cursor_bounds(cursor):
    bounds = [0.0] * 6
    cursor.GetBounds(bounds)
    return bounds


def test_frames_of_trees_with_missing_cells(tmp_path):
    """What has no value in one frame is drawn in none, and counts for nothing beside it."""
    pytest.importorskip("vtkmodules.vtkIOXML")
    write_source(tmp_path / "a.htg", lambda x, y, z: x)
    write_source(tmp_path / "b.htg", lambda x, y, z: 2 * x, missing=[2])
    points = [[0.1, 0.2, 0.3], [1.2, 0.5, 0.5], [1.8, 0.1, 0.9]]
    a, b = (nestgrid.load(tmp_path / name) for name in ("a.htg", "b.htg"))
    np.testing.assert_allclose(a.probe(points), [0.1, 1.2, 1.8], atol=1e-12)
    frames = nestgrid.load([tmp_path / "a.htg", tmp_path / "b.htg"])
    for t in (0, 0.5, 1):
        np.testing.assert_allclose(frames.at(t).probe(points), (1 + t) * np.array([0.1, 1.2, 1.8]), atol=1e-12)
        assert np.isnan(frames.at(t).probe([[2.5, 0.5, 0.5]])).all()
    write_source(tmp_path / "c.htg", lambda x, y, z: math.inf)
    with pytest.raises(nestgrid.InvalidInput, match=r"load\(\): .*c.htg: the value inf of leaf 0 is not"):
        nestgrid.load([tmp_path / "a.htg", tmp_path / "c.htg"])
    write_source(tmp_path / "d.htg", lambda x, y, z: x, descriptor="RR. | " + 54 * ".")
    with pytest.raises(nestgrid.InvalidInput, match="d.htg' has another grid than"):
        nestgrid.load([tmp_path / "a.htg", tmp_path / "d.htg"])


@pytest.mark.parametrize("name", FORMATS)
def test_files_of_codes_are_frames(amr_files, name):
    paths = [amr_files / name, amr_files / f"later_{name}"]
    frames = nestgrid.load(paths, "dist", **({"times": [0.5, 1]} if name == "amr.vthb" else {}))
    assert frames.times == [0.5, 1] and frames.name == "dist", name
    assert "80 boxes of dimension 3 on 3 levels" in repr(frames)
    expected = [nestgrid.load(path, "dist").isosurface(0).vertices for path in paths]
    for each in (frames, pickle.loads(pickle.dumps(frames))):
        for t, vertices in zip(frames.times, expected):
            np.testing.assert_array_equal(each.at(t).isosurface(0).vertices, vertices)
    assert len(frames.at(0.75).isosurface(0).vertices) > 100


def test_frames_of_codes_that_do_not_fit(amr_files):
    assert nestgrid.load([amr_files / "amr.vthb", amr_files / "later_amr.vthb"], "dist").times == [0, 1]
    with pytest.raises(nestgrid.InvalidInput, match="plane_chombo.hdf5' has other dimensions than '.*chombo.hdf5'"):
        nestgrid.load([amr_files / "chombo.hdf5", amr_files / "plane_chombo.hdf5"], "dist", times=[0, 1])


def test_rules_of_formats_of_codes(amr_files):
    areas = {
        rule: [nestgrid.load(amr_files / name, "dist", rule=rule).isosurface(0).report()["area"] for name in FORMATS[3:]]
        for rule in ("smooth", "centres", "means")
    }
    assert all(np.ptp(each) < 1e-12 for each in areas.values())
    assert len({round(each[0], 9) for each in areas.values()}) == 3
    with pytest.raises(nestgrid.InvalidInput, match="rule is for boxes and trees of cells, not 'a.nii'"):
        nestgrid.load("a.nii", rule="means")


@pytest.mark.parametrize("name", FORMATS)
def test_formats_of_codes_in_the_plane(amr_files, name):
    field = nestgrid.load(amr_files / f"plane_{name}", "plac")
    points = np.random.default_rng(1).uniform(0, 1, (50, 2))
    np.testing.assert_allclose(field.probe(points), points[:, 0], atol=1e-12)


def edited(amr_files, name, edit):
    """A file of another name with changes."""
    h5py = pytest.importorskip("h5py")
    path = amr_files / f"edited_{name}"
    path.write_bytes((amr_files / name).read_bytes())
    with h5py.File(path, "a") as file:
        edit(file)
    return path


def test_formats_of_codes_as_others_write_them(amr_files):
    """PLUTO says where cells are; texts have their lengths beside them, vectors names; levels may
    be empty."""

    def pluto(file, **more):
        for level in range(3):
            place = {"domBeg1": -1.0, "domBeg2": 3.0, "domBeg3": 0.5, "g_x2stretch": 2.0, "geometry": 1}
            file[f"level_{level}"].attrs.update(place | more)

    def long_names(file):
        file.attrs["num_levels"] = np.int32(4)
        file["level_3/boxes"] = np.zeros(0, file["level_0/boxes"].dtype)
        for i, name in enumerate(["of any length \u03c1", "dist"]):
            file.attrs[f"component_{i}"] = name
        for level in range(3):
            step = tuple(file[f"level_{level}"].attrs["dx"] * np.array([1, 2, 1]))
            file[f"level_{level}"].attrs["vec_dx"] = np.array(step, [(x, "f8") for x in "xyz"])

    def athena_texts(file):
        for each in ("DatasetNames", "VariableNames"):
            file.attrs[each] = [name.decode() for name in file.attrs[each]]
        file.attrs["Coordinates"] = "cartesian"

    load = nestgrid.load
    points = np.random.default_rng(1).uniform(0, 1, (50, 3))
    here = points * [1, 2, 1]
    expected = load(amr_files / "chombo.hdf5", "dist").probe(points)
    field = load(edited(amr_files, "chombo.hdf5", pluto), "dist")
    np.testing.assert_allclose(field.probe(here + [-1, 3, 0.5]), expected, atol=1e-12)
    field = load(edited(amr_files, "chombo.hdf5", long_names), "of any length \u03c1")
    np.testing.assert_allclose(field.probe(here), expected, atol=1e-12)
    field = load(edited(amr_files, "athena.athdf", athena_texts), "dist")
    np.testing.assert_allclose(field.probe(points), expected, atol=1e-12)

    def refused(name, sentence, edit):
        with pytest.raises(nestgrid.IoError, match=sentence):
            load(edited(amr_files, name, edit), "dist")

    curved = "curved or logarithmic coordinates, not cartesian"
    refused("chombo.hdf5", curved, lambda file: pluto(file, geometry=4))
    refused("chombo.hdf5", curved, lambda file: pluto(file, logr=1))
    dimension = lambda file: file["Chombo_global"].attrs.update(SpaceDim=1)  # noqa: E731
    refused("chombo.hdf5", "has 1 dimensions, not 2 or 3", dimension)
    size = lambda *n: lambda file: file.attrs.update(MeshBlockSize=np.array(n))  # noqa: E731
    refused("athena.athdf", "one cell thick along x or y", size(8, 1, 8))
    refused("athena.athdf", "has 1 dimension, not 2 or 3", size(8, 1, 1))
    names = lambda file: file.attrs.update(VariableNames=np.array([b"dist"]))  # noqa: E731
    refused("athena.athdf", "a variable has no name", names)
    deep = lambda file: file["Levels"].__setitem__(0, 2000000000)  # noqa: E731
    refused("athena.athdf", "a block has level 2000000000", deep)
    apart = lambda file: file["LogicalLocations"].__setitem__(-1, 0)  # noqa: E731
    refused("athena.athdf", "do not fill block .* of level [01], which it has not", apart)

    def longer(file):
        twice = np.concatenate([file["dist"][()]] * 2)
        del file["dist"]
        file["dist"] = twice

    refused("run_hdf5_plt_cnt_0000", "has not one level, one place and numbers for each block", longer)
    no_level = lambda file: file["refine level"].write_direct(np.zeros(80, np.int32))  # noqa: E731
    refused("run_hdf5_plt_cnt_0000", "a block has level 0", no_level)


def test_refusals_of_formats_of_codes(amr_files):
    load = nestgrid.load
    for name in FORMATS:
        with pytest.raises(nestgrid.InvalidInput, match="has several fields, choose one by array"):
            load(amr_files / name)
        with pytest.raises(nestgrid.InvalidInput, match="no field 'dits', only .*did you mean 'dist'"):
            load(amr_files / name, "dits")
    with pytest.raises(nestgrid.InvalidInput, match="2 numbers per cell, not one: choose by comp"):
        load(amr_files / "amr.vthb", "both")
    second = load(amr_files / "amr.vthb", "both", component=1)
    np.testing.assert_allclose(second.range, [0, 1], atol=1e-12)
    with pytest.raises(nestgrid.InvalidInput, match="component chooses nothing"):
        load(amr_files / "chombo.hdf5", "dist", component=0)
    with pytest.raises(nestgrid.InvalidInput, match="across_y.vthb' has another grid than"):
        load([amr_files / "plane_across_x.vthb", amr_files / "plane_across_y.vthb"], "dist")
    with pytest.raises(nestgrid.IoError, match="has cylindrical coordinates, not cartesian ones"):
        load(amr_files / "round_hdf5_plt_cnt_0000", "dist")
    (amr_files / "cut.athdf").write_bytes((amr_files / "athena.athdf").read_bytes()[:-9000])
    with pytest.raises(nestgrid.IoError, match="cut.athdf cannot be read"):
        load(amr_files / "cut.athdf", "dist")
