# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run by pvpython: the filters and the reader, states, times and a picture.

Arguments: a folder with stored.nestgrid, where files may be written.
"""
import math
import os
import sys

import numpy as np
import paraview.simple as pv
from paraview import servermanager
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkLagrangeHexahedron, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkFeatureEdges
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

import nestgrid
from nestgrid.paraview import PLUGIN
from nestgrid.paraview._inputs import field_of

folder = sys.argv[1]
pv.LoadPlugin(PLUGIN, remote=False)


def fetch(proxy):
    proxy.UpdatePipeline()
    return servermanager.Fetch(proxy)


def open_edges(data):
    edges = vtkFeatureEdges()
    edges.SetInputData(data)
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.NonManifoldEdgesOn()
    edges.Update()
    return edges.GetOutput().GetNumberOfCells()


def same(data, surface):
    points = vtk_to_numpy(data.GetPoints().GetData())
    np.testing.assert_array_equal(points, surface.vertices)
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    np.testing.assert_array_equal(corners, surface.triangles.ravel())


def check_image_data():
    wavelet = pv.Wavelet(WholeExtent=[-10, 10, -8, 8, -6, 6])
    image = fetch(wavelet)
    filter = pv.NestgridIsosurface(Input=wavelet)
    array = image.GetPointData().GetArray("RTData")
    least, greatest = array.GetRange()
    assert least < filter.Isovalue < greatest, "isovalues start within the range"
    samples = vtk_to_numpy(array).reshape(image.GetDimensions(), order="F")
    volume = nestgrid.Volume(samples, origin=(-10, -8, -6))
    filter.Isovalue = 157
    same(fetch(filter), volume.isosurface(157))
    filter.Threshold = 5
    same(fetch(filter), volume.isosurface(157, 5))
    filter.MaxTriangles = 1500
    data = fetch(filter)
    assert 0 < data.GetNumberOfPolys() <= 1500
    filter.MaxTriangles = 0
    filter.Indicator = "visual"
    filter.Threshold = 0.2
    same(fetch(filter), volume.isosurface(157, 0.2, indicator="visual"))
    filter.Error = 20
    same(fetch(filter), volume.isosurface(157, error=20))
    filter.Collapse = 1
    same(fetch(filter), volume.isosurface(157, error=20, collapse=True))
    filter.Error = 0
    filter.Distance = 0.5
    same(fetch(filter), volume.isosurface(157, distance=0.5, collapse=True))
    filter.Distance, filter.MaxTriangles = 0, 2000
    same(fetch(filter), volume.isosurface(157, max_triangles=2000, collapse=True))
    filter.Collapse, filter.MaxTriangles = 0, 0
    filter.Distance = 0.5
    same(fetch(filter), volume.isosurface(157, distance=0.5))
    filter.DistanceField = 1
    same(fetch(filter), volume.isosurface(157, distance=0.5, distance_field=True))
    filter.Distance = 0
    filter.Cap = 1
    assert open_edges(fetch(filter)) == 0
    slice = pv.NestgridSlice(Input=wavelet)
    slice.Origin, slice.Normal, slice.Threshold = [1, 0, 0], [1, 1, 0], 2
    data = fetch(slice)
    expected = volume.slice(plane=((1, 0, 0), (1, 1, 0)), threshold=2)
    same(data, expected)
    values = vtk_to_numpy(data.GetPointData().GetArray("RTData"))
    np.testing.assert_array_equal(values, expected.attributes[:, 0])
    slice.Error = 2
    same(fetch(slice), volume.slice(plane=((1, 0, 0), (1, 1, 0)), error=2))
    slice.Collapse = 1
    fewer = volume.slice(plane=((1, 0, 0), (1, 1, 0)), error=2, collapse=True)
    same(fetch(slice), fewer)
    assert fewer.triangles.shape[0] < expected.triangles.shape[0]


def check_measures():
    """What the package measures of each surface is told with it."""
    wavelet = pv.Wavelet(WholeExtent=[-10, 10, -8, 8, -6, 6])
    image = fetch(wavelet)
    samples = vtk_to_numpy(image.GetPointData().GetArray("RTData"))
    volume = nestgrid.Volume(
        samples.reshape(image.GetDimensions(), order="F"), origin=(-10, -8, -6)
    )
    filter = pv.NestgridIsosurface(Input=wavelet, Isovalue=157, Threshold=20, Measure=1)
    for values in ([157], [157, 120]):
        filter.MoreIsovalues = values[1:]
        told = fetch(filter).GetFieldData()
        for i, value in enumerate(values):
            measured = volume.measure(volume.isosurface(value, 20, cuts="linear"), value)
            for name in ("error", "distance", "distance_back"):
                row = told.GetArray(name.replace("_", " ")).GetTuple3(i)
                assert row == (measured[name], measured[name + "_mean"], measured[name + "_rms"])
            assert measured["distance"] > 0
    filter.Measure = 0
    assert fetch(filter).GetFieldData().GetArray("error") is None


def check_abort():
    """An observer of progress ends the drawing: nothing is drawn, and the next update draws all."""
    wavelet = pv.Wavelet(WholeExtent=[-60, 60, -60, 60, -60, 60])
    fetch(wavelet)
    filter = pv.NestgridIsosurface(Input=wavelet, Isovalue=157, Indicator="visual", Threshold=0.1)
    algorithm = filter.GetClientSideObject()
    heard = []

    def end(caller, event):
        heard.append(event)
        caller.SetAbortExecute(1)

    tag = algorithm.AddObserver("ProgressEvent", end)
    assert fetch(filter).GetNumberOfPolys() == 0
    assert heard, "the drawing tells nobody that it goes on"
    algorithm.RemoveObserver(tag)
    filter.Threshold = 0.2
    assert fetch(filter).GetNumberOfPolys() > 0


def check_where_and_how():
    """What holds in a part of space, other shapes, bands and boundaries: as the package draws."""
    wavelet = pv.Wavelet(WholeExtent=[-10, 10, -8, 8, -6, 6])
    image = fetch(wavelet)
    samples = vtk_to_numpy(image.GetPointData().GetArray("RTData"))
    volume = nestgrid.Volume(
        samples.reshape(image.GetDimensions(), order="F"), origin=(-10, -8, -6)
    )
    filter = pv.NestgridIsosurface(Input=wavelet, Isovalue=157, Threshold=20)
    filter.RegionBounds, filter.RegionThreshold = [0, 5, 0, 5, 0, 5], 1
    region = nestgrid.Region(nestgrid.box((0, 0, 0), (5, 5, 5)), 1)
    same(fetch(filter), volume.isosurface(157, 20, region=region))
    filter.RegionBounds = [0] * 6
    filter.LensCentre, filter.LensRadius = [4, 0, 0], 3
    same(fetch(filter), volume.isosurface(157, 20, lens=((4, 0, 0), 3)))
    filter.LensRadius, filter.Blend, filter.AtNodes = 0, 2, 1
    same(fetch(filter), volume.isosurface(157, 20, blend=2, at_nodes=True))
    filter.Blend, filter.AtNodes, filter.Cuts = 1, 0, "finest"
    same(fetch(filter), volume.isosurface(157, 20, cuts="finest"))
    slice = pv.NestgridSlice(Input=wavelet, Error=5)
    slice.Origin, slice.Normal, slice.Shape, slice.Radius = [0, 0, 0], [0, 0, 1], "Sphere", 5
    same(fetch(slice), volume.slice(sphere=((0, 0, 0), 5), error=5))
    slice.Collapse, slice.SliceDistance = 1, 0.5
    same(
        fetch(slice),
        volume.slice(sphere=((0, 0, 0), 5), error=5, collapse=True, distance=0.5),
    )
    slice.Shape, slice.Error, slice.MaxTriangles = "Cylinder", 0, 500
    assert 0 < fetch(slice).GetNumberOfPolys() <= 500
    slice.Shape, slice.MaxTriangles, slice.Function = "Function", 0, "sin(x) + y*z/9"
    slice.Collapse, slice.Error = 0, 5
    same(fetch(slice), volume.slice(function=lambda x, y, z: math.sin(x) + y * z / 9, error=5))
    wrong = ("x +", "w*x", "(lambda: 1)()", "x.real", "sqrt(x)", "1/(x - x)", "exit()", "'a'*x")
    for slice.Function in wrong:
        assert fetch(slice).GetNumberOfPolys() == 0, f"{slice.Function} is drawn"
    slice.Function = "sin(x) + y*z/9"
    assert fetch(slice).GetNumberOfPolys() > 0
    band = pv.NestgridBand(Input=wavelet, Band=[150, 200], Threshold=5)
    same(fetch(band), volume.isoband(150, 200, 5))
    boundary = pv.NestgridBoundary(Input=wavelet, Error=5)
    same(fetch(boundary), volume.boundary(error=5))
    assert open_edges(fetch(boundary)) == 0
    boundary.Collapse = 1
    same(fetch(boundary), volume.boundary(error=5, collapse=True))


def check_several_isovalues():
    """The surfaces of several values, which the cell array "value" tells apart."""
    wavelet = pv.Wavelet(WholeExtent=[-10, 10, -8, 8, -6, 6])
    image = fetch(wavelet)
    samples = vtk_to_numpy(image.GetPointData().GetArray("RTData"))
    volume = nestgrid.Volume(
        samples.reshape(image.GetDimensions(), order="F"), origin=(-10, -8, -6)
    )
    pv.SetActiveSource(wavelet)
    filter = pv.NestgridIsosurface(Input=wavelet, Isovalue=157, MoreIsovalues=[200, 120])
    finest = {"threshold": 5, "cuts": "finest", "normals": False}
    for set_up, options in (
        ({"Threshold": 5}, {"threshold": 5}),
        ({"Error": 20, "Cap": 1}, {"error": 20, "cap": True}),
        ({"Error": 0, "Cap": 0, "Cuts": "finest", "Normals": 0}, finest),
    ):
        for name, value in set_up.items():
            setattr(filter, name, value)
        data = fetch(filter)
        values = vtk_to_numpy(data.GetCellData().GetArray("value"))
        points = vtk_to_numpy(data.GetPoints().GetData())
        corners = points[vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
        surfaces = volume.isosurfaces([157, 200, 120], **options)
        assert len(values) == sum(len(each.triangles) for each in surfaces)
        for value, surface in zip([157, 200, 120], surfaces):
            assert len(surface.triangles) > 0
            expected = surface.vertices[surface.triangles]
            np.testing.assert_array_equal(corners[values == value], expected)
        assert (data.GetPointData().GetNormals() is None) == ("normals" in options)
    for name, value in (("Collapse", 1), ("MoreIsovalues", [200, 157])):
        before = getattr(filter, name)
        setattr(filter, name, value)
        assert fetch(filter).GetNumberOfCells() == 0, f"{name} is refused"
        setattr(filter, name, before)
    filter.Error, filter.MaxTriangles = 0, 900
    assert fetch(filter).GetNumberOfCells() == 0, "a number of triangles is refused"


def check_outlines():
    wavelet = pv.Wavelet(WholeExtent=[-10, 10, -8, 8, -6, 6])
    image = fetch(wavelet)
    samples = vtk_to_numpy(image.GetPointData().GetArray("RTData"))
    volume = nestgrid.Volume(
        samples.reshape(image.GetDimensions(), order="F"), origin=(-10, -8, -6)
    )

    def are_outlines(filter, surface):
        data, expected = fetch(filter), surface.outlines()
        assert len(expected.segments) > 0 == data.GetNumberOfPolys()
        np.testing.assert_array_equal(
            vtk_to_numpy(data.GetPoints().GetData()), expected.vertices
        )
        np.testing.assert_array_equal(
            vtk_to_numpy(data.GetLines().GetConnectivityArray()), expected.segments.ravel()
        )

    pv.SetActiveSource(wavelet)
    filter = pv.NestgridIsosurface(Input=wavelet, Isovalue=157, Threshold=20, Outlines=1)
    are_outlines(filter, volume.isosurface(157, 20, elements=True))
    filter.MoreIsovalues = [200]
    values = vtk_to_numpy(fetch(filter).GetCellData().GetArray("value"))
    counts = [
        len(each.outlines().segments)
        for each in volume.isosurfaces([157, 200], 20, elements=True)
    ]
    assert [(values == value).sum() for value in (157, 200)] == counts
    pv.SetActiveSource(wavelet)
    band = pv.NestgridBand(Input=wavelet, Band=[150, 200], Threshold=5, Outlines=1)
    are_outlines(band, volume.isoband(150, 200, 5, elements=True))
    slice = pv.NestgridSlice(Input=wavelet, Threshold=20, Outlines=1)
    slice.Origin, slice.Normal = [1, 0, 0], [1, 1, 0]
    are_outlines(slice, volume.slice(plane=((1, 0, 0), (1, 1, 0)), threshold=20, elements=True))
    boundary = pv.NestgridBoundary(Input=wavelet, Error=5, Outlines=1)
    are_outlines(boundary, volume.boundary(error=5, elements=True))


def same_lines(data, lines):
    points = vtk_to_numpy(data.GetPoints().GetData())
    np.testing.assert_array_equal(points, lines.vertices)
    np.testing.assert_array_equal(
        vtk_to_numpy(data.GetLines().GetConnectivityArray()), lines.points
    )
    np.testing.assert_array_equal(
        vtk_to_numpy(data.GetCellData().GetArray("value")), lines.values
    )


def check_planes():
    """Isolines and height fields of an image in a plane."""
    wavelet = pv.Wavelet(WholeExtent=[-10, 10, -8, 8, 4, 4])
    image = fetch(wavelet)
    samples = vtk_to_numpy(image.GetPointData().GetArray("RTData"))
    least, greatest = samples.min(), samples.max()
    low, high = least + 0.3 * (greatest - least), least + 0.7 * (greatest - least)
    error = 0.05 * (greatest - least)
    plane = nestgrid.Volume(
        samples.reshape(image.GetDimensions()[:2], order="F"),
        origin=(-10, -8, 4),
        direction=((1, 0), (0, 1), (0, 0)),
    )
    lines = pv.NestgridIsolines(Input=wavelet)
    assert len(lines.Values) == 1 and least < lines.Values[0] < greatest, "within the range"
    lines.Values = [low, high]
    same_lines(fetch(lines), plane.isolines([low, high]))
    assert set(plane.isolines([low, high]).values) == {low, high}
    lines.Values, lines.Threshold = [low], error / 2
    same_lines(fetch(lines), plane.isolines(low, error / 2))
    fewest = plane.isolines(low, max_segments=60)
    lines.MaxSegments = 60
    same_lines(fetch(lines), fewest)
    lines.Error = error
    same_lines(fetch(lines), plane.isolines(low, error=error))
    assert 0 < len(fewest.points) <= 60 + len(fewest)
    pv.SetActiveSource(wavelet)  # filters look for arrays there first
    heights = pv.NestgridHeightField(Input=wavelet, Scale=0.1)
    same(fetch(heights), plane.height_field(0.1))
    heights.Scale, heights.Error = 0, error
    data = fetch(heights)
    same(data, plane.height_field(None, error=error))
    assert data.GetBounds()[4:] == (4, 4) and data.GetPointData().GetArray("RTData") is not None
    heights.Outlines = 1
    edges = plane.height_field(None, error=error, elements=True).outlines()
    assert fetch(heights).GetNumberOfLines() == len(edges.segments) > 0
    heights.Outlines, heights.Collapse = 0, 1
    fewer = plane.height_field(None, error=error, collapse=True)
    same(fetch(heights), fewer)
    assert len(fewer.triangles) < data.GetNumberOfPolys()
    volume = pv.Wavelet(WholeExtent=[-5, 5, -5, 5, -5, 5])
    volume.UpdatePipeline()
    for filter in (pv.NestgridHeightField(Input=volume), pv.NestgridIsolines(Input=volume)):
        assert fetch(filter).GetNumberOfCells() == 0, "a field in space is refused"
    assert fetch(pv.NestgridIsosurface(Input=wavelet)).GetNumberOfCells() == 0


def lagrange_file(name, bend):
    """Lagrange hexahedra of degree 3, read by ParaView, and their field.

    bend  by how much x^2 moves points upwards
    """
    grid = vtkUnstructuredGrid()
    points, values = vtkPoints(), vtkDoubleArray()
    values.SetName("u")
    points.SetDataTypeToDouble()
    nodes = np.indices((4, 4, 4)).reshape(3, -1).T
    for cell in np.indices((2, 2, 2)).reshape(3, -1).T:
        ids = vtkIdList()
        ids.SetNumberOfIds(64)
        for node in nodes:
            x = (cell + node / 3) / 2
            place = vtkLagrangeHexahedron.PointIndexFromIJK(*map(int, node), [3, 3, 3])
            ids.SetId(place, points.InsertNextPoint(x[0], x[1], x[2] + bend * x[0] ** 2))
            values.InsertNextValue(np.sin(5 * x[0]) * np.cos(4 * x[1]) + x[2] ** 2)
        grid.InsertNextCell(72, ids)
    grid.SetPoints(points)
    grid.GetPointData().AddArray(values)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(os.path.join(folder, name))
    writer.SetInputData(grid)
    assert writer.Write()
    reader = pv.XMLUnstructuredGridReader(FileName=[os.path.join(folder, name)])
    return reader, field_of(grid, values)


def check_unstructured_grid():
    reader, expected = lagrange_file("solution.vtu", 0)
    filter = pv.NestgridIsosurface(Input=reader)
    filter.Scalars = ["POINTS", "u"]
    filter.Isovalue = 0.4
    same(fetch(filter), expected.isosurface(0.4))
    filter.Error = 0.02
    same(fetch(filter), expected.isosurface(0.4, error=0.02))
    slice = pv.NestgridSlice(Input=reader)
    slice.Scalars = ["POINTS", "u"]
    slice.Origin, slice.Normal, slice.Error = [0.5, 0.4, 0.45], [1, 2, 3], 0.02
    data = fetch(slice)
    same(data, expected.slice(plane=((0.5, 0.4, 0.45), (1, 2, 3)), error=0.02))
    filter.MaxTriangles, filter.Error = 3000, 0
    same(fetch(filter), expected.isosurface(0.4, max_triangles=3000))
    reader, expected = lagrange_file("curved.vtu", 0.3)
    filter = pv.NestgridIsosurface(Input=reader)
    filter.Scalars = ["POINTS", "u"]
    filter.Isovalue, filter.Error = 0.4, 0.2
    counts = []
    for places in (0.03, 0.003):
        filter.PositionError = places
        same(fetch(filter), expected.isosurface(0.4, error=0.2, position_error=places))
        counts.append(fetch(filter).GetNumberOfPolys())
    assert counts[0] < counts[1], counts


def check_hyper_tree_grid():
    source = pv.HyperTreeGridRandom(Dimensions=[4, 4, 4], MaxDepth=4, SplitFraction=0.4, Seed=3)
    source.UpdatePipeline()
    filter = pv.NestgridIsosurface(Input=source)
    filter.Scalars = ["CELLS", "Depth"]
    filter.Isovalue = 1.2
    data = fetch(filter)
    assert data.GetNumberOfPolys() > 100
    filter.Cap = 1
    assert open_edges(fetch(filter)) == 0, "no gap opens where the level changes"
    slice = pv.NestgridSlice(Input=source)
    slice.Scalars = ["CELLS", "Depth"]
    slice.Origin, slice.Normal = [0.5, 0.4, 0.45], [1, 2, 3]
    assert fetch(slice).GetPointData().GetArray("Depth").GetRange()[1] > 0


def check_flat_hyper_tree_grid():
    """Trees in a plane across any axis are drawn there, as fields in the plane."""
    for axis in range(3):
        points = [5, 5, 5]
        points[axis] = 1
        trees = "R" * 8 + "." * 8 + "|" + "R..." * 8 + "|" + "...." * 8
        source = pv.HyperTreeGrid(Dimensions=points, MaxDepth=3, Descriptor=trees)
        source.UpdatePipeline()
        lines = pv.NestgridIsolines(Input=source)
        lines.Scalars = ["CELLS", "Depth"]
        lines.Values = [1.2]
        data = fetch(lines)
        assert data.GetNumberOfPoints() > 10, axis
        low, high = data.GetBounds()[2 * axis : 2 * axis + 2]
        assert low == high, "lines lie in the plane"
        heights = pv.NestgridHeightField(Input=source)
        heights.Scalars = ["CELLS", "Depth"]
        assert fetch(heights).GetNumberOfPolys() > 10, axis


def check_overlapping_amr():
    source = pv.AMRGaussianPulseSource()
    source.UpdatePipeline()
    for filter in (pv.NestgridIsosurface(Input=source), pv.NestgridSlice(Input=source)):
        filter.Scalars = ["CELLS", "Gaussian-Pulse"]
        if filter.GetXMLName() == "NestgridSlice":
            filter.Origin, filter.Normal = [0.1, 0.1, 0.4], [1, 2, 3]
        else:
            filter.Isovalue, filter.Cap = 0.3, 1
        data = fetch(filter)
        assert data.GetNumberOfPolys() > 50
        assert filter.GetXMLName() == "NestgridSlice" or open_edges(data) == 0


def check_reader():
    path = os.path.join(folder, "stored.nestgrid")
    reader = pv.OpenDataFile(path)
    reader.FieldName, reader.Isovalue, reader.Threshold = "wave", 0.3, 0.05
    same(fetch(reader), nestgrid.load(path, "wave").isosurface(0.3, 0.05))
    reader.Draw = "Slice"
    reader.Origin, reader.Normal = [0.4, 0.5, 0.5], [1, 0, 0]
    assert fetch(reader).GetPointData().GetArray("wave") is not None
    reader.Distance = 0.1  # of isosurfaces
    across = ((0.4, 0.5, 0.5), (1, 0, 0))
    same(fetch(reader), nestgrid.load(path, "wave").slice(plane=across, threshold=0.05))
    reader.Error, reader.Collapse = 0.05, 1
    same(fetch(reader), nestgrid.load(path, "wave").slice(plane=across, error=0.05, collapse=True))


def check_times():
    first, second = [os.path.join(folder, name) for name in ("stored.nestgrid", "later.nestgrid")]
    reader = pv.NestgridReader(FileNames=[first, second])
    reader.FieldName, reader.Isovalue = "wave", 0.3
    reader.UpdatePipelineInformation()
    assert list(reader.TimestepValues) == [0, 1]
    counts = []
    for time in (0, 1, 0):
        reader.UpdatePipeline(time)
        counts.append(servermanager.Fetch(reader).GetNumberOfPolys())
    assert counts[0] == counts[2] != counts[1], counts


def check_frames():
    """One file with frames: its times, and fields between them."""
    path = os.path.join(folder, "frames.nestgrid")
    reader = pv.NestgridReader(FileNames=[path])
    reader.Isovalue, reader.Threshold = 0.3, 0.05
    reader.UpdatePipelineInformation()
    assert list(reader.TimestepValues) == [1, 3]
    frames = nestgrid.load(path)
    for time in (1, 1.6, 3):
        reader.UpdatePipeline(time)
        same(servermanager.Fetch(reader), frames.at(time).isosurface(0.3, 0.05))


def check_what_is_refused():
    """A message, no crash, and the filter can be used afterwards."""
    wavelet = pv.Wavelet(WholeExtent=[-5, 5, -5, 5, -5, 5])
    wavelet.UpdatePipeline()
    filter = pv.NestgridIsosurface(Input=wavelet)
    filter.MaxTriangles = 1
    filter.Isovalue = 157
    assert fetch(filter).GetNumberOfPolys() == 0
    filter.MaxTriangles = 0
    assert fetch(filter).GetNumberOfPolys() > 0
    gradient = pv.Gradient(Input=wavelet, ScalarArray=['POINTS', 'RTData'])
    gradient.UpdatePipeline()
    filter = pv.NestgridIsosurface(Input=gradient)
    filter.Scalars = ["POINTS", "Gradient"]
    assert fetch(filter).GetNumberOfPolys() == 0


def brightness(path):
    from vtkmodules.vtkIOImage import vtkPNGReader

    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)


def check_state_and_picture():
    pv.ResetSession()
    pv.LoadPlugin(PLUGIN, remote=False)
    wavelet = pv.Wavelet()
    wavelet.UpdatePipeline()
    filter = pv.NestgridIsosurface(Input=wavelet, Isovalue=157, Threshold=5, Indicator="wavelet")
    view = pv.CreateView("RenderView")
    view.ViewSize = [400, 300]
    pv.Show(filter, view)
    pv.ResetCamera(view)
    pictures = [os.path.join(folder, name) for name in ("before.png", "after.png")]
    pv.SaveScreenshot(pictures[0], view)
    triangles = fetch(filter).GetNumberOfPolys()
    state = os.path.join(folder, "state.pvsm")
    pv.SaveState(state)
    pv.ResetSession()
    pv.LoadPlugin(PLUGIN, remote=False)
    pv.LoadState(state)
    again = [each for each in pv.GetSources().values() if "Nestgrid" in each.GetXMLName()]
    assert len(again) == 1 and again[0].Isovalue == 157 and again[0].Indicator == "wavelet"
    assert fetch(again[0]).GetNumberOfPolys() == triangles > 0
    view = pv.GetActiveViewOrCreate("RenderView")
    pv.SaveScreenshot(pictures[1], view)
    before, after = map(brightness, pictures)
    assert before.shape == after.shape and np.abs(before - after).max() == 0
    background = before[0]
    drawn = (np.abs(before - background).sum(axis=1) > 30).mean()
    assert 0.05 < drawn < 0.95, f"{drawn:.2f} of the picture is drawn"


check_image_data()
check_measures()
check_abort()
check_where_and_how()
check_several_isovalues()
check_outlines()
check_planes()
check_unstructured_grid()
check_hyper_tree_grid()
check_flat_hyper_tree_grid()
check_overlapping_amr()
check_reader()
check_times()
check_frames()
check_what_is_refused()
check_state_and_picture()
print("all checks passed")
