# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The rows of docs/refusals.md for Python: each state in which it is wrong, and what it says."""
import pathlib

import numpy as np

import nestgrid

PAGE = pathlib.Path(__file__).resolve().parents[3] / "docs" / "refusals.md"
CUBE = np.arange(27, dtype=float).reshape(3, 3, 3)
LEAVES = np.array([[x, y, z, 1] for z in (0, 1) for y in (0, 1) for x in (0, 1)])


def with_value(value):
    broken = CUBE.copy()
    broken[1, 1, 1] = value
    return nestgrid.Volume(broken)


def octree_of(leaves, values=None, **options):
    values = np.zeros(len(leaves)) if values is None else values
    return nestgrid.Octree(leaves, values, **options)


STATES = {
    "an array with gaps": lambda: nestgrid.Volume(CUBE[:, ::2]),
    "an array of another type": lambda: nestgrid.Volume(CUBE.astype(complex)),
    "an array of another dimension": lambda: nestgrid.Volume(np.zeros(3)),
    "one sample along an index": lambda: nestgrid.Volume(np.zeros((3, 1, 3))),
    "a spacing of another dimension": lambda: nestgrid.Volume(CUBE, spacing=(1, 1)),
    "a spacing that is no length": lambda: nestgrid.Volume(CUBE, spacing=(1, 0, 1)),
    "a sample that is infinite": lambda: with_value(np.inf).isosurface(3),
    "an isovalue that is no number": lambda: nestgrid.Volume(CUBE).isosurface(np.nan),
    "a negative threshold": lambda: nestgrid.Volume(CUBE).isosurface(3, threshold=-1),
    "too few triangles": lambda: nestgrid.Volume(CUBE).isosurface(3, max_triangles=1),
    "an indicator that does not exist": lambda: nestgrid.Volume(CUBE).isosurface(3, indicator="ofset"),
    "lines of a volume": lambda: nestgrid.Volume(CUBE).isolines(3),
    "points of another dimension": lambda: nestgrid.Volume(CUBE).probe([[1, 2]]),
    "no leaves": lambda: octree_of(LEAVES[:0]),
    "leaves that are no integers": lambda: octree_of(LEAVES.astype(float)),
    "leaves that overlap": lambda: octree_of(np.concatenate([LEAVES, LEAVES[:1]])),
    "leaves that leave a gap": lambda: octree_of(LEAVES[:-1]),
    "another number of values": lambda: octree_of(LEAVES, np.zeros(5)),
    "another number of marks": lambda: octree_of(LEAVES, masked=np.zeros(5)),
    "a value of a leaf that is no number": lambda: octree_of(LEAVES, np.full(8, np.nan)),
    "no boxes": lambda: nestgrid.Blocks([]),
    "what is no box": lambda: nestgrid.Blocks([CUBE]),
    "boxes of several dimensions": lambda: nestgrid.Blocks([(0, (0, 0), CUBE)]),
    "a box without cells": lambda: nestgrid.Blocks([(0, (0, 0, 0), CUBE[:0])]),
    "another number of ratios": lambda: nestgrid.Blocks([(0, (0, 0, 0), CUBE)], ratio=[2]),
    "boxes that cover each other": lambda: nestgrid.Blocks([(0, (0, 0, 0), CUBE)] * 2),
    "a rule that does not exist": lambda: nestgrid.Blocks([(0, (0, 0, 0), CUBE)], rule="centre"),
    "no frames": lambda: nestgrid.Frames([]),
    "frames of files of samples": lambda: nestgrid.load(["a.nrrd", "b.nrrd"]),
    "times for one file": lambda: nestgrid.load(["a.vthb"], times=[0, 1]),
    "frames of several sizes": lambda: nestgrid.Frames([CUBE, CUBE[:2].copy()]),
    "times that do not ascend": lambda: nestgrid.Frames([CUBE, CUBE], [1, 0]),
    "a time outside the frames": lambda: nestgrid.Frames([CUBE, CUBE], [0, 1]).at(2),
    "a file that is not there": lambda: nestgrid.load("missing.nrrd"),
    "a file of another format": lambda: nestgrid.load("volume.xyz"),
}


def sentence_of(use):
    try:
        use()
    except (ValueError, RuntimeError, OSError) as error:
        return str(error)
    return "nothing was refused"


def test_every_row():
    said = {f"| Python | {state} | {sentence_of(use)} |" for state, use in STATES.items()}
    print("\n".join(sorted(said)))
    written = {line for line in PAGE.read_text().splitlines() if line.startswith("| Python |")}
    assert said == written
