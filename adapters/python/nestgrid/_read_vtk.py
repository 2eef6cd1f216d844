# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of its own, which reads .vti, .nii, .nii.gz and pictures by VTK.

Arguments: the file, and the name of a point data array or nothing. Answers as _answer.py says.
"""

from __future__ import annotations

import gzip
import math
import os
import re
from typing import Any

from _answer import Refused, answer, listed

TYPES = {
    "unsigned char": "uint8",
    "char": "int8",
    "signed char": "int8",
    "unsigned short": "uint16",
    "short": "int16",
    "unsigned int": "uint32",
    "int": "int32",
    "unsigned long": "uint64",
    "long": "int64",
    "unsigned long long": "uint64",
    "long long": "int64",
    "float": "float32",
    "double": "float64",
}
LENGTHS = {1: "m", 2: "mm", 3: "µm"}  # of NIfTI's xyzt_units


def reason(message: str) -> str:
    """What VTK complains about; nothing for ranges of arrays, whose "inf" it writes and cannot read."""
    lines = [line.strip() for line in message.splitlines() if line.strip()]
    if "InformationKey" in message:
        return ""
    return lines[-1] if lines else "VTK gives no reason"


class Errors:
    """The first error or warning of a reader."""

    CallDataType = "string0"

    def __init__(self, path: str, reader: Any) -> None:
        self.path = path
        self.first: str | None = None
        reader.AddObserver("ErrorEvent", self)
        reader.AddObserver("WarningEvent", self)

    def __call__(self, _caller: Any, _event: str, message: str = "") -> None:
        self.first = self.first or reason(message)

    def check(self) -> None:
        if self.first:
            raise Refused(f"{self.path} cannot be read: {self.first}")


def check_size(path: str, reader: Any) -> int:
    """The number of samples that a header asks for, which must be plausible for the file."""
    reader.UpdateInformation()
    info = reader.GetOutputInformation(0)
    extent = info.Get(reader.GetExecutive().WHOLE_EXTENT())
    samples = 1
    for d in range(3):
        samples *= max(0, extent[2 * d + 1] - extent[2 * d] + 1)
    found = os.path.getsize(path)
    if samples > 1032 * found:  # deflate packs at most so much
        raise Refused(f"{path} is truncated: {found} bytes cannot hold {samples} samples")
    return samples


def check_whole(path: str, reader: Any, kind: str) -> None:
    """Refuses a file that is none of the reader's kind, or lacks its end."""
    if not reader.CanReadFile(path):
        raise Refused(f"{path} is no VTK {kind} file")
    with open(path, "rb") as file:
        file.seek(max(0, os.path.getsize(path) - 64))
        if b"</VTKFile>" not in file.read():
            raise Refused(f"{path} is truncated: it does not end with </VTKFile>")


def names_of(data: Any) -> list[str]:
    return [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]


def chosen_array(path: str, name: str, data: Any) -> Any:
    """The named array; without a name, the active one, else the only one; None: there is none."""
    if name:
        return data.GetArray(name)
    names = names_of(data)
    if data.GetScalars() is not None or len(names) < 2:
        return data.GetScalars() or data.GetArray(0)
    raise Refused(f"{path} has several arrays, choose one by array: {listed(names)}", True, names)


def move_to_centres(path: str, place: dict[str, Any]) -> None:
    """Values of cells are those at their centres, which is exact where the data are linear."""
    for d in range(3):
        if place["shape"][d] < 2:
            continue
        place["shape"][d] -= 1
        for r in range(3):
            place["origin"][r] += place["direction"][r][d] * place["spacing"][d] / 2
    name = os.path.basename(path)
    place["note"] = f"the cell data of {name} are taken at the centres of the cells"


def read_vti(path: str, array: str) -> tuple[Any, dict[str, Any]]:
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    reader = vtkXMLImageDataReader()
    errors = Errors(path, reader)
    check_whole(path, reader, "image data")
    reader.SetFileName(path)
    check_size(path, reader)
    errors.check()
    reader.Update()
    errors.check()
    image = reader.GetOutput()
    points, cells = image.GetPointData(), image.GetCellData()
    scalars = chosen_array(path, array, points)
    at_centres = scalars is None
    if scalars is None:
        scalars = chosen_array(path, array, cells)
    if scalars is None and array:
        names = names_of(points) + names_of(cells)
        raise Refused(f"{path} has no point data array '{array}'", True, names)
    if scalars is None:
        raise Refused(f"{path} has neither point nor cell data", True)
    extent = image.GetExtent()
    place: dict[str, Any] = {"origin": [0.0, 0.0, 0.0]}
    image.TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], place["origin"])
    matrix = image.GetDirectionMatrix()
    place["direction"] = [[matrix.GetElement(r, c) for c in range(3)] for r in range(3)]
    place["spacing"] = list(image.GetSpacing())
    place["shape"] = list(image.GetDimensions())
    if at_centres:
        move_to_centres(path, place)
    place["name"] = scalars.GetName() or ""
    if place["name"] == "ImageScalars":  # VTK's own name for what nobody has named
        place["name"] = ""
    return scalars, place | {"unit": ""}


def check_nifti_size(path: str, reader: Any, samples: int) -> None:
    """Unpacks the file, so that its checksum is compared, and compares its size."""
    found = 0
    try:
        with gzip.open(path) if path.lower().endswith(".gz") else open(path, "rb") as file:
            while part := file.read(1 << 20):
                found += len(part)
    except (OSError, EOFError) as error:
        raise Refused(
            f"{path} is truncated or damaged: it cannot be unpacked to its end"
        ) from error
    from vtkmodules.vtkCommonCore import vtkDataArray

    size = vtkDataArray.GetDataTypeSize(reader.GetDataScalarType())
    expected = samples * size + int(reader.GetNIFTIHeader().GetVoxOffset())
    if found < expected:
        raise Refused(
            f"{path} is truncated: {found} bytes, but its header asks for {expected}"
        )


def read_nifti(path: str) -> tuple[Any, dict[str, Any]]:
    from vtkmodules.vtkIOImage import vtkNIFTIImageReader

    reader = vtkNIFTIImageReader()
    errors = Errors(path, reader)
    if not reader.CanReadFile(path):
        raise Refused(f"{path} is no NIfTI file, or truncated in its header")
    reader.SetFileName(path)
    samples = check_size(path, reader)
    errors.check()
    header = reader.GetNIFTIHeader()
    axes = [max(1, header.GetDim(d)) for d in range(4, 1 + min(7, header.GetDim(0)))]
    frames, vectors = (axes + [1, 1])[:2]
    for d, count in enumerate(axes[2:], start=6):
        if count > 1:
            raise Refused(f"{path} has {count} samples along its dimension {d}, which is not read")
    check_nifti_size(path, reader, samples * frames * vectors)
    reader.TimeAsVectorOn()
    reader.Update()
    errors.check()
    place: dict[str, Any] = {"origin": [0.0, 0.0, 0.0]}
    place["direction"] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    matrix = reader.GetSFormMatrix() or reader.GetQFormMatrix()
    if matrix is not None:
        place["direction"] = [[matrix.GetElement(r, c) for c in range(3)] for r in range(3)]
        place["origin"] = [matrix.GetElement(r, 3) for r in range(3)]
    place["unit"] = LENGTHS.get(header.GetXYZTUnits() & 7, "")
    place["name"] = header.GetIntentName() or ""
    place["frames"] = frames
    slope, intercept = header.GetSclSlope(), header.GetSclInter()
    if slope != 0 and math.isfinite(slope):  # else the numbers are the values
        if not math.isfinite(intercept):
            raise Refused(f"{path} has a scl_inter that is not a finite number")
        place["slope"], place["intercept"] = slope, intercept
    image = reader.GetOutput()
    place["spacing"] = list(image.GetSpacing())
    place["shape"] = list(image.GetDimensions())
    scalars = image.GetPointData().GetScalars()
    if scalars is None:
        raise Refused(f"{path} holds no samples")
    return scalars, place


def check_grey_map(path: str) -> None:
    """Compares the size of a portable grey map with its header, which VTK does not."""
    with open(path, "rb") as file:
        begin = file.read(4096)
    # Width, height and the greatest value, with comments between.
    blank = rb"(?:\s|#[^\n]*\n)+"
    header = re.match(rb"P5" + 3 * (blank + rb"(\d+)") + rb"\s", begin)
    if begin[:2] != b"P5":
        return
    if header is None:
        raise Refused(f"{path} has a damaged header")
    width, height, greatest = map(int, header.groups())
    needed = width * height * (2 if greatest > 255 else 1)
    found = os.path.getsize(path) - header.end()
    if found < needed:
        raise Refused(f"{path} is cut off: it has {found} bytes of pixels, not {needed}")


def read_picture(path: str) -> tuple[Any, dict[str, Any]]:
    from vtkmodules.vtkIOImage import vtkImageReader2Factory

    check_grey_map(path)
    reader = vtkImageReader2Factory.CreateImageReader2(path)
    if reader is None:
        raise Refused(f"{path} is no picture that can be read")
    errors = Errors(path, reader)
    reader.SetFileName(path)
    reader.Update()
    errors.check()
    image = reader.GetOutput()
    scalars = image.GetPointData().GetScalars()
    if scalars is None:
        raise Refused(f"{path} holds no picture")
    place: dict[str, Any] = {"name": "", "unit": "", "origin": list(image.GetOrigin())}
    place["direction"] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    place["spacing"] = list(image.GetSpacing())
    place["shape"] = list(image.GetDimensions())
    return scalars, place


def read(path: str, array: str) -> tuple[dict[str, Any], memoryview]:
    name = path.lower()
    if name.endswith(".vti"):
        scalars, place = read_vti(path, array)
    elif name.endswith((".nii", ".nii.gz")):
        scalars, place = read_nifti(path)
    else:
        scalars, place = read_picture(path)
    kind = TYPES.get(scalars.GetDataTypeAsString())
    if kind is None:
        raise Refused(f"{path} has samples of a type that is not read", True)
    if scalars.GetNumberOfTuples() != math.prod(place["shape"]):
        raise Refused(f"{path} holds fewer samples than its header says")
    place["shape"].insert(0, scalars.GetNumberOfComponents())
    place["type"] = kind
    return place, memoryview(scalars)


if __name__ == "__main__":
    answer(read)
