// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// NRRD files whose samples stand behind the header, raw or packed by gzip. Takes headers as
// tools/sample_layout.cpp does.
import { ByteStream } from './byte_stream.js';
import {
  FileError,
  alongAxes,
  bytesOfType,
  checkFound,
  checkedBytes,
  geometryOfSteps,
  printable,
  quoted,
  swapBytes,
} from './volume.js';

const longestHeader = 1 << 18;

const types = new Map(
  Object.entries({
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
  }).flatMap(([type, synonyms]) => synonyms.map((synonym) => [synonym, type])),
);

/** The fields of a header by keys in lower case, and its length in bytes. */
async function readHeader(file) {
  const text = new TextDecoder('latin1').decode(await file.slice(0, longestHeader).arrayBuffer());
  const end = /\n\r?\n/.exec(text);
  if (!text.startsWith('NRRD') || !end) {
    throw new FileError(`${file.name} is truncated or no NRRD file: its header does not end`);
  }
  const fields = new Map();
  for (const line of text.slice(0, end.index).split('\n')) {
    const at = line.indexOf(':');
    // Comments stand behind #, and what users add is key:=value.
    if (at < 0 || line[0] === '#' || line[at + 1] === '=') continue;
    fields.set(line.slice(0, at).trim().toLowerCase(), line.slice(at + 1).trim());
  }
  return { fields, length: end.index + end[0].length };
}

/** The words of a text that are numbers, brackets and commas aside. */
function numbersOf(text) {
  const words = (text ?? '')
    .replace(/[(),]/g, ' ')
    .split(/\s+/)
    .filter((word) => word !== '');
  return words.map(Number).filter(Number.isFinite);
}

function samplesOf(name, fields) {
  let counts = numbersOf(fields.get('sizes'));
  while (counts.length > 3 && counts.includes(1)) counts.splice(counts.indexOf(1), 1);
  if (counts.length === 0 || counts.length > 3) {
    throw new FileError(
      `${name} has the size ${quoted(fields.get('sizes'))}, not that of a volume`,
    );
  }
  return [...counts, 1, 1].slice(0, 3);
}

function geometryOf(fields) {
  const three = (texts, otherwise) => {
    const numbers = texts.map((key) => numbersOf(fields.get(key))).find((list) => list.length > 0);
    return otherwise.map((x, d) => numbers?.[d] ?? x);
  };
  const origin = three(['space origin', 'axis mins', 'axismins'], [0, 0, 0]);
  const axes = numbersOf(fields.get('space directions'));
  if (axes.length !== 9) {
    return { origin, spacing: three(['spacings'], [1, 1, 1]), direction: alongAxes };
  }
  return { origin, ...geometryOfSteps([axes.slice(0, 3), axes.slice(3, 6), axes.slice(6)]) };
}

/** The unit that is listed in quotes, where it is that of every axis. */
function lengthUnitOf(fields) {
  const list = fields.get('space units') ?? fields.get('units') ?? '';
  const units = new Set([...list.matchAll(/"([^"]*)"/g)].map((match) => match[1]));
  return units.size === 1 ? printable([...units][0]) : '';
}

function packingOf(name, encoding) {
  if (encoding === 'raw') return null;
  if (encoding === 'gzip' || encoding === 'gz') return 'gzip';
  throw new FileError(`${name} has the encoding ${quoted(encoding)}, which is not read`);
}

export async function openNrrd(file) {
  const { name } = file;
  const { fields, length } = await readHeader(file);
  const dataFile = fields.get('data file') ?? fields.get('datafile');
  if (dataFile) {
    throw new FileError(
      `${name} keeps its samples in another file, ${quoted(dataFile)}: a page opens one`,
    );
  }
  const type = types.get((fields.get('type') ?? '').toLowerCase());
  if (!type)
    throw new FileError(
      `${name} has the sample type ${quoted(fields.get('type'))}, which is not read`,
    );
  const packing = packingOf(name, (fields.get('encoding') ?? '').toLowerCase());
  const samples = samplesOf(name, fields);
  const bytes = checkedBytes(name, samples, type);
  checkFound(name, file.size - length, bytes, packing !== null);
  const skipped = ['line skip', 'lineskip', 'byte skip', 'byteskip'].flatMap((key) =>
    numbersOf(fields.get(key)),
  );
  const bigEndian = (fields.get('endian') ?? '').toLowerCase() === 'big';
  const fromEnd = packing === null && skipped.length === 1 && skipped[0] === -1;
  if (!fromEnd && skipped.some((n) => n !== 0)) {
    throw new FileError(`${name} skips lines or bytes of its samples, which is not read`);
  }
  return {
    type,
    samples,
    ...geometryOf(fields),
    name: printable(fields.get('content') ?? ''),
    lengthUnit: lengthUnitOf(fields),
    bytes,
    async read(target) {
      const stream = new ByteStream(
        name,
        file.slice(fromEnd ? file.size - bytes : length),
        packing,
      );
      await stream.fill(target);
      await stream.finish();
      if (bigEndian) swapBytes(target, bytesOfType[type]);
    },
  };
}
