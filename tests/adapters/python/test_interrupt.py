# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C ends an extraction, and the volume can be used afterwards."""
import os
import signal
import threading
import time

import numpy as np
import pytest

import nestgrid


@pytest.fixture(scope="module")
def volume():
    x, y, z = np.meshgrid(*[np.linspace(0, 40, 129, dtype=np.float32)] * 3, indexing="ij")
    result = nestgrid.Volume(np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x))
    assert result.range[0] < result.range[1]  # the preroll is done
    return result


@pytest.mark.parametrize("threads", [1, 2])
def test_keyboard_interrupt(volume, threads):
    start = time.perf_counter()
    whole = volume.isosurface(0.1, threads=threads)
    needed = time.perf_counter() - start
    timer = threading.Timer(0.2 * needed, os.kill, (os.getpid(), signal.SIGINT))
    drawn = 0
    with pytest.raises(KeyboardInterrupt):
        timer.start()
        while drawn < 5:
            volume.isosurface(0.1, threads=threads)
            drawn += 1
    assert drawn == 0
    again = volume.isosurface(0.1, threads=threads)
    np.testing.assert_array_equal(again.triangles, whole.triangles)


def test_other_threads_run_meanwhile(volume):
    """The lock of Python is released: another thread counts while a surface is drawn."""
    steps = [0]
    done = threading.Event()

    def count():
        while not done.is_set():
            steps[0] += 1
            time.sleep(1e-4)

    thread = threading.Thread(target=count)
    thread.start()
    before = steps[0]
    volume.isosurface(0.1, threads=1)
    counted = steps[0] - before
    done.set()
    thread.join()
    assert counted > 20
