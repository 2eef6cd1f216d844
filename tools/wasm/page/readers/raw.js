// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bare samples. What a .raw file does not say about itself is asked for, or stands in its name, as
// in bonsai_256x256x256_uint8.raw.
import { ByteStream } from './byte_stream.js';
import { FileError, alongAxes, bytesOfType, checkedBytes, swapBytes } from './volume.js';

/** { samples, type } that a name tells, or null. */
export function rawFormatOfName(name) {
  const counts = /(\d+)x(\d+)x(\d+)/i.exec(name);
  const type = /(?:^|[^a-z])(u?int(?:8|16|32|64)|float(?:32|64)?|double)(?![a-z0-9])/i.exec(name);
  if (!counts || !type) return null;
  const synonyms = { float: 'float32', double: 'float64' };
  const lower = type[1].toLowerCase();
  return { samples: counts.slice(1).map(Number), type: synonyms[lower] ?? lower };
}

/** format: { samples, type, spacing, bigEndian }, the last two by default 1 and false */
export async function openRaw(file, format) {
  const { samples, type, spacing = [1, 1, 1], bigEndian = false } = format;
  const { name } = file;
  if (!Object.hasOwn(bytesOfType, type)) throw new FileError(`${name}: there is no type '${type}'`);
  const bytes = checkedBytes(name, samples, type);
  if (file.size !== bytes) {
    throw new FileError(
      `${name} has ${file.size} bytes, but ${samples.join(' x ')} samples of ${type} ` +
        `need ${bytes}`,
    );
  }
  return {
    type,
    samples,
    spacing,
    origin: [0, 0, 0],
    direction: alongAxes,
    bytes,
    async read(target) {
      await new ByteStream(name, file).fill(target);
      if (bigEndian) swapBytes(target, bytesOfType[type]);
    },
  };
}
