// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The core as WebAssembly draws the frames of native_frames.cpp to the last bit.
// Arguments: the folder explore, the folder of native frames.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { isDeepStrictEqual } from 'node:util';
import { compileCore, fileAt, load } from './folder.mjs';

const [folder, natives] = process.argv.slice(2);
const { VolumeModule } = await load(folder, 'volume_module.js');
const { openVolume } = await load(folder, 'readers/open_volume.js');
const { decodeFrame } = await load(folder, 'frame.js');
const core = await compileCore(folder);

/** A frame without the time it took, and the bytes that this time's digits take. */
function comparable(buffer) {
  const { seconds, bytes, ...frame } = decodeFrame(buffer);
  assert.ok(seconds >= 0);
  return frame;
}

const nativeFrame = (name, i) => {
  const bytes = readFileSync(join(natives, `${name}.${i}`));
  return comparable(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
};

const names = readdirSync(natives)
  .filter((name) => name.endsWith('.nrrd'))
  .map((name) => name.slice(0, -5));
assert.equal(names.length, 8);
let triangles = 0;
for (const name of names) {
  const module = await VolumeModule.make(core);
  const info = await module.open(await openVolume([fileAt(join(natives, `${name}.nrrd`))]));
  assert.ok(info.least < info.greatest);
  const requests = readFileSync(join(natives, `${name}.requests`), 'utf8')
    .trim()
    .split('\n');
  requests.forEach((request, i) => {
    const frame = comparable(module.frame(request));
    const native = nativeFrame(name, i);
    assert.equal(frame.triangles, native.triangles, `${name}: triangles of ${request}`);
    assert.ok(isDeepStrictEqual(frame, native), `${name}: ${request} differs`);
    triangles += frame.triangles;
  });
}
assert.ok(triangles > 3e5);
console.log(`${names.length} volumes, ${triangles} triangles, equal to the last bit`);
