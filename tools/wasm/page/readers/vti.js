// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Image data of VTK, .vti: the active scalars, or else the first array of scalars, of one piece;
// text, base64 or raw, packed by zlib or not.
import { Base64Source, BlobSource, readBlocks } from './vtk_blocks.js';
import { FileError, bytesOfType, checkFound, checkedBytes, quoted, swapBytes } from './volume.js';

/** Longer headers, and samples inside XML beyond this, are not read. */
const longestHeader = 2 ** 20;
const longestText = 2 ** 28;

const decode = (buffer) => new TextDecoder('latin1').decode(buffer);

/** The tags of a text in order: name, attributes, where each begins and ends. */
function tagsOf(text) {
  const tags = [];
  const pattern = /<(\/?[A-Za-z]\w*)((?:\s+\w+\s*=\s*(?:"[^"<]*"|'[^'<]*'))*)\s*\/?>/g;
  for (let match = pattern.exec(text); match; match = pattern.exec(text)) {
    const attributes = {};
    for (const [, key, value] of match[2].matchAll(/(\w+)\s*=\s*["']([^"']*)["']/g)) {
      attributes[key] = value;
    }
    tags.push({ name: match[1], attributes, from: match.index, to: pattern.lastIndex });
  }
  return tags;
}

function integers(name, text, count) {
  const numbers = (text ?? '').trim().split(/\s+/).map(Number);
  if (numbers.length !== count || !numbers.every(Number.isSafeInteger)) {
    throw new FileError(`${name} is damaged: ${quoted(text)} are not ${count} integers`);
  }
  return numbers;
}

function numbers(name, text, otherwise) {
  if (text === undefined) return otherwise;
  const list = text.trim().split(/\s+/).map(Number);
  if (list.length !== otherwise.length || !list.every(Number.isFinite)) {
    throw new FileError(`${name} is damaged: ${quoted(text)} are not ${otherwise.length} numbers`);
  }
  return list;
}

/** The XML of a file up to the samples behind it, and where these begin. */
async function readXml(file) {
  const { name } = file;
  const end = decode(await file.slice(-256).arrayBuffer());
  if (!/<\/VTKFile>\s*$/.test(end)) {
    throw new FileError(`${name} is truncated or no VTK file: it does not end with </VTKFile>`);
  }
  let text = decode(await file.slice(0, longestHeader).arrayBuffer());
  if (!text.includes('<AppendedData') && file.size > longestHeader) {
    if (file.size > longestText)
      throw new FileError(`${name} has more than 256 MB of samples inside XML, which is not read`);
    text = decode(await file.arrayBuffer());
  }
  const appended = /<AppendedData[^>]*>\s*_/.exec(text);
  if (!appended) return { text, tags: tagsOf(text) };
  const tags = tagsOf(text.slice(0, appended.index + appended[0].length));
  return { text, tags, appendedAt: appended.index + appended[0].length };
}

function arrayOf(name, tags) {
  const data = tags.findIndex((tag) => tag.name === 'PointData');
  const end = tags.findIndex((tag) => tag.name === '/PointData');
  const arrays = data < 0 ? [] : tags.slice(data, end).filter((tag) => tag.name === 'DataArray');
  const components = (array) => Number(array.attributes.NumberOfComponents ?? 1);
  const active = tags[data]?.attributes.Scalars;
  const found =
    arrays.find((array) => array.attributes.Name === active) ??
    arrays.find((array) => components(array) === 1);
  if (!found) throw new FileError(`${name} has no point data that could be contoured`);
  if (components(found) !== 1)
    throw new FileError(`${name} has ${components(found)} numbers per sample, not one`);
  return found;
}

function gridOf(name, tags) {
  const one = (tag) => {
    const found = tags.filter((t) => t.name === tag);
    if (found.length !== 1)
      throw new FileError(`${name} has ${found.length} tags ${tag}; one is read`);
    return found[0].attributes;
  };
  const whole = one('ImageData');
  const extent = integers(name, one('Piece').Extent, 6);
  const samples = [0, 1, 2].map((d) => extent[2 * d + 1] - extent[2 * d] + 1);
  const spacing = numbers(name, whole.Spacing, [1, 1, 1]);
  const direction = numbers(name, whole.Direction, [1, 0, 0, 0, 1, 0, 0, 0, 1]);
  const origin = numbers(name, whole.Origin, [0, 0, 0]).map(
    (x, r) =>
      x + [0, 1, 2].reduce((sum, d) => sum + direction[3 * r + d] * spacing[d] * extent[2 * d], 0),
  );
  return { samples, spacing, origin, direction };
}

/** What the tag VTKFile says about bytes. */
function bytesAsIn(name, { attributes }) {
  const { type, byte_order: order, header_type: header = 'UInt32', compressor } = attributes;
  if (type !== 'ImageData') throw new FileError(`${name} is no VTK image data file`);
  if (!['UInt32', 'UInt64'].includes(header))
    throw new FileError(`${name} has headers of ${quoted(header)}`);
  if (compressor !== undefined && compressor !== 'vtkZLibDataCompressor') {
    throw new FileError(`${name} is packed by ${quoted(compressor)}, which is not read`);
  }
  return {
    bigEndian: order === 'BigEndian',
    wordBytes: header === 'UInt64' ? 8 : 4,
    packed: compressor !== undefined,
  };
}

const viewOf = {
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

/** Writes the numbers of a text to bytes. */
function readText(name, text, type, target) {
  const to = new viewOf[type](target.length / bytesOfType[type]);
  const convert = type.endsWith('64') && type !== 'float64' ? (word) => BigInt(word) : Number;
  let count = 0;
  try {
    for (const [word] of text.matchAll(/\S+/g)) {
      const number = convert(word);
      if (count === to.length || Number.isNaN(number)) throw new RangeError();
      to[count++] = number;
    }
  } catch {
    throw new FileError(
      `${name} is damaged: ${count} numbers, then something else than one of ${to.length} samples`,
    );
  }
  if (count < to.length)
    throw new FileError(`${name} is truncated: it has ${count} samples of ${to.length}`);
  target.set(new Uint8Array(to.buffer));
}

/** What fills a target with the samples of an array. */
function readerOf(file, xml, array, layout) {
  const { name } = file;
  const { text, tags, appendedAt } = xml;
  const { format } = array.attributes;
  if (format === 'appended') {
    const [offset] = integers(name, array.attributes.offset, 1);
    const appended = tags.at(-1).attributes.encoding;
    if (appendedAt === undefined || offset < 0 || !['raw', 'base64'].includes(appended)) {
      throw new FileError(`${name} is damaged: it has no appended data for its samples`);
    }
    const behind = file.slice(appendedAt + offset);
    const make =
      appended === 'raw'
        ? (from) => new BlobSource(name, behind, from)
        : (from) => new Base64Source(name, behind, from);
    return (target) => readBlocks(name, make, appended === 'base64', layout, target);
  }
  const close = text.indexOf('<', array.to);
  if (format === 'ascii')
    return async (target) => readText(name, text.slice(array.to, close), layout.type, target);
  if (format !== 'binary')
    throw new FileError(`${name} has samples of the format ${quoted(format)}, which is not read`);
  const inline = text.slice(array.to, close).trim();
  const make = (from) => new Base64Source(name, new Blob([inline]), from);
  return (target) => readBlocks(name, make, true, layout, target);
}

export async function openVti(file) {
  const { name } = file;
  const xml = await readXml(file);
  const root = xml.tags[0]?.name === 'VTKFile' ? xml.tags[0] : null;
  if (!root) throw new FileError(`${name} is no VTK image data file`);
  const { bigEndian, ...coding } = bytesAsIn(name, root);
  const grid = gridOf(name, xml.tags);
  const array = arrayOf(name, xml.tags);
  const type = (array.attributes.type ?? '').toLowerCase();
  if (!Object.hasOwn(bytesOfType, type))
    throw new FileError(
      `${name} has samples of the type ${quoted(array.attributes.type)}, which is not read`,
    );
  const bytes = checkedBytes(name, grid.samples, type);
  const isText = array.attributes.format === 'ascii';
  checkFound(name, file.size, isText ? bytes / bytesOfType[type] : bytes, coding.packed);
  const fill = readerOf(file, xml, array, { type, bigEndian, ...coding });
  return {
    type,
    ...grid,
    bytes,
    // VTK's own name for what nobody has named.
    name: array.attributes.Name === 'ImageScalars' ? '' : array.attributes.Name,
    async read(target) {
      await fill(target);
      if (bigEndian && !isText) swapBytes(target, bytesOfType[type]);
    },
  };
}
