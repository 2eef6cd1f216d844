# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program reads the volumes of foreign_volumes.py as the programs that wrote them mean them.

Arguments: the program, write_with_itk, and the folder of the Python package or nothing.
"""

import json
import os
import subprocess
import sys

import numpy as np

from ball import CENTRE, nearest_sphere
from foreign_volumes import judge_all

PROGRAM, PACKAGE = (os.path.abspath(each) if each else "" for each in (sys.argv[1], (*sys.argv[3:], "")[0]))

failures = 0


def fail(text):
    global failures
    failures += 1
    print("FAILED:", text)


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


def info(name, *options):
    done = program("info", name, *options, "--json")
    if done.returncode != 0 or done.stderr:
        fail(f"info {name}: {done.stderr.strip()}")
        return None
    return json.loads(done.stdout)


def sphere_of(name, value, options):
    """Centre and radius of the sphere nearest to the vertices of an isosurface."""
    done = program("isosurface", name, *options, "--value", repr(float(value)), "-o", "out.obj")
    if done.returncode != 0:
        fail(f"isosurface {name}: {done.stderr.strip()}")
        return None
    with open("out.obj") as lines:
        points = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)
    os.remove("out.obj")
    return nearest_sphere(points)


def near(got, expected, most):
    return np.allclose(got, expected, rtol=0, atol=most, equal_nan=True)


class Judge:
    def __init__(self):
        self.cases = 0

    def good(self, name, samples, *options, centre=CENTRE, value=88, space="", unit="", note="", python=True):
        facts = self.range(name, samples, *options)
        if facts is None:
            return
        told = (space or "") + (f" ({unit})" if space and unit else "")
        if (space is not None and facts.get("space", "") != told) or facts.get("length_unit", "") != unit:
            fail(f"{name}: space '{facts.get('space')}', unit '{facts.get('length_unit')}', not '{told}', '{unit}'")
        if note not in " ".join(facts["notes"]) or (facts["notes"] and not note):
            fail(f"{name}: says {facts['notes']}, not '{note}'")
        sphere = sphere_of(name, value, options)
        if sphere and not (near(sphere[0], centre, 0.05) and near(sphere[1], 12, 0.12)):
            fail(f"{name}: a sphere of radius {sphere[1]:.4g} around {sphere[0]}, not 12 around {centre}")
        if space and unit:
            check_written(name)
        if PACKAGE and python:
            good_in_python(name, np.asarray(samples, float), options, facts)

    def range(self, name, samples, *options):
        self.cases += 1
        facts = info(name, *options)
        if facts is None:
            return None
        samples = np.asarray(samples, float)
        least, greatest = np.nanmin(samples), np.nanmax(samples)
        if not near([facts["least_value"], facts["greatest_value"]], [least, greatest], 1e-6 * max(1, -least, greatest)):
            fail(f"{name}: range {facts['least_value']} to {facts['greatest_value']}, not {least} to {greatest}")
        if facts.get("missing", 0) != np.isnan(samples).sum():
            fail(f"{name}: {facts.get('missing')} samples are missing, not {np.isnan(samples).sum()}")
        if facts["samples"] != list(map(float, samples.shape)):
            fail(f"{name}: samples {facts['samples']}, not {samples.shape}")
        return facts

    def refused(self, name, reason, *options):
        """One sentence, which names the file and has these words."""
        self.cases += 1
        done = program("info", name, *options)
        lines = done.stderr.splitlines()
        if done.returncode != 1 or len(lines) != 1 or name not in lines[0] or reason not in lines[0]:
            fail(f"{name}: status {done.returncode}, not refused with '{reason}' but: {done.stderr.strip()}{done.stdout[:80]}")


def good_in_python(name, samples, options, facts):
    """The Python package has the same samples, up to their order, at the same places."""
    words = {"--magnitude": "magnitude", "--frame": "frame", "--component": "component", "--array": "array"}
    keywords = {}
    for i, word in enumerate(options):
        if word in words:
            number = True if word == "--magnitude" else options[i + 1]
            keywords[words[word]] = number
    try:
        volume = nestgrid.load(name, **keywords)
    except nestgrid.IoError as error:
        fail(f"load('{name}'): {error}")
        return
    if not near(np.sort(volume.array, axis=None), np.sort(samples, axis=None), 1e-5 * max(1, np.nanmax(abs(samples)))):
        fail(f"load('{name}'): other samples")
    axes = np.array([facts["axis_x"], facts["axis_y"], facts["axis_z"]]).T
    steps, origin = axes * facts["spacing"], facts["origin"]
    if not near(np.asarray(volume.direction) * volume.spacing, steps, 1e-9) or not near(volume.origin, origin, 1e-9):
        fail(f"load('{name}'): another place")


def check_written(name):
    """What is drawn of a file with a space and a unit has both."""
    program("isosurface", name, "--value", 88, "-o", "SURFACE.VTP")
    with open("SURFACE.VTP", "rb") as file:
        content = file.read()
    if b'Name="space"' not in content or b'Name="length_unit"' not in content:
        fail("SURFACE.VTP has no space and no unit")


def main():
    global nestgrid
    if PACKAGE:
        sys.path.insert(0, PACKAGE)
        import nestgrid
        import warnings

        warnings.simplefilter("ignore")
    judge = Judge()
    judge_all(judge)
    print(f"{judge.cases} files and choices, {failures} failures")
    sys.exit(failures > 0)


main()
