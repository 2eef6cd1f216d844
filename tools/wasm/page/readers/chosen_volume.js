// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The volume that is chosen among the samples of a file: one frame, one number of each sample, as
// tools/input/chosen_samples.cpp chooses it. A *volume* is
//   type, samples, spacing, origin, direction, name, lengthUnit, space   as those of a file
//   note              a sentence on what is left out; mostly ''
//   offers            { frames, components: counts, arrays: names } among which one may choose
//   choice            { frame, component, array }: what is chosen
//   bytes             of all samples
//   read(target)      fills a Uint8Array of so many bytes with the samples, least byte first
import { FileError, bytesOfType, checkedBytes, numbersBelow, numbersIn } from './volume.js';

/** what: 'frame' or 'component' */
function checkedNumber({ fileName }, number, count, what) {
  if (Number.isInteger(number) && number >= 0 && number < count) return number;
  throw new FileError(`${fileName} has no ${what} ${number}: it is ${numbersBelow(count)}`);
}

function chosenFrame(file, { frame }) {
  const { count } = file.frames;
  if (count > 1) return checkedNumber(file, frame ?? 0, count, 'frame');
  if (frame === undefined) return 0;
  throw new FileError(`${file.fileName} has one frame only: there is none to choose`);
}

/** A number, or 'magnitude'. */
function chosenComponent(file, { component, firstOfSeveral }) {
  const { fileName, componentKind: kind } = file;
  const { count } = file.components;
  if (count === 1) {
    if (component === undefined) return 0;
    throw new FileError(`${fileName} has one number per sample: there is none to choose`);
  }
  if (component === 'magnitude') return component;
  if (component === undefined && !firstOfSeveral) {
    throw new FileError(
      `${fileName} has ${count} numbers per sample${kind && ` (${kind})`}, not one: choose a ` +
        `component, ${numbersBelow(count)}, or the magnitude`,
    );
  }
  return checkedNumber(file, component ?? 0, count, 'component');
}

/** What is left out, where something is. */
function noteOf(file, frame, component) {
  const parts = [];
  const { frames, components, componentKind: kind, fileName } = file;
  if (frames.count > 1) {
    parts.push(`frame ${frame} of the ${frames.count} in ${fileName} is read`);
  } else if (file.note) parts.push(file.note);
  if (components.count > 1) {
    const numbers = `${components.count} numbers per sample${kind && ` (${kind})`}`;
    parts.push(
      component === 'magnitude'
        ? `the magnitude of the ${numbers} is taken`
        : `component ${component} of the ${numbers} is read`,
    );
  }
  return parts.join('; ');
}

/** Whether numbers computed from these need the digits of float64. */
function needDouble({ type, slope, intercept }) {
  const size = bytesOfType[type];
  const floating = type.startsWith('float');
  if (size > 4 || (size === 4 && !floating)) return true;
  // Float32 tells 2^24 neighbours apart.
  const steps = size === 1 ? 256 : 65536;
  return !floating && Math.abs(intercept) > (8388608 - steps) * Math.abs(slope);
}

/** Calls take(i, number of the first component) for the first sample of each row along x. */
function forEachRow([nx, ny, nz], stride, begin, take) {
  for (let z = 0; z < nz; ++z) {
    for (let y = 0; y < ny; ++y) {
      take(nx * (y + ny * z), begin + z * stride[2] + y * stride[1]);
    }
  }
}

function checkPlace({ fileName, spacing, origin, direction }) {
  const axis = [0, 1, 2].map((d) => [0, 1, 2].map((r) => direction[3 * r + d] * spacing[d]));
  const [[a, b, c], [d, e, f], [g, h, i]] = axis;
  const volume = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
  if (Number.isFinite(volume) && volume !== 0 && origin.every(Number.isFinite)) return;
  throw new FileError(
    `${fileName} cannot be read: spacing, direction or origin of the lattice is flat or not finite`,
  );
}

/** Counts the samples that are not a number: nothing is drawn beside them. */
function countMissing({ fileName, samples: [nx, ny] }, type, target) {
  if (!type.startsWith('float')) return 0;
  const values = numbersIn(target, type);
  let missing = 0;
  for (let i = 0; i < values.length; ++i) {
    if (Number.isFinite(values[i])) continue;
    if (!Number.isNaN(values[i])) {
      const place = [i % nx, Math.floor(i / nx) % ny, Math.floor(i / nx / ny)].join(', ');
      throw new FileError(`${fileName}: the sample at (${place}) is infinite`);
    }
    ++missing;
  }
  if (missing === values.length) throw new FileError(`${fileName}: no sample has a value`);
  return missing;
}

/** The first and the last of the numbers of which a choice consists. */
function rangeOf({ samples, stride }, begin, more) {
  const steps = [...samples.map((n, d) => (n - 1) * stride[d]), more];
  const sum = (pick) => steps.reduce((at, step) => at + pick(0, step), begin);
  return [sum(Math.min), sum(Math.max)];
}

/** Fills `to` with samples of `from`, or with what is computed from their components. */
function gather(file, from, begin, computed, components, to) {
  const { samples, stride, slope, intercept } = file;
  const [nx] = samples;
  const [step] = stride;
  const beside = file.components.stride;
  const stored = (i, at) => {
    for (let x = 0; x < nx; ++x) to[i + x] = from[at + x * step];
  };
  const scaled = (i, at) => {
    for (let x = 0; x < nx; ++x) to[i + x] = slope * Number(from[at + x * step]) + intercept;
  };
  const norms = (i, at) => {
    for (let x = 0; x < nx; ++x) {
      let norm = 0;
      for (let c = 0; c < components; ++c) {
        const number = Number(from[at + x * step + c * beside]);
        norm = Math.hypot(norm, slope * number + intercept);
      }
      to[i + x] = norm;
    }
  };
  if (components > 1) forEachRow(samples, stride, begin, norms);
  else forEachRow(samples, stride, begin, computed ? scaled : stored);
}

/**
 * Chooses a volume among the samples of a file (volume.js).
 * choice: { frame, component, firstOfSeveral }: a frame, from 0, the first where it is not given; a
 *   component, from 0, or 'magnitude'; whether the first component is taken where none is given
 * Throws FileError where the choice does not fit the file, or leaves several components.
 */
export function chooseVolume(samplesOfFile, choice) {
  const file = { ...samplesOfFile };
  const { fileName, type, samples } = file;
  checkedBytes(fileName, samples, type);
  checkPlace(file);
  const listIsSample =
    file.framesAreList &&
    file.components.count === 1 &&
    choice.frame === undefined &&
    choice.component !== undefined;
  if (listIsSample) [file.frames, file.components] = [file.components, file.frames];
  const frame = chosenFrame(file, choice);
  const component = chosenComponent(file, choice);
  const magnitude = component === 'magnitude';
  const components = magnitude ? file.components.count : 1;
  const begin =
    file.begin + frame * file.frames.stride + (magnitude ? 0 : component) * file.components.stride;
  const computed = magnitude || file.slope !== 1 || file.intercept !== 0;
  const result = computed ? (needDouble(file) ? 'float64' : 'float32') : type;
  const [nx, ny] = samples;
  const isDense = [1, nx, nx * ny].every((step, d) => step === file.stride[d]);
  const asStored = isDense && !computed;
  const [first, last] = rangeOf(file, begin, (components - 1) * file.components.stride);
  const bytesRead = (last - first + 1) * bytesOfType[type];
  const bytes = checkedBytes(fileName, samples, result, asStored ? 0 : bytesRead);
  const volume = {
    type: result,
    samples,
    spacing: file.spacing,
    origin: file.origin,
    direction: file.direction,
    name: file.name,
    lengthUnit: file.lengthUnit,
    space: file.space,
    note: noteOf(file, frame, component),
    offers: { frames: file.frames.count, components: file.components.count, arrays: file.arrays },
    choice: { frame, component, array: file.array },
    bytes,
    async read(target) {
      if (asStored) {
        await file.read(target, first);
      } else {
        const numbers = new Uint8Array(bytesRead);
        await file.read(numbers, first);
        const to = numbersIn(target, result);
        gather(file, numbersIn(numbers, type), begin - first, computed, components, to);
      }
      const missing = countMissing(file, result, target);
      if (missing > 0) {
        const all = nx * ny * samples[2];
        const sentence = `${missing} of ${all} samples have no value: nothing is drawn beside them`;
        volume.note = [volume.note, sentence].filter(Boolean).join('; ');
      }
    },
  };
  return volume;
}
