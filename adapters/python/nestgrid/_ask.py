# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Asks a reader, a program of its own: damaged files may crash libraries, and Ctrl-C ends it at once."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import IO, Any

import numpy as np

from ._arguments import suggestion
from ._nestgrid import InvalidInput, IoError


def _read_into(stream: IO[bytes], part: memoryview) -> int:
    """Fills as much of the memory as there is to read, and returns how much."""
    data = stream.read(len(part))
    part[: len(data)] = data
    return len(data)


def ask(reader_program: str, path: str, array: str) -> tuple[dict[str, Any], np.ndarray]:
    """What the reader tells of a file, and the numbers behind it."""
    program = os.path.join(os.path.dirname(__file__), reader_program)
    command = [sys.executable or "python3", program, os.path.abspath(path), array]
    with subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as reader:
        try:
            assert reader.stdout is not None
            answer = reader.stdout.readline()
            place = json.loads(answer) if answer else {}
            samples = np.empty(0)
            if "shape" in place:
                samples = np.empty(place.pop("shape")[::-1], place.pop("type"))
                rest = samples.reshape(-1).view(np.uint8).data
                while rest and (count := _read_into(reader.stdout, rest[: 1 << 24])):
                    rest = rest[count:]
                place = {} if rest else place
        except BaseException:
            reader.kill()
            raise
    if "error" in place:
        sentence = place["error"].replace(os.path.abspath(path), path)
        near = suggestion(array, place.get("names", ())) if array else ""
        if near or (array and place.get("names")):
            listed = ", ".join(f"'{each}'" for each in place["names"])
            sentence += f", only {listed}{near}"
        raise (InvalidInput if place.get("argument") else IoError)(sentence)
    if not place:
        raise IoError(f"{path} cannot be read: its reader ended with {reader.returncode}")
    return place, samples
