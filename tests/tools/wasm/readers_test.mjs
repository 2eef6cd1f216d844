// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The readers of the page give the samples and the place of every volume that VTK and
// make_volumes.cpp write, and refuse with a sentence what they do not read.
// Arguments: the folder explore, the folder of write_vti.cpp, the folder of make_volumes.cpp.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { File } from 'node:buffer';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { compileCore, fileAt, isSentence, load } from './folder.mjs';

const [folder, vtis, volumes] = process.argv.slice(2);
const { openVolume: openFiles } = await load(folder, 'readers/open_volume.js');
const { rawFormatOfName } = await load(folder, 'readers/raw.js');
const { ByteStream } = await load(folder, 'readers/byte_stream.js');
const { FileError } = await load(folder, 'readers/volume.js');
const { VolumeModule } = await load(folder, 'volume_module.js');
const core = await compileCore(folder);

const openVolume = (file, rawFormat) => openFiles([file], { rawFormat });

async function samplesOf(volume) {
  const target = new Uint8Array(volume.bytes);
  await volume.read(target);
  return Buffer.from(target);
}

/** The place of a sample in space. */
const placeOf = (volume, index) =>
  [0, 1, 2].map(
    (r) =>
      volume.origin[r] +
      [0, 1, 2].reduce(
        (sum, d) => sum + volume.direction[3 * r + d] * volume.spacing[d] * index[d],
        0,
      ),
  );

function assertNear(found, expected, what) {
  found.forEach((x, i) =>
    assert.ok(Math.abs(x - expected[i]) < 1e-5, `${what}: ${found}, not ${expected}`),
  );
}

async function refused(file, pattern, rawFormat = null) {
  const error = await openVolume(file, rawFormat)
    .then(samplesOf)
    .then(
      () => null,
      (e) => e,
    );
  assert.ok(error instanceof FileError, `${file.name}: ${error?.stack}`);
  assert.ok(isSentence(error.message) && pattern.test(error.message), error.message);
}

// Every way in which VTK writes .vti, and every type.
const names = readdirSync(vtis).filter((name) => /^\D+\d+_.*\.vti$/.test(name));
assert.equal(names.length, 250);
for (const name of names) {
  const type = name.split('_')[0];
  const volume = await openVolume(fileAt(join(vtis, name)));
  assert.deepEqual(
    [volume.type, volume.samples, volume.name],
    [type, [17, 19, 13], 'density'],
    name,
  );
  assert.ok((await samplesOf(volume)).equals(readFileSync(join(vtis, `${type}.bytes`))), name);
  // Samples (i, j, k) of the extent lie at origin + direction * spacing * (i, j, k).
  assertNear(placeOf(volume, [0, 0, 0]), [1 + 3, 2 + 1, 3], name);
  assertNear(placeOf(volume, [4, 2, 1]), [1 + 5, 2 - 1, 5], name);
}
// The core takes each type for what it is.
for (const name of names.filter((n) => n.endsWith('_text.vti'))) {
  const module = await VolumeModule.make(core);
  const info = await module.open(await openVolume(fileAt(join(vtis, name))));
  assert.deepEqual([info.least, info.greatest], [0, 112], name);
}
await refused(fileAt(join(vtis, 'lz4.vti')), /packed by 'vtkLZ4DataCompressor'/);

// What a file calls its samples, and its unit of length.
{
  const bytes = readFileSync(join(volumes, 'v.nii'));
  bytes.fill(0, 328, 344);
  bytes.write('density', 328);
  for (const [units, expected] of [
    [0, ''],
    [1, 'm'],
    [2 | 8, 'mm'],
    [3, 'µm'],
    [7, ''],
  ]) {
    bytes[123] = units;
    const { name, lengthUnit } = await openVolume(new File([bytes], 'named.nii'));
    assert.deepEqual([name, lengthUnit], ['density', expected], `NIfTI with units ${units}`);
  }
  const nrrd = (field) =>
    new File(
      [
        'NRRD0004\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: 2 2 2\nencoding: raw\n',
        `kinds: space space space\n${field}\n\n12345678`,
      ],
      'units.nrrd',
    );
  for (const [field, expected] of [
    ['space units: "mm" "mm" "mm"', 'mm'],
    ['units: "um" "um" "um"', 'um'],
    ['space units: "mm" "mm" "s"', ''],
    ['# no units', ''],
  ]) {
    assert.equal((await openVolume(nrrd(field))).lengthUnit, expected, field);
  }
}

// One volume in every format.
const bytes = readFileSync(join(volumes, 'v.raw'));
const rawFormat = { samples: [20, 24, 18], type: 'uint8', spacing: [0.5, 1, 2] };
const header = 'NRRD0004\ntype: uchar\ndimension: 3\nsizes: 20 24 18\nspacings: 0.5 1 2\n';
const packed = new File([`${header}encoding: gzip\n\n`, gzipSync(bytes)], 'packed.nrrd');
const atEnd = new File([`${header}encoding: raw\nbyte skip: -1\n\nabc`, bytes], 'end.nrrd');
const inFiles = ['v.vti', 'v.nii', 'v.nii.gz', 'v.nrrd', 'v.raw'].map((name) =>
  fileAt(join(volumes, name)),
);
for (const file of [...inFiles, packed, atEnd]) {
  const volume = await openVolume(file, rawFormat);
  assert.deepEqual([volume.type, volume.samples], ['uint8', [20, 24, 18]], file.name);
  assert.ok((await samplesOf(volume)).equals(bytes), file.name);
  const corner = placeOf(volume, [19, 23, 17]).map(Math.abs);
  const first = placeOf(volume, [0, 0, 0]).map(Math.abs);
  assertNear(
    corner.map((x, d) => Math.abs(x - first[d])),
    [9.5, 23, 34],
    file.name,
  );
  const module = await VolumeModule.make(core);
  const info = await module.open(await openVolume(file, rawFormat));
  assert.deepEqual([info.least, info.greatest], [10, 250], file.name);
}

// Big-endian samples, and a NIfTI header with its bytes the other way round.
const swapped = Buffer.alloc(2 * 27);
for (let i = 0; i < 27; ++i) swapped.writeInt16BE(i - 13, 2 * i);
const nifti = Buffer.alloc(352);
nifti.writeInt32BE(348, 0);
[3, 3, 3, 3].forEach((n, i) => nifti.writeInt16BE(n, 40 + 2 * i));
nifti.writeInt16BE(4, 70);
[1, 2, 3, 4].forEach((x, i) => nifti.writeFloatBE(x, 76 + 4 * i));
nifti.writeFloatBE(352, 108);
nifti.writeInt16BE(1, 252);
// A quarter turn about z: i runs along y.
nifti.writeFloatBE(Math.SQRT1_2, 264);
nifti.writeFloatBE(7, 268);
nifti.write('n+1\0', 344, 'latin1');
const bigEndian = [
  new File([nifti, swapped], 'big.nii'),
  new File(
    ['NRRD0001\ntype: short\ndimension: 3\nsizes: 3 3 3\nencoding: raw\nendian: big\n\n', swapped],
    'big.nrrd',
  ),
  new File([swapped], 'big.raw'),
];
for (const file of bigEndian) {
  const volume = await openVolume(file, { samples: [3, 3, 3], type: 'int16', bigEndian: true });
  const samples = await samplesOf(volume);
  for (let i = 0; i < 27; ++i) assert.equal(samples.readInt16LE(2 * i), i - 13, file.name);
}
for (const [place, message] of [
  [5, /series.nii has 2 numbers per sample, not one/],
  [6, /series.nii has 2 samples along its dimension 6/],
]) {
  const series = Buffer.from(nifti);
  series.writeInt16BE(place, 40);
  for (let d = 4; d <= 7; ++d) series.writeInt16BE(d === place ? 2 : 1, 40 + 2 * d);
  await refused(new File([series, swapped, swapped], 'series.nii'), message);
}
assertNear(placeOf(await openVolume(bigEndian[0]), [1, 1, 1]), [7 - 3, 2, 4], 'quaternion');

// What a name tells.
assert.deepEqual(rawFormatOfName('bonsai_256x256x110_uint8.raw'), {
  samples: [256, 256, 110],
  type: 'uint8',
});
assert.deepEqual(rawFormatOfName('a_2x3x4_float.raw'), { samples: [2, 3, 4], type: 'float32' });
assert.equal(rawFormatOfName('v.raw'), null);
assert.equal(rawFormatOfName('v_2x3x4.raw'), null);

// Claims of size, before anything is allocated.
const claim = (sizes, encoding = 'raw') =>
  new File(
    [`NRRD0004\ntype: float\ndimension: 3\nsizes: ${sizes}\nencoding: ${encoding}\n\n`, bytes],
    'claim.nrrd',
  );
await refused(claim('2000 2000 2000'), /need 59.6 GB; a page has less/);
await refused(
  claim('1000 1000 100'),
  /truncated: 8640 bytes of samples, but its header asks for 400000000/,
);
await refused(claim('1000 1000 100', 'gzip'), /truncated.*at least/);
await refused(claim('20 24 18', 'gzip'), /cannot be unpacked/);
// A wrong checksum, with the samples and apart from them.
const wrongSum = gzipSync(bytes);
wrongSum[wrongSum.length - 6] ^= 1;
await refused(
  new File([`${header}encoding: gzip\n\n`, wrongSum], 'sum.nrrd'),
  /cannot be unpacked/,
);
const apart = {
  stream: () =>
    new ReadableStream({
      start(controller) {
        controller.enqueue(wrongSum.subarray(0, -8));
        controller.enqueue(wrongSum.subarray(-8));
        controller.close();
      },
    }),
};
const stream = new ByteStream('apart', apart, 'gzip');
await stream.fill(new Uint8Array(bytes.length));
await assert.rejects(stream.finish(), /apart is truncated or damaged/);
await refused(claim('65536 65536 1'), /at least 2 along each direction/);
await refused(claim('1e300 2 2'), /which are no counts/);
await refused(claim('1e9 2 2'), /2\^20/);
await refused(new File([bytes], 'long.raw'), /has 8640 bytes, but 20 x 24 x 17/, {
  samples: [20, 24, 17],
  type: 'uint8',
});
await refused(new File([bytes], 'short.raw'), /has 8640 bytes, but 20 x 24 x 19/, {
  samples: [20, 24, 19],
  type: 'uint8',
});
await refused(new File([`${header}encoding: bzip2\n\n`], 'v.nrrd'), /encoding 'bzip2'/);
await refused(
  new File([`${header}encoding: raw\ndata file: v.raw\n\n`], 'v.nrrd'),
  /in another file, 'v.raw', which is not here/,
);
await refused(new File([bytes], 'v.nii'), /no NIfTI file/);
await refused(new File([bytes], 'v.vti'), /no VTK file/);
await refused(new File([bytes], 'v.png'), /no known format/);
await refused(new File([], 'v.vti'), /is empty/);
await refused(fileAt(join(volumes, 'flat.vti')), /5 x 5 x 1 samples/);
await refused(fileAt(join(volumes, 'colours.vti')), /3 numbers per sample/);

// A sample that is not a number leaves a hole.
{
  const holed = await openVolume(fileAt(join(volumes, 'nan.vti')));
  const info = await (await VolumeModule.make(core)).open(holed);
  assert.match(holed.note, /^1 of 8640 samples have no value/);
  assert.ok(info.least < info.greatest, JSON.stringify(info));
}
// The core refuses what no lattice has.
const many = { ...(await openVolume(packed)), samples: [2000, 2000, 2000] };
await assert.rejects(
  (await VolumeModule.make(core)).open(many),
  /the padded lattice has \d+ nodes, more than this machine can number/,
);
const flat = { ...(await openVolume(packed)), spacing: [0, 1, 1] };
await assert.rejects((await VolumeModule.make(core)).open(flat), /flat or not finite/);
const module = await VolumeModule.make(core);
assert.throws(() => module.frame('isovalue=1&threshold=0'), /there is no volume yet/);
await module.open(await openVolume(packed));
assert.throws(
  () => module.frame('isovalue=abc&threshold=0'),
  /isovalue is no finite number: 'abc'/,
);
assert.throws(() => module.frame('x'.repeat(3000)), /longer than 2000/);
assert.ok(module.frame('isovalue=130&threshold=0').byteLength > 1000);
console.log(`${names.length + 10} files read`);
