// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Opens files of all formats. The reader of a format is loaded when a file needs it.
import { FileError } from './volume.js';

const openers = {
  '.vti': async () => (await import('./vti.js')).openVti,
  '.mha': async () => (await import('./meta_image.js')).openMetaImage,
  '.mhd': async () => (await import('./meta_image.js')).openMetaImage,
  '.nrrd': async () => (await import('./nrrd.js')).openNrrd,
  '.nhdr': async () => (await import('./nrrd.js')).openNrrd,
  '.nii': async () => (await import('./nifti.js')).openNifti,
  '.nii.gz': async () => (await import('./nifti.js')).openNifti,
  '.raw': async () => (await import('./raw.js')).openRaw,
};

export const formats = Object.keys(openers);

const formatOf = ({ name }) => formats.find((format) => name.toLowerCase().endsWith(format));

/**
 * Of files that are chosen together, the one that describes the volume; the others may hold its
 * samples. Throws FileError where there is none, or more than one.
 * returns { file, format }
 */
export function describingFile(files) {
  const known = files.filter(formatOf);
  const withHeader = known.filter((file) => formatOf(file) !== '.raw');
  const describing = withHeader.length > 0 ? withHeader : known;
  if (describing.length > 1) {
    const [one, other] = describing;
    throw new FileError(`${one.name} and ${other.name} are two volumes: choose one of them`);
  }
  const [file] = describing;
  if (file) return { file, format: formatOf(file) };
  throw new FileError(`${files[0].name} is of no known format (${formats.join(', ')})`);
}

/**
 * Reads the header of a volume.
 * files: with names; one, or a header and its data files
 * choice: { frame, component, array, firstOfSeveral, rawFormat }: as chooseVolume() takes it
 *   (chosen_volume.js); an array of a .vti by its name; for .raw what raw.js asks for
 * returns a volume (chosen_volume.js)
 * Throws FileError, with one sentence, where a file is damaged, truncated or not read, and where the
 * choice does not fit it.
 */
export async function openVolume(files, choice = {}) {
  const { file, format } = describingFile(files);
  if (file.size === 0) throw new FileError(`${file.name} is empty`);
  const open = await openers[format]();
  const beside = (name) => files.find((each) => each !== file && each.name === name);
  const samples = await open(file, { ...choice, beside });
  if (choice.array !== undefined && samples.arrays.length === 0)
    throw new FileError(`${file.name} has no arrays to choose from`);
  const { chooseVolume } = await import('./chosen_volume.js');
  return chooseVolume(samples, choice);
}
