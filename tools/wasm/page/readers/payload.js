// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The numbers behind a header, in one file or spread evenly over several: plain, packed by gzip or
// zlib, or written as text. A *layout* is
//   fileName, type
//   numbers           how many there are in all
//   parts             [{ name, blob }], each with as many numbers as the others
//   encoding          'raw', 'packed', 'text' or 'hex'
//   lineSkip          lines before the numbers of each part
//   byteSkip          bytes behind these lines, unpacked; -1 - n: the numbers end n bytes before the end
//   bigEndian
import { ByteStream, packingOf } from './byte_stream.js';
import { FileError, arrayOfType, bytesOfType, checkFound, swapBytes } from './volume.js';

/** Longer texts are not read. */
const longestText = 2 ** 28;
/** Bytes of a file that are looked at for lines at a time. */
const lineBytes = 2 ** 16;

/** Writes numbers of a text, behind those that are skipped, to bytes. */
export function readText(name, text, type, skipped, target) {
  const to = new arrayOfType[type](target.length / bytesOfType[type]);
  const isWhole = type.includes('int');
  const convert = isWhole && type.endsWith('64') ? (word) => BigInt(word) : Number;
  let count = -skipped;
  try {
    for (const [word] of text.matchAll(/[^\s,]+/g)) {
      if (count === to.length) break;
      if (count >= 0) {
        const number = convert(word);
        if (Number.isNaN(number) && !/^[+-]?nan$/i.test(word)) throw new RangeError();
        to[count] = number;
      }
      ++count;
    }
  } catch {
    throw new FileError(
      `${name} is damaged: ${count} numbers, then something else than one of ${to.length} samples`,
    );
  }
  if (count < to.length)
    throw new FileError(
      `${name} is truncated: it has ${Math.max(count, 0)} samples of ${to.length}`,
    );
  target.set(new Uint8Array(to.buffer));
}

/** Writes bytes, of which the text has two hexadecimal digits each, behind those that are skipped. */
function readHex(name, text, skipped, target) {
  const digits = text.replace(/\s+/g, '');
  for (let i = 0; i < target.length; ++i) {
    const at = 2 * (skipped + i);
    const byte = digits.slice(at, at + 2);
    if (!/^[\da-f]{2}$/i.test(byte)) {
      throw new FileError(
        `${name} is truncated or damaged: only ${i} of its bytes are hexadecimal`,
      );
    }
    target[i] = Number.parseInt(byte, 16);
  }
}

/** A blob behind so many of its lines. */
async function behindLines(name, blob, lines) {
  let at = 0;
  for (let rest = lines; rest > 0;) {
    const block = new Uint8Array(await blob.slice(at, at + lineBytes).arrayBuffer());
    if (block.length === 0) throw new FileError(`${name} is truncated: it has fewer lines`);
    let to = 0;
    while (rest > 0) {
      const end = block.indexOf(10, to);
      if (end < 0) break;
      to = end + 1;
      --rest;
    }
    at += rest > 0 ? block.length : to;
  }
  return blob.slice(at);
}

class Part {
  #layout;
  #name;
  #blob;

  constructor(layout, { name, blob }) {
    this.#layout = layout;
    this.#name = name;
    this.#blob = blob;
  }

  /** Fills a target with bytes from one on. bytes: of all numbers of this part */
  async read(target, from, bytes) {
    const { encoding, lineSkip, byteSkip, type } = this.#layout;
    if (encoding === 'packed') return this.#unpack(target, from, bytes);
    let blob = await behindLines(this.#name, this.#blob, lineSkip);
    if (byteSkip < 0) blob = blob.slice(Math.max(0, blob.size - bytes + byteSkip + 1));
    else blob = blob.slice(byteSkip);
    if (encoding === 'raw') {
      checkFound(this.#name, blob.size, bytes, false);
      return new ByteStream(this.#name, blob.slice(from)).fill(target);
    }
    if (blob.size > longestText)
      throw new FileError(`${this.#name} has more than 256 MB of text, which is not read`);
    const text = new TextDecoder('latin1').decode(await blob.arrayBuffer());
    if (encoding === 'hex') return readHex(this.#name, text, from, target);
    return readText(this.#name, text, type, from / bytesOfType[type], target);
  }

  async #unpack(target, from, bytes) {
    const { lineSkip, byteSkip } = this.#layout;
    const blob = await behindLines(this.#name, this.#blob, lineSkip);
    const stream = new ByteStream(this.#name, blob, (await packingOf(blob)) ?? 'deflate');
    await stream.skip(byteSkip + from);
    await stream.fill(target);
    // Numbers that are not wanted must be there, too.
    await stream.skip(bytes - from - target.length);
    await stream.finish();
  }
}

/**
 * Compares a layout with the sizes of its files.
 * returns read(target, first), as a file has it (volume.js)
 */
export function payloadReader(layout) {
  const { fileName, type, numbers, parts, encoding, byteSkip } = layout;
  if (numbers % parts.length !== 0) {
    throw new FileError(
      `${fileName} does not spread its samples evenly over its ${parts.length} data files`,
    );
  }
  if (encoding !== 'raw' && byteSkip < 0) {
    throw new FileError(
      `${fileName} skips bytes of packed samples from their end, which is not read`,
    );
  }
  const share = numbers / parts.length;
  const bytes = share * bytesOfType[type];
  const least = { raw: bytes, packed: bytes, text: 2 * share - 1, hex: 2 * bytes }[encoding];
  const skipped = encoding === 'raw' ? Math.max(0, byteSkip) : 0;
  for (const { name, blob } of parts)
    checkFound(name, blob.size - skipped, least, encoding === 'packed');
  return async (target, first) => {
    const from = first * bytesOfType[type];
    for (let at = 0; at < target.length;) {
      const i = Math.floor((from + at) / bytes);
      const inPart = from + at - i * bytes;
      const some = target.subarray(at, at + bytes - inPart);
      await new Part(layout, parts[i]).read(some, inPart, bytes);
      at += some.length;
    }
    if (layout.bigEndian && encoding !== 'text') swapBytes(target, bytesOfType[type]);
  };
}
