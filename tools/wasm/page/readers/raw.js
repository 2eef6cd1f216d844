// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bare samples. What a .raw file does not say about itself is asked for, or stands in its name, as
// in bonsai_256x256x256_uint8.raw.
import { payloadReader } from './payload.js';
import {
  FileError,
  alongAxes,
  bytesOfType,
  checkedBytes,
  denseStrides,
  plainFile,
} from './volume.js';

/** { samples, type } that a name tells, or null. */
export function rawFormatOfName(name) {
  const counts = /(\d+)x(\d+)x(\d+)/i.exec(name);
  const type = /(?:^|[^a-z])(u?int(?:8|16|32|64)|float(?:32|64)?|double)(?![a-z0-9])/i.exec(name);
  if (!counts || !type) return null;
  const synonyms = { float: 'float32', double: 'float64' };
  const lower = type[1].toLowerCase();
  return { samples: counts.slice(1).map(Number), type: synonyms[lower] ?? lower };
}

/** rawFormat: { samples, type, spacing, bigEndian }, the last two by default 1 and false */
export async function openRaw(file, { rawFormat }) {
  const { samples, type, spacing = [1, 1, 1], bigEndian = false } = rawFormat;
  const { name } = file;
  if (!Object.hasOwn(bytesOfType, type)) throw new FileError(`${name}: there is no type '${type}'`);
  const bytes = checkedBytes(name, samples, type);
  if (file.size !== bytes) {
    throw new FileError(
      `${name} has ${file.size} bytes, but ${samples.join(' x ')} samples of ${type} ` +
        `need ${bytes}`,
    );
  }
  const read = payloadReader({
    fileName: name,
    type,
    numbers: bytes / bytesOfType[type],
    parts: [{ name, blob: file }],
    encoding: 'raw',
    lineSkip: 0,
    byteSkip: 0,
    bigEndian,
  });
  return {
    ...plainFile,
    fileName: name,
    type,
    samples,
    spacing,
    origin: [0, 0, 0],
    direction: alongAxes,
    ...denseStrides(samples),
    read,
  };
}
