# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The pipeline of docs/paraview.md, and its picture. Run by pvpython.

Arguments: the picture to write, a .png file.
"""
import sys

# [pipeline]
from paraview.simple import *
from nestgrid.paraview import PLUGIN

LoadPlugin(PLUGIN, remote=False, ns=globals())
wavelet = Wavelet(WholeExtent=[-40, 40, -40, 40, -40, 40])
wavelet.UpdatePipeline()
surface = NestgridIsosurface(Input=wavelet, Isovalue=140, MaxTriangles=20000)
cut = NestgridSlice(Input=wavelet, Origin=[0, 0, -30], Normal=[0, 0, 1], Threshold=4)
# [pipeline]


def refined_near_a_sphere(depth):
    """The descriptor of 2 x 2 x 2 trees of width 1 whose cells are split near a sphere."""
    low = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    width, levels = 1.0, []
    for _ in range(depth):
        near = []
        for cell in low:
            r2 = sum((x + width / 2 - 1) ** 2 for x in cell)
            near.append(abs(r2**0.5 - 0.7) < 0.8 * width)
        levels.append("".join("R" if split else "." for split in near))
        width /= 2
        low = [
            tuple(x + width * (c >> d & 1) for d, x in enumerate(cell))
            for cell, split in zip(low, near)
            if split
            for c in range(8)
        ]
    return "|".join([*levels, "." * len(low)])


trees = HyperTreeGrid(Dimensions=[3, 3, 3], MaxDepth=6, Descriptor=refined_near_a_sphere(5))
trees.UpdatePipeline()
levels = NestgridIsosurface(Input=trees, Isovalue=3.5, Normals=0)


def view(title, shown):
    result = CreateView("RenderView")
    result.ViewSize = [500, 380]
    result.OrientationAxesVisibility = 0
    result.UseColorPaletteForBackground = 0
    result.Background = [1, 1, 1]
    for source, properties in shown:
        Show(source, result, **properties)
    text = Show(Text(Text=title), result)
    text.Color, text.FontSize, text.WindowLocation = [0, 0, 0], 15, "Lower Left Corner"
    result.CameraPosition, result.CameraViewUp = [-3, -5, 3.5], [0, 0, 1]
    ResetCamera(result)
    GetActiveCamera().Zoom(1.25)
    return result


layout = CreateLayout("picture")
count = servermanager.Fetch(surface).GetNumberOfPolys()
left = view(
    f"image data: {count:,} triangles, and a slice",
    [
        (surface, {"DiffuseColor": [0.53, 0.68, 0.85]}),
        (cut, {"ColorArrayName": ["POINTS", "RTData"]}),
    ],
)
edges = {"Representation": "Surface With Edges", "EdgeColor": [0.1, 0.15, 0.25]}
right = view(
    "hyper tree grid: depth 3.5, no gap where it changes",
    [(levels, {"DiffuseColor": [0.85, 0.72, 0.5], "ColorArrayName": [None, ""], **edges})],
)
layout.SplitHorizontal(0, 0.5)
layout.AssignView(1, left)
layout.AssignView(2, right)
layout.SetSize(1000, 380)
SaveScreenshot(sys.argv[1], layout, ImageResolution=[1000, 380])
