# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The whole command beside a script of VTK's Python: from a scan in a file to a surface in a file.

Both read the same NIfTI file, draw one isosurface with normals and write it as .vtp; the script by
VTK's reader, flying edges and writer. They take turns, each in a process of its own; told are the
processor seconds of the user, the least of all turns. The scan is one of the Debian package
mricron-data, with linear interpolation between its samples, so that there are as many as asked for.
Prints the table of docs/speed.md.

Arguments: the program; --quick for a small scan and one turn; --turns N; --samples N, in millions;
--scan FILE, another one of unsigned bytes.
"""
import argparse
import gzip
import os
import subprocess
import sys
import tempfile

import numpy as np

try:
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
    from vtkmodules.vtkIOImage import vtkNIFTIImageReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter
except ImportError as missing:
    print(missing)
    sys.exit(77)

SCAN = "/usr/share/mricron/templates/ch2.nii.gz"


def draw_with_vtk(source, value, target, packed):
    """The script: what somebody writes who has VTK.

    packed: whether the writer is left as it is, or told to write raw bytes packed with LZ4."""
    reader = vtkNIFTIImageReader()
    reader.SetFileName(source)
    contour = vtkFlyingEdges3D()
    contour.SetInputConnection(reader.GetOutputPort())
    contour.SetValue(0, value)
    contour.ComputeNormalsOn()
    contour.ComputeGradientsOff()
    writer = vtkXMLPolyDataWriter()
    writer.SetInputConnection(contour.GetOutputPort())
    writer.SetFileName(target)
    if packed:
        writer.EncodeAppendedDataOff()
        writer.SetCompressorTypeToLZ4()
    writer.Write()


def resampled(samples, count):
    """Linear interpolation, one axis after the other."""
    factor = (count / samples.size) ** (1 / 3)
    for axis in range(3):
        at = np.linspace(0, samples.shape[axis] - 1, round(samples.shape[axis] * factor), dtype=np.float32)
        low = np.minimum(at.astype(int), samples.shape[axis] - 2)
        shape = [-1 if d == axis else 1 for d in range(3)]
        part = (at - low).reshape(shape)
        samples = np.take(samples, low, axis) * (1 - part) + np.take(samples, low + 1, axis) * part
    return samples


def make_scan(scan, path, count):
    """Writes a NIfTI file of so many samples of 16 bits."""
    data = gzip.decompress(open(scan, "rb").read())
    shape = np.frombuffer(data, "<i2", 3, 42)
    if np.frombuffer(data, "<i2", 1, 70)[0] != 2:
        raise SystemExit(f"{scan} has no samples of unsigned bytes")
    first = int(np.frombuffer(data, "<f4", 1, 108)[0])
    samples = np.frombuffer(data, np.uint8, shape.prod(), first).reshape(shape, order="F").astype(np.float32)
    samples = np.rint(16 * resampled(samples, count)).astype("<i2")
    header = bytearray(data[:352])
    header[42:48] = np.array(samples.shape, "<i2").tobytes()
    header[70:74] = np.array([4, 16], "<i2").tobytes()
    header[108:112] = np.float32(352).tobytes()
    with open(path, "wb") as file:
        file.write(header + samples.tobytes("F"))
    return samples.size


def measured(command):
    """Seconds of the user."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{command} failed")
    return usage.ru_utime


def triangles_of(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput().GetNumberOfPolys()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--samples", type=float, default=35)
    parser.add_argument("--scan", default=SCAN)
    parser.add_argument("--script", nargs=4, help=argparse.SUPPRESS)
    o = parser.parse_args()
    if o.script:
        source, value, target, packed = o.script
        return draw_with_vtk(source, float(value), target, packed == "packed")
    if not os.path.exists(o.scan):
        print(o.scan, "is missing")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        scan = os.path.join(folder, "scan.nii")
        count = make_scan(o.scan, scan, 300000 if o.quick else o.samples * 1e6)
        value, target = str(16 * 60), os.path.join(folder, "surface.vtp")
        script = [sys.executable, "-B", __file__, o.program, "--script", scan, value, target]
        draw = [o.program, "isosurface", scan, "--value", value, "-o", target]
        commands = {
            "`nestgrid isosurface`, one thread": draw + ["--threads", "1"],
            "the same, `--threshold 2%`": draw + ["--threads", "1", "--threshold", "2%"],
            "the same, `--no-normals`": draw + ["--threads", "1", "--no-normals"],
            "VTK's Python": script + ["plain"],
            "VTK's Python, raw bytes packed with LZ4": script + ["packed"],
        }
        seconds = {name: [] for name in commands}
        facts = {}
        for _ in range(1 if o.quick else o.turns):
            for name, command in commands.items():
                seconds[name].append(measured(command))
                facts[name] = triangles_of(target), os.path.getsize(target) / 1e6
        print(f"{count / 1e6:.1f} million samples, value {value}\n")
        print("| from .nii to .vtp | user, s | triangles | file, MB |\n|---|---|---|---|")
        for name, (triangles, size) in facts.items():
            print(f"| {name} | {min(seconds[name]):.1f} | {triangles:,} | {size:,.0f} |")
        if any(triangles == 0 for triangles, _ in facts.values()):
            raise SystemExit("a surface is empty")


if __name__ == "__main__":
    main()
