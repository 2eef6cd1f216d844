# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Coarse surfaces of one volume by several programs, at equal numbers of triangles.

scikit-image's step_size sets the number of triangles; the others are asked for as many. Distances
are in samples, between a surface and the full one of VTK's flying edges, at points spread evenly
over the area: "there" from the coarse surface to the full one, "back" from the full one to the
coarse one. Normals are those of triangles: the mean angle between that of the coarse surface and that
of the full one at the nearest point. "Least angle" is the mean of those of all triangles. Times are
processor times, "again" of a second surface of the same samples at another isovalue, close by. Prints
the tables of docs/equal_triangles.md.

Arguments: --quick for small volumes; --step N ..., the values of step_size; --data NAME ..., of the
volumes; --brain FILE, the NIfTI volume in the place of the one of the Debian package mricron-data;
--cgal, the program cgal_collapse; --envelope, CGAL's collapses in an envelope, too, which is as wide as
the collapsed surface is far, which takes minutes to hours.
Needs VTK and scikit-image; OpenVDB (pyopenvdb) where it is found.
"""
import argparse
import gzip
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

import nestgrid

try:
    import pyopenvdb
except ImportError:
    pyopenvdb = None
try:
    from skimage.measure import marching_cubes
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints, vtkSMPTools
    from vtkmodules.vtkCommonCore import reference
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkGenericCell, vtkImageData
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkStaticCellLocator
    from vtkmodules.vtkFiltersCore import vtkDecimatePro, vtkFlyingEdges3D, vtkQuadricDecimation
except ImportError as missing:
    print(missing)
    sys.exit(77)

BRAIN = "/usr/share/mricron/templates/ch2bet.nii.gz"


def brain(path, quick):
    """8 bits, a magnetic resonance volume without its skull."""
    data = gzip.decompress(open(path, "rb").read())
    header = np.frombuffer(data, "<i2", 8, 40)
    shape = header[1:4]
    assert np.frombuffer(data, "<i2", 1, 70)[0] == 2, "not a volume of unsigned bytes"
    first = int(np.frombuffer(data, "<f4", 1, 108)[0])
    samples = np.frombuffer(data, np.uint8, shape.prod(), first).reshape(shape, order="F")
    return np.asfortranarray(samples[60:93, 80:113, 60:93] if quick else samples, np.float32)


def grid(n):
    return np.meshgrid(*[np.linspace(-1, 1, n, dtype=np.float32)] * 3, indexing="ij", sparse=True)


def molecule(n):
    """Fourteen Gaussians: smooth everywhere."""
    x, y, z = grid(n)
    density = np.zeros((n, n, n), np.float32)
    for atom in np.random.default_rng(5).uniform(-0.6, 0.6, (14, 3)):
        density += np.exp(-((x - atom[0]) ** 2 + (y - atom[1]) ** 2 + (z - atom[2]) ** 2) / 0.03)
    return density


def cap(n):
    """A ball, smooth but for ripples on the cap around one pole."""
    x, y, z = grid(n)
    r = np.sqrt(x * x + y * y + z * z)
    on_cap = np.clip((z / np.maximum(r, 1e-6) - 0.8) / 0.1, 0, 1)
    return (0.7 - r + 0.012 * on_cap * np.sin(50 * x) * np.sin(50 * y)).astype(np.float32)


def scan(n):
    """Like a computed tomogram: air, tissue, shells of bone, a point spread, noise."""
    x, y, z = grid(n)
    tissue = (x / 0.9) ** 2 + (y / 0.7) ** 2 + (z * 0.6) ** 2 < 1
    values = np.where(tissue, np.float32(40), np.float32(-1000))
    bones = np.random.default_rng(3).uniform(-0.5, 0.5, (9, 4))
    for cx, cy, cz, size in bones:
        r = np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - 0.7 * cz) ** 2) / (0.16 + 0.12 * size)
        values[(r < 1) & tissue] = 300
        values[(r < 1) & (r > 0.7) & tissue] = 900
    for axis in range(3):  # the point spread: (1, 2, 1) / 4, twice
        for _ in range(2):
            pad = [(1, 1) if d == axis else (0, 0) for d in range(3)]
            wide = np.pad(values, pad, mode="edge")
            low, middle, high = (np.take(wide, range(k, k + n), axis) for k in range(3))
            values = (low + 2 * middle + high) / 4
    noise = np.random.default_rng(7).normal(0, 20, values.shape)
    return (values + noise).astype(np.float32)


def poly_data(vertices, triangles):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(vertices, float), deep=True))
    cells = vtkCellArray()
    flat = np.ascontiguousarray(triangles, np.int64).ravel()
    offsets = np.arange(0, len(flat) + 1, 3, dtype=np.int64)
    cells.SetData(
        numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(flat, deep=True)
    )
    result = vtkPolyData()
    result.SetPoints(points)
    result.SetPolys(cells)
    return result


def arrays(data):
    cells = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    return vtk_to_numpy(data.GetPoints().GetData()).copy(), cells.reshape(-1, 3).copy()


class Samples:
    """The contestants. Each is asked for at most so many triangles, and gives its arrays."""

    def __init__(self, values):
        self.values = values
        self.volume = nestgrid.Volume(values)
        self.image = vtkImageData()
        self.image.SetDimensions(values.shape)
        flat = values.ravel(order="F")
        self.image.GetPointData().SetScalars(numpy_to_vtk(flat, deep=True))

    def scikit_image(self, level, step):
        return marching_cubes(self.values, level, step_size=step)[:2]

    def nestgrid(self, level, most, indicator="offset"):
        surface = self.volume.isosurface(
            level, max_triangles=most, indicator=indicator, normals=False, threads=1
        )
        return surface.vertices, surface.triangles

    def collapsed(self, level, error):
        surface = self.volume.isosurface(
            level, error=error, collapse=True, normals=False, threads=1
        )
        return surface.vertices, surface.triangles

    def error_within(self, level, most):
        """The least error whose collapsed surface has at most so many triangles."""
        least = self.volume.isosurface(level, max_triangles=most, collapse=True, normals=False)
        return least.threshold

    def flying_edges(self, level):
        edges = vtkFlyingEdges3D()
        edges.SetInputData(self.image)
        edges.SetValue(0, level)
        edges.ComputeNormalsOff()
        edges.ComputeScalarsOff()
        edges.Update()
        return edges.GetOutput()

    def decimated(self, filter, level, most):
        full = self.flying_edges(level)
        filter.SetInputData(full)
        filter.SetTargetReduction(1 - most / full.GetNumberOfPolys())
        filter.Update()
        return arrays(filter.GetOutput())

    def quadric(self, level, most):
        return self.decimated(vtkQuadricDecimation(), level, most)

    def decimate_pro(self, level, most):
        filter = vtkDecimatePro()
        filter.PreserveTopologyOff()
        return self.decimated(filter, level, most)

    def cgal(self, level, most, program, *distance):
        vertices, triangles = arrays(self.flying_edges(level))
        with tempfile.TemporaryDirectory() as folder:
            before, after = f"{folder}/before.off", f"{folder}/after.off"
            with open(before, "w") as file:
                file.write(f"OFF\n{len(vertices)} {len(triangles)} 0\n")
                np.savetxt(file, vertices, "%.9g")
                np.savetxt(file, np.insert(triangles, 0, 3, axis=1), "%d")
            command = [program, str(most), before, after, *map(str, distance)]
            seconds = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout
            with open(after) as file:
                words = file.read().split()[1:]
            end = 3 + 3 * int(words[0])
            vertices = np.array(words[3:end], float).reshape(-1, 3)
            return vertices, np.array(words[end:], int).reshape(-1, 4)[:, 1:], float(seconds)

    def openvdb(self, level, adaptivity):
        least = float(self.values.min())
        tree = pyopenvdb.FloatGrid(least)
        tree.copyFromArray(self.values, tolerance=0)
        points, triangles, quads = tree.convertToPolygons(isovalue=level, adaptivity=adaptivity)
        parts = [part for part in (triangles, quads[:, :3], quads[:, [0, 2, 3]]) if len(part)]
        return points, np.concatenate(parts)

    def adaptivity(self, level, most):
        """The least adaptivity with at most so many triangles; none where 1 has more."""
        if len(self.openvdb(level, 1)[1]) > most:
            return None
        low, high = 0, 1
        for _ in range(10):
            middle = (low + high) / 2
            if len(self.openvdb(level, middle)[1]) > most:
                low = middle
            else:
                high = middle
        return high


def corners(vertices, triangles):
    return [vertices[triangles[:, k]].astype(float) for k in range(3)]


def unit(rows):
    return rows / np.maximum(np.linalg.norm(rows, axis=1), 1e-30)[:, None]


def normals(vertices, triangles):
    a, b, c = corners(vertices, triangles)
    return unit(np.cross(b - a, c - a))


def least_angle(vertices, triangles):
    """The mean of the least angles of triangles, in degrees."""
    a, b, c = corners(vertices, triangles)
    cosines = [np.sum(unit(q - p) * unit(r - p), axis=1) for p, q, r in ((a, b, c), (b, c, a), (c, a, b))]
    return np.degrees(np.arccos(np.clip(np.max(cosines, axis=0), -1, 1))).mean()


def spread(vertices, triangles, count):
    """Points spread evenly over the area, and the triangles that they are on."""
    a, b, c = corners(vertices, triangles)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).cumsum()
    random = np.random.default_rng(1)
    chosen = np.searchsorted(area, (np.arange(count) + random.random(count)) / count * area[-1])
    s, t = random.random((2, count, 1))
    s, t = np.where(s + t > 1, 1 - s, s), np.where(s + t > 1, 1 - t, t)
    return a[chosen] + s * (b - a)[chosen] + t * (c - a)[chosen], chosen


def nearest(points, surface):
    """From the points to the surface: distances, and the triangles that are nearest."""
    locator = vtkStaticCellLocator()
    locator.SetDataSet(surface)
    locator.BuildLocator()
    at, cell = [0.0, 0.0, 0.0], vtkGenericCell()
    number, part, square = reference(0), reference(0), reference(0.0)
    distances, triangles = [], []
    for x in points:
        locator.FindClosestPoint(x, at, cell, number, part, square)
        distances.append(float(square) ** 0.5)
        triangles.append(int(number))
    return np.array(distances), np.array(triangles)


def timed(call, *arguments):
    start = time.process_time()
    result = call(*arguments)
    return result, time.process_time() - start


def compare(name, values, level, steps, count, cgal, envelope):
    samples = Samples(values)
    full = samples.flying_edges(level)
    there, _ = spread(*arrays(full), count)
    normals_of_full = normals(*arrays(full))
    nearby = level + 1e-3 * float(np.ptp(values))
    reached = {}  # the greatest distance, by program

    def row(step, by, contestant, *how):
        (vertices, triangles, *inside), first = timed(contestant, level, *how)
        (_, _, *inside_again), again = timed(contestant, nearby, *how)
        if inside:  # files count for nothing
            edges = timed(samples.flying_edges, level)[1]
            first, again = inside[0] + edges, inside_again[0] + edges
        points, on = spread(vertices, triangles, count)
        near, nearby_triangles = nearest(points, full)
        back, _ = nearest(there, poly_data(vertices, triangles))
        # Programs differ in which side is the front.
        same = np.sum(normals(vertices, triangles)[on] * normals_of_full[nearby_triangles], axis=1)
        turn = np.degrees(np.arccos(np.clip(np.abs(same), 0, 1))).mean()
        angle = least_angle(vertices, triangles)
        print(f"| {name} | {step} | {by} | {len(triangles):,} | {near.mean():.3f} | {back.mean():.3f} | "
              f"{near.max():.2f} | {back.max():.2f} | {turn:.1f} | {angle:.0f} | {first:.2f} | "
              f"{again:.2f} |", flush=True)
        reached[by] = max(near.max(), back.max())
        return len(triangles)

    row("", "VTK, all", lambda level: arrays(samples.flying_edges(level)))
    row("", "nestgrid, all", samples.nestgrid, None)
    for step in steps:
        most = row(step, "scikit-image", samples.scikit_image, step)
        samples.volume.changed()  # forgets what was computed
        assert row(step, "nestgrid", samples.nestgrid, most) <= most
        assert row(step, "nestgrid, by slopes", samples.nestgrid, most, "slope") <= most
        row(step, "nestgrid, collapsed", samples.collapsed, samples.error_within(level, most))
        row(step, "VTK, quadric", samples.quadric, most)
        row(step, "VTK, DecimatePro", samples.decimate_pro, most)
        if cgal:
            row(step, "CGAL, collapses", samples.cgal, most, cgal)
            if envelope:
                distance = reached["nestgrid, collapsed"]
                row(step, "CGAL, envelope", samples.cgal, 4, cgal, distance)
        adaptivity = samples.adaptivity(level, most) if pyopenvdb else None
        if adaptivity is not None:
            row(step, "OpenVDB", samples.openvdb, adaptivity)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--quick", action="store_true")
    arguments.add_argument("--step", type=int, nargs="+", default=[2, 3, 5])
    arguments.add_argument("--brain", default=BRAIN)
    arguments.add_argument("--data", nargs="+", default=["brain", "molecule", "ripples", "scan"])
    arguments.add_argument("--cgal")
    arguments.add_argument("--envelope", action="store_true")
    chosen = arguments.parse_args()
    vtkSMPTools.Initialize(1)
    n, count, steps = (33, 300, [2]) if chosen.quick else (129, 20_000, chosen.step)
    print("| data | step_size | by | triangles | mean there | mean back | greatest there | "
          "greatest back | normals | least angle | first, s | again, s |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    volumes = {"molecule": (lambda: molecule(n), 0.35), "ripples": (lambda: cap(n), 0.0),
               "scan": (lambda: scan(n), 400.0)}
    if os.path.exists(chosen.brain):
        volumes["brain"] = (lambda: brain(chosen.brain, chosen.quick), 95.5)
    for name in chosen.data:
        if name in volumes:
            make, level = volumes[name]
            compare(name, make(), level, steps, count, chosen.cgal, chosen.envelope)


if __name__ == "__main__":
    main()
