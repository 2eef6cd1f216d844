// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the readers of files have in common. The reader of a format gives the numbers of a *file* and
// what they mean, as FileSamples does in the program (tools/input/file_samples.hpp):
//   fileName
//   type              of the numbers: uint8, int8, ... uint64, int64, float32 or float64
//   samples           three counts, x first
//   spacing, origin, direction   as in LatticeGeometry (lattice.hpp), the direction as nine numbers
//   begin, stride     the number of the first sample, and the steps along x, y and z, in numbers
//   components, frames           { count, stride } of what each place has several of
//   componentKind     such as RGB-color; '' where the file does not say
//   framesAreList     which the file does not say to be times
//   slope, intercept  a value is slope times number plus intercept
//   arrays, array     names of the arrays that may be chosen, and the one that is
//   name              of the field; '' where the file has none
//   lengthUnit        such as mm; '' where the file has none
//   space             such as RAS, where the axes point to; '' where the file does not say
//   note              a sentence on how the file is taken; mostly ''
//   read(target, first)   fills a Uint8Array with the numbers from one on, least byte first
// What is one frame, one number of each sample, of these is a *volume* (chosen_volume.js).
//
// Invariant: what a file says about sizes is compared with its own size before anyone allocates.

/** A file that cannot be read. The message is one sentence. */
export class FileError extends Error {}

export const bytesOfType = {
  uint8: 1,
  int8: 1,
  uint16: 2,
  int16: 2,
  uint32: 4,
  int32: 4,
  uint64: 8,
  int64: 8,
  float32: 4,
  float64: 8,
};

export const arrayOfType = {
  uint8: Uint8Array,
  int8: Int8Array,
  uint16: Uint16Array,
  int16: Int16Array,
  uint32: Uint32Array,
  int32: Int32Array,
  uint64: BigUint64Array,
  int64: BigInt64Array,
  float32: Float32Array,
  float64: Float64Array,
};

/** Numbers of a type in bytes that begin at a multiple of their size. */
export const numbersIn = (bytes, type) =>
  new arrayOfType[type](bytes.buffer, bytes.byteOffset, bytes.length / bytesOfType[type]);

/** Deflate packs at most 1032 to 1. */
const mostPacked = 1032;
/** A page has 4 GB; nodes take 4 bytes, and one block of memory has at most 2 GB. */
const mostMemory = 3.5 * 2 ** 30;
const mostInOneBlock = 2 ** 31 - 2 ** 20;

const mostAlong = 2 ** 20;

/** What a file says, for a message: short, and without what cannot be printed. */
export function quoted(text) {
  const short = (text ?? '').slice(0, 40).replace(/[^ -~]/g, '?');
  return `'${short}${(text ?? '').length > 40 ? '...' : ''}'`;
}

/** A text that a file gives, cut short, without what cannot be printed. */
export function printable(text) {
  return text.slice(0, 63).replace(/[\0-\x1f\x7f]/g, '?');
}

/**
 * The bytes of samples. Throws where no volume has them, and where memory does not suffice for them
 * and so many bytes beside them.
 */
export function checkedBytes(name, samples, type, beside = 0) {
  for (const n of samples) {
    if (!Number.isInteger(n) || n < 2 || n > mostAlong) {
      throw new FileError(
        `${name} has ${samples.join(' x ')} samples; ` +
          'an isosurface needs at least 2 along each direction, and at most 2^20 are read',
      );
    }
  }
  const count = samples[0] * samples[1] * samples[2];
  const bytes = count * bytesOfType[type];
  const needed = bytes + 4 * count + beside;
  if (Math.max(bytes, beside) > mostInOneBlock || needed > mostMemory) {
    throw new FileError(
      `${name} has ${samples.join(' x ')} samples of ${type}, which need ` +
        `${(needed / 2 ** 30).toFixed(1)} GB; a page has less`,
    );
  }
  return bytes;
}

/** Throws where a file cannot hold so many bytes of samples in those behind its header. */
export function checkFound(name, found, bytes, packed) {
  const least = packed ? Math.floor(bytes / mostPacked) : bytes;
  if (found < least) {
    throw new FileError(
      `${name} is truncated: ${Math.max(found, 0)} bytes of samples, but its header ` +
        `asks for ${packed ? 'at least ' : ''}${least}`,
    );
  }
}

/** The product of counts. Throws where it is beyond all files. */
export function countedNumbers(name, ...counts) {
  const product = counts.reduce((a, b) => a * b, 1);
  if (Number.isSafeInteger(product)) return product;
  throw new FileError(`${name} asks for more samples than any memory holds`);
}

/** Strides of numbers without gaps: components of a sample first, then x, y, z and frames. */
export function denseStrides([nx, ny, nz], components = 1, frames = 1) {
  return {
    begin: 0,
    stride: [components, components * nx, components * nx * ny],
    components: { count: components, stride: 1 },
    frames: { count: frames, stride: components * nx * ny * nz },
  };
}

/** What a file has that says nothing more. */
export const plainFile = {
  componentKind: '',
  framesAreList: false,
  slope: 1,
  intercept: 0,
  arrays: [],
  array: '',
  name: '',
  lengthUnit: '',
  space: '',
  note: '',
};

/** "0 to 4", or "0 or 1". */
export const numbersBelow = (count) => (count === 2 ? '0 or 1' : `0 to ${count - 1}`);

/** 'heat', 'cold' */
export const listed = (names) => names.map(quoted).join(', ');

/** Reverses the bytes of each number. */
export function swapBytes(target, size) {
  for (let at = 0; at + size <= target.length; at += size) {
    for (let i = 0, j = size - 1; i < j; ++i, --j) {
      const byte = target[at + i];
      target[at + i] = target[at + j];
      target[at + j] = byte;
    }
  }
}

/** Three axes of a volume, each the step from one sample to the next, as spacing and direction. */
export function geometryOfSteps(steps) {
  const spacing = steps.map((step) => Math.hypot(...step));
  const direction = [];
  for (let r = 0; r < 3; ++r) for (let d = 0; d < 3; ++d) direction.push(steps[d][r] / spacing[d]);
  return { spacing, direction };
}

export const alongAxes = [1, 0, 0, 0, 1, 0, 0, 0, 1];
