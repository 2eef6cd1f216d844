# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C ends every method soon, and what it was called on can be used afterwards."""
import gc
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import nestgrid

SOON = 0.5  # seconds from the signal to the exception


@pytest.fixture(scope="module")
def array():
    """Noise, so that nothing is coarse: 193 samples along each index."""
    return np.random.default_rng(1).random((193, 193, 193), np.float32)


@pytest.fixture(scope="module")
def volume(array):
    result = nestgrid.Volume(array)
    assert result.range[0] < result.range[1]  # the preroll is done
    return result


@pytest.fixture(scope="module")
def expected(volume):
    """What a probe gives where no call was interrupted before."""
    return volume.probe([[1.5, 2.25, 3]], 0.1)


@pytest.fixture(scope="module")
def surface(array):
    """About 4 million triangles."""
    part = nestgrid.Volume(array[:97, :97, :97].copy())
    return part.isosurface(0.5, elements=True, normals=False)


def wait_for_abandoned_work():
    """Waits until this process rests: work that could not be ended counts for the next call."""
    while True:
        before = time.process_time()
        time.sleep(0.05)
        if time.process_time() - before < 0.02:
            return


def interrupted(function, after=0.05):
    """Asserts that a real SIGINT ends a call soon.

    after  seconds from the call to the signal
    """
    sent = []

    def send():
        sent.extend((time.monotonic(), time.process_time()))
        os.kill(os.getpid(), signal.SIGINT)

    gc.collect()  # a signal that comes in a destructor is lost
    timer = threading.Timer(after, send)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            function()
            # A call that was quicker than the signal shows nothing.
            timer.join()
            time.sleep(0.01)
            raise AssertionError("the call ended before the signal came")
    finally:
        timer.cancel()
        timer.join()
    # Where the machine has other work, the processor time of this process tells.
    waited = min(time.monotonic() - sent[0], time.process_time() - sent[1])
    wait_for_abandoned_work()
    assert waited < SOON, f"{waited:.2f} s"


PREROLLS = {
    "offset": {"threshold": 0.1},
    "visual": {"indicator": "visual", "threshold": 0.1},
    "numerical": {"indicator": "numerical", "threshold": 0.1},
    "wavelet": {"indicator": "wavelet", "threshold": 0.1},
    "blend": {"blend": 2, "threshold": 0.1},
    "lens": {"lens": ((0, 0, 0), 30)},
}


@pytest.mark.parametrize("name", PREROLLS)
def test_prerolls(array, expected, name):
    volume = nestgrid.Volume(array)
    threads = 1 + len(name) % 2
    interrupted(lambda: volume.isosurface(0.5, threads=threads, **PREROLLS[name]))
    # What was begun is no part of what is kept.
    np.testing.assert_array_equal(volume.probe([[1.5, 2.25, 3]], 0.1), expected)


POINTS = np.random.default_rng(2).random((3_000_000, 3)) * 192
METHODS = {
    "isosurface": lambda v: v.isosurface(0.5),
    "max_triangles": lambda v: v.isosurface(0.5, max_triangles=2_000_000),
    "slice": lambda v: v.slice(sphere=((96, 96, 96), 80), threshold=0.01),
    "probe": lambda v: v.probe(POINTS, threads=1),
}


@pytest.mark.parametrize("name", METHODS)
def test_methods(volume, name):
    interrupted(lambda: METHODS[name](volume))


def test_range(array):
    interrupted(lambda: nestgrid.Volume(array).range)


@pytest.mark.parametrize("name", ["isolines", "height_field"])
def test_methods_in_two_dimensions(name):
    flat = nestgrid.Volume(np.random.default_rng(1).random((3000, 3000), np.float32))
    assert flat.range
    call = {"isolines": lambda: flat.isolines([0.2, 0.5, 0.8]), "height_field": flat.height_field}
    interrupted(call[name])


def test_frames(array):
    frames = nestgrid.Frames([array, array])
    interrupted(lambda: frames.at(0.5))


def test_holes(array):
    """Missing samples all over, so that no large part is known to have values."""
    missing = np.random.default_rng(3).random(array.shape, np.float32) < 0.01
    holes = np.where(missing, np.float32(np.nan), array)
    interrupted(lambda: nestgrid.Volume(holes))
    interrupted(lambda: nestgrid.Frames([array, holes]), after=0.1)


def test_octrees():
    side = np.arange(128)
    leaves = np.stack(np.meshgrid(side, side, side, indexing="ij"), axis=-1).reshape(-1, 3)
    leaves = np.hstack([leaves, np.full((len(leaves), 1), 7)])
    values = np.random.default_rng(1).random(len(leaves))
    interrupted(lambda: nestgrid.Octree(leaves, values))


@pytest.mark.parametrize("name", ["report", "outlines", "isolines"])
def test_results(surface, name):
    call = {"report": surface.report, "outlines": surface.outlines}
    if name == "isolines":
        heights = nestgrid.Volume(np.random.default_rng(1).random((600, 600), np.float32))
        graph = heights.height_field()
        call["isolines"] = lambda: graph.isolines([0.2, 0.5, 0.8])
    interrupted(call[name])


@pytest.mark.parametrize("suffix", [".vtp", ".ply", ".stl", ".obj", ".gltf"])
def test_save(surface, suffix, tmp_path):
    interrupted(lambda: surface.save(tmp_path / ("x" + suffix)))
    assert os.listdir(tmp_path) == []


def test_marching_cubes(array):
    interrupted(lambda: nestgrid.marching_cubes(array, 0.5))


def test_load(tmp_path):
    pytest.importorskip("vtkmodules.vtkIOXML")
    path = tmp_path / "x.vti"
    path.write_bytes(b"<VTKFile>" + b" " * 100 + b"</VTKFile>")
    slow = tmp_path / "slow"
    slow.write_text("#!/bin/sh\nexec sleep 20\n")
    slow.chmod(0o755)
    executable, sys.executable = sys.executable, str(slow)
    try:
        interrupted(lambda: nestgrid.load(path))
    finally:
        sys.executable = executable


def test_the_end_of_python_waits_for_abandoned_work(tmp_path):
    """Work that does not hear is left to end, also where the program ends meanwhile."""
    program = """
import os, signal, threading, numpy as np, nestgrid
volume = nestgrid.Volume(np.random.default_rng(1).random((65, 65, 65), np.float32))
surface = volume.isosurface(0.5, elements=True, normals=False)
threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    for _ in range(20):
        surface.report()
except KeyboardInterrupt:
    del surface, volume
    print("interrupted")
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "interrupted\n", "")


def test_same_result_afterwards(volume):
    interrupted(lambda: volume.isosurface(0.5))
    gc.collect()
    region = {"lens": ((0, 0, 0), 20)}
    first = volume.isosurface(0.5, **region)
    again = nestgrid.Volume(volume.array).isosurface(0.5, **region)
    np.testing.assert_array_equal(first.vertices, again.vertices)


def test_other_threads_run_meanwhile(array):
    """The lock of Python is released: another thread counts while a surface is drawn."""
    volume = nestgrid.Volume(array[:65, :65, :65].copy())
    steps = [0]
    done = threading.Event()

    def count():
        while not done.is_set():
            steps[0] += 1
            time.sleep(1e-4)

    thread = threading.Thread(target=count)
    thread.start()
    before = steps[0]
    volume.isosurface(0.5, threads=1)
    counted = steps[0] - before
    done.set()
    thread.join()
    assert counted > 20
