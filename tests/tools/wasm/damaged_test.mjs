// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Damages files of one format as mutate_files.cpp does, of a header and its data file one, and opens
// them in the core: it must draw a volume of as many samples as it says, or refuse the file with one
// sentence, in time.
// Arguments: the folder explore, the folder of write_vti.cpp, the folder of make_volumes.cpp, the
// format. The environment variable NESTGRID_DAMAGED_FILES says how many files, by default 300.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { File } from 'node:buffer';
import { join } from 'node:path';
import { deflateSync, gzipSync } from 'node:zlib';
import { compileCore, isSentence, load } from './folder.mjs';

const [folder, vtis, volumes, format] = process.argv.slice(2);
const count = Number(process.env.NESTGRID_DAMAGED_FILES ?? 300);
const { openVolume } = await load(folder, 'readers/open_volume.js');
const { VolumeModule } = await load(folder, 'volume_module.js');
const { decodeFrame } = await load(folder, 'frame.js');
const core = await compileCore(folder);

const at = (folder_, name) => readFileSync(join(folder_, name));
const raw = at(volumes, 'v.raw');
const text = Buffer.from([...raw].join(' '));
const hex = Buffer.from(raw.toString('hex'));
const halves = [raw.subarray(0, 4320), raw.subarray(4320)];
const three = Buffer.concat([raw, raw, raw]);
const nrrd = (encoding, more = '', [dimension, sizes] = ['3', '20 24 18']) =>
  Buffer.from(
    `NRRD0004\ntype: uchar\ndimension: ${dimension}\nsizes: ${sizes}\nendian: little\n` +
      `encoding: ${encoding}\n${more}\n`,
  );
const space =
  'space: LPS\nspace directions: (1,0,0) (0,2,0) (0,0,1) none\nspace origin: (1,2,3)\n' +
  'kinds: domain domain domain list\nspace units: "mm" "mm" "mm"\n';
const vectors = 'kinds: vector domain domain domain\nspacings: nan 1 2 0.5\n';
const meta = (data, more = '', sizes = '20 24 18') =>
  Buffer.from(
    `ObjectType = Image\nNDims = ${sizes.split(' ').length}\nBinaryDataByteOrderMSB = False\n${more}` +
      `DimSize = ${sizes}\nElementType = MET_UCHAR\nElementDataFile = ${data}\n`,
  );
const place = 'Offset = 1 2 3\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nElementSpacing = 1 2 3\n';
const slope = 'ElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = 7\n';

/** A NIfTI file of three frames with a slope and both forms. */
const frames = () => {
  const header = Buffer.from(at(volumes, 'v.nii').subarray(0, 352));
  header.writeInt16LE(4, 40);
  header.writeInt16LE(3, 48);
  header.writeFloatLE(0.5, 112);
  header.writeInt16LE(1, 252);
  header.writeInt16LE(1, 254);
  header.writeFloatLE(352, 108);
  [1, 0, 0, 5, 0, 2, 0, 6, 0, 0, 1, 7].forEach((x, i) => header.writeFloatLE(x, 280 + 4 * i));
  return Buffer.concat([header, three]);
};

/** One file, or several that are chosen together. */
const originals = {
  vti: [
    'uint8_text',
    'int16_packed_little32_binary',
    'float32_packed_big64_base64',
    'uint16_packed_little32_raw',
    'float64_plain_little64_raw',
    'int32_plain_little32_base64',
  ].map((name) => [at(vtis, `${name}.vti`)]),
  nrrd: [
    [Buffer.concat([nrrd('raw'), raw])],
    [Buffer.concat([nrrd('gzip'), gzipSync(raw)])],
    [Buffer.concat([nrrd('ascii'), text])],
    [Buffer.concat([nrrd('hex'), hex])],
    [Buffer.concat([nrrd('raw', space, ['4', '20 24 18 3']), three])],
    [Buffer.concat([nrrd('gzip', vectors, ['4', '3 20 24 18']), gzipSync(three)])],
  ],
  nhdr: [
    [nrrd('raw', `${space}data file: v.0\n`, ['4', '20 24 18 3']), three],
    [nrrd('gzip', 'data file: LIST 3\nv.0\nv.1\n'), ...halves.map((half) => gzipSync(half))],
    [nrrd('raw', 'data file: v.%d 0 1 1 3\nbyte skip: -1\n'), ...halves],
  ],
  mha: [
    [Buffer.concat([meta('LOCAL', place), raw])],
    [Buffer.concat([meta('LOCAL', `${slope}CompressedData = True\n`), deflateSync(raw)])],
    [Buffer.concat([meta('LOCAL', 'ElementNumberOfChannels = 3\n'), three])],
    [Buffer.concat([meta('LOCAL', 'BinaryData = False\n', '20 24 18 1'), text])],
  ],
  mhd: [
    [meta('v.0', `${place}HeaderSize = -1\n`), raw],
    [meta('LIST\nv.0\nv.1'), ...halves],
  ],
  nii: [[at(volumes, 'v.nii')], [frames()]],
  'nii.gz': [
    [at(volumes, 'v.nii.gz')],
    [gzipSync(at(volumes, 'v.nii'), { level: 0 })],
    [gzipSync(frames())],
  ],
  raw: [[raw]],
}[format].map((files) => files.map((bytes) => Buffer.from(bytes)));

/** Numbers that are the same on every machine (xorshift). */
let state = 2463534242;
function below(limit) {
  state ^= state << 13;
  state ^= state >>> 17;
  state ^= state << 5;
  return limit < 1 ? 0 : (state >>> 0) % limit;
}

/** Half of all places are among the first 600, where headers are. */
const somewhere = (bytes) => below(below(2) === 0 ? Math.min(600, bytes.length) : bytes.length);

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
    const from = somewhere(bytes);
    const length = Math.min(bytes.length - from, 1 + below(20));
    switch (below(8)) {
      case 0:
        for (let k = 1 + below(8); k > 0; --k) bytes[somewhere(bytes)] ^= 1 << below(8);
        break;
      case 1:
        for (let k = 1 + below(8); k > 0; --k) bytes[somewhere(bytes)] = below(256);
        break;
      case 2:
        bytes.fill(below(256), from, from + length);
        break;
      case 3:
        bytes = Buffer.concat([bytes.subarray(0, from), bytes.subarray(from + length)]);
        break;
      case 4: {
        const copied = somewhere(bytes);
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

/** Opens files and draws them, as the page does. */
async function draw(contents) {
  const files = contents.map(
    (bytes, i) => new File([bytes], i === 0 ? `v.${format}` : `v.${i - 1}`),
  );
  const rawFormat = { samples: [20, 24, 18], type: 'uint8' };
  const volume = await openVolume(files, { rawFormat, firstOfSeveral: true });
  const module = await VolumeModule.make(core);
  const info = await module.open(volume);
  const isovalue = Number.isFinite(info.isovalue) ? info.isovalue : 0;
  const frame = decodeFrame(module.frame(`isovalue=${isovalue}&triangles=5000&normals=int8`));
  assert.ok(info.nodes >= volume.samples[0] * volume.samples[1] * volume.samples[2]);
  assert.equal(frame.parts[0].indices.length, 3 * frame.triangles);
}

for (const original of originals) await draw(original);
let drawn = 0;
const sentences = new Map();
for (let i = 0; i < count; ++i) {
  const files = [...originals[i % originals.length]];
  const which = Math.floor(i / originals.length) % files.length;
  files[which] = damaged(files[which]);
  const start = performance.now();
  try {
    await draw(files);
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
