// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The text headers of MetaImage and NRRD files, and the data files that they name.
import { FileError, printable } from './volume.js';

const longestHeader = 2 ** 20;

/** The number that a word is; undefined where it is none. */
export function numberOf(word) {
  if (/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(word)) return Number(word);
  const [, sign, special] = /^([+-]?)(inf(?:inity)?|nan)$/i.exec(word) ?? [];
  if (!special) return undefined;
  if (special.toLowerCase() === 'nan') return NaN;
  return sign === '-' ? -Infinity : Infinity;
}

/** Lines "key <separator> value" of a header. */
export class TextHeader {
  name;
  /** Of bytes. */
  length = 0;
  /** By a blank line or by the last key. */
  ended = false;
  /** Bytes behind it. */
  behind = new Uint8Array();
  #fields = new Map();

  constructor(name) {
    this.name = name;
  }

  set(key, spelling, value) {
    this.#fields.set(key, { spelling, value });
  }

  /** '' where there is no such key. */
  value(key) {
    return this.#fields.get(key)?.value ?? '';
  }

  /** The first of the keys that is there. */
  firstKey(...keys) {
    return keys.find((key) => this.value(key) !== '') ?? keys[0];
  }

  /** "the ElementSpacing '1 1 2'", for sentences. */
  described(key) {
    const { spelling, value } = this.#fields.get(key) ?? { spelling: key, value: '' };
    return `the ${printable(spelling)} '${printable(value)}'`;
  }

  /** The words of a value, brackets and commas aside, which must be numbers, and `count`, or none. */
  numbers(key, count = null) {
    const words = this.value(key)
      .split(/[\s(),]+/)
      .filter((word) => word !== '');
    const numbers = words.map((word) => {
      const number = numberOf(word);
      if (number !== undefined) return number;
      throw new FileError(
        `${this.name} has ${this.described(key)}, of which '${printable(word)}' is no number`,
      );
    });
    if (count !== null && numbers.length > 0 && numbers.length !== count) {
      throw new FileError(
        `${this.name} has ${this.described(key)}, not ${count} number${count === 1 ? '' : 's'}`,
      );
    }
    return numbers;
  }
}

/**
 * Reads lines up to a blank one, or to one that is the last.
 * parse: parse(line) -> { key, spelling, value }, or null for lines that say nothing
 * isLast: isLast(key, value)
 */
export async function readTextHeader(file, parse, isLast) {
  const bytes = new Uint8Array(await file.slice(0, longestHeader).arrayBuffer());
  const decoder = new TextDecoder();
  const header = new TextHeader(file.name);
  while (!header.ended && header.length < bytes.length) {
    const newline = bytes.indexOf(10, header.length);
    const end = newline < 0 ? bytes.length : newline;
    const line = decoder.decode(bytes.subarray(header.length, end)).replace(/\r+$/, '');
    header.length = newline < 0 ? bytes.length : newline + 1;
    header.ended = line === '' && newline >= 0;
    const field = parse(line);
    if (!field) continue;
    header.set(field.key, field.spelling, field.value);
    header.ended = isLast(field.key, field.value);
  }
  header.behind = bytes.subarray(header.length);
  return header;
}

/** The names that a pattern and its first and last number and step stand for; none where it is none. */
function namesOfPattern(text) {
  const [, front, width, tail, numbers] = /^(.*?)%(\d{0,2})d(\S*)\s+(.*)$/.exec(text) ?? [];
  const [first, last, step = 1] = (numbers ?? '').split(/\s+/).map(Number);
  const isCount = (n) => Number.isInteger(n) && Math.abs(n) <= 1000000;
  if (![first, last, step].every(isCount) || step === 0 || (last - first) * step < 0) return [];
  const names = [];
  for (let i = first; step > 0 ? i <= last : i >= last; i += step) {
    const filler = width.startsWith('0') ? '0' : ' ';
    names.push(front + String(i).padStart(Number(width), filler) + tail);
  }
  return names;
}

/** The names of data files: one; LIST and those in the lines behind the header; or a pattern. */
export function namesOfData(header, value) {
  let names = [value];
  if (value.startsWith('LIST')) {
    const lines = new TextDecoder().decode(header.behind).split('\n');
    names = lines.map((line) => line.trim()).filter((line) => line !== '');
  }
  if (/%\d*d/.test(value)) names = namesOfPattern(value);
  if (names.length > 0) return names;
  throw new FileError(`${header.name} names no data files by '${printable(value)}'`);
}

/**
 * The parts of a layout (payload.js): the data files that a header names.
 * beside: beside(name) is the file of this name that was chosen with the header, or undefined
 */
export function partsOf(header, names, beside) {
  return names.map((name) => {
    const blob = beside(name.split(/[\\/]/).at(-1));
    if (blob) return { name: blob.name, blob };
    throw new FileError(
      `${header.name} keeps its samples in another file, '${printable(name)}', ` +
        'which is not here: choose both together',
    );
  });
}
