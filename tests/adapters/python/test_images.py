# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM series, planes and pictures that pydicom and VTK write have their values where these say."""
import os
import shutil

import numpy as np
import pytest

import nestgrid

pydicom = pytest.importorskip("pydicom")
pytest.importorskip("vtkmodules.vtkIOImage")
from pydicom.dataset import FileDataset, FileMetaDataset  # noqa: E402
from pydicom.uid import ExplicitVRLittleEndian, generate_uid  # noqa: E402
from vtkmodules.util.numpy_support import numpy_to_vtk  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkImageData  # noqa: E402
from vtkmodules.vtkIOImage import vtkPNGWriter, vtkPNMWriter, vtkTIFFWriter  # noqa: E402
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter  # noqa: E402

SHAPE = (9, 7, 5)  # columns, rows, slices
ROW, COLUMN = np.array([0.8, 0.6, 0]), np.array([0, 0, -1.0])
STEP = np.array([-1.5, 2.5, 0.25])  # from slice to slice: no multiple of the normal
SPACING = (0.75, 1.25)  # along a row, from row to row
ORIGIN = np.array([10.0, -20, 30])
SLOPE, INTERCEPT = 0.0625, -100


def function(x):
    return x @ [3.0, -2, 5] + 7


def place_of(index):
    i, j, k = np.moveaxis(np.asarray(index, float), -1, 0)[..., None]
    return ORIGIN + i * SPACING[0] * ROW + j * SPACING[1] * COLUMN + k * STEP


def write_slice(path, number, series, sign=1, **more):
    """Slice `number` of the function, or of its negative, as integers with a slope."""
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.4"
    meta.MediaStorageSOPInstanceUID = generate_uid()
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data = FileDataset(str(path), {}, file_meta=meta, preamble=b"\0" * 128)
    data.SOPClassUID, data.SOPInstanceUID = meta[0x00020002].value, meta[0x00020003].value
    data.SeriesInstanceUID, data.SeriesNumber, data.InstanceNumber = series, 4, number + 1
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.Columns, data.Rows = SHAPE[:2]
    data.ImagePositionPatient = [f"{x:.10g}" for x in place_of((0, 0, number))]
    data.ImageOrientationPatient = [f"{x:.10g}" for x in (*ROW, *COLUMN)]
    data.PixelSpacing = [SPACING[1], SPACING[0]]
    data.BitsAllocated = data.BitsStored = 16
    data.HighBit, data.PixelRepresentation = 15, 1
    data.RescaleSlope, data.RescaleIntercept = str(SLOPE), str(INTERCEPT)
    for key, value in more.items():
        setattr(data, key, value)
    index = np.moveaxis(np.indices((SHAPE[1], SHAPE[0], 1)), 0, -1)[:, :, 0, [1, 0, 2]]
    values = sign * function(place_of(index + [0, 0, number]))
    data.PixelData = np.rint((values - INTERCEPT) / SLOPE).astype("<i2").tobytes()
    data.is_little_endian, data.is_implicit_VR = True, False
    data.save_as(path, write_like_original=False)


def write_series(folder, sign=1, **more):
    """A slice in each file, under names in another order."""
    folder.mkdir(exist_ok=True)
    series = generate_uid()
    for k in range(SHAPE[2]):
        write_slice(folder / f"IM{3 * k % 5}", k, series, sign, **more)
    return series


def places(volume):
    """Of all samples of a volume or plane, in space."""
    index = np.moveaxis(np.indices(volume.array.shape), 0, -1)
    return np.asarray(volume.origin) + (index * volume.spacing) @ volume.direction.T


def expect_function(volume, sign=1):
    np.testing.assert_allclose(volume.array, sign * function(places(volume)), atol=SLOPE)


def test_series(tmp_path):
    """In space as positions say, also of a tilted gantry."""
    write_series(tmp_path / "head", SeriesDescription="T1 head")
    volume = nestgrid.load(tmp_path / "head")
    assert volume.array.shape == SHAPE and (volume.name, volume.unit) == ("T1 head", "mm")
    np.testing.assert_allclose(volume.origin, ORIGIN)
    np.testing.assert_allclose(volume.direction[:, 2] * volume.spacing[2], STEP, atol=1e-9)
    expect_function(volume)
    points = volume.isosurface(float(np.median(volume.array))).vertices
    np.testing.assert_allclose(function(points), np.median(volume.array), atol=2 * SLOPE)
    for name in "IM2", "IM0":  # any of its files is the series
        np.testing.assert_array_equal(nestgrid.load(tmp_path / "head" / name).array, volume.array)
    shutil.copy(tmp_path / "head" / "IM2", tmp_path / "head" / "IM7.dcm")
    with pytest.raises(nestgrid.IoError, match="another number elsewhere"):
        nestgrid.load(tmp_path / "head" / "IM7.dcm")


def test_whole_slopes_keep_integers(tmp_path):
    write_series(tmp_path / "x", RescaleSlope="1", RescaleIntercept="-1024")
    assert nestgrid.load(tmp_path / "x").array.dtype == np.int16
    write_series(tmp_path / "y", RescaleSlope="1", RescaleIntercept="0")
    stored = nestgrid.load(tmp_path / "y").array
    np.testing.assert_array_equal(stored - 1024, nestgrid.load(tmp_path / "x").array)


def test_several_series(tmp_path):
    study = tmp_path / "study"
    study.mkdir()
    write_series(study / "a", SeriesDescription="ball")
    write_series(study / "b", -1, SeriesDescription="hole")
    with pytest.raises(nestgrid.InvalidInput, match="choose one by array: 'ball', 'hole'"):
        nestgrid.load(study)
    with pytest.raises(nestgrid.InvalidInput, match="no series 'bell', only .* did you mean 'ball'"):
        nestgrid.load(study, "bell")
    expect_function(nestgrid.load(study, "ball"))
    expect_function(nestgrid.load(study, "hole"), -1)
    expect_function(nestgrid.load(study / "b" / "IM1"), -1)


def test_moments_are_frames(tmp_path):
    series = write_series(tmp_path / "x")
    for k in range(SHAPE[2]):
        write_slice(tmp_path / "x" / f"later{k}", k, series, -1, InstanceNumber=100 + k)
    with pytest.warns(UserWarning, match="frame 0 of the 2"):
        expect_function(nestgrid.load(tmp_path / "x"))
    expect_function(nestgrid.load(tmp_path / "x", frame=1), -1)


def test_refusals(tmp_path):
    write_series(tmp_path / "missing")
    os.remove(tmp_path / "missing" / "IM1")  # slice 2
    with pytest.raises(nestgrid.IoError, match="a slice is missing, or they are not even"):
        nestgrid.load(tmp_path / "missing")
    (tmp_path / "empty").mkdir()
    (tmp_path / "empty" / "readme.txt").write_text("no image")
    with pytest.raises(nestgrid.IoError, match="holds no DICOM series"):
        nestgrid.load(tmp_path / "empty")
    with pytest.raises(nestgrid.InvalidInput, match="ends in none of"):
        nestgrid.load(tmp_path / "empty" / "readme.txt")
    with pytest.raises(nestgrid.IoError):
        nestgrid.load(tmp_path / "none.dcm")
    write_series(tmp_path / "cut")
    whole = (tmp_path / "cut" / "IM3").read_bytes()
    for count in range(200, len(whole), 97):
        (tmp_path / "cut" / "IM3").write_bytes(whole[:count])
        with pytest.raises((nestgrid.IoError, nestgrid.InvalidInput)):
            nestgrid.load(tmp_path / "cut")


def test_a_slice_is_a_plane_in_space(tmp_path):
    write_slice(tmp_path / "one.dcm", 2, generate_uid())
    plane = nestgrid.load(tmp_path / "one.dcm")
    assert plane.array.shape == SHAPE[:2] and plane.direction.shape == (3, 2)
    expect_function(plane)
    value = float(np.median(plane.array))
    lines = plane.isolines([value])
    assert len(lines.vertices) > 2
    np.testing.assert_allclose(function(lines.vertices), value, atol=2 * SLOPE)
    normal = np.cross(ROW, COLUMN)
    np.testing.assert_allclose((lines.vertices - place_of((0, 0, 2))) @ normal, 0, atol=1e-6)


def image_of(samples, **place):
    image = vtkImageData()
    image.SetDimensions(samples.shape[:3])
    numbers = samples.reshape(-1, *samples.shape[3:], order="F")
    image.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(numbers), deep=True))
    return image


def write(writer, image, path):
    writer.SetInputData(image)
    writer.SetFileName(str(path))
    writer.Write()
    return path


@pytest.mark.parametrize("across", range(3))
def test_planes_of_volumes(across, tmp_path):
    """One sample along an axis: a plane, where it lies."""
    shape = [4, 5, 6]
    shape[across] = 1
    samples = np.random.default_rng(across).random(shape)
    image = image_of(samples)
    image.SetOrigin(1, 2, 3)
    image.SetSpacing(0.5, 0.25, 2)
    plane = nestgrid.load(write(vtkXMLImageDataWriter(), image, tmp_path / "x.vti"))
    np.testing.assert_array_equal(plane.array, samples.squeeze(across))
    along = [d for d in range(3) if d != across]
    expected = np.array([1.0, 2, 3]) + np.indices(plane.array.shape).T.swapaxes(0, 1) @ np.diag(
        [0.5, 0.25, 2]
    )[along]
    np.testing.assert_allclose(places(plane), expected)
    assert plane.isolines([0.5]).vertices[:, across] == pytest.approx([1, 2, 3][across])


def test_pictures(tmp_path):
    grey = (np.arange(12 * 8).reshape(12, 8, 1) * 257).astype(np.uint16)
    picture = nestgrid.load(write(vtkPNGWriter(), image_of(grey), tmp_path / "grey.PNG"))
    np.testing.assert_array_equal(picture.array, grey[:, :, 0])
    assert picture.origin == (0, 0) and picture.array.dtype == np.uint16
    colours = np.random.default_rng(1).integers(0, 255, (12, 8, 1, 3)).astype(np.uint8)
    path = write(vtkPNGWriter(), image_of(colours), tmp_path / "colours.png")
    with pytest.raises(nestgrid.InvalidInput, match="3 numbers per sample, not one"):
        nestgrid.load(path)
    for part in range(3):
        green = nestgrid.load(path, component=part)
        np.testing.assert_array_equal(green.array, colours[:, :, 0, part])
    stack = np.random.default_rng(2).integers(0, 9, (6, 5, 4)).astype(np.uint8)
    pages = nestgrid.load(write(vtkTIFFWriter(), image_of(stack), tmp_path / "stack.tif"))
    np.testing.assert_array_equal(pages.array, stack)
    path = write(vtkPNMWriter(), image_of(colours[..., 0]), tmp_path / "cut.pgm")
    np.testing.assert_array_equal(nestgrid.load(path).array, colours[:, :, 0, 0])
    path.write_bytes(path.read_bytes()[:-10])
    with pytest.raises(nestgrid.IoError, match="cut off: it has 86 bytes of pixels, not 96"):
        nestgrid.load(path)
    (tmp_path / "no.png").write_bytes(b"no picture")
    with pytest.raises(nestgrid.IoError, match="no picture that can be read"):
        nestgrid.load(tmp_path / "no.png")
