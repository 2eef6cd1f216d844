# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM series, planes of all formats, and pictures are read as pydicom, DCMTK, nibabel and VTK mean
them, and one scan in several formats is one surface in one space.

Samples are those of a ball, 100 - |p - CENTRE|, at the places that the headers mean, in LPS.

Argument: the program.
"""

import base64
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile

try:
    import meshio
    import nibabel
    import pydicom
    from pydicom.dataset import FileDataset, FileMetaDataset
    from pydicom.uid import ExplicitVRLittleEndian, generate_uid
except ImportError:
    print("skipped: meshio, nibabel or pydicom is missing")
    sys.exit(77)
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter, vtkTIFFWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataReader

from ball import AXES, CENTRE, FLIP, ORIGIN, SHAPE, SPACING, STEPS, affine, ball, nearest_sphere

PROGRAM = os.path.abspath(sys.argv[1])
failures = 0
cases = 0


def fail(text):
    global failures
    failures += 1
    print("FAILED:", text)


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


def refused(name, words, *options):
    global cases
    cases += 1
    done = program("info", name, *options)
    lines = done.stderr.strip().split("\n")
    if done.returncode != 1 or len(lines) != 1 or words not in lines[0] or done.stdout:
        fail(f"{name} {options}: {done.returncode}, {done.stderr.strip()}, not '{words}'")


def points_of(*arguments):
    done = program(*arguments, "-o", "out.vtp")
    if done.returncode != 0:
        fail(f"{arguments}: {done.stderr.strip()}")
        return None
    reader = vtkXMLPolyDataReader()
    reader.SetFileName("out.vtp")
    reader.Update()
    os.remove("out.vtp")
    return vtk_to_numpy(reader.GetOutput().GetPoints().GetData()).astype(float)


def good(name, *options, centre=CENTRE, value=88.0, words=""):
    """The isosurface of 88 is a sphere of radius 12 around the centre."""
    global cases
    cases += 1
    done = program("info", name, *options, "--json")
    if done.returncode != 0 or done.stderr:
        return fail(f"info {name} {options}: {done.stderr.strip()}")
    if words not in done.stdout:
        fail(f"info {name} {options}: {done.stdout} does not say '{words}'")
    points = points_of("isosurface", name, *options, "--value", value)
    if points is None:
        return
    middle, radius = nearest_sphere(points)
    if np.abs(middle - centre).max() > 0.05 or abs(radius - 12) > 0.12:
        fail(f"{name} {options}: a sphere of radius {radius:.4g} around {middle}, not {centre}")
    return json.loads(done.stdout)


# DICOM


def write_slice(path, samples, place, row, column, series, number, **more):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.4"
    meta.MediaStorageSOPInstanceUID = generate_uid()
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data = FileDataset(path, {}, file_meta=meta, preamble=b"\0" * 128)
    data.SOPClassUID = meta.MediaStorageSOPClassUID
    data.SOPInstanceUID = meta.MediaStorageSOPInstanceUID
    data.PatientName, data.PatientID = "Ball", "1"
    data.StudyInstanceUID, data.SeriesInstanceUID = STUDY, series
    data.FrameOfReferenceUID = STUDY
    data.StudyID, data.StudyDate, data.StudyTime = "1", "20200101", "120000"
    data.AccessionNumber, data.Modality = "1", "MR"
    data.SeriesNumber, data.InstanceNumber = 1, number
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.Columns, data.Rows = samples.shape
    data.ImagePositionPatient = [f"{x:.10g}" for x in place]
    data.ImageOrientationPatient = [f"{x:.12g}" for x in (*row, *column)]
    data.PixelSpacing = [SPACING[1], SPACING[0]]
    data.SliceThickness = SPACING[2]
    data.BitsAllocated = data.BitsStored = 16
    data.HighBit, data.PixelRepresentation = 15, 1
    for key, value in more.items():
        setattr(data, key, value)
    scaled = (samples - float(data.get("RescaleIntercept", 0))) / float(data.get("RescaleSlope", 1))
    data.PixelData = np.rint(scaled).astype("<i2").tobytes("F")
    data.is_little_endian, data.is_implicit_VR = True, False
    data.save_as(path, write_like_original=False)


STUDY = generate_uid()


def write_series(folder, samples=None, steps=STEPS, order=None, **more):
    """A slice in each file, under names that are in no order."""
    samples = 100 * ball(steps) if samples is None else samples
    os.makedirs(folder, exist_ok=True)
    series = generate_uid()
    axes = steps / np.linalg.norm(steps, axis=0)
    for k in range(samples.shape[2]):
        name = f"{folder}/IM{(7 * k) % 101:03d}{len(os.listdir(folder)):04d}"
        place = ORIGIN + k * steps[:, 2]
        write_slice(name, samples[:, :, k], place, axes[:, 0], axes[:, 1], series, k + 1, **more)


def test_dicom():
    write_series("plain", SeriesDescription="T1 head")
    facts = good("plain", value=8800, words='"LPS (mm)"')
    if facts and facts["field"] != "T1 head":
        fail(f"plain: field {facts['field']}")
    any_file = sorted(os.listdir("plain"))[5]
    good(f"plain/{any_file}", value=8800)
    write_series("scaled", samples=ball(), RescaleSlope="0.01", RescaleIntercept="-20")
    good("scaled")
    steps = STEPS * [1, 1, -1]
    centre = ORIGIN + steps @ [11.3, 10.2, 9.6]
    write_series("backwards", samples=100 * ball(steps, centre=centre), steps=steps)
    good("backwards", centre=centre, value=8800)
    tilt = STEPS.copy()
    tilt[:, 2] += 0.5 * STEPS[:, 1]
    write_series("tilted", steps=tilt)
    good("tilted", value=8800)
    # A study of two series and its DICOMDIR.
    os.makedirs("study")
    write_series("study/A", SeriesDescription="ball")
    write_series("study/B", samples=-100 * ball(), SeriesDescription="hole")
    refused("study", "several series, choose one by --array: 'ball', 'hole'")
    good("study", "--array", "ball", value=8800)
    good("study", "--array", "hole", value=-8800)
    refused("study", "has no series 'bell', only 'ball', 'hole': did you mean 'ball'?", "--array", "bell")
    os.makedirs("disc")
    write_series("disc/A")
    for name in os.listdir("disc/A"):
        shutil.move(f"disc/A/{name}", f"disc/A/{name[:2] + name[-3:] + name[2:5]}")
    done = subprocess.run(["dcmmkdir", "+r", "+id", ".", "-Pgp", "-W", "+D", "DICOMDIR"], cwd="disc",
                          capture_output=True, text=True)
    if os.path.exists("disc/DICOMDIR"):
        good("disc/DICOMDIR", value=8800)
        good("disc", value=8800)
    else:
        fail(f"dcmmkdir: {done.stderr}")
    # Two moments in one place.
    write_series("moments", samples=100 * ball())
    series = pydicom.dcmread("moments/" + os.listdir("moments")[0]).SeriesInstanceUID
    for k in range(SHAPE[2]):
        write_slice(f"moments/later{k}", -100 * ball()[:, :, k], ORIGIN + k * STEPS[:, 2], AXES[:, 0],
                    AXES[:, 1], series, 100 + k)
    good("moments", value=8800, words="frame 0 of the 2 in moments")
    good("moments", "--frame", "1", value=-8800)
    # A slice that is missing, or too many.
    shutil.copytree("plain", "missing")
    for name in os.listdir("missing"):
        if pydicom.dcmread(f"missing/{name}").InstanceNumber == 9:
            os.remove(f"missing/{name}")
    refused("missing", "a slice is missing, or they are not even")
    # Packed files, by another program.
    os.makedirs("packed")
    for name in os.listdir("plain"):
        subprocess.run(["gdcmconv", "--jpegls", f"plain/{name}", f"packed/{name}"], capture_output=True)
    good("packed", value=8800)
    os.makedirs("nothing")
    open("nothing/readme.txt", "w").write("no image")
    refused("nothing", "folder")
    with open("cut.dcm", "wb") as file:
        file.write(open(f"plain/{any_file}", "rb").read()[:700])
    os.makedirs("damaged")
    shutil.move("cut.dcm", "damaged/cut.dcm")
    refused("damaged", "DICOM")


# One scan in several formats


def test_spaces():
    global cases
    samples = np.rint(100 * ball())
    write_series("scan", samples=samples)
    matrix = affine(FLIP[:, None] * STEPS, FLIP * ORIGIN)
    nibabel.save(nibabel.Nifti1Image(samples.astype(np.int16), matrix), "scan.nii.gz")
    header = "NRRD0004\ntype: int16\ndimension: 3\nsizes: %d %d %d\nspace: %s\n" % (*SHAPE, "LPS")
    header += "space directions: " + " ".join("(%.12g,%.12g,%.12g)" % tuple(STEPS[:, d]) for d in range(3))
    header += "\nspace origin: (%.12g,%.12g,%.12g)\nendian: little\nencoding: raw\n\n" % tuple(ORIGIN)
    with open("scan.nrrd", "wb") as file:
        file.write(header.encode() + samples.astype("<i2").tobytes("F"))
    with open("scan.mha", "wb") as file:
        file.write(("NDims = 3\nDimSize = %d %d %d\nElementType = MET_SHORT\nAnatomicalOrientation = RAI\n"
                    % SHAPE
                    + "TransformMatrix = " + " ".join("%.12g" % x for x in AXES.T.ravel())
                    + "\nOffset = %.12g %.12g %.12g\n" % tuple(ORIGIN)
                    + "ElementSpacing = %.12g %.12g %.12g\nElementDataFile = LOCAL\n" % tuple(SPACING)
                    ).encode() + samples.astype("<i2").tobytes("F"))
    for space, flip in ("lps", np.ones(3)), ("ras", FLIP):
        surfaces = []
        for name in "scan", "scan.nii.gz", "scan.nrrd", "scan.mha":
            good(name, "--space", space, centre=flip * CENTRE, value=8800, words=space.upper())
            points = points_of("isosurface", name, "--space", space, "--value", "8800.5")
            surfaces.append(points)
        for other in surfaces[1:]:
            cases += 1
            distance = max(np.linalg.norm(surfaces[0] - x, axis=1).min() for x in other[::97])
            if len(other) != len(surfaces[0]) or distance > 1e-4:
                fail(f"surfaces in {space} differ by {distance}")


# Planes


def write_plane_by_hand(name, plane, origin):
    """NRRD and MetaImage, as their definitions say."""
    numbers = lambda row: ",".join(f"{x:.17g}" for x in row)
    header = "NRRD0004\ntype: float\ndimension: 3\nsizes: %d %d %d\nspace dimension: 3\n" % plane.shape
    header += "space directions: " + " ".join(f"({numbers(step)})" for step in STEPS.T) + "\n"
    header += f"space origin: ({numbers(origin)})\nendian: little\nencoding: raw\n\n"
    with open(name + ".nrrd", "wb") as file:
        file.write(header.encode() + plane.astype("<f4").tobytes("F"))
    words = lambda row: " ".join(f"{x:.17g}" for x in row)
    header = "NDims = 3\nDimSize = %d %d %d\n" % plane.shape
    header += f"ElementSpacing = {words(SPACING)}\nOffset = {words(origin)}\nTransformMatrix = {words(AXES.T.ravel())}\n"
    with open(name + ".mha", "wb") as file:
        file.write((header + "ElementType = MET_FLOAT\nElementDataFile = LOCAL\n").encode() + plane.astype("<f4").tobytes("F"))


def test_planes():
    samples = ball().astype(np.float32)
    for axis in range(3):
        index = [slice(None)] * 3
        index[axis] = slice(9, 10)
        plane = samples[tuple(index)]
        origin = ORIGIN + STEPS[:, axis] * 9
        matrix = affine(STEPS, origin)
        nibabel.save(nibabel.Nifti1Image(plane, matrix), f"plane{axis}.nii")
        image = vtkImageData()
        image.SetDimensions(plane.shape)
        image.SetSpacing(SPACING)
        image.SetOrigin(origin)
        image.SetDirectionMatrix(*AXES.ravel())
        array = numpy_to_vtk(plane.ravel("F"), deep=True)
        array.SetName("heat")
        image.GetPointData().SetScalars(array)
        writer = vtkXMLImageDataWriter()
        writer.SetInputData(image)
        writer.SetFileName(f"plane{axis}.vti")
        writer.Write()
        write_plane_by_hand(f"plane{axis}", plane, origin)
        normal = np.cross(STEPS[:, (axis + 1) % 3], STEPS[:, (axis + 2) % 3])
        normal /= np.linalg.norm(normal)
        for name in (f"plane{axis}.{ending}" for ending in ("nii", "vti", "nrrd", "mha")):
            global cases
            cases += 1
            points = points_of("isolines", name, "--values", "90")
            if points is None:
                continue
            off = np.abs(np.linalg.norm(points - CENTRE, axis=1) - 10).max()
            flat = np.abs((points - origin) @ normal).max()
            if off > 0.15 or flat > 1e-4:
                fail(f"{name}: lines are {off} off the circle, {flat} off the plane")
            for command in ("height", "--scale", "0.5"), ("surface",):
                done = program(command[0], name, *command[1:], "-o", "out.vtp")
                if done.returncode != 0:
                    fail(f"{command} {name}: {done.stderr}")
            place = ",".join(map(str, CENTRE - ((CENTRE - origin) @ normal) * normal))
            with open("places.csv", "w") as file:
                file.write(place + "\n")
            done = program("probe", name, "--points", "places.csv")
            value = done.stdout.strip().split("\n")[-1].split(",")[3]
            expected = 100 - abs((CENTRE - origin) @ normal)
            if axis == 2 and name.endswith("vti") and done.returncode == 0 and value:
                if abs(float(value) - expected) > 1:
                    fail(f"probe {name}: {done.stdout} {done.stderr}, not {expected}")


def test_pictures():
    """The pages of a TIFF file are slices; colours are components."""
    image = vtkImageData()
    image.SetDimensions(SHAPE)
    samples = np.rint(100 * ball(np.eye(3) * 2, np.zeros(3), np.array([22.0, 20.0, 19.0])))
    array = numpy_to_vtk(samples.ravel("F").astype(np.uint16), deep=True)
    image.GetPointData().SetScalars(array)
    writer = vtkTIFFWriter()
    writer.SetInputData(image)
    writer.SetFileName("stack.tif")
    writer.Write()
    global cases
    cases += 1
    done = program("info", "stack.tif", "--json")
    facts = json.loads(done.stdout) if done.returncode == 0 else {}
    if facts.get("samples") != list(map(float, SHAPE)) or facts["greatest_value"] != samples.max():
        fail(f"stack.tif: {done.stdout} {done.stderr}")
    colours = vtkImageData()
    colours.SetDimensions(30, 20, 1)
    values = (np.arange(1800) % 251).astype(np.uint8).reshape(-1, 3)
    colours.GetPointData().SetScalars(numpy_to_vtk(values, deep=True))
    writer = vtkPNGWriter()
    writer.SetInputData(colours)
    writer.SetFileName("colours.png")
    writer.Write()
    refused("colours.png", "3 numbers per sample (colour), not one: choose by --component 0 to 2")
    cases += 1
    done = program("info", "colours.png", "--component", "1", "--json")
    facts = json.loads(done.stdout) if done.returncode == 0 else {}
    if facts.get("greatest_value") != values[:, 1].max():
        fail(f"colours.png: {done.stdout} {done.stderr}")


def test_frames():
    """Frames of one file are moments: values fall by 3 from each to the next."""
    global cases
    matrix = affine()
    frames = np.stack([ball() - 3 * t for t in range(4)], axis=3).astype(np.float32)
    image = nibabel.Nifti1Image(frames, matrix)
    image.header.set_xyzt_units("mm", "sec")
    image.header["pixdim"][4], image.header["toffset"] = 2.5, 10
    nibabel.save(image, "four.nii.gz")
    good("four.nii.gz", words="frame 0 of the 4 in four.nii.gz")
    good("four.nii.gz", "--frame", "3", value=79)
    for time, value in (10, 88), (13.75, 83.5), (17.5, 79):
        cases += 1
        points = points_of("isosurface", "four.nii.gz", "--value", value, "--time", time)
        if points is not None and abs(nearest_sphere(points)[1] - 12) > 0.12:
            fail(f"four.nii.gz at {time}: radius {nearest_sphere(points)[1]}")
    done = program("isosurface", "four.nii.gz", "--value", "83.5", "--frames", "4", "-o", "film.vtp")
    if done.returncode != 0 or 'timestep="17.5"' not in open("film.pvd").read():
        fail(f"film of four.nii.gz: {done.stderr}")
    refused_time = program("isosurface", "four.nii.gz", "--value", "88", "--time", "9", "-o", "out.vtp")
    if refused_time.returncode != 1 or "10" not in refused_time.stderr:
        fail(f"a time before all frames: {refused_time.stderr}")
    header = "NRRD0004\ntype: float\ndimension: 4\nsizes: %d %d %d 4\nkinds: domain domain domain time\n" % SHAPE
    header += "spacings: 1 1 1 2.5\naxis mins: NaN NaN NaN 10\nendian: little\nencoding: raw\n\n"
    with open("four.nrrd", "wb") as file:
        file.write(header.encode() + frames.astype("<f4").tobytes("F"))
    cases += 1
    done = program("probe", "four.nrrd", "--line", "11,10,9,11,10,9.5", "--count", "2", "--time", "13.75")
    found = done.stdout.strip().split("\n")[1].split(",")
    if done.returncode != 0 or abs(float(found[3]) - (frames[11, 10, 9, 0] - 4.5)) > 1e-3:
        fail(f"probe four.nrrd: {done.stdout} {done.stderr}")


def test_labels():
    """A label is a part of its own, whatever its neighbours are."""
    global cases
    matrix = affine()
    distance = 100 - ball()
    labels = np.where(distance < 6, 7, np.where(distance < 12, 3, 0)).astype(np.int16)
    nibabel.save(nibabel.Nifti1Image(labels, matrix), "labels.nii.gz")
    for label in 3, 7:
        cases += 1
        done = program("isosurface", "labels.nii.gz", "--label", label, "--value", "0.5", "--json")
        row = json.loads(done.stdout)["surfaces"][0] if done.returncode == 0 else {}
        shells = 2 if label == 3 else 1
        if row.get("components") != shells or row.get("open_edges") != 0:
            fail(f"label {label}: {row} {done.stderr}")
    cases += 1
    both = ["labels.nii.gz", "--label", 3, "--label", 7]
    done = program("isosurface", *both, "--value", 0.5, "--json", "-o", "part.obj")
    rows = json.loads(done.stdout)["surfaces"] if done.returncode == 0 else []
    parts = [(row["label"], row["components"]) for row in rows]
    if parts != [(3, 2), (7, 1)] or not (os.path.exists("part-1.obj") and os.path.exists("part-2.obj")):
        fail(f"labels 3 and 7: {parts} {done.stderr}")
    refused("labels.nii.gz", "--label is given several times", *both[1:])


def test_holes():
    """Samples are missing where they are no number, have a value, or are outside a mask: the surface
    is the part of the ball for which all are there."""
    global cases
    matrix = affine()
    samples = ball().astype(np.float32)
    outside = np.indices(SHAPE)[0] > 12
    there = np.where(outside, 0, 5).astype(np.uint8)
    holes = np.where(outside, np.nan, samples).astype(np.float32)
    whole = np.round(samples).astype(np.int16)
    nibabel.save(nibabel.Nifti1Image(samples, matrix), "ball.nii.gz")
    nibabel.save(nibabel.Nifti1Image(there, matrix), "there.nii.gz")
    nibabel.save(nibabel.Nifti1Image(holes, matrix), "holes.nii.gz")
    scaled = nibabel.Nifti1Image(np.where(outside, -999, whole), matrix)
    scaled.header.set_slope_inter(1, 0)
    nibabel.save(scaled, "padded.nii.gz")
    image = vtkImageData()
    image.SetDimensions(SHAPE)
    array = numpy_to_vtk(there.ravel(order="F"), deep=True)
    image.GetPointData().SetScalars(array)
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    writer.SetFileName("there.vti")
    writer.Write()
    last = ORIGIN + STEPS[:, 0] * 12
    for name, *options in (
        ("holes.nii.gz",),
        ("ball.nii.gz", "--mask", "there.nii.gz"),
        ("ball.nii.gz", "--mask", "there.vti"),
        ("holes.nii.gz", "--mask", "there.vti"),
        ("padded.nii.gz", "--missing", -999),
        ("padded.nii.gz", "--missing", 17.5, "--missing", -999, "--mask", "there.nii.gz"),
    ):
        for more in (), ("--threshold", "3%"), ("--error", 1), ("--threshold", "3%", "--indicator", "wavelet"):
            cases += 1
            points = points_of("isosurface", name, *options, "--value", 88, *more)
            if points is None:
                continue
            along = (points - last) @ AXES[:, 0]
            distance = np.linalg.norm(points - CENTRE, axis=1)
            if along.max() > 1e-4 or along.max() < -SPACING[0] or np.abs(distance - 12).max() > 2.5:
                fail(f"{name} {options} {more}: up to {along.max()} beyond the mask, radii {distance.min()} to {distance.max()}")
    whole = points_of("isosurface", "ball.nii.gz", "--value", 88)
    inside = whole[(whole - last) @ AXES[:, 0] < -1e-3]
    part = points_of("isosurface", "holes.nii.gz", "--value", 88)
    cut = part[(part - last) @ AXES[:, 0] < -1e-3]
    if len(inside) != len(cut) or np.abs(np.sort(inside, axis=0) - np.sort(cut, axis=0)).max() > 1e-5:
        fail(f"{len(cut)} vertices beside holes, {len(inside)} of them of the whole ball")
    # Frames hide what is missing in any of them.
    both = np.stack([samples, holes, samples + 2], axis=3)
    nibabel.save(nibabel.Nifti1Image(both, matrix), "frames.nii.gz")
    for time in 0, 0.5, 2:
        cases += 1
        points = points_of("isosurface", "frames.nii.gz", "--value", 88, "--time", time, "--threshold", "3%")
        if points is not None and ((points - last) @ AXES[:, 0]).max() > 1e-4:
            fail(f"at the time {time} there is a surface beyond the mask")
    # Planes.
    plane = ball()[:, :, 10:11].astype(np.float32)
    plane[13:] = np.nan
    nibabel.save(nibabel.Nifti1Image(plane, matrix), "plane.nii.gz")
    for command in ("isosurface", "plane.nii.gz", "--value", 90), ("isolines", "plane.nii.gz", "--count", 4), ("height", "plane.nii.gz", "--scale", 1):
        cases += 1
        points = points_of(*command)
        if points is not None and ((points - last) @ AXES[:, 0]).max() > 1e-4:
            fail(f"{command}: draws what is missing")
    refused("ball.nii.gz", "but ball.nii.gz has 24 x 22 x 20", "--mask", "plane.nii.gz")
    refused("ball.nii.gz", "'none.nii' does not exist", "--mask", "none.nii")
    refused("there.nii.gz", "no sample has a value", "--missing", 0, "--missing", 5)
    refused("labels.nii.gz", "no sample has the value 9", "--label", 9)
    done = program("isosurface", "holes.nii.gz", "--value", 88, "--against-vtk")
    if done.returncode != 1 or "every sample has a value" not in done.stderr:
        fail(f"--against-vtk: {done.stderr}")


def test_analyze():
    global cases
    samples = np.rint(100 * ball(np.eye(3) * 2, np.zeros(3), np.array([22.0, 20.0, 19.0]))).astype(np.int16)
    for kind, name in (
        (nibabel.Nifti1Pair, "pair.img"),
        (nibabel.Nifti1Pair, "packed.img.gz"),
        (nibabel.AnalyzeImage, "analyze.img"),
        (nibabel.Spm99AnalyzeImage, "spm.img"),
    ):
        nibabel.save(kind(samples, np.diag([2.0, 2.0, 2.0, 1.0])), name)
        for ending in ".img", ".hdr":
            cases += 1
            done = program("info", name.replace(".img", ending), "--json")
            facts = json.loads(done.stdout) if done.returncode == 0 else {}
            if [facts.get(key) for key in ("samples", "least_value", "greatest_value")] != [
                list(map(float, SHAPE)), samples.min(), samples.max()
            ]:
                fail(f"{name} {ending}: {done.stdout} {done.stderr}")
    content = open("pair.img", "rb").read()
    with open("pair.img", "wb") as file:
        file.write(content[:-1000])
    refused("pair.hdr", "truncated")
    os.remove("pair.img")
    refused("pair.hdr", "does not exist")
    content = open("packed.img.gz", "rb").read()
    with open("packed.img.gz", "wb") as file:
        file.write(content[:-1000])
    refused("packed.hdr.gz", "cannot be unpacked to its end")
    os.remove("packed.img.gz")
    refused("packed.hdr.gz", "does not exist")
    plain = nibabel.Nifti1Image(samples, np.eye(4))
    nibabel.save(plain, "plain.nii")
    content = bytearray(open("plain.nii", "rb").read())
    for code in 0, 1, 7, 1536, 2048:
        content[70:72] = struct.pack("<h", code)
        with open("code.nii", "wb") as file:
            file.write(content)
        refused("code.nii", f"samples of the type {code}, which is not read")
    content[70:72], content[108:112] = struct.pack("<h", 4), struct.pack("<f", 0)
    with open("start.nii", "wb") as file:
        file.write(content)
    refused("start.nii", "inside its header")


def volume_of(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return abs(np.einsum("ij,ij->i", a - points.mean(axis=0), np.cross(b - a, c - a)).sum()) / 6


def gltf_of(path):
    """Points, triangles, what is told of them, and whether there are normals, by the definition of glTF."""
    document = json.load(open(path))

    def array(number):
        accessor = document["accessors"][number]
        view = document["bufferViews"][accessor["bufferView"]]
        content = base64.b64decode(document["buffers"][view["buffer"]]["uri"].split(",", 1)[1])
        size = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
        kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.frombuffer(content, kind, accessor["count"] * size, start).reshape(-1, size)

    root = document["nodes"][document["scenes"][document["scene"]]["nodes"][0]]
    part = document["meshes"][0]["primitives"][0]
    points = array(part["attributes"]["POSITION"]).astype(float) + root.get("translation", [0, 0, 0])
    return points, array(part["indices"]).reshape(-1, 3), root.get("extras", {}), "NORMAL" in part["attributes"]


def test_written():
    """Far from the origin, files keep the surface that is told, or say what they do to it."""
    global cases
    steps, origin = np.eye(3) * 0.01, np.array([500000.0, -300000.0, 12.0])
    centre = origin + steps @ [11.3, 10.2, 9.6]
    samples = 100 - 100 * (100 - ball(steps, origin, centre))
    header = "NRRD0004\ntype: double\ndimension: 3\nsizes: %d %d %d\nspace: RAS\n" % SHAPE
    header += 'space units: "mm" "mm" "mm"\n'
    header += "space directions: (0.01,0,0) (0,0.01,0) (0,0,0.01)\nspace origin: (500000,-300000,12)\n"
    with open("far.nrrd", "wb") as file:
        file.write((header + "endian: little\nencoding: raw\n\n").encode() + samples.astype("<f8").tobytes("F"))
    for ending in ".ply", ".vtp", ".obj", ".stl", ".gltf":
        cases += 1
        done = program("isosurface", "far.nrrd", "--value", "93", "-o", "far" + ending, "--json")
        if done.returncode != 0:
            fail(f"far{ending}: {done.stderr}")
            continue
        told = json.loads(done.stdout)
        moved = "they move by up to" in " ".join(told["notes"])
        if moved != (ending == ".stl"):
            fail(f"far{ending}: {told['notes']}")
        if ending != ".stl":
            if ending == ".gltf":
                points, triangles, known, has_normals = gltf_of("far.gltf")
                if known != {"space": "RAS", "length_unit": "mm", "value": 93} or not has_normals:
                    fail(f"far.gltf: tells {known}, normals {has_normals}")
            elif ending == ".vtp":
                reader = vtkXMLPolyDataReader()
                reader.SetFileName("far.vtp")
                reader.Update()
                surface = reader.GetOutput()
                points = vtk_to_numpy(surface.GetPoints().GetData())
                triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
            else:
                mesh = meshio.read("far" + ending)
                points, triangles = mesh.points, mesh.cells_dict["triangle"]
                if ending == ".ply" and b"comment space RAS" not in open("far.ply", "rb").read(400):
                    fail("far.ply: does not tell its space")
                if ending == ".ply" and not {"nx", "ny", "nz"} <= set(mesh.point_data):
                    fail(f"far.ply: has {list(mesh.point_data)}, no normals")
            volume = told["surfaces"][0]["volume"]
            if abs(volume_of(points, triangles) - volume) > 1e-6 * volume:
                fail(f"far{ending}: volume {volume_of(points, triangles)}, told {volume}")
    cases += 1
    done = program("slice", "far.nrrd", "--axis", "z", "--at", "12.09", "-o", "slice.ply")
    mesh = meshio.read("slice.ply") if done.returncode == 0 else None
    if mesh is None or "value" not in mesh.point_data:
        fail(f"slice.ply: {done.stderr} {mesh and list(mesh.point_data)}")
    elif abs(mesh.point_data["value"] - (100 - 100 * np.linalg.norm(mesh.points - centre, axis=1))).max() > 0.6:
        fail("slice.ply: values are not those of the field")
    # Close to the origin, single precision is enough.
    near = header.replace("500000,-300000,12", "0,0,0")
    with open("near.nrrd", "wb") as file:
        file.write((near + "endian: little\nencoding: raw\n\n").encode() + samples.astype("<f8").tobytes("F"))
    done = program("isosurface", "near.nrrd", "--value", "93", "-o", "near.ply")
    if b"property float x" not in open("near.ply", "rb").read(400):
        fail(f"near.ply: {done.stderr}")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for test in (test_dicom, test_spaces, test_planes, test_pictures, test_frames, test_labels, test_holes, test_analyze, test_written):
        test()
    os.chdir("/")
print(f"{cases} files and choices, {failures} failures")
sys.exit(1 if failures else 0)
