# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The code of docs/python.md, cell by cell, and its picture.

Arguments: the picture to write, a .png file. Needs VTK, and a display or xvfb-run.
"""
import sys

# [data]
import numpy as np
import nestgrid

rng = np.random.default_rng(5)
axis = np.linspace(-1, 1, 129)
x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
density = np.zeros((129, 129, 129), np.float32)
for atom in rng.uniform(-0.6, 0.6, (14, 3)):
    r2 = (x - atom[0]) ** 2 + (y - atom[1]) ** 2 + (z - atom[2]) ** 2
    density += np.exp(-r2 / 0.03).astype(np.float32)
# [data]

# [surface]
spacing = (2 / 128,) * 3
volume = nestgrid.Volume(density, spacing=spacing, origin=(-1, -1, -1))
full = volume.isosurface(0.35)
coarse = volume.isosurface(0.35, max_triangles=6_000, elements=True)
print(full, coarse, coarse.report()["open_edges"])
# [surface]

# [lens]
top = full.vertices[full.vertices[:, 2].argmax()]
lens = nestgrid.Lens(nestgrid.ball(top, 0.3), coarsest=0.15)
focused = volume.isosurface(0.35, lens=lens, elements=True)
# [lens]

# [slice]
cut = volume.slice(plane=((0, 0, 0.1), (0, 0, 1)), threshold=0.01)
levels = cut.isolines([0.1, 0.2, 0.35, 0.5])
area = full.report()["area"]
values = volume.probe([(0, 0, 0), (0.2, 0.1, 0)])
# [slice]

# [values]
distance = nestgrid.Volume(np.sqrt(x * x + y * y + z * z), spacing=spacing, origin=(-1, -1, -1))
colour = distance.probe(coarse.vertices)
# [values]

# [slider]
least, greatest = volume.range
budget = nestgrid.FrameBudget(goal=6_000, greatest=greatest - least)
for level in np.linspace(0.2, 0.5, 30):
    frame = volume.isosurface(level, budget.threshold)
    budget.drawn(len(frame.triangles))
# [slider]


def actor(data, colour, **properties):
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    if data.GetNumberOfPolys():  # lines lie in front
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(3, 3)
    result = vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().SetColor(colour)
    for name, value in properties.items():
        getattr(result.GetProperty(), "Set" + name)(value)
    return result


def panel(window, place, title, actors):
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkTextActor

    renderer = vtkRenderer()
    renderer.SetViewport(place / 3, 0, (place + 1) / 3, 1)
    renderer.SetBackground(1, 1, 1)
    for each in actors:
        renderer.AddActor(each)
    text = vtkTextActor()
    text.SetInput(title)
    text.SetPosition(14, 8)
    text.GetTextProperty().SetFontSize(17)
    text.GetTextProperty().SetColor(0, 0, 0)
    renderer.AddActor(text)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(3, -5, 3)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.Zoom(1.3)
    window.AddRenderer(renderer)


def draw(path):
    import vtkmodules.vtkRenderingFreeType  # noqa: F401
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkmodules.vtkRenderingCore import vtkRenderWindow, vtkWindowToImageFilter

    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetSize(1140, 400)
    window.SetMultiSamples(8)
    blue, ink = (0.53, 0.68, 0.85), (0.1, 0.15, 0.25)
    surfaces = {"isosurface(0.35)": full, "max_triangles=6_000": coarse, "lens=lens": focused}
    for place, (name, surface) in enumerate(surfaces.items()):
        actors = [actor(surface.to_vtk(), blue)]
        if surface is not full:
            edges = surface.outlines().to_vtk()
            actors.append(actor(edges, ink, LineWidth=1, Lighting=False, Opacity=0.55))
        panel(window, place, f"{name}: {len(surface.triangles):,} triangles", actors)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    draw(sys.argv[1])
