// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The isovalue that the page begins with, in the heads and atlases of Debian's mricron-data, whose
// background is 0: in an atlas every label lies inside, in a head the surface lies between the noise of
// the air and the tissue. Arguments: the program, the folder of the volumes.
import { spawn } from 'node:child_process';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { gunzipSync } from 'node:zlib';

import { addressOf, check, finish } from './checks.mjs';

const [program, folder] = process.argv.slice(2);
const heads = /^(ch2|inia19-t1)/;

/** The samples of a volume, which is written in the order of bytes of this machine. */
function samplesOf(name) {
  const file = gunzipSync(readFileSync(join(folder, name)));
  const start = file.readFloatLE(108);
  const bytes = new Uint8Array(file.subarray(start)).buffer;
  const types = { 2: Uint8Array, 4: Int16Array, 16: Float32Array };
  return new types[file.readInt16LE(70)](bytes);
}

async function infoOf(name) {
  const child = spawn(program, ['view', join(folder, name), '--no-browser'], { stdio: ['ignore', 'pipe', 'inherit'] });
  const info = await (await fetch(`${await addressOf(child)}info`)).json();
  child.kill('SIGTERM');
  return info;
}

for (const name of readdirSync(folder).filter((file) => file.endsWith('.nii.gz'))) {
  const info = await infoOf(name);
  const { isovalue, least, greatest, samples } = info;
  check(info.name === name.replace('.nii.gz', ''), `${name} has data that are called ${info.name}`);
  check(info.length_unit === (/^(aal|brodmann|ch2|inia19)/.test(name) ? '' : 'mm'),
    `${name} has lengths in '${info.length_unit}'`);
  const values = samplesOf(name);
  const share = (fits) => values.reduce((sum, x) => sum + (fits(x) ? 1 : 0), 0) / values.length;
  const inside = share((x) => x >= isovalue);
  const notBackground = share((x) => x > 0);
  console.log(`${name}: isovalue ${isovalue} of ${least} to ${greatest}, ${(100 * inside).toFixed(1)} % inside`);
  const range = values.reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
  check(range[0] === least && range[1] === greatest && samples === values.length,
    `${name} has ${values.length} samples from ${range}, and ${samples} from ${least} to ${greatest} are told`);
  if (heads.test(name)) {
    check(isovalue > 0.05 * greatest && isovalue < 0.5 * greatest, `${name} begins at ${isovalue}`);
    check(inside > 0.7 * notBackground && inside < 0.99, `${name}: ${inside} of ${notBackground} are inside`);
  } else {
    check(isovalue > 0 && isovalue < 1 && inside === notBackground, `${name} begins at ${isovalue}`);
  }
}
finish();
