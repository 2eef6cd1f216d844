// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
import { openNifti } from './nifti.js';
import { openNrrd } from './nrrd.js';
import { openRaw } from './raw.js';
import { openVti } from './vti.js';
import { FileError } from './volume.js';

const openers = {
  '.vti': openVti,
  '.nrrd': openNrrd,
  '.nii': openNifti,
  '.nii.gz': openNifti,
  '.raw': openRaw,
};

export const formats = Object.keys(openers);

/**
 * Reads the header of a file with a name. Throws FileError, with one sentence, where it is damaged,
 * truncated or not read.
 * rawFormat: see raw.js, for .raw alone
 * returns a volume (volume.js)
 */
export async function openVolume(file, rawFormat = null) {
  const name = file.name.toLowerCase();
  const ending = formats.find((format) => name.endsWith(format));
  if (!ending) throw new FileError(`${file.name} is of no known format (${formats.join(', ')})`);
  if (file.size === 0) throw new FileError(`${file.name} is empty`);
  const volume = await openers[ending](file, rawFormat);
  const place = [...volume.spacing, ...volume.origin, ...volume.direction];
  if (!place.every(Number.isFinite)) {
    throw new FileError(`${file.name} places its samples by numbers that are not finite`);
  }
  return volume;
}
