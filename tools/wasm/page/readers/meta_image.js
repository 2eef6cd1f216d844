// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// MetaImage, .mha and .mhd. Takes headers as meta_layout() of
// adapters/volume_files/sample_layout.cpp does, where all fields are listed.
import { payloadReader } from './payload.js';
import { namesOfData, partsOf, readTextHeader } from './text_header.js';
import {
  FileError,
  checkedBytes,
  countedNumbers,
  denseStrides,
  plainFile,
  printable,
  quoted,
} from './volume.js';

const types = {
  MET_CHAR: 'int8',
  MET_UCHAR: 'uint8',
  MET_SHORT: 'int16',
  MET_USHORT: 'uint16',
  MET_INT: 'int32',
  MET_UINT: 'uint32',
  MET_LONG: 'int32',
  MET_ULONG: 'uint32',
  MET_LONG_LONG: 'int64',
  MET_ULONG_LONG: 'uint64',
  MET_FLOAT: 'float32',
  MET_DOUBLE: 'float64',
};

function parseLine(line) {
  const at = line.indexOf('=');
  if (at < 0 || line[0] === '#') return null;
  const spelling = line.slice(0, at).trim();
  const value = line.slice(at + 1).trim();
  return { key: spelling.toLowerCase(), spelling, value };
}

const isTrue = (value) => /^[ty1]/i.test(value);

function wholeNumber(header, key, number) {
  if (Number.isInteger(number) && number >= 1 && number <= 2 ** 20) return number;
  throw new FileError(
    `${header.name} has the size '${printable(header.value(key))}', not that of a volume`,
  );
}

/** Number i of a list, which must be finite; `otherwise` where the list is empty. */
function finite(header, key, numbers, i, otherwise) {
  if (numbers.length === 0) return otherwise;
  if (Number.isFinite(numbers[i])) return numbers[i];
  throw new FileError(`${header.name} has ${header.described(key)}, which is not finite`);
}

/** Counts of samples and frames, and the place. The axes behind the third one are frames. */
function geometryOf(header) {
  const sizes = header.numbers('dimsize');
  const [dimensions = sizes.length] = header.numbers('ndims', 1);
  const n = wholeNumber(header, 'ndims', dimensions);
  if (sizes.length !== n || n > 10) {
    const size = printable(header.value('dimsize'));
    throw new FileError(
      `${header.name} has the size '${size}' of ${n} dimensions, not that of a volume`,
    );
  }
  const counts = sizes.map((size) => wholeNumber(header, 'dimsize', size));
  const spacing = header.firstKey('elementspacing', 'elementsize');
  const origin = header.firstKey('offset', 'position', 'origin');
  const matrix = header.firstKey('transformmatrix', 'rotation', 'orientation');
  const spacings = header.numbers(spacing, n);
  const places = header.numbers(origin, n);
  const axes = header.numbers(matrix, n * n);
  const three = [0, 1, 2];
  return {
    samples: three.map((d) => counts[d] ?? 1),
    frames: countedNumbers(header.name, ...counts.slice(3)),
    spacing: three.map((d) => (d < n ? finite(header, spacing, spacings, d, 1) : 1)),
    origin: three.map((d) => (d < n ? finite(header, origin, places, d, 0) : 0)),
    // MetaImage lists the axes one after the other.
    direction: three.flatMap((r) =>
      three.map((d) => {
        const along = r === d ? 1 : 0;
        return r < n && d < n ? finite(header, matrix, axes, d * n + r, along) : along;
      }),
    ),
  };
}

function scaleOf(header) {
  const one = (key, otherwise) => finite(header, key, header.numbers(key, 1), 0, otherwise);
  const slope = one('elementtointensityfunctionslope', 1);
  if (slope === 0) throw new FileError(`${header.name} has an intensity function of slope 0`);
  return { slope, intercept: one('elementtointensityfunctionoffset', 0) };
}

/** Where the samples are, and how they are packed. */
function payloadOf(header, file, beside) {
  const names = header.value('elementdatafile');
  const local = names.toLowerCase() === 'local';
  const [skipped = 0] = local ? [] : header.numbers('headersize', 1);
  const binary = header.value('binarydata');
  let encoding = binary !== '' && !isTrue(binary) ? 'text' : 'raw';
  if (isTrue(header.value('compresseddata'))) encoding = 'packed';
  return {
    parts: local
      ? [{ name: file.name, blob: file.slice(header.length) }]
      : partsOf(header, namesOfData(header, names), beside),
    encoding,
    lineSkip: 0,
    byteSkip: Number.isInteger(skipped) && skipped >= 0 ? skipped : -1,
    bigEndian: ['binarydatabyteordermsb', 'elementbyteordermsb'].some((key) =>
      isTrue(header.value(key)),
    ),
  };
}

export async function openMetaImage(file, { beside }) {
  const fileName = file.name;
  const header = await readTextHeader(file, parseLine, (key) => key === 'elementdatafile');
  if (header.value('elementdatafile') === '')
    throw new FileError(`${fileName} is no MetaImage: it names no data file`);
  const typeName = header.value('elementtype');
  if (!Object.hasOwn(types, typeName))
    throw new FileError(`${fileName} has the sample type ${quoted(typeName)}, which is not read`);
  const type = types[typeName];
  const { frames, ...geometry } = geometryOf(header);
  checkedBytes(fileName, geometry.samples, type);
  const [channels = 1] = header.numbers('elementnumberofchannels', 1);
  const components = wholeNumber(header, 'elementnumberofchannels', channels);
  const numbers = countedNumbers(fileName, ...geometry.samples, components, frames);
  const scale = scaleOf(header);
  const read = payloadReader({ fileName, type, numbers, ...payloadOf(header, file, beside) });
  const unit = header.value('distanceunits');
  // Who knows where a patient lies writes places as ITK does.
  const orientation = header.value('anatomicalorientation');
  return {
    ...plainFile,
    fileName,
    type,
    ...geometry,
    ...denseStrides(geometry.samples, components, frames),
    ...scale,
    name: printable(header.value('name')),
    lengthUnit: unit === '?' ? '' : printable(unit),
    space: orientation.length >= 3 && !orientation.includes('?') ? 'LPS' : '',
    read,
  };
}
