// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Image data of VTK, .vti: an array of one piece, chosen as tools/input/vti_file.cpp does; text,
// base64 or raw, packed by zlib or not.
import { readText } from './payload.js';
import { Base64Source, BlobSource, readBlocks } from './vtk_blocks.js';
import {
  FileError,
  bytesOfType,
  checkFound,
  checkedBytes,
  countedNumbers,
  denseStrides,
  listed,
  plainFile,
  printable,
  quoted,
  swapBytes,
} from './volume.js';

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

/** The arrays of numbers in a tag, PointData or CellData, and the name of the active one. */
function arraysIn(tags, tag) {
  const begin = tags.findIndex((t) => t.name === tag);
  const end = tags.findIndex((t) => t.name === `/${tag}`);
  const inside = begin < 0 ? [] : tags.slice(begin, end);
  const arrays = inside.filter((t) => t.name === 'DataArray' && t.attributes.type !== 'String');
  return { arrays, active: tags[begin]?.attributes.Scalars };
}

const nameOf = (array) => array.attributes.Name ?? '';

/** The array of this name; without one, the active scalars, else the only array; or undefined. */
function chosenArray(name, { arrays, active }, { array, firstOfSeveral }) {
  const called = (text) => arrays.find((each) => nameOf(each) === text);
  if (array !== undefined) return called(array);
  const scalars = active === undefined ? undefined : called(active);
  if (scalars || arrays.length < 2 || firstOfSeveral) return scalars ?? arrays[0];
  throw new FileError(`${name} has several arrays, choose one: ${listed(arrays.map(nameOf))}`);
}

/** { found, ofCells, names }: an array of the points, else of the cells, and the names of all. */
function arrayOf(name, tags, choice) {
  const points = arraysIn(tags, 'PointData');
  const cells = arraysIn(tags, 'CellData');
  const ofPoints = chosenArray(name, points, choice);
  const found = ofPoints ?? chosenArray(name, cells, choice);
  const names = [...points.arrays, ...cells.arrays].map(nameOf);
  if (found) return { found, ofCells: !ofPoints, names: [...new Set(names)] };
  if (choice.array === undefined) throw new FileError(`${name} has neither point nor cell data`);
  throw new FileError(
    `${name} has no point data array ${quoted(choice.array)}, ` +
      (names.length > 0 ? `only ${listed(names)}` : 'and no other'),
  );
}

/** The grid of the centres of cells. A plane has as many of these as samples across it. */
function gridOfCentres({ samples, spacing, origin, direction }) {
  return {
    samples: samples.map((n) => (n < 2 ? n : n - 1)),
    spacing,
    direction,
    origin: origin.map((x, r) =>
      [0, 1, 2].reduce(
        (sum, d) => sum + (samples[d] < 2 ? 0 : (direction[3 * r + d] * spacing[d]) / 2),
        x,
      ),
    ),
  };
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
    return async (target) => readText(name, text.slice(array.to, close), layout.type, 0, target);
  if (format !== 'binary')
    throw new FileError(`${name} has samples of the format ${quoted(format)}, which is not read`);
  const inline = text.slice(array.to, close).trim();
  const make = (from) => new Base64Source(name, new Blob([inline]), from);
  return (target) => readBlocks(name, make, true, layout, target);
}

export async function openVti(file, choice) {
  const fileName = file.name;
  const xml = await readXml(file);
  const root = xml.tags[0]?.name === 'VTKFile' ? xml.tags[0] : null;
  if (!root) throw new FileError(`${fileName} is no VTK image data file`);
  const { bigEndian, ...coding } = bytesAsIn(fileName, root);
  const ofPoints = gridOf(fileName, xml.tags);
  const { found: array, ofCells, names } = arrayOf(fileName, xml.tags, choice);
  const grid = ofCells ? gridOfCentres(ofPoints) : ofPoints;
  const type = (array.attributes.type ?? '').toLowerCase();
  if (!Object.hasOwn(bytesOfType, type))
    throw new FileError(
      `${fileName} has samples of the type ${quoted(array.attributes.type)}, which is not read`,
    );
  checkedBytes(fileName, grid.samples, type);
  const [components] = integers(fileName, array.attributes.NumberOfComponents ?? '1', 1);
  if (components < 1) throw new FileError(`${fileName} has samples without numbers`);
  const numbers = countedNumbers(fileName, ...grid.samples, components);
  const bytes = numbers * bytesOfType[type];
  const isText = array.attributes.format === 'ascii';
  checkFound(fileName, file.size, isText ? numbers : bytes, coding.packed);
  const fill = readerOf(file, xml, array, { type, bigEndian, ...coding });
  const name = nameOf(array);
  return {
    ...plainFile,
    fileName,
    type,
    ...grid,
    ...denseStrides(grid.samples, components),
    arrays: names,
    array: name,
    // VTK's own name for what nobody has named.
    name: name === 'ImageScalars' ? '' : printable(name),
    note: ofCells ? `the cell data of ${fileName} are taken at the centres of the cells` : '',
    /** Blocks are of all numbers. */
    async read(target, first) {
      const all = target.length === bytes ? target : new Uint8Array(bytes);
      await fill(all);
      if (all !== target) {
        const from = first * bytesOfType[type];
        target.set(all.subarray(from, from + target.length));
      }
      if (bigEndian && !isText) swapBytes(target, bytesOfType[type]);
    },
  };
}
