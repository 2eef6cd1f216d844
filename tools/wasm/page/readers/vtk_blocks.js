// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The bytes of an array in a VTK file: a header of words, then the samples, whole or in blocks that
// zlib has packed one by one. As base64, the header of packed samples is a text of its own.
import { ByteStream } from './byte_stream.js';
import { FileError } from './volume.js';

/** Bytes as they are. */
export class BlobSource {
  #name;
  #blob;
  constructor(name, blob, from) {
    this.#name = name;
    this.#blob = blob.slice(from);
  }
  /** So many bytes from one on, as a Blob. */
  async part(from, count) {
    const part = this.#blob.slice(from, from + count);
    if (part.size < count) throw truncated(this.#name);
    return part;
  }
}

/** Bytes written as base64. */
export class Base64Source {
  #name;
  #blob;
  /** from: a character, at which a text of base64 begins */
  constructor(name, blob, from) {
    this.#name = name;
    this.#blob = blob.slice(from);
  }
  async part(from, count) {
    const first = Math.floor(from / 3);
    const last = Math.ceil((from + count) / 3);
    const text = await this.#blob.slice(4 * first, 4 * last).text();
    let binary;
    try {
      binary = atob(text);
    } catch {
      throw new FileError(`${this.#name} is damaged: its samples are no base64`);
    }
    const skipped = from - 3 * first;
    if (binary.length < skipped + count) throw truncated(this.#name);
    const bytes = new Uint8Array(count);
    for (let i = 0; i < count; ++i) bytes[i] = binary.charCodeAt(skipped + i);
    return new Blob([bytes]);
  }
}

function truncated(name) {
  return new FileError(`${name} is truncated: its samples end too early`);
}

/** Words of a header. */
async function wordsOf(name, source, from, count, { wordBytes, bigEndian }) {
  const part = await source.part(from * wordBytes, count * wordBytes);
  const view = new DataView(await part.arrayBuffer());
  const words = [];
  for (let i = 0; i < count; ++i) {
    const word =
      wordBytes === 8
        ? Number(view.getBigUint64(8 * i, !bigEndian))
        : view.getUint32(4 * i, !bigEndian);
    if (!Number.isSafeInteger(word))
      throw new FileError(`${name} is damaged: its samples take ${word} bytes`);
    words.push(word);
  }
  return words;
}

/** Bytes of base64 that are decoded at a time; a multiple of 3. */
const most = 3 * 2 ** 20;

async function readWhole(name, source, layout, target) {
  const [bytes] = await wordsOf(name, source, 0, 1, layout);
  if (bytes !== target.length) {
    throw new FileError(
      `${name} is damaged: its samples take ${target.length} bytes, not ${bytes}`,
    );
  }
  for (let at = 0; at < target.length; at += most) {
    const part = await source.part(layout.wordBytes + at, Math.min(most, target.length - at));
    await new ByteStream(name, part).fill(target.subarray(at, at + part.size));
  }
}

/**
 * Fills a target with the samples of an array.
 * make: make(from) is the source of bytes that begins with byte or character `from`
 * isText: whether they are base64
 * layout: { wordBytes, bigEndian, packed }
 */
export async function readBlocks(name, make, isText, layout, target) {
  const source = make(0);
  if (!layout.packed) return readWhole(name, source, layout, target);
  const [count, blockBytes, lastBytes] = await wordsOf(name, source, 0, 3, layout);
  const whole = lastBytes > 0 ? count - 1 : count;
  if (count < 1 || blockBytes < 1 || whole * blockBytes + lastBytes !== target.length) {
    throw new FileError(
      `${name} is damaged: ${count} blocks of ${blockBytes} bytes are not its ` +
        `${target.length} bytes of samples`,
    );
  }
  const packed = await wordsOf(name, source, 3, count, layout);
  const headerBytes = (3 + count) * layout.wordBytes;
  const data = make(isText ? 4 * Math.ceil(headerBytes / 3) : headerBytes);
  for (let block = 0, from = 0, at = 0; block < count; ++block) {
    const part = await data.part(from, packed[block]);
    const bytes = block < whole ? blockBytes : lastBytes;
    const stream = new ByteStream(name, part, 'deflate');
    await stream.fill(target.subarray(at, at + bytes));
    await stream.finish();
    from += packed[block];
    at += bytes;
  }
}
