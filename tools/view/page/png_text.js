// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Texts in a PNG file: chunks of type tEXt, or iTXt for what Latin-1 does not have.

/** The signature, and the chunk IHDR with its length, type, 13 bytes and sum. */
const headBytes = 8 + 25;

const table = new Uint32Array(256).map((_, n) => {
  let c = n;
  for (let k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c;
});

function sumOf(bytes) {
  let c = 0xffffffff;
  for (const byte of bytes) c = table[(c ^ byte) & 255] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

function chunk(keyword, text) {
  const isLatin = [...text].every((c) => c.codePointAt(0) < 256);
  const latin = (letters) => Uint8Array.from(letters, (c) => c.codePointAt(0));
  const content = isLatin
    ? latin(`tEXt${keyword}\0${text}`)
    : Uint8Array.of(...latin(`iTXt${keyword}\0\0\0\0\0`), ...new TextEncoder().encode(text));
  const bytes = new Uint8Array(content.length + 8);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, content.length - 4);
  bytes.set(content, 4);
  view.setUint32(content.length + 4, sumOf(content));
  return bytes;
}

/** A PNG file with texts { keyword: text } behind its head. */
export function withTexts(png, texts) {
  const chunks = Object.entries(texts).map(([keyword, text]) => chunk(keyword, text));
  return new Blob([png.slice(0, headBytes), ...chunks, png.slice(headBytes)], { type: 'image/png' });
}
