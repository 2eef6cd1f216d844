// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where a member of gzip ends. Files may have several, one behind the other, as bgzip writes them, and
// others something else behind the last one; browsers unpack the first and fail, without its end.
const blockBytes = 2 ** 20;
const mostTries = 8;

/** The bytes of a stream; null where it fails. */
async function countedBytes(stream) {
  let count = 0;
  try {
    const reader = stream.getReader();
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return count;
      count += value.length;
    }
  } catch {
    return null;
  }
}

/** The places in a blob behind four bytes that are this number, least byte first. */
async function* placesBehind(blob, number) {
  const [a, b, c, d] = [0, 8, 16, 24].map((shift) => (number >>> shift) & 255);
  for (let from = 0; from < blob.size; from += blockBytes) {
    const block = new Uint8Array(await blob.slice(from, from + blockBytes + 3).arrayBuffer());
    for (let i = block.indexOf(a); i >= 0 && i < blockBytes; i = block.indexOf(a, i + 1)) {
      if (block[i + 1] === b && block[i + 2] === c && block[i + 3] === d) yield from + i + 4;
    }
  }
}

/**
 * Where the first member in a blob ends, of which so many bytes were unpacked: behind their number, and
 * where the browser finds its checksum right. null where there is no such place.
 */
export async function endOfMember(blob, unpacked) {
  let tries = 0;
  for await (const end of placesBehind(blob, unpacked % 2 ** 32)) {
    if (++tries > mostTries) return null;
    const member = blob.slice(0, end).stream().pipeThrough(new DecompressionStream('gzip'));
    if ((await countedBytes(member)) === unpacked) return end;
  }
  return null;
}
