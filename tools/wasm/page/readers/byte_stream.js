// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bytes of a file one after the other, packed or not. Holds one chunk of the file at a time.
import { FileError } from './volume.js';

/** How bytes are packed that begin as those of gzip do; null where they do not. */
export async function packingOf(blob) {
  const [first, second] = new Uint8Array(await blob.slice(0, 2).arrayBuffer());
  return first === 0x1f && second === 0x8b ? 'gzip' : null;
}

export class ByteStream {
  #name;
  #packing;
  /** From the member of gzip on that is being unpacked, of which so many bytes are. */
  #blob;
  #unpacked = 0;
  #reader;
  #chunk = new Uint8Array(0);

  /**
   * name: of the file, for messages
   * blob: where the bytes are
   * packing: null, 'gzip' or 'deflate' (that of zlib)
   */
  constructor(name, blob, packing = null) {
    this.#name = name;
    this.#packing = packing;
    this.#open(blob);
  }

  /** Fills an array with the next bytes. */
  async fill(target) {
    for (let at = 0; at < target.length;) {
      if (!(await this.#more())) {
        this.close();
        throw this.#damaged(at, target.length);
      }
      const part = this.#chunk.subarray(0, target.length - at);
      target.set(part, at);
      at += part.length;
      this.#chunk = this.#chunk.subarray(part.length);
    }
  }

  async skip(count) {
    for (let rest = count; rest > 0;) {
      if (!(await this.#more())) {
        this.close();
        throw this.#damaged(count - rest, count);
      }
      const part = Math.min(rest, this.#chunk.length);
      this.#chunk = this.#chunk.subarray(part);
      rest -= part;
    }
  }

  /** Compares the checksum, where the stream ends here. */
  async finish() {
    await this.#more();
    this.close();
  }

  close() {
    // Where the stream has failed, somebody has been told.
    this.#reader.cancel().catch(() => {});
  }

  #open(blob) {
    this.#blob = blob;
    this.#unpacked = 0;
    const bytes = blob.stream();
    this.#reader = (
      this.#packing ? bytes.pipeThrough(new DecompressionStream(this.#packing)) : bytes
    ).getReader();
  }

  /** Makes the chunk not empty; false where there are no more bytes. */
  async #more() {
    while (this.#chunk.length === 0) {
      let next;
      try {
        next = await this.#reader.read();
      } catch {
        if (!this.#packing) throw new FileError(`${this.#name} cannot be read`);
        if (!(await this.#openNextMember())) return false;
        continue;
      }
      if (next.done) return false;
      this.#chunk = next.value;
      this.#unpacked += this.#chunk.length;
    }
    return true;
  }

  /**
   * Opens the member of gzip behind the one that was unpacked; false where something else is there.
   * Throws where the member has no end.
   */
  async #openNextMember() {
    if (this.#packing !== 'gzip') throw this.#damaged(0, 0);
    const { endOfMember } = await import('./gzip_members.js');
    const end = await endOfMember(this.#blob, this.#unpacked);
    if (end === null) throw this.#damaged(0, 0);
    const behind = this.#blob.slice(end);
    if ((await packingOf(behind)) !== 'gzip') return false;
    this.#open(behind);
    return true;
  }

  #damaged(found, expected) {
    return new FileError(
      this.#packing
        ? `${this.#name} is truncated or damaged: it cannot be unpacked to its end`
        : `${this.#name} is truncated: it ends after ${found} bytes of ${expected}`,
    );
  }
}
