// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// NIfTI-1 and NIfTI-2 in one file, .nii or .nii.gz. Takes headers as VTK's reader and
// tools/input/nifti_file.cpp do, where all fields are listed.
import { ByteStream, packingOf } from './byte_stream.js';
import { payloadReader } from './payload.js';
import {
  FileError,
  alongAxes,
  checkedBytes,
  countedNumbers,
  plainFile,
  printable,
} from './volume.js';

/** Types, and how many of their numbers a sample has: two of complex ones, more of colours. */
const types = {
  2: ['uint8', 1],
  4: ['int16', 1],
  8: ['int32', 1],
  16: ['float32', 1],
  32: ['float32', 2],
  64: ['float64', 1],
  128: ['uint8', 3],
  256: ['int8', 1],
  512: ['uint16', 1],
  768: ['uint32', 1],
  1024: ['int64', 1],
  1280: ['uint64', 1],
  1792: ['float64', 2],
  2304: ['uint8', 4],
};

/** Of xyzt_units. */
const lengthUnits = { 1: 'm', 2: 'mm', 3: 'µm' };

/** Where the fields of both versions are, and the types of their numbers. */
const versions = {
  348: {
    magicAt: 344,
    magic: 0x6e2b3100,
    dim: [40, 'Int16', 2],
    datatype: [70, 'Int16'],
    pixdim: [76, 'Float32', 4],
    voxOffset: [108, 'Float32'],
    slope: [112, 'Float32'],
    intercept: [116, 'Float32'],
    units: 123,
    qformCode: [252, 'Int16'],
    sformCode: [254, 'Int16'],
    quatern: [256, 'Float32', 4],
    srow: [280, 'Float32', 4],
    intentName: 328,
  },
  540: {
    magicAt: 4,
    magic: 0x6e2b3200,
    dim: [16, 'BigInt64', 8],
    datatype: [12, 'Int16'],
    pixdim: [104, 'Float64', 8],
    voxOffset: [168, 'BigInt64'],
    slope: [176, 'Float64'],
    intercept: [184, 'Float64'],
    units: 500,
    qformCode: [344, 'Int32'],
    sformCode: [348, 'Int32'],
    quatern: [352, 'Float64', 8],
    srow: [400, 'Float64', 8],
    intentName: 508,
  },
};

/** The fields of a header, in the order of bytes in which it was written. */
class Header {
  #view;
  #version;

  /** null where it is none */
  static of(bytes) {
    const view = new DataView(bytes.buffer);
    for (const littleEndian of [true, false]) {
      const size = view.getInt32(0, littleEndian);
      const version = Object.hasOwn(versions, size) ? versions[size] : null;
      if (version && view.getUint32(version.magicAt) === version.magic) {
        return Object.assign(new Header(view, version), { size, littleEndian });
      }
    }
    return null;
  }

  constructor(view, version) {
    this.#view = view;
    this.#version = version;
  }

  get units() {
    return this.#view.getUint8(this.#version.units);
  }
  /** Ends with the first 0. */
  get intentName() {
    const bytes = new Uint8Array(this.#view.buffer, this.#version.intentName, 16);
    const end = bytes.indexOf(0);
    return new TextDecoder().decode(end < 0 ? bytes : bytes.subarray(0, end));
  }

  /** Number i of a field. */
  number(field, i = 0) {
    const [at, type, bytes = 0] = this.#version[field];
    return Number(this.#view[`get${type}`](at + i * bytes, this.littleEndian));
  }
}

async function readHeader(name, stream) {
  const most = 540;
  const bytes = new Uint8Array(most);
  await stream.fill(bytes.subarray(0, 348));
  const first = new DataView(bytes.buffer);
  if ([true, false].some((littleEndian) => first.getInt32(0, littleEndian) === most))
    await stream.fill(bytes.subarray(348));
  const header = Header.of(bytes);
  if (header) return header;
  throw new FileError(`${name} is no NIfTI file with its samples inside`);
}

/** The rotation of a quaternion, by rows. */
function rotationOf(header) {
  const [b, c, d] = [0, 1, 2].map((i) => header.number('quatern', i));
  const a = Math.sqrt(Math.max(0, 1 - b * b - c * c - d * d));
  const square = a * a + b * b + c * c + d * d;
  return [
    [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
    [2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)],
    [2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c],
  ].map((row) => row.map((x) => x / square));
}

const isLeftHanded = ([a, b, c]) =>
  a[0] * (b[1] * c[2] - b[2] * c[1]) -
    a[1] * (b[0] * c[2] - b[2] * c[0]) +
    a[2] * (b[0] * c[1] - b[1] * c[0]) <
  0;

/** The place. Axes that would be left-handed have their slices, of which there are nz, reversed. */
function geometryOf(header, nz) {
  const spacing = [1, 2, 3].map((i) => header.number('pixdim', i)).map((x) => (x === 0 ? 1 : x));
  const hasMatrix = header.number('sformCode') > 0;
  const hasQuaternion = header.number('qformCode') > 0;
  if (!hasMatrix && !hasQuaternion) {
    return { spacing, origin: [0, 0, 0], direction: alongAxes, reversed: false, space: '' };
  }
  const srow = (r, d) => header.number('srow', 4 * r + d);
  const rows = hasMatrix
    ? [0, 1, 2].map((r) => spacing.map((step, d) => srow(r, d) / step))
    : rotationOf(header);
  const reversed = hasQuaternion ? header.number('pixdim', 0) < 0 : isLeftHanded(rows);
  const origin = [0, 1, 2].map((r) => (hasMatrix ? srow(r, 3) : header.number('quatern', 3 + r)));
  if (reversed) {
    // The slices of a quaternion go down from its origin, those of a matrix as this says.
    rows.forEach((row, r) => {
      if (hasMatrix) row[2] = -row[2];
      origin[r] -= row[2] * spacing[2] * (nz - 1);
    });
  }
  return { spacing, origin, direction: rows.flat(), reversed, space: 'RAS' };
}

/** Counts along dimensions 1 to 5. */
function countsOf(name, header) {
  const dimensions = header.number('dim');
  if (dimensions < 1 || dimensions > 7) throw new FileError(`${name} has ${dimensions} dimensions`);
  const along = (d) => (d <= dimensions ? header.number('dim', d) : 1);
  for (const d of [6, 7]) {
    if (along(d) > 1) {
      throw new FileError(
        `${name} has ${along(d)} samples along its dimension ${d}, which is not read`,
      );
    }
  }
  return [1, 2, 3, 4, 5].map((d) => (d > 3 ? Math.max(1, along(d)) : along(d)));
}

/** A slope of 0, or one that is no number, means that the numbers are the values. */
function scaleOf(name, header) {
  const slope = header.number('slope');
  const intercept = header.number('intercept');
  if (!Number.isFinite(slope) || slope === 0) return { slope: 1, intercept: 0 };
  if (Number.isFinite(intercept)) return { slope, intercept };
  throw new FileError(`${name} has a scl_inter that is not a finite number`);
}

/** Frames stand one after the other, and components of dimension 5 behind all of them. */
function stridesOf(name, [nx, ny, nz, nt, nv], ofSample, reversed) {
  if (ofSample > 1 && nv > 1) {
    throw new FileError(
      `${name} has ${nv} colours or complex numbers per sample, which are not read`,
    );
  }
  const slice = ofSample * nx * ny;
  const volume = slice * nz;
  const components =
    ofSample > 1 ? { count: ofSample, stride: 1 } : { count: nv, stride: volume * nt };
  return {
    begin: reversed ? slice * (nz - 1) : 0,
    stride: [ofSample, ofSample * nx, reversed ? -slice : slice],
    components,
    frames: { count: nt, stride: volume },
  };
}

export async function openNifti(file) {
  const { name } = file;
  const packing = await packingOf(file);
  const stream = new ByteStream(name, file, packing);
  const header = await readHeader(name, stream).finally(() => stream.close());
  const known = types[header.number('datatype')];
  if (!known)
    throw new FileError(
      `${name} has samples of the type ${header.number('datatype')}, which is not read`,
    );
  const [type, ofSample] = known;
  const counts = countsOf(name, header);
  const samples = counts.slice(0, 3);
  checkedBytes(name, samples, type);
  const start = header.number('voxOffset');
  if (!(start >= header.size && start < 2 ** 24 && Number.isInteger(start))) {
    throw new FileError(`${name} is damaged: its samples are said to begin at byte ${start}`);
  }
  const { reversed, ...geometry } = geometryOf(header, samples[2]);
  const strides = stridesOf(name, counts, ofSample, reversed);
  const read = payloadReader({
    fileName: name,
    type,
    numbers: countedNumbers(name, ...counts, ofSample),
    parts: [{ name, blob: file }],
    encoding: packing ? 'packed' : 'raw',
    lineSkip: 0,
    byteSkip: start,
    bigEndian: !header.littleEndian,
  });
  return {
    ...plainFile,
    fileName: name,
    type,
    samples,
    ...geometry,
    ...strides,
    ...scaleOf(name, header),
    name: printable(header.intentName),
    lengthUnit: lengthUnits[header.units & 7] ?? '',
    read,
  };
}
