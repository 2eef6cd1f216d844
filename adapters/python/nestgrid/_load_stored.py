# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of .nestgrid files and plotfiles, which are pickled as the paths of their files."""

from __future__ import annotations

import os
from typing import Any, Callable, List, Tuple

from . import _nestgrid
from ._fields import Field
from ._nestgrid import IoError
from ._sources import Frames

#: How to read what was pickled as paths again, and what changes when its files do.
_Files = Tuple[Callable[..., Any], Tuple[Any, ...], List[Tuple[str, Tuple[int, int]]]]


class LoadedField(Field):
    """The field of a .nestgrid file or a plotfile."""

    _files: _Files

    def __reduce__(self) -> tuple[Any, ...]:
        return _loaded_again, self._files


class LoadedFrames(Frames):
    """The frames of a .nestgrid file or of plotfiles."""

    _files: _Files

    def _size(self) -> str:
        return f"dimension {self.at(self.times[0]).dimension}"

    def _range_text(self) -> str:
        ranges = [self.at(t).range for t in self.times]
        least, greatest = min(r[0] for r in ranges), max(r[1] for r in ranges)
        return f"from {least:.6g} to {greatest:.6g}"

    def __reduce__(self) -> tuple[Any, ...]:
        return _loaded_again, self._files


def hierarchy(path: str, array: str) -> Any:
    loaded = _nestgrid.load(path, array)
    path = os.path.abspath(path)
    return _loaded(loaded, (hierarchy, (path, array)), [path])


def plotfiles(paths: list[str], array: str, rule: str, times: list[float]) -> Any:
    loaded = _nestgrid.plotfiles(paths, array, rule, times)
    paths = [os.path.abspath(path) for path in paths]
    return _loaded(loaded, (plotfiles, (paths, array, rule, times)), paths)


def _loaded(
    loaded: tuple[_nestgrid.Source | _nestgrid.Frames, str],
    call: tuple[Callable[..., Any], tuple[Any, ...]],
    paths: list[str],
) -> LoadedField | LoadedFrames:
    source, name = loaded
    files = (*call, [(path, _stamp(path)) for path in paths])
    if isinstance(source, _nestgrid.Frames):
        frames = LoadedFrames.__new__(LoadedFrames)
        frames._frames = source
        frames._name = name
        frames._unit = ""
        frames._files = files
        return frames
    field = LoadedField.__new__(LoadedField)
    field._set(source, name, "")
    field._files = files
    return field


def _stamp(path: str) -> tuple[int, int]:
    """What changes when a file does."""
    status = os.stat(os.path.join(path, "Header") if os.path.isdir(path) else path)
    return status.st_size, status.st_mtime_ns


def _loaded_again(
    load_files: Callable[..., Any],
    arguments: tuple[Any, ...],
    stamps: list[tuple[str, tuple[int, int]]],
) -> Field | Frames:
    """What was pickled as the paths of its files.

    Raises IoError where a file has changed since.
    """
    for path, stamp in stamps:
        if os.path.exists(path) and _stamp(path) != stamp:
            raise IoError(
                f"{path} has changed since the field was pickled, which keeps its path only"
            )
    return load_files(*arguments)
