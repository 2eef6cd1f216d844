# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C ends an extraction, and the volume can be used afterwards."""
import signal
import threading
import time

import numpy as np
import pytest

import nestgrid


@pytest.fixture(scope="module")
def volume():
    x, y, z = np.meshgrid(*[np.linspace(0, 30, 97, dtype=np.float32)] * 3, indexing="ij")
    result = nestgrid.Volume(np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x))
    assert result.range[0] < result.range[1]  # the preroll is done
    return result


@pytest.fixture
def interrupt_after():
    """Does what Ctrl-C does, after so many seconds of processor time."""
    before = signal.signal(signal.SIGPROF, signal.default_int_handler)
    yield lambda seconds: signal.setitimer(signal.ITIMER_PROF, seconds)
    signal.setitimer(signal.ITIMER_PROF, 0)
    signal.signal(signal.SIGPROF, before)


@pytest.mark.parametrize("threads", [1, 2])
def test_keyboard_interrupt(volume, threads, interrupt_after):
    start = time.process_time()
    whole = volume.isosurface(0.1, threads=threads)
    needed = time.process_time() - start
    start = time.process_time()
    interrupt_after(0.2 * needed)
    with pytest.raises(KeyboardInterrupt):
        volume.isosurface(0.1, threads=threads)
    # Without looking for signals it would be raised after the extraction.
    assert time.process_time() - start < 0.7 * needed
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
