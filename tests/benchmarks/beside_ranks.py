# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""One surface of a distributed forest, beside VTK's contour of the files that p8est writes of it.

Runs beside_ranks under mpirun, contours the forest that p8est has written with VTK, merged points,
and counts of both surfaces, as VTK reads them, triangles and open edges inside the domain; seconds
until the surface is in a file, and bytes that were written. With the name of a picture draws both:
nestgrid's coloured by rank, VTK's with its open edges in red.

Arguments: the program; [picture]; --ranks N; --level N, the deepest; --mpirun COMMAND
"""
import argparse
import glob
import os
import subprocess
import sys
import tempfile
import time

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkFeatureEdges
    from vtkmodules.vtkIOXML import (
        vtkXMLPolyDataReader,
        vtkXMLPolyDataWriter,
        vtkXMLPUnstructuredGridReader,
    )
except ImportError as missing:
    print(missing)
    sys.exit(77)


def run(arguments, folder):
    """What the program prints, as a dictionary of numbers."""
    command = [*arguments.mpirun.split(), "-n", str(arguments.ranks), arguments.program, folder]
    text = subprocess.run(
        [*command, str(arguments.level)], check=True, capture_output=True, text=True
    ).stdout
    return {name: float(number) for name, number in map(str.split, text.splitlines())}


def size_of(pattern):
    return sum(os.path.getsize(name) for name in glob.glob(pattern))


def read(name):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()


def contour(folder):
    """The contour of p8est's files, written; and the seconds until it is."""
    begin = time.perf_counter()
    reader = vtkXMLPUnstructuredGridReader()
    reader.SetFileName(f"{folder}/forest.pvtu")
    reader.Update()
    reader.GetOutput().GetPointData().SetActiveScalars("wave")
    surface = vtkContourFilter()
    surface.SetInputData(reader.GetOutput())
    surface.SetValue(0, 0)
    surface.ComputeNormalsOff()
    writer = vtkXMLPolyDataWriter()
    writer.SetInputConnection(surface.GetOutputPort())
    writer.SetFileName(f"{folder}/contour.vtp")
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    writer.Write()
    return surface.GetOutput(), time.perf_counter() - begin


def open_edges(surface):
    """Edges of one triangle that do not lie in a side of the unit cube, as poly data."""
    edges = vtkFeatureEdges()
    edges.SetInputData(surface)
    edges.BoundaryEdgesOn()
    edges.FeatureEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.ColoringOff()
    edges.Update()
    found = edges.GetOutput()
    inside = []
    points = vtk_to_numpy(found.GetPoints().GetData()) if found.GetNumberOfCells() else None
    for i in range(found.GetNumberOfCells()):
        ends = points[[found.GetCell(i).GetPointId(k) for k in (0, 1)]]
        on_side = any((abs(ends[:, d] - s) < 1e-9).all() for d in range(3) for s in (0, 1))
        if not on_side:
            inside.append(i)
    return found, inside


def draw(folder, surface, edges, inside, picture):
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkTubeFilter
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkmodules.vtkRenderingCore import (
        vtkActor,
        vtkPolyDataMapper,
        vtkRenderer,
        vtkRenderWindow,
        vtkWindowToImageFilter,
    )

    def actor(data, colour):
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(data)
        mapper.ScalarVisibilityOff()
        made = vtkActor()
        made.SetMapper(mapper)
        made.GetProperty().SetColor(colour)
        return made

    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(1400, 700)
    sides = []
    for left in (0, 0.5):
        side = vtkRenderer()
        side.SetViewport(left, 0, left + 0.5, 1)
        side.SetBackground(1, 1, 1)
        window.AddRenderer(side)
        sides.append(side)
    colours = [(0.27, 0.47, 0.67), (0.93, 0.8, 0.4), (0.13, 0.53, 0.2), (0.67, 0.2, 0.47)]
    pieces = sorted(glob.glob(f"{folder}/pieces_*.vtp"), key=lambda n: int(n[:-4].rsplit("_")[-1]))
    for i, name in enumerate(pieces):
        sides[0].AddActor(actor(read(name), colours[i % len(colours)]))
    sides[1].AddActor(actor(surface, (0.75, 0.75, 0.75)))
    lines = vtkCellArray()
    for i in inside:
        lines.InsertNextCell(edges.GetCell(i))
    marked = vtkPolyData()
    marked.SetPoints(edges.GetPoints())
    marked.SetLines(lines)
    tubes = vtkTubeFilter()
    tubes.SetInputData(marked)
    tubes.SetRadius(0.003)
    tubes.Update()
    sides[1].AddActor(actor(tubes.GetOutput(), (0.85, 0.1, 0.1)))
    camera = sides[0].GetActiveCamera()
    camera.SetPosition(-1.6, -2.2, 1.7)
    camera.SetFocalPoint(0.5, 0.5, 0.5)
    camera.SetViewUp(0, 0, 1)
    sides[0].ResetCamera()
    camera.Zoom(1.3)
    sides[1].SetActiveCamera(camera)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtkPNGWriter()
    writer.SetInputConnection(image.GetOutputPort())
    writer.SetFileName(picture)
    writer.Write()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("picture", nargs="?")
    parser.add_argument("--ranks", type=int, default=4)
    parser.add_argument("--level", type=int, default=6)
    parser.add_argument("--mpirun", default="mpirun --oversubscribe")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        told = run(arguments, folder)
        surface = read(f"{folder}/surface.vtp")
        ours = len(open_edges(surface)[1])
        theirs, seconds = contour(folder)
        edges, inside = open_edges(theirs)
        print(f"{told['leaves']:.0f} leaves on {told['ranks']:.0f} ranks")
        print("               triangles  open edges  seconds  bytes")
        print(
            f"nestgrid       {surface.GetNumberOfPolys():9d}  {ours:10d}  "
            f"{told['nestgrid_seconds']:7.2f}  {size_of(folder + '/surface.vtp'):,}"
        )
        written = size_of(folder + "/forest*") + size_of(folder + "/contour.vtp")
        print(
            f"p8est and VTK  {theirs.GetNumberOfPolys():9d}  {len(inside):10d}  "
            f"{told['forest_seconds'] + seconds:7.2f}  {written:,}"
        )
        if arguments.picture:
            draw(folder, theirs, edges, inside, arguments.picture)
    alike = surface.GetNumberOfPolys() == told["nestgrid_triangles"]
    sys.exit(0 if ours == 0 and alike and len(inside) > 0 else 1)


main()
