# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of Lagrange cells: from arrays, and from files that VTK writes."""
import pickle

import numpy as np
import pytest

import nestgrid

pytest.importorskip("vtkmodules.vtkCommonDataModel")
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray  # noqa: E402
from vtkmodules.vtkCommonCore import vtkPoints  # noqa: E402
from vtkmodules.vtkCommonDataModel import (  # noqa: E402
    vtkCellArray,
    vtkLagrangeHexahedron,
    vtkLagrangeQuadrilateral,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter  # noqa: E402


def waves(x):
    return np.sin(5 * x[:, 0]) * np.cos(4 * x[:, 1]) + x[:, 2] ** 2


def box(dimension, n, degree):
    """Points of each cell's own, and the cells, of a unit square or cube."""
    nodes = np.indices((degree + 1,) * dimension).reshape(dimension, -1).T
    if dimension == 3:
        place = [vtkLagrangeHexahedron.PointIndexFromIJK(*map(int, at), [degree] * 3) for at in nodes]
    else:
        place = [vtkLagrangeQuadrilateral.PointIndexFromIJK(*map(int, at), [degree] * 2) for at in nodes]
    in_cell = np.empty_like(nodes)
    in_cell[place] = nodes
    cells = np.indices((n,) * dimension).reshape(dimension, -1).T
    points = np.zeros((len(cells), len(nodes), 3))
    points[:, :, :dimension] = (cells[:, None] + in_cell / degree) / n
    count = len(nodes)
    offsets = np.arange(len(cells) + 1) * count
    types = np.full(len(cells), 72 if dimension == 3 else 70)
    return points.reshape(-1, 3), types, offsets, np.arange(len(cells) * count)


def write(path, mesh, ghosts=None, **fields):
    points, types, offsets, connectivity = mesh
    grid = vtkUnstructuredGrid()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(places)
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, True), numpy_to_vtkIdTypeArray(connectivity, True))
    grid.SetCells(numpy_to_vtk(types.astype(np.uint8), deep=True), cells)
    for name, values in fields.items():
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        grid.GetPointData().AddArray(array)
    if ghosts is not None:
        array = numpy_to_vtk(ghosts, deep=True)
        array.SetName("vtkGhostType")
        grid.GetCellData().AddArray(array)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    assert writer.Write()


@pytest.mark.parametrize("degree", [2, 4])
def test_surfaces_are_closed_and_within_the_error(degree):
    mesh = box(3, 3, degree)
    field = nestgrid.Cells(*mesh, waves(mesh[0]))
    assert (field.dimension, field.degree) == (3, degree)
    for error in (0.05, 0.005):
        surface = field.isosurface(0.4, error=error)
        assert 0 < surface.error_bound <= error * (1 + 1e-6)
        assert surface.report()["open_edges"] == 0
    drawn = field.slice(plane=((0.5, 0.5, 0.41), (0.2, 0.1, 1)), error=0.005)
    assert drawn.error_bound <= 0.005 * (1 + 1e-6)
    # The polynomial itself is as near to the waves as its degree allows.
    off = np.abs(drawn.attributes[:, 0] - waves(drawn.vertices)).max()
    assert off <= 0.005 + {2: 0.1, 4: 0.003}[degree]
    boundary = field.boundary(error=0.01)
    assert boundary.report()["open_edges"] == 0


def test_a_thousandth_of_the_range_is_the_error_unless_one_is_given():
    mesh = box(3, 3, 3)
    values = waves(mesh[0])
    field = nestgrid.Cells(*mesh, values)
    assert field.range == (values.min(), values.max())
    surface = field.isosurface(0.4)
    size = values.max() - values.min()
    assert 2e-4 * size < surface.threshold < 2e-3 * size
    assert surface.error_bound <= surface.threshold * (1 + 1e-6)


def test_budgets_are_kept_by_the_least_error():
    mesh = box(3, 3, 3)
    field = nestgrid.Cells(*mesh, waves(mesh[0]))
    for most in (1000, 10_000):
        surface = field.isosurface(0.4, max_triangles=most)
        assert most * 0.8 < len(surface.triangles) <= most
        assert surface.error_bound <= surface.threshold * (1 + 1e-6)
        assert surface.report()["open_edges"] == 0
        again = field.isosurface(0.4, error=surface.threshold)
        np.testing.assert_array_equal(surface.vertices, again.vertices)
        drawn = field.slice(plane=((0.5, 0.5, 0.41), (0.2, 0.1, 1)), max_triangles=most)
        assert most * 0.7 < len(drawn.triangles) <= most
    with pytest.raises(nestgrid.InvalidInput, match="even the coarsest surface has more than 2 triangles"):
        field.isosurface(0.4, max_triangles=2)


def test_lenses_ask_for_small_elements():
    mesh = box(3, 3, 3)
    field = nestgrid.Cells(*mesh, waves(mesh[0]))
    plain = field.isosurface(0.4, error=0.05)
    lens = nestgrid.Lens(nestgrid.ball((0.5, 0.5, 0.5), 0.2), finest=0.02)
    fine = field.isosurface(0.4, error=0.05, lens=lens)
    assert len(fine.triangles) > 2 * len(plain.triangles)
    assert fine.report()["open_edges"] == 0
    assert fine.error_bound <= 0.05 * (1 + 1e-6)


def test_edges_are_collapsed_and_regions_are_finer():
    mesh = box(3, 3, 3)
    field = nestgrid.Cells(*mesh, waves(mesh[0]))
    plain = field.isosurface(0.4, error=0.02)
    fewer = field.isosurface(0.4, error=0.02, collapse=True)
    assert len(fewer.triangles) < len(plain.triangles)
    assert fewer.report()["open_edges"] == 0
    assert fewer.error_bound <= 0.02 * (1 + 1e-6)
    region = nestgrid.Region(nestgrid.ball((0.5, 0.5, 0.5), 0.2), 0.002)
    assert len(field.isosurface(0.4, error=0.02, region=region).triangles) > len(plain.triangles)


def test_ghosts_and_cells_of_lower_dimension_are_left_out(tmp_path):
    points, types, offsets, connectivity = mesh = box(3, 3, 2)
    values = waves(points)
    surface = nestgrid.Cells(*mesh, values).isosurface(0.4, error=0.05)
    beside = (
        points,
        np.concatenate([[1, 9], types, [3]]),
        np.concatenate([[0, 1, 5], 5 + offsets[1:], [7 + offsets[-1]]]),
        np.concatenate([[0, 0, 1, 3, 2], connectivity, [0, 1]]),
    )
    same = nestgrid.Cells(*beside, values).isosurface(0.4, error=0.05)
    np.testing.assert_array_equal(surface.vertices, same.vertices)
    # Two pieces, one of which has a cell of the other as a ghost.
    cell = offsets[1]
    for name, first, last, ghosts in (("a", 0, 14, 1), ("b", 13, 27, 0)):
        part = slice(first * cell, last * cell)
        numbers = np.arange((last - first) * cell)
        flags = np.zeros(last - first, np.uint8)
        flags[last - first - ghosts :] = 1
        write(
            tmp_path / f"{name}.vtu",
            (points[part], types[first:last], offsets[: last - first + 1], numbers),
            ghosts=flags,
            u=values[part],
        )
    pieces = "".join(f'<Piece Source="{name}.vtu"/>' for name in "ab")
    (tmp_path / "ab.pvtu").write_text(
        '<VTKFile type="PUnstructuredGrid" version="0.1"><PUnstructuredGrid GhostLevel="1">'
        '<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>'
        '<PPointData><PDataArray type="Float64" Name="u"/></PPointData>'
        '<PCellData><PDataArray type="UInt8" Name="vtkGhostType"/></PCellData>'
        f"{pieces}</PUnstructuredGrid></VTKFile>"
    )
    joined = nestgrid.load(tmp_path / "ab.pvtu").isosurface(0.4, error=0.05)
    assert len(joined.triangles) == len(surface.triangles)
    assert joined.report()["open_edges"] == surface.report()["open_edges"]


def test_isolines_and_height_fields():
    mesh = box(2, 3, 3)
    field = nestgrid.Cells(*mesh, waves(mesh[0]))
    assert field.dimension == 2
    assert field.isolines([0.1, 0.4], error=0.01).error_bound <= 0.01 * (1 + 1e-6)
    graph = field.height_field(1, error=0.01)
    assert graph.error_bound <= 0.01 * (1 + 1e-6)
    np.testing.assert_allclose(graph.vertices[:, 2], graph.attributes[:, 0])


def test_linear_cells_are_as_other_fields():
    mesh = box(3, 4, 1)
    field = nestgrid.Cells(*mesh, waves(mesh[0]))
    assert field.degree == 1
    assert field.isosurface(0.4, max_triangles=1000).report()["open_edges"] == 0


def test_files_are_as_arrays(tmp_path):
    mesh = box(3, 3, 3)
    values = waves(mesh[0])
    vectors = np.column_stack([values, -values])
    write(tmp_path / "mesh.vtu", mesh, u=values, v=vectors)
    path = str(tmp_path / "mesh.vtu")
    expected = nestgrid.Cells(*mesh, values).isosurface(0.4, error=0.01)
    for field in (
        nestgrid.load(path, "u"),
        nestgrid.load(path, "v", component=0),
        pickle.loads(pickle.dumps(nestgrid.load(path, "u"))),
    ):
        surface = field.isosurface(0.4, error=0.01)
        np.testing.assert_array_equal(surface.vertices, expected.vertices)
        np.testing.assert_array_equal(surface.triangles, expected.triangles)
    assert "27 cells of dimension 3, degree 3" in repr(nestgrid.load(path, "u"))
    with pytest.raises(nestgrid.InvalidInput, match="has several arrays, choose one by array: 'u', 'v'"):
        nestgrid.load(path)
    with pytest.raises(nestgrid.InvalidInput, match="has no point data array 'w', only 'u', 'v'"):
        nestgrid.load(path, "w")
    with pytest.raises(nestgrid.InvalidInput, match="has 2 numbers per sample, not one"):
        nestgrid.load(path, "v")
    with pytest.raises(nestgrid.InvalidInput, match="frame chooses nothing of a .vtu"):
        nestgrid.load(path, "u", frame=1)
    data = (tmp_path / "mesh.vtu").read_bytes()
    (tmp_path / "cut.vtu").write_bytes(data[: len(data) // 2])
    with pytest.raises(nestgrid.IoError, match="cut.vtu"):
        nestgrid.load(str(tmp_path / "cut.vtu"))


def test_refusals_name_what_is_wrong(tmp_path):
    points, types, offsets, connectivity = box(3, 2, 2)
    values = waves(points)
    good = nestgrid.Cells(points, types, offsets, connectivity, values)
    for arguments, sentence in (
        ({"threshold": 0.1}, "the field has degree 2"),
        ({"max_triangles": 100, "collapse": True}, "by no number of triangles"),
    ):
        with pytest.raises(nestgrid.InvalidInput, match=sentence):
            good.isosurface(0.4, **arguments)
    with pytest.raises(nestgrid.InvalidInput, match="cell 3 is of VTK's type 42"):
        nestgrid.Cells(points, np.where(np.arange(8) == 3, 42, types), offsets, connectivity, values)
    with pytest.raises(nestgrid.InvalidInput, match="not a finite number at point 7"):
        nestgrid.Cells(
            points, types, offsets, connectivity, np.where(np.arange(len(values)) == 7, np.nan, values)
        )
    with pytest.raises(nestgrid.InvalidInput, match="has 215 values for 216 points"):
        nestgrid.Cells(points, types, offsets, connectivity, values[:-1])
    with pytest.raises(nestgrid.InvalidInput, match="offsets do not say"):
        nestgrid.Cells(points, types, offsets[:-1], connectivity, values)
    with pytest.raises(nestgrid.InvalidInput, match="offsets do not say"):
        nestgrid.Cells(points, types, offsets[::-1], connectivity, values)
    halves = points.copy()
    halves[:, 0] += 1
    # A cell of twice the size beside them.
    one = box(3, 1, 2)
    both = np.vstack([one[0], halves])
    mesh = (
        both,
        np.append(72, types),
        np.append(0, offsets + 27),
        np.append(one[3], connectivity + 27),
    )
    with pytest.raises(nestgrid.InvalidInput, match="a face of cell 0 is divided on its other side"):
        nestgrid.Cells(*mesh, np.zeros(len(both)))
    write(tmp_path / "halves.vtu", mesh, u=np.zeros(len(both)))
    with pytest.raises(nestgrid.InvalidInput, match="halves.vtu: a face of cell 0 is divided"):
        nestgrid.load(str(tmp_path / "halves.vtu"))


def test_curved_cells_are_drawn_where_they_are():
    points, *cells = box(3, 3, 2)
    bent = points.copy()
    bent[:, 2] += 0.3 * points[:, 0] ** 2
    heights = nestgrid.Cells(bent, *cells, points[:, 2]).isosurface(0.4, error=1e-3)
    x = heights.vertices
    assert np.abs(x[:, 2] - 0.4 - 0.3 * x[:, 0] ** 2).max() < 5e-3


def test_points_of_curved_cells_keep_their_error():
    points, *cells = box(3, 3, 2)
    bent = points.copy()
    bent[:, 2] += 0.3 * points[:, 0] ** 2
    field = nestgrid.Cells(bent, *cells, points[:, 2])
    flat, *quadrilaterals = box(2, 3, 2)
    curve = flat.copy()
    curve[:, 1] += 0.3 * flat[:, 0] ** 2
    plane = nestgrid.Cells(curve, *quadrilaterals, flat[:, 1])
    drawings = {
        "isosurface": lambda **fine: field.isosurface(0.4, **fine),
        "isosurfaces": lambda **fine: field.isosurfaces([0.4], **fine)[0],
        "isoband": lambda **fine: field.isoband(0.3, 0.6, **fine),
        "boundary": field.boundary,
        "slice": lambda **fine: field.slice(plane=((0.5, 0.5, 0.5), (0.2, 0.3, 1)), **fine),
        "isolines": lambda **fine: plane.isolines(0.4, **fine),
        "height_field": plane.height_field,
    }
    for name, draw in drawings.items():
        before = 0
        for places in (0.03, 0.003, 0.0003):
            drawn = draw(error=0.2, position_error=places)
            assert 0 < drawn.position_bound <= places * 1.00001, name
            assert len(drawn.vertices) > before, name
            before = len(drawn.vertices)
        assert pickle.loads(pickle.dumps(drawn)).position_bound == drawn.position_bound
        assert draw(error=0.2).position_bound > 0.0003, name
        for wrong in (0, -1, np.nan, np.inf):
            with pytest.raises(nestgrid.InvalidInput, match="position_error is not a finite number > 0"):
                draw(error=0.2, position_error=wrong)
    # At (0.5, 0.475) the field is 0.4, less what straight lines leave out of the curve.
    off = [abs(plane.probe([0.25, 0.41875], error=0.2, position_error=p) - 0.4) for p in (0.03, 0.0003)]
    assert off[1] < off[0] and off[1] < 0.001
    straight = nestgrid.Cells(points, *cells, waves(points))
    with pytest.raises(nestgrid.InvalidInput, match="for curved cells"):
        straight.isosurface(0.4, error=0.1, position_error=0.1)
    assert straight.isosurface(0.4, error=0.1).position_bound == 0
    with pytest.raises(nestgrid.InvalidInput, match="for curved cells"):
        nestgrid.Volume(np.random.default_rng(1).random((5, 5, 5))).isosurface(0.5, error=0.1, position_error=0.1)
