# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package beside the library in C++ and scikit-image: from array to arrays. Its import.

Prints processor times in ms on one thread, the least of several rounds in turns, and their ratios.
Arguments: the program bench_python; --quick for a small array.
"""
import subprocess
import sys
import time

import numpy as np

import nestgrid


def gyroid(n):
    x, y, z = np.meshgrid(*[np.linspace(0, 4 * np.pi, n)] * 3, indexing="ij")
    values = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return values.astype(np.float32)


def least(function, times):
    best = np.inf
    for _ in range(times):
        start = time.process_time()
        function()
        best = min(best, 1e3 * (time.process_time() - start))
    return best


def draw(array, threshold):
    surface = nestgrid.Volume(array).isosurface(0.1, threshold, threads=1)
    return surface.vertices, surface.triangles, surface.normals


def import_ms():
    """How long the import takes where NumPy is there already, the least of five."""
    program = "import numpy, time; t = time.process_time(); import nestgrid; "
    program += "print(1e3 * (time.process_time() - t))"
    command = [sys.executable, "-c", program]
    return min(float(subprocess.run(command, capture_output=True).stdout) for _ in range(5))


def main():
    program = sys.argv[1]
    quick = "--quick" in sys.argv
    n, rounds, times = (33, 1, 1) if quick else (129, 4, 5)
    array = gyroid(n)
    orders = {"C": np.ascontiguousarray(array), "Fortran": np.asfortranarray(array)}
    thresholds = (0, 0.05)
    ours = {(order, t): np.inf for order in orders for t in thresholds}
    cpp = {t: np.inf for t in thresholds}
    triangles = {}
    for _ in range(rounds):
        out = subprocess.run([program, str(n), str(times)], capture_output=True, check=True).stdout
        for t, line in zip(thresholds, out.decode().splitlines()):
            cpp[t] = min(cpp[t], float(line.split()[0]))
            triangles[t] = int(line.split()[1])
        for order, t in ours:
            ours[order, t] = min(ours[order, t], least(lambda: draw(orders[order], t), times))
    for (order, t), ms in ours.items():
        found = len(draw(orders[order], t)[1])
        assert order != "Fortran" or found == triangles[t]
        print(f"{order:7} order, threshold {t}: {found} triangles, {ms:.1f} ms, "
              f"{ms / cpp[t]:.2f} of the {cpp[t]:.1f} ms of C++")
    print(f"import beside NumPy: {import_ms():.0f} ms")
    try:
        from skimage.measure import marching_cubes
    except ImportError:
        return
    ms = least(lambda: marching_cubes(array, 0.1), times)
    print(f"scikit-image: {len(marching_cubes(array, 0.1)[1])} triangles, {ms:.1f} ms")


if __name__ == "__main__":
    main()
