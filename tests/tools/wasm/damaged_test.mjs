// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Damages files of one format as mutate_files.cpp does and opens each in the core: it must draw a
// volume of as many samples as it says, or refuse the file with one sentence, in time.
// Arguments: the folder explore, the folder of write_vti.cpp, the folder of make_volumes.cpp, the
// format. The environment variable NESTGRID_DAMAGED_FILES says how many files, by default 300.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { File } from 'node:buffer';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { compileCore, isSentence, load } from './folder.mjs';

const [folder, vtis, volumes, format] = process.argv.slice(2);
const count = Number(process.env.NESTGRID_DAMAGED_FILES ?? 300);
const { openVolume } = await load(folder, 'readers/open_volume.js');
const { VolumeModule } = await load(folder, 'volume_module.js');
const { decodeFrame } = await load(folder, 'frame.js');
const core = await compileCore(folder);

const at = (folder_, name) => readFileSync(join(folder_, name));
const raw = at(volumes, 'v.raw');
const header = (encoding) =>
  Buffer.from(
    'NRRD0004\ntype: uchar\ndimension: 3\nsizes: 20 24 18\nspacings: 0.5 1 2\n' +
      `encoding: ${encoding}\n\n`,
  );
const originals = {
  vti: [
    'uint8_text',
    'int16_packed_little32_binary',
    'float32_packed_big64_base64',
    'uint16_packed_little32_raw',
    'float64_plain_little64_raw',
    'int32_plain_little32_base64',
  ].map((name) => at(vtis, `${name}.vti`)),
  nrrd: [Buffer.concat([header('raw'), raw]), Buffer.concat([header('gzip'), gzipSync(raw)])],
  nii: [at(volumes, 'v.nii')],
  'nii.gz': [at(volumes, 'v.nii.gz'), gzipSync(at(volumes, 'v.nii'), { level: 0 })],
  raw: [raw],
}[format];

/** Numbers that are the same on every machine (xorshift). */
let state = 2463534242;
function below(limit) {
  state ^= state << 13;
  state ^= state >>> 17;
  state ^= state << 5;
  return limit < 1 ? 0 : (state >>> 0) % limit;
}

/** Half of all places are among the first 600, where headers are. */
const place = (bytes) => below(below(2) === 0 ? Math.min(600, bytes.length) : bytes.length);

function changeDigit(bytes, from) {
  for (let i = from; i < Math.min(bytes.length, from + 100); ++i) {
    if (bytes[i] < 48 || bytes[i] > 57) continue;
    bytes[i] = '0123456789012345678901234567890123456789-.e '.charCodeAt(below(44));
    return;
  }
}

function damaged(original) {
  let bytes = Buffer.from(original);
  for (let i = 0, times = 1 + below(2); i < times && bytes.length > 0; ++i) {
    const from = place(bytes);
    const length = Math.min(bytes.length - from, 1 + below(20));
    switch (below(8)) {
      case 0:
        for (let k = 1 + below(8); k > 0; --k) bytes[place(bytes)] ^= 1 << below(8);
        break;
      case 1:
        for (let k = 1 + below(8); k > 0; --k) bytes[place(bytes)] = below(256);
        break;
      case 2:
        bytes.fill(below(256), from, from + length);
        break;
      case 3:
        bytes = Buffer.concat([bytes.subarray(0, from), bytes.subarray(from + length)]);
        break;
      case 4: {
        const copied = place(bytes);
        bytes = Buffer.concat([
          bytes.subarray(0, from),
          bytes.subarray(copied, copied + length),
          bytes.subarray(from),
        ]);
        break;
      }
      case 5:
        bytes = bytes.subarray(0, below(bytes.length));
        break;
      default:
        changeDigit(bytes, from);
    }
  }
  return bytes;
}

/** Opens a file and draws it, as the page does. */
async function draw(file) {
  const volume = await openVolume(file, { samples: [20, 24, 18], type: 'uint8' });
  const module = await VolumeModule.make(core);
  const info = await module.open(volume);
  const isovalue = Number.isFinite(info.isovalue) ? info.isovalue : 0;
  const frame = decodeFrame(module.frame(`isovalue=${isovalue}&triangles=5000&normals=int8`));
  assert.ok(info.nodes >= volume.samples[0] * volume.samples[1] * volume.samples[2]);
  assert.equal(frame.parts[0].indices.length, 3 * frame.triangles);
}

for (const original of originals) await draw(new File([original], `v.${format}`));
let drawn = 0;
const sentences = new Map();
for (let i = 0; i < count; ++i) {
  const file = new File([damaged(originals[i % originals.length])], `v.${format}`);
  const start = performance.now();
  try {
    await draw(file);
    ++drawn;
  } catch (error) {
    // Errors of the language (TypeError, RangeError, RuntimeError) are faults of ours.
    assert.ok(error.constructor.name === 'FileError' || error.constructor === Error, error.stack);
    assert.ok(isSentence(error.message), error.message);
    const kind = error.message.replace(/[\d.]+/g, '0').slice(0, 60);
    sentences.set(kind, (sentences.get(kind) ?? 0) + 1);
  }
  const seconds = (performance.now() - start) / 1000;
  assert.ok(seconds < 20, `file ${i} took ${seconds} s`);
}
console.log(`${count} damaged files: ${drawn} drawn, ${count - drawn} refused`);
for (const [kind, times] of sentences) console.log(`${times} ${kind}`);
assert.ok(drawn > 0 || format === 'raw');
assert.ok(drawn < count);
