# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A gyroid in a plotfile of three levels: nestgrid beside VTK's reader and contour, in turns.

Each drawing is a process of its own, of one thread, which prints processor seconds of reading and of
surfaces, triangles, open edges, and by what the memory grew, less the bytes of the file.
Arguments: a folder for the plotfile, cells of level 0 along a side (96: 5.1 million in all), rounds.
Ends with 1 where a surface of nestgrid has an open edge, and with 77 where VTK is missing.
"""

from __future__ import annotations

import importlib.util
import itertools
import os
import resource
import subprocess
import sys
import time

import numpy as np

BOX = 32  # cells along the side of a box, at most


def levels_of(n: int) -> list[list[tuple[int, ...]]]:
    """The first cells of the boxes of each level; finer ones fill the middle of those before."""
    levels = []
    for low, high in ((0, n), (n - 9 * n // 16, n + 9 * n // 16), (2 * n - n // 2, 2 * n + n // 2)):
        low, high = low // BOX * BOX, -(-high // BOX) * BOX
        levels.append(list(itertools.product(range(low, high, BOX), repeat=3)))
    return levels


def text_of_box(low: tuple[int, ...], size: int) -> str:
    return "((%d,%d,%d) (%d,%d,%d) (0,0,0))" % (*low, *(a + size - 1 for a in low))


def write(folder: str, n: int) -> None:
    levels = levels_of(n)
    domains = " ".join(text_of_box((0, 0, 0), n << level) for level in range(3))
    sizes = "\n".join(" ".join([repr(1 / (n << level))] * 3) for level in range(3))
    text = f"HyperCLaw-V1.1\n1\ngyroid\n3\n0\n2\n0 0 0\n1 1 1\n2 2\n{domains}\n0 0 0\n{sizes}\n0\n0\n"
    for level, boxes in enumerate(levels):
        os.makedirs(os.path.join(folder, f"Level_{level}"))
        h = 1 / (n << level)
        text += f"{level} {len(boxes)} 0\n0\n"
        lines, places = [], []
        with open(os.path.join(folder, f"Level_{level}", "Cell_D_00000"), "wb") as file:
            for low in boxes:
                text += "".join(f"{a * h!r} {(a + BOX) * h!r}\n" for a in low)
                lines.append(text_of_box(low, BOX))
                places.append(f"FabOnDisk: Cell_D_00000 {file.tell()}")
                kind = "((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))"
                file.write(f"FAB {kind}{lines[-1]} 1\n".encode())
                x, y, z = (4 * np.pi * h * (a + np.arange(BOX) + 0.5) for a in low)
                x, y, z = x[:, None, None], y[:, None], z
                wave = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
                file.write(wave.astype("<f8").tobytes("F"))
        text += f"Level_{level}/Cell\n"
        count = len(boxes)
        head = "1\n1\n1\n0\n(%d 0\n%s\n)\n%d\n%s\n" % (count, "\n".join(lines), count, "\n".join(places))
        ends = "%d,1\n%s\n" % (count, "\n".join(["-1.5,"] * count))
        with open(os.path.join(folder, f"Level_{level}", "Cell_H"), "w") as file:
            file.write(head + "\n" + ends + "\n" + ends.replace("-", ""))
    with open(os.path.join(folder, "Header"), "w") as file:
        file.write(text)


def open_edges(points: np.ndarray, triangles: np.ndarray) -> int:
    """Edges of one triangle alone, without those in the walls of the domain, where a surface ends."""
    pairs = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    pairs.sort(axis=1)
    edges, counts = np.unique(pairs, axis=0, return_counts=True)
    at_wall = ((points < 1e-6) | (points > 1 - 1e-6)).any(axis=1)
    return int(((counts == 1) & ~at_wall[edges].all(axis=1)).sum())


def megabytes() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def draw_with_vtk(folder: str) -> None:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkCellDataToPointData, vtkCleanPolyData
    from vtkmodules.vtkFiltersCore import vtkContourFilter
    from vtkmodules.vtkIOAMR import vtkAMReXGridReader

    before, begin = megabytes(), time.process_time()
    reader = vtkAMReXGridReader()
    reader.SetFileName(folder)
    reader.UpdateInformation()
    reader.SetMaxLevel(2)
    reader.SetCellArrayStatus("gyroid", 1)
    reader.Update()
    read = time.process_time()
    to_points = vtkCellDataToPointData()
    to_points.SetInputConnection(reader.GetOutputPort())
    contour = vtkContourFilter()
    contour.SetInputConnection(to_points.GetOutputPort())
    contour.SetInputArrayToProcess(0, 0, 0, 0, "gyroid")
    contour.SetValue(0, 0)
    contour.Update()
    seconds, peak = time.process_time() - read, megabytes()
    pieces = vtkAppendPolyData()
    walk = contour.GetOutputDataObject(0).NewIterator()
    while not walk.IsDoneWithTraversal():
        pieces.AddInputData(walk.GetCurrentDataObject())
        walk.GoToNextItem()
    weld = vtkCleanPolyData()
    weld.SetInputConnection(pieces.GetOutputPort())
    weld.SetTolerance(1e-7)
    weld.Update()
    surface = weld.GetOutput()
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    points = vtk_to_numpy(surface.GetPoints().GetData())
    at = time.process_time()
    contour.SetValue(0, 0.01)
    contour.Update()
    times = [seconds, time.process_time() - at]
    report(read - begin, times, triangles, points, peak - before, folder)


def draw_with_nestgrid(folder: str, normals: bool) -> None:
    import nestgrid

    before, begin = megabytes(), time.process_time()
    field = nestgrid.load(folder, "gyroid")
    read = time.process_time()
    times = []
    for isovalue in (0, 0.01):
        at = time.process_time()
        surface = field.isosurface(isovalue, 0, normals=normals, threads=1)
        times.append(time.process_time() - at)
        if isovalue == 0:
            first, peak = surface, megabytes()
    report(read - begin, times, first.triangles, first.vertices, peak - before, folder)


def report(read: float, times: list[float], triangles: np.ndarray, points: np.ndarray, grown: float, folder: str) -> None:
    bytes_of_file = sum(
        os.path.getsize(os.path.join(at, name)) for at, _, names in os.walk(folder) for name in names
    )
    row = [f"{read:.2f}", *(f"{each:.2f}" for each in times), f"{len(triangles)} triangles"]
    row.append(f"{open_edges(points, triangles)} open edges")
    print(", ".join([*row, f"{grown - bytes_of_file / 2**20:.0f} MB beside the file"]))


def main() -> int:
    if importlib.util.find_spec("vtkmodules") is None:
        return 77
    folder = os.path.join(sys.argv[1], "plt_gyroid")
    n = int(sys.argv[2]) if len(sys.argv) > 2 else 96
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 3
    if not os.path.exists(os.path.join(folder, "Header")):
        write(folder, n)
    cells = sum(len(boxes) * BOX**3 for boxes in levels_of(n))
    print(f"{cells} cells; seconds to read, of the first surface, of the next one")
    are_closed = True
    for _ in range(rounds):
        for way in ("vtk", "nestgrid", "nestgrid without normals"):
            command = [sys.executable, "-B", __file__, "--draw", way, folder]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            print(f"{way:25}", done.stdout.strip())
            are_closed = are_closed and (way == "vtk" or ", 0 open edges" in done.stdout)
    return 0 if are_closed else 1


if __name__ == "__main__":
    if sys.argv[1] != "--draw":
        sys.exit(main())
    elif sys.argv[2] == "vtk":
        draw_with_vtk(sys.argv[3])
    else:
        draw_with_nestgrid(sys.argv[3], sys.argv[2] == "nestgrid")
