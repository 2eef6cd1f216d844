# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields of files."""

from __future__ import annotations

import os
import warnings
from typing import Any, NamedTuple, Sequence, Union

import numpy as np

from . import _nestgrid
from ._arguments import SampleType, flag, numbers, optional, sample_type, sequence, suggestion
from ._arguments import path as path_kind
from ._arguments import name_of, takes, text, whole
from ._ask import ask
from ._blocks import BlockFrames, Blocks
from ._choice import Choice, chosen
from ._fields import Field
from ._load_cells import load_boxes, load_mesh, load_tree_frames, load_trees
from ._load_stored import hierarchy, plotfiles
from ._nestgrid import InvalidInput, IoError
from ._sources import Frames, Rule, Volume

Numbers = Union[Sequence[float], np.ndarray]

#: What load() reads, by the end of the name.
PICTURES = (".png", ".tif", ".tiff", ".jpg", ".jpeg", ".bmp", ".pgm", ".pnm")
SUFFIXES = [".nestgrid", ".vti", ".mhd", ".mha", ".nrrd", ".nhdr", ".nii", ".nii.gz", ".raw"]
SUFFIXES += [".vtu", ".pvtu", ".vthb", ".htg", ".phtg", ".hierarchy", ".athdf", ".dcm", ".dicom"]
SUFFIXES += PICTURES
BOXES = (".vthb", ".hierarchy", ".athdf")
TREES = (".htg", ".phtg")


def _paths(value: Any) -> str | list[str]:
    if isinstance(value, (list, tuple)):
        return sequence(path_kind, "a sequence of paths")(value)
    return path_kind(value)


@takes(
    path=_paths,
    array=text,
    frame=optional(whole(0, 1 << 40)),
    component=optional(whole(0, 1 << 40)),
    magnitude=flag,
    dims=optional(sequence(whole(1, 1 << 20), "3 whole numbers")),
    type=optional(sample_type),
    big_endian=flag,
    spacing=optional(numbers),
    rule=optional(name_of(Rule)),
    times=optional(numbers),
)
def load(
    path: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    array: str = "",
    *,
    frame: int | None = None,
    component: int | None = None,
    magnitude: bool = False,
    dims: Sequence[int] | None = None,
    type: SampleType | None = None,
    big_endian: bool = False,
    spacing: Numbers | None = None,
    rule: Rule | None = None,
    times: Sequence[float] | None = None,
) -> Field | Frames:
    """The field of a file: a Volume, a hierarchy's, Cells, Blocks, or Frames of several.

    path        ends in .nestgrid; or in .vtu or .pvtu, a mesh (Cells); or in .vti, .mhd, .mha,
                .nrrd, .nhdr, .nii, .nii.gz or .raw, which are volumes: Volume.array[i, j, k] is
                sample i of row j of slice k; or a folder of DICOM, its DICOMDIR or a slice of it;
                or a picture; or a plotfile of AMReX, a folder with the file Header, which must stay
                as it is; or other boxes of cells (Blocks): .vthb, Enzo's .hierarchy, .athdf of
                Athena++, or HDF5 of Chombo or FLASH, of any name; or .htg, hyper trees (Octree), in
                pieces .phtg.
                Several plotfiles, or files of boxes or of hyper trees, of one format and with the
                same cells, are Frames. What has one sample along an axis is a plane:
                Volume.array[i, j]. Reading .vtu, .vti, .vthb, .htg, .nii and pictures needs VTK's
                Python package, HDF5 and Enzo h5py, DICOM pydicom
    array       the name of the field, for .nestgrid, cells, .vtu and .vti, or of the series of
                DICOM; "": the only one, or the active one, or that of the slice
    frame       which of several volumes in a file, from 0; None: the first, with a warning that
                tells how many there are
    component   which of several numbers per sample, from 0
    magnitude   or the norm of all of them
    dims        for .raw alone, which does not describe itself: samples along x, y and z
    type        for .raw alone: of the samples, "uint8" to "float64"
    big_endian  for .raw alone: whether the highest byte of a sample comes first
    spacing     for .raw alone: distance of samples along x, y and z, in units of length; None: 1
    rule        for boxes and trees of cells: of the values at nodes, as Blocks() has it; None:
                "smooth"
    times       for several files: ascending, one for each; None: those that the files tell, or
                0, 1, 2, ... where one of them tells none

    Raises IoError where the file cannot be read or is damaged, InvalidInput where there is no such
    field or an argument does not fit the format.
    """
    paths = [path] if isinstance(path, (str, os.PathLike)) else path
    given_paths = [str(each) for each in paths]
    if not given_paths:
        raise InvalidInput("load(): there are no paths")
    first = given_paths[0]
    kinds = [_kind(each) for each in given_paths]
    suffix, plotfile, boxes, dicom = kinds[0]
    if not any(kinds[0]):
        near = suggestion(os.path.splitext(first.lower())[1], SUFFIXES)
        raise InvalidInput(f"load(): '{first}' ends in none of {', '.join(SUFFIXES)}{near}")
    raw = {"dims": dims, "type": type, "big_endian": big_endian or None, "spacing": spacing}
    given = [each for each, value in raw.items() if value is not None]
    if given and (suffix != ".raw" or plotfile):
        raise InvalidInput(f"load(): {given[0]} is for .raw files: '{first}' describes itself")
    named = dicom or plotfile or boxes or suffix in (".nestgrid", *TREES, ".vti", ".vtu", ".pvtu")
    if array and not named:
        raise InvalidInput(f"load(): '{first}' has one array, which has no name: leave out array")
    if rule is not None and not (plotfile or boxes or suffix in TREES):
        raise InvalidInput(f"load(): rule is for boxes and trees of cells, not '{first}'")
    choice = Choice(frame, component, magnitude)
    if (plotfile or suffix in (".nestgrid", ".raw")) and choice != Choice():
        raise InvalidInput(
            f"load(): frame, component and magnitude choose nothing in '{first}', which has one "
            "number per sample"
        )
    if len(given_paths) > 1 or times is not None:
        return _frames(given_paths, kinds, array, choice, rule or "smooth", times)
    if plotfile:
        return plotfiles([plotfile], array, rule or "smooth", [])
    if suffix == ".nestgrid":
        return hierarchy(first, array)
    if dicom:
        return _read_apart("_read_dicom.py", first, array, choice)
    _require_file(first)
    if boxes:
        return load_boxes(first, array, choice, rule or "smooth")[0]
    if suffix in TREES:
        return load_trees(first, array, choice, rule or "smooth")
    if suffix in (".vtu", ".pvtu"):
        return load_mesh(first, array, choice)
    if suffix == ".raw":
        return _raw(first, dims, type, big_endian, spacing)
    if suffix in (".vti", ".nii", ".nii.gz", *PICTURES):
        return _read_apart("_read_vtk.py", first, array, choice)
    place: dict[str, Any] = dict(_nestgrid.volume_file(first, suffix in (".mhd", ".mha")))
    return _volume(first, chosen(first, choice, **_split(place)), **place)


class _Kind(NamedTuple):
    """What a file is, as far as its name and first bytes tell."""

    suffix: str
    plotfile: str
    boxes: bool
    dicom: bool

    def cells(self) -> tuple[bool, bool]:
        """Whether it is a plotfile, and whether a file of boxes."""
        return bool(self.plotfile), self.boxes


def _kind(path: str) -> _Kind:
    name = path.lower()
    suffix = max((each for each in SUFFIXES if name.endswith(each)), key=len, default="")
    plotfile = _plotfile(path)
    boxes = suffix in BOXES or (not suffix and _is_hdf5(path))
    dicom = not plotfile and (suffix in (".dcm", ".dicom") or _is_dicom(path))
    return _Kind(suffix, plotfile, boxes, dicom)


def _frames(
    paths: list[str],
    kinds: list[_Kind],
    array: str,
    choice: Choice,
    rule: Rule,
    times: Sequence[float] | None,
) -> Frames:
    """Several plotfiles, or files of boxes or of hyper trees."""
    given = [] if times is None else np.ravel(times).tolist()
    if len(paths) == 1:
        raise InvalidInput(
            f"load(): times is for several files: '{paths[0]}' alone is given no time"
        )
    if times is not None and len(given) != len(paths):
        raise InvalidInput(
            f"load(): times has {len(given)}, not one for each of the {len(paths)} files"
        )
    for path, kind in zip(paths, kinds):
        if not kind.plotfile and not kind.boxes and kind.suffix not in TREES:
            raise InvalidInput(
                "load(): several files are frames of plotfiles, of boxes of cells or of hyper "
                f"trees, which '{path}' is not"
            )
        if kind.cells() != kinds[0].cells():
            raise InvalidInput(f"load(): '{path}' is of another format than '{paths[0]}'")
    if kinds[0].plotfile:
        return plotfiles([kind.plotfile for kind in kinds], array, rule, given)
    for path in paths:
        _require_file(path)
    if kinds[0].suffix in TREES:
        times_of_files = given or np.arange(float(len(paths))).tolist()
        return load_tree_frames(paths, array, choice, rule, times_of_files)
    loaded: list[tuple[Blocks, float | None]] = []
    for path in paths:
        name = loaded[0][0].name if loaded else array
        loaded.append(load_boxes(path, name, choice, rule))
    told = [time for _, time in loaded if time is not None]
    if not given:
        given = told if len(told) == len(loaded) else np.arange(float(len(loaded))).tolist()
    names = [f"'{path}'" for path in paths]
    return BlockFrames._of([field for field, _ in loaded], given, names)


def _plotfile(path: str) -> str:
    """The folder of a plotfile, which may be named by its Header, too; "" where it is none."""
    folder = os.path.dirname(path) or "." if os.path.basename(path) == "Header" else path
    return folder if os.path.isfile(os.path.join(folder, "Header")) else ""


def _is_hdf5(path: str) -> bool:
    """Whether a file begins as those of HDF5 do, which Chombo and FLASH name in many ways."""
    try:
        with open(path, "rb") as file:
            return file.read(8) == b"\x89HDF\r\n\x1a\n"
    except OSError:
        return False


def _is_dicom(path: str) -> bool:
    """Whether it is a folder, or a file that begins as one of DICOM does."""
    if os.path.isdir(path):
        return True
    try:
        with open(path, "rb") as file:
            return file.read(132)[128:] == b"DICM"
    except OSError:
        return False


def _split(place: dict[str, Any]) -> dict[str, Any]:
    """Takes the numbers and what they mean away from where they are."""
    return {each: place.pop(each) for each in ("numbers", "slope", "intercept")}


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
    flat = [d for d in range(3) if array.shape[d] == 1]
    if len(flat) == 1:
        return plane_of(array, spacing, origin, direction, flat[0], name, unit)
    if min(array.shape) < 2:
        counts = " x ".join(str(n) for n in array.shape)
        raise InvalidInput(
            f"{path} has {counts} samples; a volume needs at least 2 along each direction"
        )
    return Volume(array, spacing, origin, direction=direction, name=name, unit=unit)


def plane_of(
    array: np.ndarray,
    spacing: Numbers,
    origin: Numbers,
    direction: Any,
    across: int,
    name: str = "",
    unit: str = "",
) -> Volume:
    """A volume with one sample along an axis, without that axis, where it lies in space."""
    along = [d for d in range(3) if d != across]
    start, axes = np.asarray(origin, float), np.asarray(direction, float)[:, along]
    if start[2] == 0 and not axes[2].any():  # as Volume has it without a place
        start, axes = start[:2], axes[:2]
    samples = np.asfortranarray(array.squeeze(across))
    steps = np.asarray(spacing, float)[along]
    return Volume(samples, steps, start, direction=axes, name=name, unit=unit)


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


def _read_apart(reader_program: str, path: str, array: str, choice: Choice) -> Volume:
    place, samples = ask(reader_program, path, array)
    # The components of a frame are side by side, those of the next one behind them.
    numbers = samples.T
    numbers = numbers.reshape((-1, place.pop("frames", 1), *numbers.shape[1:]), order="F")
    numbers = np.moveaxis(numbers, 1, 4)
    slope, intercept = place.pop("slope", 1), place.pop("intercept", 0)
    if note := place.pop("note", ""):
        warnings.warn(note, stacklevel=3)
    return _volume(path, chosen(path, choice, numbers, slope, intercept), **place)
