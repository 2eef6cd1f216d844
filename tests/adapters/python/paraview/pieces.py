# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run by pvpython: what ranks wrote, one file of all and one of each, is one closed surface.

Arguments: a folder with surface.vtp and surface.pvtp, where a picture may be written.
"""
import os
import sys

import paraview.simple as pv
from paraview import servermanager
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFeatureEdges
from vtkmodules.vtkIOImage import vtkPNGReader

folder = sys.argv[1]
said = vtkStringOutputWindow()
vtkOutputWindow.SetInstance(said)


def shape(data):
    """Of the surface in which equal points are one: points, triangles, open edges."""
    welded = vtkCleanPolyData()
    welded.SetInputData(data)
    welded.SetTolerance(0)
    edges = vtkFeatureEdges()
    edges.SetInputConnection(welded.GetOutputPort())
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    surface = welded.GetOutput()
    counts = surface.GetNumberOfPoints(), surface.GetNumberOfPolys()
    return counts + (edges.GetOutput().GetNumberOfCells(),)


def picture(source, name):
    """Shows a surface, and returns how many pixels are not of the background."""
    view = pv.CreateView("RenderView")
    view.ViewSize = [320, 320]
    view.OrientationAxesVisibility = 0
    pv.Show(source, view)
    pv.ResetCamera(view)
    path = os.path.join(folder, name)
    pv.SaveScreenshot(path, view)
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return int((pixels != pixels[0]).any(axis=1).sum())


shapes, shown = [], []
for name in ("surface.vtp", "surface.pvtp"):
    source = pv.OpenDataFile(os.path.join(folder, name))
    source.UpdatePipeline()
    shapes.append(shape(servermanager.Fetch(source)))
    shown.append(picture(source, name + ".png"))
messages = said.GetOutput()
vtkOutputWindow.SetInstance(None)  # through which Python prints, too
print(shapes, shown)
assert shapes[0] == shapes[1] and shapes[0][2] == 0, shapes
assert min(shown) > 5000 and abs(shown[0] - shown[1]) < 50, shown
assert messages == "", messages
print("all checks passed")
