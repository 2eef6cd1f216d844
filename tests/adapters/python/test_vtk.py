# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces and lines in VTK, PyVista and files."""
import gc
import os
import sys
import types

import numpy as np
import pytest

import nestgrid

pytest.importorskip("vtkmodules.vtkCommonDataModel")
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402
from vtkmodules.vtkFiltersCore import vtkFeatureEdges  # noqa: E402
from vtkmodules.vtkIOGeometry import vtkSTLReader  # noqa: E402
from vtkmodules.vtkIOPLY import vtkPLYReader  # noqa: E402
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader  # noqa: E402


@pytest.fixture
def surface(gyroid):
    return nestgrid.Volume(gyroid).isosurface(0.1, 0.1, cap=True)


@pytest.fixture
def lines(gyroid):
    return nestgrid.Volume(np.ascontiguousarray(gyroid[:, :, 5])).isolines([-0.5, 0, 0.5])


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def corners_of(cells):
    return vtk_to_numpy(cells.GetConnectivityArray())


def edges_of(data, boundary, manifold):
    edges = vtkFeatureEdges()
    edges.SetInputData(data)
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.SetBoundaryEdges(boundary)
    edges.SetNonManifoldEdges(manifold)
    edges.Update()
    return edges.GetOutput().GetNumberOfCells()


def test_surface(surface):
    data = surface.to_vtk()
    np.testing.assert_array_equal(points_of(data), surface.vertices)
    np.testing.assert_array_equal(corners_of(data.GetPolys()), surface.triangles.ravel())
    normals = data.GetPointData().GetNormals()
    np.testing.assert_array_equal(vtk_to_numpy(normals), surface.normals)
    assert edges_of(data, True, True) == 0


def test_slice_has_its_values(gyroid):
    surface = nestgrid.Volume(gyroid).slice(plane=((32, 32, 32), (1, 1, 0)))
    values = surface.to_vtk().GetPointData().GetScalars()
    np.testing.assert_array_equal(vtk_to_numpy(values), surface.attributes[:, 0])


def test_data_outlive_everything_of_python(gyroid):
    surface = nestgrid.Volume(gyroid).isosurface(0.1, 0.1)
    vertices, triangles = surface.vertices.copy(), surface.triangles.copy()
    data = surface.to_vtk()
    del surface
    gc.collect()
    taken = [np.full(len(vertices) * 3, 7.0) for _ in range(20)]
    np.testing.assert_array_equal(points_of(data), vertices)
    np.testing.assert_array_equal(corners_of(data.GetPolys()), triangles.ravel())
    del taken


def test_lines(lines):
    data = lines.to_vtk()
    assert data.GetNumberOfLines() == len(lines)
    ids = vtk_to_numpy(data.GetLines().GetOffsetsArray())
    np.testing.assert_array_equal(ids, lines.first)
    np.testing.assert_array_equal(corners_of(data.GetLines()), lines.points)
    value = data.GetCellData().GetArray("value")
    np.testing.assert_array_equal(vtk_to_numpy(value), lines.values)
    assert sum(len(line) for line in lines) == len(lines.points)


def test_nothing_drawn_is_empty_data(gyroid):
    surface = nestgrid.Volume(gyroid).isosurface(10)
    assert surface.to_vtk().GetNumberOfPolys() == 0 and surface.report()["area"] == 0


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def test_files_of_surfaces(surface, tmp_path):
    for suffix in ("ply", "stl", "vtp"):
        surface.save(tmp_path / f"surface.{suffix}")
    assert len(list(tmp_path.iterdir())) == 3
    data = read(vtkXMLPolyDataReader(), tmp_path / "surface.vtp")
    np.testing.assert_array_equal(points_of(data), surface.vertices)
    np.testing.assert_array_equal(corners_of(data.GetPolys()), surface.triangles.ravel())
    np.testing.assert_array_equal(
        vtk_to_numpy(data.GetPointData().GetArray("Normals")), surface.normals
    )
    data = read(vtkPLYReader(), tmp_path / "surface.ply")
    np.testing.assert_allclose(points_of(data), surface.vertices, rtol=1e-6)
    np.testing.assert_array_equal(corners_of(data.GetPolys()), surface.triangles.ravel())
    reader = vtkSTLReader()
    reader.MergingOff()
    data = read(reader, tmp_path / "surface.stl")
    corners = points_of(data)[corners_of(data.GetPolys())]
    np.testing.assert_allclose(
        corners, surface.vertices[surface.triangles].reshape(-1, 3), rtol=1e-6, atol=1e-6
    )


@pytest.mark.parametrize("compress", ["none", "zlib"])
@pytest.mark.parametrize("double", [True, False])
def test_encodings_of_files(surface, lines, gyroid, tmp_path, compress, double):
    kind = np.float64 if double else np.float32
    empty = nestgrid.Volume(gyroid).isosurface(100)
    edges = nestgrid.Volume(gyroid).isosurface(0.1, 0.1, elements=True).outlines()
    for what in (surface, lines, empty, edges):
        what.save(tmp_path / "x.vtp", compress=compress, double=double)
        data = read(vtkXMLPolyDataReader(), tmp_path / "x.vtp")
        np.testing.assert_array_equal(points_of(data), what.vertices.astype(kind))
        assert points_of(data).dtype == kind
        expected = what.to_vtk()
        for cells, others in (
            (data.GetPolys(), expected.GetPolys()),
            (data.GetLines(), expected.GetLines()),
        ):
            np.testing.assert_array_equal(corners_of(cells), corners_of(others))
            assert cells.GetNumberOfCells() == others.GetNumberOfCells()
    surface.save(tmp_path / "x.ply", double=double)
    assert (b"property double" in (tmp_path / "x.ply").read_bytes()) == double


def test_packed_files_are_smaller(surface, tmp_path):
    sizes = []
    for compress in ("none", "zlib"):
        surface.save(tmp_path / "x.vtp", compress=compress)
        sizes.append(os.path.getsize(tmp_path / "x.vtp"))
    assert sizes[1] < 0.7 * sizes[0]


def test_files_of_lines(lines, gyroid, tmp_path):
    lines.save(tmp_path / "lines.vtp")
    data = read(vtkXMLPolyDataReader(), tmp_path / "lines.vtp")
    np.testing.assert_array_equal(points_of(data), lines.vertices)
    np.testing.assert_array_equal(corners_of(data.GetLines()), lines.points)
    np.testing.assert_array_equal(
        vtk_to_numpy(data.GetCellData().GetArray("value")), lines.values
    )
    edges = nestgrid.Volume(gyroid).isosurface(0.1, 0.1, elements=True).outlines()
    edges.save(tmp_path / "edges.vtp")
    data = read(vtkXMLPolyDataReader(), tmp_path / "edges.vtp")
    np.testing.assert_array_equal(corners_of(data.GetLines()), edges.segments.ravel())
    assert edges.to_vtk().GetNumberOfLines() == data.GetNumberOfLines() > 0


def test_pyvista_gets_the_same_data(surface, monkeypatch):
    """PyVista is not packaged everywhere: what it is handed is looked at."""
    stand_in = types.SimpleNamespace(wrap=lambda data: ("wrapped", data))
    monkeypatch.setitem(sys.modules, "pyvista", stand_in)
    name, data = surface.to_pyvista()
    assert name == "wrapped" and data.GetNumberOfPolys() == len(surface.triangles)
