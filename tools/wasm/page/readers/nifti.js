// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// NIfTI-1 in one file, .nii or .nii.gz: the first volume of those in the file, as it is stored, not
// scaled.
import { ByteStream } from './byte_stream.js';
import {
  FileError,
  alongAxes,
  bytesOfType,
  checkFound,
  checkedBytes,
  geometryOfSteps,
  printable,
  swapBytes,
} from './volume.js';

const headerBytes = 348;

const types = {
  2: 'uint8',
  4: 'int16',
  8: 'int32',
  16: 'float32',
  64: 'float64',
  256: 'int8',
  512: 'uint16',
  768: 'uint32',
  1024: 'int64',
  1280: 'uint64',
};

/** The steps along i, j and k that the quaternion of a header gives, and its origin. */
function quaternionFrame(header, spacing, handedness) {
  const [b, c, d] = [256, 260, 264].map((at) => header.getFloat32(at));
  const a = Math.sqrt(Math.max(0, 1 - b * b - c * c - d * d));
  const columns = [
    [a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)],
    [2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)],
    [2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c],
  ];
  const signs = [1, 1, handedness];
  return {
    steps: columns.map((column, axis) => column.map((x) => x * spacing[axis] * signs[axis])),
    origin: [268, 272, 276].map((at) => header.getFloat32(at)),
  };
}

function geometryOf(header) {
  const spacing = [80, 84, 88].map((at) => Math.abs(header.getFloat32(at)) || 1);
  const hasMatrix = header.getInt16(254) > 0;
  const hasQuaternion = header.getInt16(252) > 0;
  if (!hasMatrix && !hasQuaternion) return { spacing, origin: [0, 0, 0], direction: alongAxes };
  if (!hasMatrix) {
    const handedness = header.getFloat32(76) < 0 ? -1 : 1;
    const { steps, origin } = quaternionFrame(header, spacing, handedness);
    return { ...geometryOfSteps(steps), origin };
  }
  const row = (r, c) => header.getFloat32(280 + 16 * r + 4 * c);
  const steps = [0, 1, 2].map((axis) => [row(0, axis), row(1, axis), row(2, axis)]);
  return { ...geometryOfSteps(steps), origin: [row(0, 3), row(1, 3), row(2, 3)] };
}

/** The numbers of a header, in the order of bytes in which it was written. */
class Header {
  #view;
  constructor(bytes) {
    this.#view = new DataView(bytes.buffer);
    const dimensions = this.#view.getInt16(40, true);
    this.littleEndian = dimensions >= 1 && dimensions <= 7;
  }
  getInt16(at) {
    return this.#view.getInt16(at, this.littleEndian);
  }
  getInt32(at) {
    return this.#view.getInt32(at, this.littleEndian);
  }
  getFloat32(at) {
    return this.#view.getFloat32(at, this.littleEndian);
  }
  getByte(at) {
    return this.#view.getUint8(at);
  }
  /** The text that ends with the first 0, or has so many bytes. */
  text(at, count) {
    const bytes = new Uint8Array(this.#view.buffer, at, count);
    const end = bytes.indexOf(0);
    return new TextDecoder().decode(end < 0 ? bytes : bytes.subarray(0, end));
  }
  get magic() {
    return this.#view.getUint32(344, false);
  }
}

/** Of xyzt_units. */
const lengthUnits = { 1: 'm', 2: 'mm', 3: 'µm' };

function samplesOf(name, header) {
  const dimensions = header.getInt16(40);
  if (dimensions < 1 || dimensions > 7) throw new FileError(`${name} has ${dimensions} dimensions`);
  const along = (d) => (d <= dimensions ? header.getInt16(40 + 2 * d) : 1);
  if (along(4) > 1) {
    throw new FileError(
      `${name} has ${along(4)} volumes, one after the other: give each in a file of its own`,
    );
  }
  const numbers = along(5) * along(6) * along(7);
  if (numbers > 1) throw new FileError(`${name} has ${numbers} numbers per sample, not one`);
  return [1, 2, 3].map(along);
}

export async function openNifti(file) {
  const { name } = file;
  const packing = name.toLowerCase().endsWith('.gz') ? 'gzip' : null;
  const stream = new ByteStream(name, file, packing);
  const header = new Header(await stream.take(headerBytes));
  if (header.getInt32(0) !== headerBytes || header.magic !== 0x6e2b3100) {
    stream.close();
    throw new FileError(`${name} is no NIfTI-1 file with its samples inside`);
  }
  const type = types[header.getInt16(70)];
  if (!type)
    throw new FileError(
      `${name} has samples of the type ${header.getInt16(70)}, which is not read`,
    );
  const samples = samplesOf(name, header);
  const bytes = checkedBytes(name, samples, type);
  const start = header.getFloat32(108);
  if (!(start >= headerBytes && start < 2 ** 24 && Number.isInteger(start))) {
    throw new FileError(`${name} is damaged: its samples are said to begin at byte ${start}`);
  }
  checkFound(name, file.size - (packing ? 0 : start), bytes, packing !== null);
  return {
    type,
    samples,
    ...geometryOf(header),
    name: printable(header.text(328, 16)),
    lengthUnit: lengthUnits[header.getByte(123) & 7],
    bytes,
    async read(target) {
      await stream.skip(start - headerBytes);
      await stream.fill(target);
      await stream.finish();
      if (!header.littleEndian) swapBytes(target, bytesOfType[type]);
    },
  };
}
