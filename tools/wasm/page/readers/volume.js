// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the readers of files have in common. A *volume* is
//   type              of its samples: uint8, int8, ... uint64, int64, float32 or float64
//   samples           three counts, x first
//   spacing, origin, direction   as in LatticeGeometry (lattice.hpp), the direction as nine numbers
//   name              of the field, where the file has one
//   lengthUnit        such as mm, where the file has one
//   bytes             of all samples
//   read(target)      fills a Uint8Array of so many bytes with the samples, least byte first
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

/** The bytes of samples. Throws where no volume has them, and where memory does not suffice. */
export function checkedBytes(name, samples, type) {
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
  if (bytes > mostInOneBlock || bytes + 4 * count > mostMemory) {
    throw new FileError(
      `${name} has ${samples.join(' x ')} samples of ${type}, which need ` +
        `${((bytes + 4 * count) / 2 ** 30).toFixed(1)} GB; a page has less`,
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
