# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of volumes as VTK and other programs write them, and files of surfaces as VTK reads them."""
import gzip
import json
import os
import subprocess
import sys

import numpy as np
import pytest

import nestgrid

pytest.importorskip("vtkmodules.vtkCommonDataModel")
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkImageData  # noqa: E402
from vtkmodules.vtkIOGeometry import vtkGLTFReader, vtkOBJReader  # noqa: E402
from vtkmodules.vtkIOImage import (  # noqa: E402
    vtkMetaImageWriter,
    vtkNIFTIImageHeader,
    vtkNIFTIImageWriter,
)
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter  # noqa: E402

SHAPE = (7, 5, 4)
SPACING = (0.5, 1.5, 2.0)
ORIGIN = (1.0, -2.0, 3.0)
POINTS = np.random.default_rng(3).random((50, 3)) * (3, 6, 6) + ORIGIN


@pytest.fixture(params=["uint8", "int16", "float32", "float64"])
def samples(request):
    values = np.random.default_rng(1).integers(0, 100, SHAPE)
    return np.asfortranarray(values.astype(request.param))


def image_of(samples):
    image = vtkImageData()
    image.SetDimensions(samples.shape)
    image.SetSpacing(SPACING)
    image.SetOrigin(ORIGIN)
    array = numpy_to_vtk(samples.ravel(order="F"), deep=True)
    array.SetName("heat")
    image.GetPointData().SetScalars(array)
    return image


def write(writer, image, path):
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.Write()
    return path


def same_field(loaded, samples):
    np.testing.assert_array_equal(loaded.array, samples)
    assert loaded.array.dtype == samples.dtype
    expected = nestgrid.Volume(samples, SPACING, ORIGIN)
    np.testing.assert_allclose(loaded.probe(POINTS), expected.probe(POINTS), rtol=1e-6)
    assert not np.isnan(expected.probe(POINTS)).any()


@pytest.mark.parametrize("mode", ["Ascii", "Binary", "Appended"])
def test_vti(samples, tmp_path, mode):
    writer = vtkXMLImageDataWriter()
    getattr(writer, f"SetDataModeTo{mode}")()
    volume = nestgrid.load(write(writer, image_of(samples), tmp_path / "x.vti"))
    same_field(volume, samples)
    assert volume.name == "heat"


def test_arrays_of_a_vti(tmp_path):
    image = image_of(np.zeros(SHAPE, np.float32, "F"))
    other = numpy_to_vtk(np.arange(140.0), deep=True)
    other.SetName("cold")
    image.GetPointData().AddArray(other)
    path = write(vtkXMLImageDataWriter(), image, tmp_path / "x.vti")
    assert nestgrid.load(path, "cold").array[1, 0, 0] == 1
    with pytest.raises(nestgrid.InvalidInput, match="no point data array 'colt', only 'heat', 'cold'; did you mean 'cold'"):
        nestgrid.load(path, "colt")


@pytest.mark.parametrize("suffix", [".mha", ".mhd"])
def test_meta_image(samples, tmp_path, suffix):
    if samples.dtype == np.float64:
        pytest.skip("VTK writes it wrong")
    path = write(vtkMetaImageWriter(), image_of(samples), tmp_path / ("x" + suffix))
    same_field(nestgrid.load(path), samples)


@pytest.mark.parametrize("suffix", [".nii", ".nii.gz"])
def test_nifti(samples, tmp_path, suffix):
    writer = vtkNIFTIImageWriter()
    header = vtkNIFTIImageHeader()
    header.SetXYZTUnits(2 + 8)  # millimetres and seconds
    header.SetIntentName("heat")
    writer.SetNIFTIHeader(header)
    path = write(writer, image_of(samples), tmp_path / ("x" + suffix))
    volume = nestgrid.load(path)
    np.testing.assert_array_equal(volume.array, samples)
    assert volume.spacing == pytest.approx(SPACING)
    assert (volume.name, volume.unit) == ("heat", "mm")


def test_nifti_of_several_volumes(samples, tmp_path):
    one = write(vtkNIFTIImageWriter(), image_of(samples), tmp_path / "one.nii")
    data = bytearray(one.read_bytes())
    data[40:42] = (4).to_bytes(2, "little")
    data[48:50] = (2).to_bytes(2, "little")
    series = tmp_path / "series.nii"
    series.write_bytes(data + bytes(reversed(data[352:])))
    with pytest.warns(UserWarning, match="frame 0 of the 2 in series.nii is read; frame= chooses another"):
        first = nestgrid.load(series)
    np.testing.assert_array_equal(first.array, samples)
    second = nestgrid.load(series, frame=1).array
    assert second.shape == samples.shape
    assert second.tobytes("F") == samples.tobytes("F")[::-1]
    with pytest.raises(nestgrid.InvalidInput, match="series.nii has no frame 2: frame is from 0 to 1"):
        nestgrid.load(series, frame=2)
    with pytest.raises(nestgrid.InvalidInput, match="component chooses nothing"):
        nestgrid.load(series, frame=1, component=0)


def nrrd(samples, encoding):
    data = samples.ravel(order="F").tobytes()
    kind = {"uint8": "uchar", "int16": "short", "float32": "float", "float64": "double"}
    header = f"""NRRD0004
# written by hand
content: heat of the head
type: {kind[samples.dtype.name]}
dimension: 3
space: left-posterior-superior
sizes: {" ".join(map(str, samples.shape))}
space directions: (0.5,0,0) (0,1.5,0) (0,0,2)
space units: "mm" "mm" "mm"
endian: little
encoding: {encoding}
space origin: (1,-2,3)

"""
    return header.encode() + (gzip.compress(data) if encoding == "gzip" else data)


@pytest.mark.parametrize("encoding", ["raw", "gzip"])
def test_nrrd(samples, tmp_path, encoding):
    (tmp_path / "x.nrrd").write_bytes(nrrd(samples, encoding))
    volume = nestgrid.load(tmp_path / "x.nrrd")
    same_field(volume, samples)
    assert (volume.name, volume.unit) == ("heat of the head", "mm")
    assert "mm" in volume._repr_html_() and "heat of the head" in repr(volume)


def test_axes_in_space(tmp_path):
    """The axes of a scanner are honoured: index 0 runs along y."""
    samples = np.arange(24, dtype=np.float32).reshape(2, 3, 4)
    data = nrrd(samples, "raw").replace(b"(0.5,0,0) (0,1.5,0)", b"(0,0.5,0) (1.5,0,0)")
    (tmp_path / "x.nrrd").write_bytes(data)
    volume = nestgrid.load(tmp_path / "x.nrrd")
    assert volume.probe((1 + 1.5 * 2, -2 + 0.5, 3 + 2 * 3)) == samples[1, 2, 3]
    np.testing.assert_array_equal(volume.direction, [[0, 1, 0], [1, 0, 0], [0, 0, 1]])


@pytest.mark.parametrize("big_endian", [False, True])
def test_raw(samples, tmp_path, big_endian):
    stored = samples.astype(samples.dtype.newbyteorder(">" if big_endian else "<"))
    (tmp_path / "x.raw").write_bytes(stored.tobytes(order="F"))
    given = {"dims": SHAPE, "type": samples.dtype.name, "big_endian": big_endian}
    volume = nestgrid.load(tmp_path / "x.raw", spacing=SPACING, **given)
    np.testing.assert_array_equal(volume.array, samples)
    assert volume.spacing == SPACING
    with pytest.raises(nestgrid.IoError, match="bytes, but dims and type ask for"):
        nestgrid.load(tmp_path / "x.raw", **(given | {"dims": (7, 5, 5)}))


def test_refused_files(tmp_path):
    samples = np.zeros(SHAPE, np.float32)
    whole = {
        "x.vti": write(vtkXMLImageDataWriter(), image_of(samples), tmp_path / "w.vti").read_bytes(),
        "x.nii": write(vtkNIFTIImageWriter(), image_of(samples), tmp_path / "w.nii").read_bytes(),
        "x.nii.gz": write(vtkNIFTIImageWriter(), image_of(samples), tmp_path / "w.nii.gz").read_bytes(),
        "x.mha": write(vtkMetaImageWriter(), image_of(samples), tmp_path / "w.mha").read_bytes(),
        "x.nrrd": nrrd(samples, "gzip"),
    }
    for name, content in whole.items():
        path = tmp_path / name
        for damaged in (content[: len(content) * 3 // 4], b"nothing of the kind", b""):
            path.write_bytes(damaged)
            with pytest.raises(nestgrid.IoError, match=name):
                nestgrid.load(path)
    with pytest.raises(nestgrid.IoError, match="does not exist"):
        nestgrid.load(tmp_path / "none.vti")
    with pytest.raises(nestgrid.InvalidInput, match="give dims and type"):
        nestgrid.load(tmp_path / "x.raw") if (tmp_path / "x.raw").write_bytes(b"1") else None
    with pytest.raises(nestgrid.InvalidInput, match="dims is for .raw files"):
        nestgrid.load(tmp_path / "x.nrrd", dims=(1, 2, 3))
    with pytest.raises(nestgrid.InvalidInput, match="has no name: leave out array"):
        nestgrid.load(tmp_path / "x.nrrd", "heat")


def test_a_crash_of_the_reader_is_told(tmp_path, monkeypatch):
    path = write(vtkXMLImageDataWriter(), image_of(np.zeros(SHAPE)), tmp_path / "x.vti")
    crash = tmp_path / "crash"
    crash.write_text("#!/bin/sh\nkill -SEGV $$\n")
    crash.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(crash))
    with pytest.raises(nestgrid.IoError, match="its reader ended with -11"):
        nestgrid.load(path)


@pytest.fixture
def surface(gyroid):
    return nestgrid.Volume(gyroid, name="heat").slice(
        plane=((32, 32, 32), (1, 1, 0)), threshold=0.1, normals=True, elements=True
    )


@pytest.fixture
def lines(surface):
    return surface.isolines([-0.5, 0, 0.5])


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def test_obj(surface, lines, tmp_path):
    surface.save(tmp_path / "surface.obj")
    data = read(vtkOBJReader(), tmp_path / "surface.obj")
    np.testing.assert_allclose(vtk_to_numpy(data.GetPoints().GetData()), surface.vertices, rtol=1e-6)
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    np.testing.assert_array_equal(corners, surface.triangles.ravel())
    normals = vtk_to_numpy(data.GetPointData().GetNormals())
    np.testing.assert_allclose(normals, surface.normals, atol=1e-5)
    lines.save(tmp_path / "lines.obj")
    data = read(vtkOBJReader(), tmp_path / "lines.obj")
    assert data.GetNumberOfLines() == len(lines)
    surface.outlines().save(tmp_path / "outlines.obj")
    data = read(vtkOBJReader(), tmp_path / "outlines.obj")
    assert data.GetNumberOfLines() == len(surface.outlines().segments)


def gltf_of(path):
    data = read(vtkGLTFReader(), path)
    iterator = data.NewIterator()
    iterator.InitTraversal()
    return iterator.GetCurrentDataObject()


def test_gltf(surface, lines, tmp_path):
    surface.save(tmp_path / "surface.gltf")
    data = gltf_of(tmp_path / "surface.gltf")
    np.testing.assert_allclose(vtk_to_numpy(data.GetPoints().GetData()), surface.vertices, rtol=1e-6)
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    np.testing.assert_array_equal(corners, surface.triangles.ravel())
    scene = json.loads((tmp_path / "surface.gltf").read_text())
    attributes = scene["meshes"][0]["primitives"][0]["attributes"]
    assert set(attributes) == {"POSITION", "NORMAL", "_HEAT"}
    bounds = scene["accessors"][attributes["POSITION"]]
    np.testing.assert_allclose(bounds["min"], surface.vertices.min(axis=0), rtol=1e-6)
    lines.save(tmp_path / "lines.gltf")
    data = gltf_of(tmp_path / "lines.gltf")
    assert data.GetNumberOfLines() == len(lines.points) - len(lines)
    surface.outlines().save(tmp_path / "outlines.gltf")
    assert gltf_of(tmp_path / "outlines.gltf").GetNumberOfLines() > 0


@pytest.mark.parametrize("suffix", [".vtp", ".ply", ".stl", ".obj", ".gltf"])
def test_empty_surfaces_and_failures(gyroid, tmp_path, suffix):
    nestgrid.Volume(gyroid).isosurface(100).save(tmp_path / ("empty" + suffix))
    assert os.listdir(tmp_path) == ["empty" + suffix]
    folder = tmp_path / ("folder" + suffix)
    folder.mkdir()
    with pytest.raises(nestgrid.IoError, match="cannot be written"):
        nestgrid.Volume(gyroid).isosurface(0).save(folder)
    assert len(os.listdir(tmp_path)) == 2


@pytest.mark.parametrize("suffix", [".vtp", ".ply", ".stl", ".obj", ".gltf"])
def test_full_disks(gyroid, tmp_path, suffix):
    """A limit on the size of files stands for a full disk: nothing is left behind."""
    program = f"""
import resource, signal, nestgrid, numpy as np
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
surface = nestgrid.Volume(np.load({str(tmp_path / 'a.npy')!r})).isosurface(0)
resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000))
try:
    surface.save({str(tmp_path / ('x' + suffix))!r})
except nestgrid.IoError as error:
    print(error)
"""
    np.save(tmp_path / "a.npy", gyroid)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert "cannot be written: File too large" in done.stdout, done
    assert os.listdir(tmp_path) == ["a.npy"]
