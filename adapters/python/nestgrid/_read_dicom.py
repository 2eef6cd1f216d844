# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of its own, which reads DICOM series by pydicom, as the program nestgrid does by GDCM.

Arguments: a folder, its DICOMDIR or one of its files, and the name of a series or nothing. Answers
as _read_vtk.py does.

Slope and intercept of each slice are applied. Slices lie where their positions say (LPS, mm), so
that a tilted gantry shears the volume; several in one place are frames, by their instance numbers.
"""

from __future__ import annotations

import json
import os
import sys
from typing import Any

try:
    import numpy as np
    import pydicom
except ImportError as error:
    needed = "reading DICOM needs the package pydicom (python3-pydicom of Debian)"
    print(json.dumps({"error": f"{sys.argv[1]}: {needed}: {error}"}))
    sys.exit()

from _answer import Refused, answer, listed

LARGEST = 1 << 30  # bytes of one slice


def has_mark(path: str) -> bool:
    """Whether a file begins as one of DICOM does."""
    try:
        with open(path, "rb") as file:
            return file.read(132)[128:] == b"DICM"
    except OSError:
        return False


def files_in(folder: str) -> list[str]:
    found = []
    for at, folders, names in os.walk(folder):
        folders.sort()
        found += [os.path.join(at, name) for name in sorted(names)]
    return [path for path in found if has_mark(path)]


class Slice:
    """A file with one slice; its header is read at once, its samples when they are asked for."""

    def __init__(self, path: str) -> None:
        self.path = path
        try:
            self.header = pydicom.dcmread(path, stop_before_pixels=True)
            self.rows, self.columns = int(self.header.Rows), int(self.header.Columns)
            self.components = int(self.header.get("SamplesPerPixel", 1))
            place = self.header.get("ImagePositionPatient") or (0, 0, 0)
            axes = self.header.get("ImageOrientationPatient") or (1, 0, 0, 0, 1, 0)
            spacing = self.header.get("PixelSpacing") or (1, 1)
            self.place = np.array(place, float)
            self.axes = np.array(axes, float).reshape(2, 3)
            self.spacing = float(spacing[1]), float(spacing[0])  # along a row, from row to row
            self.instance = int(self.header.get("InstanceNumber") or 0)
            self.slope = float(self.header.get("RescaleSlope") or 1)
            self.intercept = float(self.header.get("RescaleIntercept") or 0)
            frames = int(self.header.get("NumberOfFrames") or 1)
        except Exception as error:  # whatever a damaged file makes pydicom throw
            raise Refused(f"'{path}' holds no DICOM image that can be read") from error
        if self.rows * self.columns * self.components > LARGEST:
            raise Refused(f"'{path}' asks for more samples than a slice can have")
        if frames > 1:
            raise Refused(f"'{path}' holds {frames} slices in one file, which is not read here")

    @property
    def series(self) -> tuple[Any, ...]:
        """What the slices of one series have in common."""
        keys = ("SeriesInstanceUID", "SeriesNumber", "SequenceName", "SliceThickness")
        return (*(str(self.header.get(key, "")) for key in keys), self.rows, self.columns)

    def samples(self) -> np.ndarray:
        """The numbers of the file: rows, columns, components."""
        try:
            pixels = pydicom.dcmread(self.path).pixel_array
        except Exception as error:
            reason = str(error).split("\n")[0]
            raise Refused(f"'{self.path}' is truncated, damaged or packed: {reason}") from error
        if pixels.size != self.rows * self.columns * self.components:
            raise Refused(f"'{self.path}' holds fewer samples than its header says")
        return pixels.reshape(self.rows, self.columns, self.components)


def series_in(paths: list[str]) -> dict[str, list[Slice]]:
    """The series of files by name: the description, numbered where several have the same."""
    groups: dict[tuple[Any, ...], list[Slice]] = {}
    for path in paths:
        header = pydicom.dcmread(path, specific_tags=["Rows"], stop_before_pixels=True, force=True)
        if "Rows" not in header:  # no image: a DICOMDIR, a report
            continue
        each = Slice(path)
        groups.setdefault(each.series, []).append(each)
    series: dict[str, list[Slice]] = {}
    for _, slices in sorted(groups.items()):
        header = slices[0].header
        same = str(header.get("SeriesDescription") or "").strip()
        same = same or f"series {header.get('SeriesNumber', '')}"
        name, number = same, 2
        while name in series:
            name, number = f"{same} {number}", number + 1
        series[name] = slices
    return series


def chosen_series(path: str, wanted: str) -> tuple[str, list[Slice]]:
    is_folder = os.path.isdir(path)
    is_list = not is_folder and os.path.basename(path) == "DICOMDIR"
    try:
        series = series_in(files_in(path if is_folder else os.path.dirname(path) or "."))
    except (OSError, ValueError) as error:
        raise Refused(f"{path} holds a DICOM file that cannot be read: {error}") from error
    names = sorted(series)
    if wanted:
        if wanted in series:
            return wanted, series[wanted]
        raise Refused(f"{path} has no series '{wanted}'", True, names)
    if not is_folder and not is_list:
        for name, slices in series.items():
            if any(os.path.samefile(path, each.path) for each in slices):
                return name, slices
    if not series:
        raise Refused(f"{path} holds no DICOM series that can be read")
    if len(series) > 1:
        raise Refused(f"{path} has several series, choose one by array: {listed(names)}", True)
    return next(iter(series.items()))


def sorted_slices(path: str, slices: list[Slice]) -> list[list[Slice]]:
    """The slices of each place along their normal, by their instance numbers."""
    normal = np.cross(*slices[0].axes)
    by_height = sorted(slices, key=lambda each: (float(each.place @ normal), each.instance))
    places: list[list[Slice]] = []
    for each in by_height:
        if not places or (each.place - places[-1][-1].place) @ normal > 1e-3:
            places.append([])
        places[-1].append(each)
    if any(len(place) != len(places[0]) for place in places):
        raise Refused(
            f"{path} has {len(places[0])} slices in its first place, and another number elsewhere"
        )
    return [sorted(place, key=lambda each: each.instance) for place in places]


def step_between(places: list[list[Slice]]) -> np.ndarray:
    first = places[0][0]
    if len(places) == 1:
        return np.cross(*first.axes)
    step = (places[-1][0].place - first.place) / (len(places) - 1)
    for number, (each, *_) in enumerate(places):
        off = np.linalg.norm(each.place - first.place - number * step)
        if off > 0.1 * np.linalg.norm(step):
            raise Refused(
                f"'{each.path}' lies {off:.6g} mm off even steps of {np.linalg.norm(step):.6g} mm: "
                "a slice is missing, or they are not even"
            )
    return step


def values_of(places: list[list[Slice]]) -> np.ndarray:
    """All values: slices, rows, columns, frames, components; of the type of the files where these
    have one and no slope, else int16, int32 or float64."""
    stack = np.array([[each.samples() for each in place] for place in places])
    stack = np.moveaxis(stack, 1, 3)
    slopes = np.array([[each.slope for each in place] for place in places])
    intercepts = np.array([[each.intercept for each in place] for place in places])
    if (slopes == 1).all() and (intercepts == 0).all():
        return stack
    scaled = stack * slopes[:, None, None, :, None] + intercepts[:, None, None, :, None]
    whole = (slopes % 1 == 0).all() and (intercepts % 1 == 0).all()
    for kind in ("int16", "int32"):
        least, greatest = np.iinfo(kind).min, np.iinfo(kind).max
        if whole and least <= scaled.min() and scaled.max() <= greatest:
            return scaled.astype(kind)
    return scaled


def read(path: str, wanted: str) -> tuple[dict[str, Any], memoryview]:
    name, slices = chosen_series(path, wanted)
    first = slices[0]
    for each in slices:
        if (each.rows, each.columns, each.components) != (first.rows, first.columns, first.components):
            raise Refused(f"'{each.path}' has other dimensions than '{first.path}'")
    places = sorted_slices(path, slices)
    step = step_between(places)
    first = places[0][0]
    values = np.ascontiguousarray(values_of(places))
    length = float(np.linalg.norm(step))
    frames = len(places[0])
    return {
        "shape": [frames * first.components, first.columns, first.rows, len(places)],
        "frames": frames,
        "type": str(values.dtype),
        "spacing": [*first.spacing, length],
        "origin": first.place.tolist(),
        "direction": np.column_stack([*first.axes, step / length]).tolist(),
        "name": name,
        "unit": "mm",
    }, values.data.cast("B")


if __name__ == "__main__":
    answer(read)
