# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A program of its own, which reads .vti, .nii and .nii.gz files: a crash of VTK ends it alone.

Arguments: the file, and the name of a point data array or nothing. Writes one line of JSON, which
describes the volume or says what is wrong, and the bytes of the samples behind it.
"""

from __future__ import annotations

import gzip
import json
import os
import sys
from typing import Any, Sequence

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


class Refused(Exception):
    """A sentence, and whether the arguments are wrong, not the file."""

    def __init__(
        self, sentence: str, argument: bool = False, names: Sequence[str] = ()
    ) -> None:
        super().__init__(sentence)
        self.argument = argument
        self.names = names


class Errors:
    """The first error or warning of a reader."""

    CallDataType = "string0"

    def __init__(self, path: str, reader: Any) -> None:
        self.path = path
        self.first: str | None = None
        reader.AddObserver("ErrorEvent", self)
        reader.AddObserver("WarningEvent", self)

    def __call__(self, _caller: Any, _event: str, message: str = "") -> None:
        lines = [line.strip() for line in message.splitlines() if line.strip()]
        self.first = self.first or (lines[-1] if lines else "VTK gives no reason")

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


def read_vti(path: str, array: str) -> tuple[Any, dict[str, Any]]:
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    reader = vtkXMLImageDataReader()
    errors = Errors(path, reader)
    if not reader.CanReadFile(path):
        raise Refused(f"{path} is no VTK image data file")
    with open(path, "rb") as file:
        file.seek(max(0, os.path.getsize(path) - 64))
        if b"</VTKFile>" not in file.read():
            raise Refused(f"{path} is truncated: it does not end with </VTKFile>")
    reader.SetFileName(path)
    check_size(path, reader)
    errors.check()
    reader.Update()
    errors.check()
    image = reader.GetOutput()
    data = image.GetPointData()
    names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
    if array and data.SetActiveScalars(array) < 0:
        raise Refused(f"{path} has no point data array '{array}'", True, names)
    if data.GetScalars() is None and len(names) == 1:
        data.SetActiveScalars(names[0])
    extent = image.GetExtent()
    place: dict[str, Any] = {"origin": [0.0, 0.0, 0.0]}
    image.TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], place["origin"])
    matrix = image.GetDirectionMatrix()
    place["direction"] = [[matrix.GetElement(r, c) for c in range(3)] for r in range(3)]
    scalars = data.GetScalars()
    place["name"] = (scalars.GetName() or "") if scalars is not None else ""
    if place["name"] == "ImageScalars":  # VTK's own name for what nobody has named
        place["name"] = ""
    return image, place | {"unit": ""}


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
    if (volumes := reader.GetTimeDimension()) > 1:
        raise Refused(
            f"{path} has {volumes} volumes, one after the other: give each in a file of its own"
        )
    check_nifti_size(path, reader, samples)
    reader.Update()
    errors.check()
    header = reader.GetNIFTIHeader()
    place: dict[str, Any] = {"origin": [0.0, 0.0, 0.0]}
    place["direction"] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    matrix = reader.GetSFormMatrix() or reader.GetQFormMatrix()
    if matrix is not None:
        place["direction"] = [[matrix.GetElement(r, c) for c in range(3)] for r in range(3)]
        place["origin"] = [matrix.GetElement(r, 3) for r in range(3)]
    place["unit"] = LENGTHS.get(header.GetXYZTUnits() & 7, "")
    place["name"] = header.GetIntentName() or ""
    return reader.GetOutput(), place


def read(path: str, array: str) -> tuple[dict[str, Any], memoryview]:
    is_vti = path.lower().endswith(".vti")
    image, place = read_vti(path, array) if is_vti else read_nifti(path)
    data = image.GetPointData()
    scalars = data.GetScalars()
    if scalars is None:
        names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
        if names:
            listed = ", ".join(f"'{name}'" for name in names)
            raise Refused(f"{path} has several arrays, choose one by array: {listed}", True, names)
        raise Refused(f"{path} has no point data that could be contoured", True)
    if scalars.GetNumberOfComponents() != 1:
        raise Refused(
            f"{path} has {scalars.GetNumberOfComponents()} numbers per sample, not one", True
        )
    kind = TYPES.get(scalars.GetDataTypeAsString())
    if kind is None:
        raise Refused(f"{path} has samples of a type that is not read", True)
    shape = list(image.GetDimensions())
    if scalars.GetNumberOfTuples() != shape[0] * shape[1] * shape[2]:
        raise Refused(f"{path} holds fewer samples than its header says")
    place |= {"type": kind, "shape": shape, "spacing": list(image.GetSpacing())}
    return place, memoryview(scalars)


def main() -> None:
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what VTK prints is no part of the answer
    try:
        place, samples = read(sys.argv[1], sys.argv[2])
    except ImportError as error:
        needed = "reading it needs the package vtk (python3-vtk9 of Debian)"
        out.write(json.dumps({"error": f"{sys.argv[1]}: {needed}: {error}"}).encode() + b"\n")
    except Refused as refused:
        answer = {"error": str(refused), "argument": refused.argument, "names": refused.names}
        out.write(json.dumps(answer).encode() + b"\n")
    else:
        out.write(json.dumps(place).encode() + b"\n")
        out.write(samples)
    out.close()


if __name__ == "__main__":
    main()
