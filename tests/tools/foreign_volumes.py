# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Volumes that nibabel, teem's unu, ITK and VTK write, for tests that judge how they are read.

The samples are those of a ball, 100 - |p - CENTRE|, at the places that the header means: the
isosurface of a value v is a sphere of radius 100 - v around the centre, wherever an axis points.

A judge has three methods, which are called while the files of a case are in the current folder. The
options are those of the program.

    good(name, samples, *options, centre, value, space, unit, note, python)
        the file is read as these samples, and the isosurface of the value is a sphere of radius 12
        around the centre; its space, unit of length and notes are these, a space of None any; python:
        whether the package reads it, too
    range(name, samples, *options)
        the file is read, with the shape and the range of these samples
    refused(name, reason, *options)
        with a sentence that has these words

The second argument of the tests is write_with_itk.
"""

import gzip
import os
import subprocess
import sys
import tempfile

try:
    import nibabel
except ImportError:
    print("skipped: nibabel is missing")
    sys.exit(77)
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from ball import AXES, CENTRE, FLIP, ORIGIN, SHAPE, SPACING, STEPS, affine
from ball import ball as exact_ball

ITK_WRITER = os.path.abspath(sys.argv[2])
UNU = "teem-unu"


def ball(*place, **more):
    """The samples in float32."""
    return exact_ball(*place, **more).astype(np.float32)


# NIfTI


def nifti(name, samples, steps=STEPS, qform=None, sform=1, slope=None, unit=None, kind=nibabel.Nifti1Image, **more):
    image = kind(samples, affine(steps), **more)
    image.set_qform(affine(steps) if qform else None, qform or 0)
    image.set_sform(affine(steps) if sform else None, sform or 0)
    if unit:
        image.header.set_xyzt_units(unit, "sec")
    if slope:
        image.header.set_slope_inter(*slope)
    nibabel.save(image, name)
    return samples_of(name)


def samples_of(name):
    return nibabel.load(name).get_fdata()


def patch(name, source, at, numbers):
    """A copy of a file with other numbers in float32 at a byte."""
    with open(source, "rb") as file:
        content = bytearray(file.read())
    numbers = np.array(numbers, np.float32).tobytes()
    content[at : at + len(numbers)] = numbers
    with open(name, "wb") as file:
        file.write(content)


def nifti_cases(judge):
    plain = ball()
    judge.good("plain.nii", nifti("plain.nii", plain), space="RAS")
    judge.good("packed.nii.gz", nifti("packed.nii.gz", plain, unit="mm"), space="RAS", unit="mm")
    os.rename("packed.nii.gz", "CAPITALS.NII.GZ")
    judge.good("CAPITALS.NII.GZ", plain, space="RAS", unit="mm")
    judge.good("metres.nii", nifti("metres.nii", plain, unit="meter"), space="RAS", unit="m")
    judge.good("microns.nii", nifti("microns.nii", plain, unit="micron"), space="RAS", unit="µm")
    judge.good("qform.nii", nifti("qform.nii", plain, qform=1, sform=None), space="RAS")
    judge.good("both.nii", nifti("both.nii", plain, qform=1, sform=2), space="RAS")
    judge.good("second.nii", nifti("second.nii", plain, kind=nibabel.Nifti2Image), space="RAS")
    sheared = STEPS @ [[1, 0.3, 0], [0, 1, -0.2], [0, 0, 1]]
    centre = ORIGIN + sheared @ [11.3, 10.2, 9.6]
    judge.good("sheared.nii", nifti("sheared.nii", ball(sheared, centre=centre), sheared), centre=centre, space="RAS")
    left = STEPS * [-1, 1, 1]
    centre = ORIGIN + left @ [11.3, 10.2, 9.6]
    for name, codes in ("left_s.nii", (None, 1)), ("left_q.nii", (1, None)):
        samples = nifti(name, ball(left, centre=centre), left, *codes)
        judge.good(name, samples, centre=centre, space="RAS")
    # Neither form: places are indices times spacings.
    straight = np.diag(SPACING)
    centre = straight @ [11.3, 10.2, 9.6]
    samples = nifti("no_form.nii", ball(straight, np.zeros(3), centre), straight, sform=None)
    judge.good("no_form.nii", samples, centre=centre)

    header = nibabel.Nifti1Header(endianness=">")
    judge.good("big_endian.nii", nifti("big_endian.nii", plain, header=header), space="RAS")
    for kind in "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8":
        name = f"type_{kind}.nii"
        samples = nifti(name, np.rint(plain).astype(kind), dtype=kind)
        judge.range(name, samples)

    header = nibabel.Nifti2Header(endianness=">")
    big_second = nifti("big_second.nii.gz", plain, kind=nibabel.Nifti2Image, header=header)
    judge.good("big_second.nii.gz", big_second, space="RAS")
    image = nibabel.load("plain.nii")
    image.header.extensions.append(nibabel.nifti1.Nifti1Extension("comment", b"between header and samples"))
    nibabel.save(image, "extended.nii")
    judge.good("extended.nii", plain, space="RAS")

    # Spacings with a sign, without a number, or of 0, which is 1 unless axes say more.
    for name, source, spacings in [
        ("negative_s.nii", "plain.nii", (1, -1.5, 2, 2.5)),
        ("zero_s.nii", "plain.nii", (1, 0, 2, 2.5)),
        ("qfac_0.nii", "qform.nii", (0, 1.5, 2, 2.5)),
    ]:
        patch(name, source, 76, spacings)
        judge.good(name, plain, space="RAS", python=min(spacings) >= 0)
    for name, spacings, signs in ("negative_q.nii", (1, 1.5, -2, 2.5), (1, -1, 1)), ("qfac.nii", (-1, 1.5, 2, 2.5), (1, 1, -1)):
        patch(name, "qform.nii", 76, spacings)
        judge.good(name, plain, centre=ORIGIN + STEPS * signs @ [11.3, 10.2, 9.6], space="RAS", python=name == "qfac.nii")
    patch("negative.nii", "no_form.nii", 76, (1, 1.5, -2, 2.5))
    centre = straight * [1, -1, 1] @ [11.3, 10.2, 9.6]
    judge.good("negative.nii", samples_of("no_form.nii"), centre=centre, python=False)
    for source in "plain.nii", "qform.nii", "no_form.nii":
        patch("no_number.nii", source, 76, (1, np.nan, 2, 2.5))
        judge.refused("no_number.nii", "cannot be read: spacing, direction or origin of the lattice is flat or not finite")

    # Values are slope times number plus intercept.
    for name, kind, slope, intercept in [
        ("slope_i2.nii.gz", "i2", 1 / 64, 0),
        ("slope_u1.nii", "u1", 0.5, -20),
        ("slope_negative.nii", "i2", -1 / 64, 70),
        ("slope_i4.nii", "i4", 1e-6, 3),
        ("slope_far.nii", "i2", 1 / 64, 1e7),
        ("slope_f4.nii", "f4", 2, 50),
        ("intercept.nii", "f4", 1, -1000),
    ]:
        value = 88
        wanted = plain.astype(float)
        if name == "slope_far.nii":
            wanted, value = wanted + 1e7, 1e7 + 88
        numbers = (wanted - intercept) / slope
        numbers = numbers.astype(kind) if kind == "f4" else np.rint(numbers).astype(kind)
        samples = nifti(name, numbers, slope=(slope, intercept))
        judge.good(name, samples, value=value, space="RAS")
    image = nibabel.load("slope_u1.nii")
    patch("slope_zero.nii", "slope_u1.nii", 112, [0])
    judge.good("slope_zero.nii", np.asarray(image.dataobj.get_unscaled()), value=216, space="RAS")
    patch("slope_nan.nii", "slope_u1.nii", 112, [2, np.nan])
    judge.refused("slope_nan.nii", "scl_inter")

    frames = np.stack([plain, plain + 10, 2 * plain], axis=3)
    for name in "time.nii", "time.nii.gz":
        nifti(name, frames)
        judge.good(name, frames[..., 0], space="RAS", note=f"frame 0 of the 3 in {name} is read")
        judge.good(name, frames[..., 1], "--frame", 1, value=98, space="RAS", note="frame 1 of the 3")
        judge.good(name, frames[..., 2], "--frame", 2, value=176, space="RAS", note="frame 2 of the 3")
    judge.refused("time.nii", "no frame 3", "--frame", 3)
    judge.refused("time.nii", "no frame -1", "--frame", -1)
    judge.refused("plain.nii", "one frame only", "--frame", 0)
    judge.refused("plain.nii", "one number per sample", "--magnitude")
    scaled = nifti("time_slope.nii", np.rint(frames * 50).astype("i2"), slope=(0.02, 0))
    judge.good("time_slope.nii", scaled[..., 1], "--frame", 1, value=98, space="RAS", note="frame 1 of the 3")
    one_frame = nifti("one_frame.nii", plain[..., None])
    judge.good("one_frame.nii", one_frame[..., 0], space="RAS")
    vectors = np.stack([plain, 2 * plain, -2 * plain], axis=3)[:, :, :, None, :]
    nifti("vector.nii.gz", vectors)
    judge.refused("vector.nii.gz", "3 numbers per sample, not one: choose by --component 0 to 2, or by --magnitude")
    judge.good("vector.nii.gz", vectors[..., 0, 2], "--component", 2, value=-176, space="RAS")
    judge.good("vector.nii.gz", 3 * plain, "--magnitude", value=264, space="RAS")
    judge.refused("vector.nii.gz", "no component 3", "--component", 3)
    both = vectors * np.array([1, 3])[:, None]
    nifti("vector_time.nii", both.astype("f4"))
    judge.good("vector_time.nii", both[..., 1, 1], "--component", 1, "--frame", 1, value=528, space="RAS", note="frame 1 of the 2")
    colours = np.zeros(SHAPE, [("R", "u1"), ("G", "u1"), ("B", "u1")])
    colours["G"] = np.rint(2 * plain)
    nibabel.save(nibabel.Nifti1Image(colours, affine()), "colours.nii")
    judge.refused("colours.nii", "3 numbers per sample")
    judge.good("colours.nii", colours["G"], "--component", 1, value=176, space="RAS")
    waves = np.ones(SHAPE, np.complex64) * (plain * (0.6 + 0.8j))
    nibabel.save(nibabel.Nifti1Image(waves.astype(np.complex64), affine()), "waves.nii")
    judge.refused("waves.nii", "2 numbers per sample")
    judge.good("waves.nii", plain, "--magnitude", space="RAS")
    # Slices are reversed where axes are left-handed, also where samples have more than a number.
    centre = ORIGIN + left @ [11.3, 10.2, 9.6]
    samples = ball(left, centre=centre)
    nifti("left_vector.nii", np.stack([samples, 2 * samples], axis=3)[:, :, :, None, :], left)
    judge.good("left_vector.nii", 2 * samples, "--component", 1, value=176, centre=centre, space="RAS")
    nifti("left_time.nii.gz", np.stack([samples, samples + 10], axis=3), left, 1, None)
    judge.good("left_time.nii.gz", samples + 10, "--frame", 1, value=98, centre=centre, space="RAS", note="frame 1 of the 2")
    hole = plain.copy()
    hole[3, 4, 5] = np.nan
    nifti("hole.nii", hole)
    judge.good("hole.nii", hole, space="RAS", note="1 of 10560 samples have no value")
    hole[3, 4, 5] = np.inf
    nifti("infinite.nii", hole)
    judge.refused("infinite.nii", "sample at (3, 4, 5) is infinite")
    nifti("nothing.nii", np.full_like(hole, np.nan))
    judge.refused("nothing.nii", "no sample has a value")


# NRRD


def vector(numbers):
    return "(" + ",".join(repr(float(each)) for each in numbers) + ")"


def directions(steps=STEPS):
    return " ".join(vector(steps[:, d]) for d in range(3))


def raw(name, samples):
    """Samples with the first index fastest."""
    np.asarray(samples).T.tofile(name)


def unu(*arguments):
    subprocess.run([UNU, *map(str, arguments)], check=True, capture_output=True)


def make(name, samples, *options, kind="float", encoding="raw"):
    raw("samples.raw", samples)
    unu("make", "-i", "samples.raw", "-t", kind, "-s", *samples.shape, *options, "-o", "made.nrrd")
    unu("save", "-f", "nrrd", "-e", encoding, "-i", "made.nrrd", "-o", name)


PLACE = ["-orig", vector(ORIGIN), "-dirs", directions()]
LPS = ["-spc", "LPS", *PLACE]


def nrrd_cases(judge):
    plain = ball()
    for encoding in "raw", "gzip", "ascii", "hex":
        for ending in "nrrd", "nhdr":
            name = f"{encoding}.{ending}"
            make(name, plain, *LPS, encoding=encoding)
            judge.good(name, plain, space="LPS")
    make("mm.nhdr", plain, *LPS, "-spu", "mm", "mm", "mm", "-c", "a ball")
    judge.good("mm.nhdr", plain, space="LPS", unit="mm")
    for space in "RAS", "LAS", "scanner-xyz":
        make(f"{space}.nrrd", plain, "-spc", space, *PLACE)
        judge.good(f"{space}.nrrd", plain, space=space)
    make("space_3.nrrd", plain, "-spc", 3, *PLACE)
    judge.good("space_3.nrrd", plain)
    raw("swapped.raw", plain.astype(">f4"))
    unu("make", "-h", "-i", "swapped.raw", "-t", "float", "-en", "big", "-s", *SHAPE, *LPS, "-o", "big.nhdr")
    judge.good("big.nhdr", plain, space="LPS")
    for kind, name in ("short", "i2"), ("uchar", "u1"), ("uint", "u4"), ("longlong", "i8"), ("double", "f8"):
        samples = np.rint(plain).astype(name)
        make(f"{kind}.nrrd", samples, *LPS, kind=kind)
        judge.range(f"{kind}.nrrd", samples)
    # Slices of a volume in files of their own, and slabs.
    for k in range(SHAPE[2]):
        raw(f"slice{k:02}.raw", plain[:, :, k])
    for k in range(2):
        raw(f"slab{k}.raw", plain[:, :, 10 * k : 10 * k + 10])
    unu("make", "-h", "-i", "slice%02d.raw", 0, SHAPE[2] - 1, 1, "-t", "float", "-s", *SHAPE, *LPS, "-o", "slices.nhdr")
    judge.good("slices.nhdr", plain, space="LPS")
    unu("make", "-h", "-i", "slab0.raw", "slab1.raw", "-fd", 3, "-t", "float", "-s", *SHAPE, *LPS, "-o", "slabs.nhdr")
    judge.good("slabs.nhdr", plain, space="LPS")

    # No space: spacings; or minima and maxima, of samples or of cells.
    straight = np.diag(SPACING)
    centre = straight @ [11.3, 10.2, 9.6]
    there = ball(straight, np.zeros(3), centre)
    make("spacings.nrrd", there, "-sp", *SPACING)
    judge.good("spacings.nrrd", there, centre=centre)
    low = np.array([3.0, -4.0, 5.0])
    for centring, shift, count in ("node", 0, np.array(SHAPE) - 1), ("cell", 0.5, np.array(SHAPE)):
        high = low + SPACING * count
        for given in "minmax", "min":
            name = f"{centring}_{given}.nrrd"
            make("place.nrrd", there, *(["-sp", *SPACING] if given == "min" else []), "-cn", *[centring] * 3)
            unu("axinfo", "-i", "place.nrrd", "-a", 0, "-mm", low[0], high[0], "-o", "place.nrrd")
            unu("axinfo", "-i", "place.nrrd", "-a", 1, "-mm", low[1], high[1], "-o", "place.nrrd")
            unu("axinfo", "-i", "place.nrrd", "-a", 2, "-mm", low[2], high[2], "-o", name)
            judge.good(name, there, centre=centre + low + shift * SPACING)

    # Axes that are none of space.
    colours = np.rint(np.stack([plain, 2 * plain, 0.5 * plain])).astype("u1")
    for kind in "RGB-color", "3-color", "3-vector", "vector", "covariant-vector":
        name = f"{kind}.nrrd"
        make(name, colours, "-k", kind, "domain", "domain", "domain", "-sp", "nan", *SPACING, kind="uchar")
        judge.refused(name, f"3 numbers per sample ({kind}), not one")
        judge.range(name, colours[1], "--component", 1)
    flat = colours[:, :, :, 0]
    make("flat.nrrd", flat, "-k", "RGB-color", "domain", "domain", kind="uchar")
    judge.refused("flat.nrrd", "sample")
    vectors = np.stack([plain, 2 * plain, -2 * plain])
    space = ["-spc", "LPS", "-orig", vector(ORIGIN)]
    for kind, name in ("3-vector", "vector.nrrd"), ("vector", "vector.nhdr"):
        make(name, vectors, "-k", kind, "space", "space", "space", *space, "-dirs", "none " + directions())
        judge.good(name, 2 * plain, "--component", 1, value=176, space="LPS")
        judge.good(name, 3 * plain, "--magnitude", value=264, space="LPS")
    last = np.moveaxis(vectors, 0, 3)
    make("last.nrrd", last, "-k", "space", "space", "space", "3-vector", *space, "-dirs", directions() + " none")
    judge.good("last.nrrd", 2 * plain, "--component", 1, value=176, space="LPS", python=False)
    four = np.stack([plain, plain + 1, plain + 2, plain + 3])
    make("4-color.nrrd", four, "-k", "4-color", "space", "space", "space", *space, "-dirs", "none " + directions())
    judge.refused("4-color.nrrd", "4 numbers per sample (4-color)")
    judge.good("4-color.nrrd", plain + 2, "--component", 2, value=90, space="LPS")
    for kind in "list", "time":
        name = f"{kind}_last.nrrd"
        make(name, np.moveaxis(four, 0, 3), "-k", "space", "space", "space", kind, *space, "-dirs", directions() + " none")
        judge.good(name, plain, space="LPS", note=f"frame 0 of the 4 in {name} is read")
        judge.good(name, plain + 3, "--frame", 3, value=91, space="LPS", note="frame 3 of the 4")
    make("list_first.nrrd", four, "-k", "list", "space", "space", "space", *space, "-dirs", "none " + directions())
    judge.good("list_first.nrrd", plain + 1, "--frame", 1, value=89, space="LPS", note="frame 1 of the 4", python=False)
    judge.good("list_first.nrrd", plain + 1, "--component", 1, value=89, space="LPS", python=False)
    # Four axes that say nothing: the last one is none of space.
    make("four.nrrd", np.moveaxis(four, 0, 3), "-sp", *SPACING, 1)
    judge.range("four.nrrd", four[2], "--frame", 2)

    judge.range("four.nrrd", four[0])
    for kind, count in ("RGBA", 4), ("3D-sym-tensor", 6), ("contravariant-vector", 2):
        samples = np.stack([plain * (i + 1) for i in range(count)])
        space = ["-spc", "LPS", *PLACE[:2]]
        make(f"{kind}.nrrd", samples, "-k", kind, "space", "space", "space", *space, "-dirs", "none " + directions())
        judge.good(f"{kind}.nrrd", samples[-1], "--component", count - 1, value=88 * count, space="LPS", python=False)
    # Numbers between those of space.
    between = np.moveaxis(vectors, 0, 1)
    first, *others = directions().split(" ")
    vectors_between = ["-k", "space", "3-vector", "space", "space", "-dirs", " ".join([first, "none", *others])]
    make("between.nrrd", between, *space, *vectors_between)
    judge.good("between.nrrd", vectors[2], "--component", 2, value=-176, space="LPS", python=False)
    judge.good("between.nrrd", 3 * plain, "--magnitude", value=264, space="LPS", python=False)
    # What stands before and behind the samples.
    for name, skips, before, behind in [
        ("bytes.nhdr", "byte skip: 3", b"abc", b""),
        ("end.nhdr", "byte skip: -1", b"abc", b""),
        ("near_end.nhdr", "byte skip: -3", b"abc", b"de"),
        ("lines.nhdr", "line skip: 2\nbyte skip: 1", b"a\nb\nc", b""),
    ]:
        with open("skipped.raw", "wb") as file:
            file.write(before + plain.T.tobytes() + behind)
        with open("raw.nrrd", "rb") as file:
            header = file.read().split(b"\n\n")[0].decode()
        with open(name, "w") as file:
            file.write(f"{header}\n{skips}\ndata file: ./skipped.raw\n")
        judge.good(name, plain, space="LPS", python=False)

    for before, after, reason in [
        (b"(-7,31", b"(x,31", "parsed 0 values, but space dimension is 3"),
        (b"sizes: 24 22 20", b"sizes: 24 22", "parsed 2 values, but dimension is 3"),
        (b"sizes: 24 22 20", b"sizes: 24 22 two", "axis 2 size is zero"),
        (b"encoding: raw", b"encoding: row", "encoding"),
    ]:
        with open("raw.nrrd", "rb") as file:
            content = file.read()
        assert before in content, f"raw.nrrd has no {before}"
        with open("wrong.nrrd", "wb") as file:
            file.write(content.replace(before, after))
        judge.refused("wrong.nrrd", reason)


# ITK's writers


def itk(name, samples, packed=False, components=1, axes=AXES, spacing=SPACING, origin=ORIGIN):
    shape = samples.shape[1:] if components > 1 else samples.shape
    raw("samples.raw", samples)
    lists = (shape, spacing, origin, np.asarray(axes).T.ravel())
    kind = "short" if samples.dtype == np.int16 else "float"
    how = [components, "packed" if packed else "plain"]
    texts = [" ".join(repr(float(each)) for each in one) for one in lists]
    subprocess.run([ITK_WRITER, name, "samples.raw", kind, *map(str, how), *texts], check=True)


def itk_cases(judge):
    plain = ball()
    for ending, space in ("mha", None), ("mhd", None), ("nrrd", "LPS"), ("nhdr", "LPS"):
        for packed in False, True:
            name = f"itk_{packed}.{ending}"
            itk(name, plain, packed)
            judge.good(name, plain, space=space)
    for name in "itk.nii", "itk.nii.gz":
        itk(name, plain)
        judge.good(name, plain, space="RAS", unit="mm", centre=CENTRE * FLIP)
    axes = np.eye(4)
    axes[:3, :3] = AXES
    four = np.stack([plain, plain + 5, plain + 10], axis=3)
    place = dict(axes=axes, spacing=[*SPACING, 1], origin=[*ORIGIN, 0])
    for name in "itk_four.mha", "itk_four.mhd":
        itk(name, four, **place)
        judge.good(name, plain, space=None, note=f"frame 0 of the 3 in {name} is read")
        judge.good(name, plain + 10, "--frame", 2, value=98, space=None, note="frame 2 of the 3")
    itk("itk_one.mha", four[..., :1].copy(), **place)
    judge.good("itk_one.mha", plain, space=None)
    vectors = np.stack([plain, 2 * plain, -2 * plain])
    for name in "itk_vector.mha", "itk_vector.nrrd":
        itk(name, vectors, components=3, packed=True)
        judge.refused(name, "3 numbers per sample")
        judge.good(name, -2 * plain, "--component", 2, value=-176, space=None)
        judge.good(name, 3 * plain, "--magnitude", value=264, space=None)
    with open("itk_False.mha", "rb") as file:
        content = file.read()
    for before, after, reason in [
        (b"ElementSpacing = 1.5 2 2.5", b"ElementSpacing = 1.5 two 2.5", "'two' is no number"),
        (b"ElementSpacing = 1.5 2 2.5", b"ElementSpacing = 1.5 2", "not 3 numbers"),
        (b"ElementSpacing = 1.5 2 2.5", b"ElementSpacing = 1.5 nan 2.5", "not finite"),
        (b"ElementSpacing = 1.5 2 2.5", b"ElementSpacing = 1.5 0 2.5", "flat"),
        (b"DimSize = 24 22 20", b"DimSize = 24 22", "3 dimensions"),
        (b"NDims = 3", b"NDims = 4", "4 dimensions"),
        (b"MET_FLOAT", b"MET_FLOOT", "sample type 'MET_FLOOT'"),
    ]:
        assert before in content, f"itk_False.mha has no {before}"
        with open("wrong.mha", "wb") as file:
            file.write(content.replace(before, after))
        judge.refused("wrong.mha", reason)
    # Headers that others write.
    header = content.split(b"ElementDataFile")[0].decode()
    samples = plain.T.tobytes()
    texts = " ".join(map(repr, map(float, plain.T.ravel()))).encode()
    for name, fields, behind in [
        ("text.mha", {"BinaryData": "False"}, texts),
        ("big.mha", {"BinaryDataByteOrderMSB": "True"}, plain.astype(">f4").T.tobytes()),
        ("gzip.mha", {"CompressedData": "True"}, gzip.compress(samples)),
        ("mm.mha", {"DistanceUnits": "mm", "AnatomicalOrientation": "RAI"}, samples),
    ]:
        lines = [line for line in header.splitlines() if line.split(" =")[0] not in fields]
        lines += [f"{key} = {value}" for key, value in fields.items()] + ["ElementDataFile = LOCAL", ""]
        with open(name, "wb") as file:
            file.write("\n".join(lines).encode() + behind)
        judge.good(name, plain, space=None, unit=fields.get("DistanceUnits", ""))
    with open("skipped.raw", "wb") as file:
        file.write(b"abc" + samples)
    for name, fields in [
        ("behind.mhd", "HeaderSize = -1\nElementDataFile = skipped.raw"),
        ("pattern.mhd", f"ElementDataFile = slice%02d.raw 0 {SHAPE[2] - 1} 1"),
        ("list.mhd", "ElementDataFile = LIST\nslab0.raw\nslab1.raw"),
    ]:
        with open(name, "w") as file:
            file.write(header + fields + "\n")
        judge.good(name, plain, space=None)
    slope = b"ElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = 7\nElementType"
    with open("slope.mha", "wb") as file:
        file.write(content.replace(b"ElementType", slope))
    judge.good("slope.mha", 2 * plain + 7, value=183, space=None)


# VTK's writer


def vti(name, cells=(), points=(), shape=SHAPE, active=None, start=(0, 0, 0), mode=vtkXMLImageDataWriter.Appended):
    image = vtkImageData()
    image.SetExtent([end for first, n in zip(start, shape) for end in (first, first + n - 1)])
    image.SetSpacing(SPACING)
    image.SetOrigin(ORIGIN)
    image.SetDirectionMatrix(*AXES.ravel())
    for data, arrays in (image.GetPointData(), points), (image.GetCellData(), cells):
        for title, samples in arrays:
            flat = samples.ravel("F") if samples.ndim == 3 else samples.reshape(-1, samples.shape[3], order="F")
            array = numpy_to_vtk(flat, deep=True)
            array.SetName(title)
            data.AddArray(array)
        if active and data.HasArray(active):
            data.SetActiveScalars(active)
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    writer.SetFileName(name)
    writer.SetDataMode(mode)
    writer.Write()


def vti_cases(judge):
    plain = ball()
    vti("one.vti", points=[("heat", plain)])
    judge.good("one.vti", plain)
    vti("two.vti", points=[("heat", plain), ("cold", -plain)])
    judge.refused("two.vti", "several arrays, choose one by --array: 'heat', 'cold'")
    judge.good("two.vti", -plain, "--array", "cold", value=-88)
    vti("active.vti", points=[("heat", plain), ("cold", -plain)], active="cold")
    judge.good("active.vti", -plain, value=-88)
    centres = ball(origin=ORIGIN + STEPS @ [0.5, 0.5, 0.5])
    vti("cells.vti", cells=[("heat", centres)], shape=np.array(SHAPE) + 1)
    judge.good("cells.vti", centres, note="the cell data of cells.vti are taken at the centres of the cells")
    vti("cells_two.vti", cells=[("heat", centres), ("cold", -centres)], shape=np.array(SHAPE) + 1)
    judge.refused("cells_two.vti", "several arrays, choose one by --array: 'heat', 'cold'")
    judge.good("cells_two.vti", -centres, "--array", "cold", value=-88, note="cell data")
    # Points go before cells.
    vti("both.vti", cells=[("cold", -centres)], points=[("heat", ball(shape=np.array(SHAPE) + 1))], shape=np.array(SHAPE) + 1)
    judge.range("both.vti", ball(shape=np.array(SHAPE) + 1))
    judge.good("both.vti", -centres, "--array", "cold", value=-88, note="cell data")
    judge.refused("both.vti", "has no point data array 'mild', only 'heat', 'cold'", "--array", "mild")
    start = np.array([3, -4, 5])
    vectors = np.stack([plain, 2 * plain, -2 * plain], axis=3)
    for mode in "Appended", "Binary", "Ascii":
        name = f"{mode}.vti"
        vti(name, points=[("heat", vectors)], start=start, mode=getattr(vtkXMLImageDataWriter, mode))
        judge.refused(name, "3 numbers per sample")
        judge.good(name, 2 * plain, "--component", 1, value=176, centre=CENTRE + STEPS @ start)
        judge.good(name, 3 * plain, "--magnitude", value=264, centre=CENTRE + STEPS @ start)
    vti("none.vti")
    judge.refused("none.vti", "neither point nor cell data")


def judge_all(judge):
    """Makes all files, in a folder that goes, and has each case judged."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for each in nifti_cases, nrrd_cases, itk_cases, vti_cases:
            each(judge)
        os.chdir("/")
