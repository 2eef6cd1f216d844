# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of files."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import IO, Any, Sequence, Union

import numpy as np

from . import _nestgrid
from ._arguments import SampleType, flag, numbers, optional, sample_type, sequence, suggestion
from ._arguments import path as path_kind
from ._arguments import takes, text, whole
from ._fields import Field
from ._nestgrid import InvalidInput, IoError
from ._sources import Frames, Volume

Numbers = Union[Sequence[float], np.ndarray]

#: What load() reads, by the end of the name.
SUFFIXES = [".nestgrid", ".vti", ".mhd", ".mha", ".nrrd", ".nhdr", ".nii", ".nii.gz", ".raw"]


@takes(
    path=path_kind,
    array=text,
    dims=optional(sequence(whole(1, 1 << 20), "3 whole numbers")),
    type=optional(sample_type),
    big_endian=flag,
    spacing=optional(numbers),
)
def load(
    path: str | os.PathLike[str],
    array: str = "",
    *,
    dims: Sequence[int] | None = None,
    type: SampleType | None = None,
    big_endian: bool = False,
    spacing: Numbers | None = None,
) -> Field | Frames:
    """The field of a file: a Volume, the field of a hierarchy, or Frames where there are several.

    path        ends in .nestgrid; or in .vti, .mhd, .mha, .nrrd, .nhdr, .nii, .nii.gz or .raw,
                which are volumes: Volume.array[i, j, k] is sample i of row j of slice k. Reading
                .vti and .nii needs VTK's Python package
    array       the name of the field, for .nestgrid and .vti; "": the only one, or the active one
    dims        for .raw alone, which does not describe itself: samples along x, y and z
    type        for .raw alone: of the samples, "uint8" to "float64"
    big_endian  for .raw alone: whether the highest byte of a sample comes first
    spacing     for .raw alone: distance of samples along x, y and z, in units of length; None: 1

    Raises IoError where the file cannot be read or is damaged, InvalidInput where there is no such
    field or an argument does not fit the format.
    """
    name = path.lower() if isinstance(path, str) else ""
    suffix = max((each for each in SUFFIXES if name.endswith(each)), key=len, default="")
    if not suffix:
        near = suggestion(os.path.splitext(name)[1], SUFFIXES)
        raise InvalidInput(f"load(): '{path}' ends in none of {', '.join(SUFFIXES)}{near}")
    raw = {"dims": dims, "type": type, "big_endian": big_endian or None, "spacing": spacing}
    given = [each for each, value in raw.items() if value is not None]
    if given and suffix != ".raw":
        raise InvalidInput(f"load(): {given[0]} is for .raw files: '{path}' describes itself")
    if array and suffix not in (".nestgrid", ".vti"):
        raise InvalidInput(f"load(): '{path}' has one array, which has no name: leave out array")
    if suffix == ".nestgrid":
        return _hierarchy(str(path), array)
    _require_file(str(path))
    if suffix == ".raw":
        return _raw(str(path), dims, type, big_endian, spacing)
    if suffix in (".vti", ".nii", ".nii.gz"):
        return _with_vtk(str(path), array)
    place = _nestgrid.volume_file(str(path), suffix in (".mhd", ".mha"))
    return _volume(str(path), **place)


class LoadedField(Field):
    """The field of a .nestgrid file."""

    _file: tuple[str, str, tuple[int, int]]

    def __reduce__(self) -> tuple[Any, ...]:
        return _loaded_again, self._file


class LoadedFrames(Frames):
    """The frames of a .nestgrid file."""

    _file: tuple[str, str, tuple[int, int]]

    def _size(self) -> str:
        return f"dimension {self.at(self.times[0]).dimension}"

    def _range_text(self) -> str:
        ranges = [self.at(t).range for t in self.times]
        least, greatest = min(r[0] for r in ranges), max(r[1] for r in ranges)
        return f"from {least:.6g} to {greatest:.6g}"

    def __reduce__(self) -> tuple[Any, ...]:
        return _loaded_again, self._file


def _hierarchy(path: str, array: str) -> LoadedField | LoadedFrames:
    loaded, name = _nestgrid.load(path, array)
    file = (os.path.abspath(path), array, _stamp(path))
    if isinstance(loaded, _nestgrid.Frames):
        frames = LoadedFrames.__new__(LoadedFrames)
        frames._frames = loaded
        frames._name = name
        frames._unit = ""
        frames._file = file
        return frames
    field = LoadedField.__new__(LoadedField)
    field._set(loaded, name, "")
    field._file = file
    return field


def _stamp(path: str) -> tuple[int, int]:
    """What changes when a file does."""
    status = os.stat(path)
    return status.st_size, status.st_mtime_ns


def _loaded_again(path: str, array: str, stamp: tuple[int, int]) -> Field | Frames:
    """What was pickled as the path of its file.

    Raises IoError where the file has changed since.
    """
    if os.path.exists(path) and _stamp(path) != stamp:
        raise IoError(f"{path} has changed since the field was pickled, which keeps its path only")
    return _hierarchy(path, array)


def _require_file(path: str) -> None:
    if not os.path.exists(path):
        raise IoError(f"{path} does not exist")
    if not os.path.isfile(path):
        raise IoError(f"{path} is no file")
    if os.path.getsize(path) == 0:
        raise IoError(f"{path} is empty")
    if not os.access(path, os.R_OK):
        raise IoError(f"{path} cannot be opened")


def _volume(
    path: str,
    array: np.ndarray,
    spacing: Numbers,
    origin: Numbers,
    direction: Any,
    name: str,
    unit: str,
) -> Volume:
    if min(array.shape) < 2:
        counts = " x ".join(str(n) for n in array.shape)
        raise InvalidInput(
            f"{path} has {counts} samples; a volume needs at least 2 along each direction"
        )
    return Volume(array, spacing, origin, direction=direction, name=name, unit=unit)


def _raw(
    path: str,
    dims: Sequence[int] | None,
    type: str | None,
    big_endian: bool,
    spacing: Numbers | None,
) -> Volume:
    if dims is None or type is None:
        raise InvalidInput(f"load(): '{path}' does not describe itself: give dims and type")
    if len(dims) != 3:
        raise InvalidInput(f"load(): dims has {len(dims)} numbers, not 3")
    kind = np.dtype(type).newbyteorder(">" if big_endian else "<")
    count = dims[0] * dims[1] * dims[2]
    found = os.path.getsize(path)
    if found != count * kind.itemsize:
        raise IoError(
            f"{path} has {found} bytes, but dims and type ask for {count * kind.itemsize}"
        )
    samples = np.fromfile(path, kind).astype(type, copy=False)
    step = np.ones(3) if spacing is None else spacing
    array = samples.reshape(tuple(dims), order="F")
    return _volume(path, array, step, np.zeros(3), np.eye(3), "", "")


def _read_into(stream: IO[bytes], part: memoryview) -> int:
    """Fills as much of the memory as there is to read, and returns how much."""
    data = stream.read(len(part))
    part[: len(data)] = data
    return len(data)


def _with_vtk(path: str, array: str) -> Volume:
    """Reads in another process: damaged files may crash VTK, and Ctrl-C ends it at once."""
    program = os.path.join(os.path.dirname(__file__), "_read_vtk.py")
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
    return _volume(path, samples.T, **place)
