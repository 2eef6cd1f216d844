// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads volumes as the page does, for foreign_volumes_test.py. Each line of standard input asks for one,
// as JSON: { files, choice, places }, paths of files, what openVolume() takes, and places as numbers of
// samples. Each line of output tells of it: { refusal }, or what the volume is, with its range and its
// values at these places.
// Arguments: the folder explore.
import { createInterface } from 'node:readline';
import { fileAt, load } from './folder.mjs';

const [folder] = process.argv.slice(2);
const { openVolume } = await load(folder, 'readers/open_volume.js');
const { FileError, numbersIn } = await load(folder, 'readers/volume.js');

async function read({ files, choice, places }) {
  const volume = await openVolume(files.map(fileAt), choice);
  const target = new Uint8Array(volume.bytes);
  await volume.read(target);
  const values = numbersIn(target, volume.type);
  let [least, greatest] = [Infinity, -Infinity];
  for (const value of values) {
    if (value < least) least = value;
    if (value > greatest) greatest = value;
  }
  return {
    ...volume,
    least: Number(least),
    greatest: Number(greatest),
    values: places.map((i) => Number(values[i])),
  };
}

for await (const line of createInterface({ input: process.stdin })) {
  let answer;
  try {
    answer = await read(JSON.parse(line));
  } catch (error) {
    // Others than ours are faults.
    answer = { refusal: error instanceof FileError ? error.message : error.stack };
  }
  console.log(JSON.stringify(answer));
}
