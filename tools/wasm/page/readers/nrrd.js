// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// NRRD, .nrrd and .nhdr. Takes headers as the format's own library and tools/input/nrrd_file.cpp do,
// where all fields are listed.
import { payloadReader } from './payload.js';
import { namesOfData, numberOf, partsOf, readTextHeader } from './text_header.js';
import {
  FileError,
  checkedBytes,
  countedNumbers,
  geometryOfSteps,
  plainFile,
  printable,
  quoted,
} from './volume.js';

/** Words and what they mean, from lists of synonyms. */
const synonyms = (lists) =>
  new Map(Object.entries(lists).flatMap(([meant, words]) => words.map((word) => [word, meant])));

const types = synonyms({
  int8: ['signed char', 'int8', 'int8_t'],
  uint8: ['unsigned char', 'uchar', 'uint8', 'uint8_t'],
  int16: ['short', 'short int', 'signed short', 'signed short int', 'int16', 'int16_t'],
  uint16: ['ushort', 'unsigned short', 'unsigned short int', 'uint16', 'uint16_t'],
  int32: ['int', 'signed int', 'int32', 'int32_t'],
  uint32: ['uint', 'unsigned int', 'uint32', 'uint32_t'],
  int64: [
    'longlong',
    'long long',
    'long long int',
    'signed long long',
    'signed long long int',
    'int64',
    'int64_t',
  ],
  uint64: ['ulonglong', 'unsigned long long', 'unsigned long long int', 'uint64', 'uint64_t'],
  float32: ['float'],
  float64: ['double'],
});

const encodings = synonyms({
  raw: ['raw'],
  packed: ['gzip', 'gz'],
  text: ['txt', 'text', 'ascii'],
  hex: ['hex'],
});

/** Of the names without blanks. */
const fieldNames = new Set(
  `content number type blocksize dimension space spacedimension sizes spacings thicknesses axismins
  axismaxs spacedirections centers centerings kinds labels units min max oldmin oldmax endian encoding
  lineskip byteskip sampleunits spaceunits spaceorigin measurementframe datafile`.split(/\s+/),
);

/** Kinds of axes, and how many samples those of a fixed number have. */
const kindSizes = {
  domain: 0,
  space: 0,
  time: 0,
  list: 0,
  point: 0,
  vector: 0,
  'covariant-vector': 0,
  normal: 0,
  stub: 1,
  scalar: 1,
  complex: 2,
  '2-vector': 2,
  '3-color': 3,
  'RGB-color': 3,
  'HSV-color': 3,
  'XYZ-color': 3,
  '4-color': 4,
  'RGBA-color': 4,
  '3-vector': 3,
  '3-gradient': 3,
  '3-normal': 3,
  '4-vector': 4,
  quaternion: 4,
  '2D-symmetric-matrix': 3,
  '2D-masked-symmetric-matrix': 4,
  '2D-matrix': 4,
  '2D-masked-matrix': 5,
  '3D-symmetric-matrix': 6,
  '3D-masked-symmetric-matrix': 7,
  '3D-matrix': 9,
  '3D-masked-matrix': 10,
};
const kinds = new Map(Object.keys(kindSizes).map((kind) => [kind.toLowerCase(), kind]));

/** The kind that a word means; undefined where it means none. */
const kindOfWord = (word) =>
  kinds.get(
    word
      .toLowerCase()
      .replace('contravariant-', '')
      .replace('-sym-', '-symmetric-')
      .replace('tensor', 'matrix')
      .replace(/^(rgba?|hsv)(color)?$/, '$1-color'),
  );

/** Names in lower case, what the space is called here, and its dimension. */
const spaces = new Map(
  [
    ['right-anterior-superior', 'RAS', 3],
    ['ras', 'RAS', 3],
    ['left-anterior-superior', 'LAS', 3],
    ['las', 'LAS', 3],
    ['left-posterior-superior', 'LPS', 3],
    ['lps', 'LPS', 3],
    ['right-anterior-superior-time', 'RAS', 4],
    ['rast', 'RAS', 4],
    ['left-anterior-superior-time', 'LAS', 4],
    ['last', 'LAS', 4],
    ['left-posterior-superior-time', 'LPS', 4],
    ['lpst', 'LPS', 4],
    ['scanner-xyz', 'scanner-xyz', 3],
    ['scanner-xyz-time', 'scanner-xyz-time', 4],
    ['3d-right-handed', '3D-right-handed', 3],
    ['3d-left-handed', '3D-left-handed', 3],
    ['3d-right-handed-time', '3D-right-handed-time', 4],
    ['3d-left-handed-time', '3D-left-handed-time', 4],
  ].map(([word, name, dimension]) => [word, { name, dimension }]),
);

const isUnknown = (word) => word === '???' || word === 'none';

async function readHeader(file) {
  const { name } = file;
  let isFirst = true;
  const seen = new Set();
  const header = await readTextHeader(
    file,
    (line) => {
      if (isFirst) {
        if (!/^NRRD(00\.01|000[1-5])$/.test(line))
          throw new FileError(`${name} is no NRRD file: it does not begin with NRRD and a version`);
        isFirst = false;
        return null;
      }
      const at = line.indexOf(': ');
      const key = line.slice(0, Math.max(at, 0)).toLowerCase().replace(/ /g, '');
      if (line === '' || line[0] === '#') return null;
      if (fieldNames.has(key)) {
        if (seen.has(key)) throw new FileError(`${name} has the field ${quoted(key)} twice`);
        seen.add(key);
        return { key, spelling: line.slice(0, at), value: line.slice(at + 2).trim() };
      }
      // What users add.
      if (line.includes(':=')) return null;
      throw new FileError(
        `${name} is truncated or damaged: its header has ${quoted(line)}, which is no field`,
      );
    },
    (key, value) => key === 'datafile' && value.startsWith('LIST'),
  );
  if (!header.ended && header.value('datafile') === '')
    throw new FileError(`${name} is truncated or no NRRD file: its header does not end`);
  return header;
}

/** The words of a value, one for each axis, or none. */
function wordsOf(header, key, count) {
  const words = header
    .value(key)
    .split(/\s+/)
    .filter((word) => word !== '');
  if (words.length === 0 || words.length === count) return words;
  throw new FileError(
    `${header.name} has ${header.described(key)}, not one for each of its ${count} axes`,
  );
}

/** Vectors of the dimension of the space, or null for "none": `count` of them, or no list. */
function vectorsOf(header, key, count, dimension) {
  const text = header.value(key);
  if (text === '') return [];
  const refuse = (why) => new FileError(`${header.name} has ${header.described(key)}, ${why}`);
  if (dimension === 0) throw refuse('but no space before it');
  const matches = [...text.matchAll(/\s*(?:(none)(?=\s|$)|\(([^()]*)\))/gy)];
  const length = matches.reduce((sum, [all]) => sum + all.length, 0);
  if (matches.length !== count || text.slice(length).trim() !== '')
    throw refuse(`not ${count} vector${count === 1 ? '' : 's'}`);
  return matches.map(([, none, inside]) => {
    if (none) return null;
    const words = inside.split(',').map((word) => word.trim());
    if (words.length !== dimension) throw refuse(`but a space of dimension ${dimension}`);
    const vector = words.map((word) => {
      const number = numberOf(word);
      if (number === undefined) throw refuse(`of which '${printable(word)}' is no number`);
      return number;
    });
    if (vector.every(Number.isNaN)) return null;
    if (!vector.every(Number.isFinite)) throw refuse('which is not finite');
    return vector;
  });
}

/** Texts in quotes; `count` of them, or none. */
function quotedTexts(header, key, count) {
  const texts = [...header.value(key).matchAll(/"((?:[^"\\]|\\.)*)"/g)].map((match) => match[1]);
  if (header.value(key) === '' || texts.length === count) return texts;
  throw new FileError(`${header.name} has ${header.described(key)}, not ${count} texts in quotes`);
}

function spaceOf(header) {
  const text = header.value('space');
  if (text !== '') {
    const space = spaces.get(text.toLowerCase());
    if (space) return space;
    throw new FileError(`${header.name} has the space ${quoted(text)}, which is not known`);
  }
  const [dimension = 0] = header.numbers('spacedimension', 1);
  if (Number.isInteger(dimension) && dimension >= 0 && dimension <= 8)
    return { name: '', dimension };
  throw new FileError(
    `${header.name} has ${header.described('spacedimension')}, which is not read`,
  );
}

const hasSpacing = ({ spacing, min, max }) => [spacing, min, max].some(Number.isFinite);

function kindOf(header, word) {
  if (word === undefined || isUnknown(word)) return '';
  const kind = kindOfWord(word);
  if (kind) return kind;
  throw new FileError(`${header.name} has an axis of the kind ${quoted(word)}, which is not known`);
}

function isNodeCentred(header, word) {
  if (word === undefined || isUnknown(word)) return false;
  const centre = word.toLowerCase();
  if (centre === 'node' || centre === 'cell') return centre === 'node';
  throw new FileError(`${header.name} has the centering ${quoted(word)}, which is not known`);
}

/** "frames", "list", "components" or "space". */
function roleOf({ kind, direction }, spaceDimension) {
  const alongTime = spaceDimension === 4 && direction?.slice(0, 3).every((x) => x === 0);
  if (kind === 'time' || alongTime) return 'frames';
  if (kind === 'domain' || kind === 'space') return 'space';
  if (kind === 'list') return 'list';
  if (kind !== '') return 'components';
  // The axes of space have directions where there is a space.
  return spaceDimension === 0 || direction ? 'space' : 'list';
}

/** The axes of an array. */
function axesOf(header, space) {
  const { name } = header;
  const [n] = header.numbers('dimension', 1);
  if (!(Number.isInteger(n) && n >= 1 && n <= 16))
    throw new FileError(`${name} has the dimension ${quoted(header.value('dimension'))}`);
  const sizes = header.numbers('sizes');
  if (sizes.length !== n) {
    throw new FileError(`${name} has ${header.described('sizes')}, but the dimension ${n}`);
  }
  const kindWords = wordsOf(header, 'kinds', n);
  const centreWords = wordsOf(header, header.firstKey('centers', 'centerings'), n);
  const directions = vectorsOf(header, 'spacedirections', n, space.dimension);
  const [spacings, mins, maxs] = ['spacings', 'axismins', 'axismaxs'].map((key) =>
    header.numbers(key, n),
  );
  const units = quotedTexts(header, 'units', n);
  return sizes.map((size, a) => {
    if (!(Number.isSafeInteger(size) && size >= 1))
      throw new FileError(`${name} has ${header.described('sizes')}, which are no counts`);
    const axis = {
      size,
      kind: kindOf(header, kindWords[a]),
      direction: directions[a] ?? null,
      spacing: spacings[a],
      min: mins[a],
      max: maxs[a],
      unit: units[a] ?? '',
      nodes: isNodeCentred(header, centreWords[a]),
    };
    const fixed = kindSizes[axis.kind] ?? 0;
    if (fixed > 0 && fixed !== size)
      throw new FileError(`${name} has an axis of ${size} samples, but of the kind ${axis.kind}`);
    if (axis.direction && (hasSpacing(axis) || axis.unit !== ''))
      throw new FileError(`${name} has an axis with a direction and spacing, minimum or unit`);
    axis.role = roleOf(axis, space.dimension);
    return axis;
  });
}

/**
 * The axes of space, fastest first. Where there are more than three, those of one sample are left
 * out, then the slowest ones are frames.
 */
function axesOfSpace(axes) {
  const chosen = axes.filter(({ role }) => role === 'space');
  while (chosen.length > 3) {
    const one = chosen.findIndex(({ size }) => size === 1);
    const [leftOut] = chosen.splice(one < 0 ? chosen.length - 1 : one, 1);
    leftOut.role = 'frames';
  }
  return chosen;
}

/** The step from one sample to the next along an axis of an array without a space. */
function scalarSpacing(name, { size, spacing, min, max, nodes }) {
  if (spacing !== undefined && !Number.isNaN(spacing)) return spacing;
  if (!Number.isFinite(min) || !Number.isFinite(max) || (nodes && size < 2)) return 1;
  if (min === max) throw new FileError(`${name} has an axis whose minimum is its maximum`);
  return (max - min) / (nodes ? size - 1 : size);
}

function geometryOf(header, axes, space) {
  const origin = [0, 0, 0];
  const steps = [0, 1, 2].map((d) => {
    const step = [0, 0, 0];
    const axis = axes[d];
    if (!axis) {
      step[d] = 1;
    } else if (axis.direction) {
      axis.direction.slice(0, 3).forEach((x, r) => {
        step[r] = x;
      });
    } else {
      step[d] = scalarSpacing(header.name, axis);
      // The minimum is that of the first cell, unless the axis is node-centred; axes that say nothing
      // are taken for cell-centred ones, too.
      if (space.dimension === 0 && Number.isFinite(axis.min))
        origin[d] = axis.min + (axis.nodes ? 0 : step[d] / 2);
    }
    const length = Math.hypot(...step);
    if (!(length > 0) || !Number.isFinite(length))
      throw new FileError(`${header.name} has an axis without a length`);
    return step;
  });
  const [given] = vectorsOf(header, 'spaceorigin', 1, space.dimension);
  given?.slice(0, 3).forEach((x, r) => {
    origin[r] = x;
  });
  const samples = [0, 1, 2].map((d) => axes[d]?.size ?? 1);
  return { samples, origin, ...geometryOfSteps(steps) };
}

/** The unit that all axes of space have; '' where they differ or have none. */
function lengthUnitOf(header, axes, space) {
  const common = (units) => (new Set(units).size === 1 ? units[0] : '');
  const units = quotedTexts(header, 'spaceunits', space.dimension).slice(0, 3);
  return printable(common(units) || common(axes.map(({ unit }) => unit)));
}

/** Strides of all axes. Those of one sample that are none of space add nothing. */
function stridesOf(name, axes) {
  const result = {
    begin: 0,
    stride: [],
    components: { count: 1, stride: 0 },
    frames: { count: 1, stride: 0 },
    componentKind: '',
    framesAreList: false,
  };
  let stride = 1;
  for (const { size, role, kind } of axes) {
    if (role === 'space') {
      result.stride.push(stride);
    } else if (size > 1) {
      const to = role === 'components' ? 'components' : 'frames';
      if (result[to].count > 1)
        throw new FileError(`${name} has two axes for ${to}, of which one is read`);
      result[to] = { count: size, stride };
      if (role === 'components') result.componentKind = kind;
      if (role === 'list') result.framesAreList = true;
    }
    stride *= size;
  }
  while (result.stride.length < 3) result.stride.push(stride);
  return result;
}

/** The data files, each with as many samples as the others. */
function partsOfData(header, axes, beside) {
  const value = header.value('datafile');
  const names = namesOfData(header, value);
  const isList = value.startsWith('LIST');
  if (isList || /%\d*d/.test(value)) {
    const words = value.split(/\s+/);
    const dimension = Number(words[isList ? 1 : 4] ?? axes.length - 1);
    const sizes = axes.map(({ size }) => size);
    const expected = sizes.slice(dimension).reduce((a, b) => a * b, 1);
    const fits =
      dimension === axes.length ? sizes.at(-1) % names.length === 0 : expected === names.length;
    if (!fits) {
      throw new FileError(
        `${header.name} names ${names.length} data files, which are not its samples cut into pieces`,
      );
    }
  }
  return partsOf(header, names, beside);
}

function numberOfSkipped(header, key, least) {
  const [count = 0] = header.numbers(key, 1);
  if (Number.isSafeInteger(count) && count >= least) return count;
  throw new FileError(`${header.name} has ${header.described(key)}, which is not read`);
}

/** Where the samples are, and how they are packed. */
function payloadOf(header, file, axes, beside) {
  const { name } = file;
  const encoding = encodings.get(header.value('encoding').toLowerCase());
  if (!encoding)
    throw new FileError(
      `${name} has the encoding ${quoted(header.value('encoding'))}, which is not read`,
    );
  const endian = header.value('endian').toLowerCase();
  if (!['', 'little', 'big'].includes(endian))
    throw new FileError(`${name} has ${header.described('endian')}, which is not known`);
  const detached = header.value('datafile') !== '';
  return {
    parts: detached
      ? partsOfData(header, axes, beside)
      : [{ name, blob: file.slice(header.length) }],
    encoding,
    lineSkip: numberOfSkipped(header, 'lineskip', 0),
    byteSkip: numberOfSkipped(header, 'byteskip', -Number.MAX_SAFE_INTEGER),
    bigEndian: endian === 'big',
  };
}

export async function openNrrd(file, { beside }) {
  const fileName = file.name;
  const header = await readHeader(file);
  const type = types.get(header.value('type').toLowerCase());
  if (!type)
    throw new FileError(
      `${fileName} has the sample type ${quoted(header.value('type'))}, which is not read`,
    );
  const space = spaceOf(header);
  const axes = axesOf(header, space);
  const ofSpace = axesOfSpace(axes);
  const geometry = geometryOf(header, ofSpace, space);
  checkedBytes(fileName, geometry.samples, type);
  const strides = stridesOf(fileName, axes);
  const numbers = countedNumbers(fileName, ...axes.map(({ size }) => size));
  return {
    ...plainFile,
    fileName,
    type,
    ...geometry,
    ...strides,
    name: printable(header.value('content')),
    lengthUnit: lengthUnitOf(header, ofSpace, space),
    space: space.name,
    read: payloadReader({ fileName, type, numbers, ...payloadOf(header, file, axes, beside) }),
  };
}
