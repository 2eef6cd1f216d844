// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the tests of the page and of its server have in common.
import http from 'node:http';

import { decodeFrame } from './frame.js';

let failures = 0;

export function check(holds, what) {
  if (holds) return;
  ++failures;
  console.log(`FAILED: ${what}`);
}

/** Ends the test. */
export function finish() {
  if (failures === 0) console.log('all is as it should be');
  process.exit(failures > 0 ? 1 : 0);
}

/** The address that a program prints first, whose output is a pipe. */
export function addressOf(child) {
  return new Promise((resolve, reject) => {
    let text = '';
    child.stdout.on('data', (data) => {
      text += data;
      if (text.includes('\n')) resolve(text.split('\n')[0]);
    });
    child.once('error', reject);
    child.once('exit', (code) => reject(new Error(`ended with status ${code} and without an address`)));
  });
}

// One connection, as of a page: a solver that ends takes no more of them.
const agent = new http.Agent({ keepAlive: true, maxSockets: 1 });

/** The newest surface that a solver has pushed behind surface `after`, as the page decodes it. */
export function pushedFrame(address, after = 0) {
  return new Promise((resolve, reject) => {
    http.get(`${address}frame?after=${after}`, { agent }, (response) => {
      const chunks = [];
      response.on('data', (data) => chunks.push(data));
      response.on('error', reject);
      response.on('end', () => {
        const bytes = Buffer.concat(chunks);
        if (response.statusCode === 200) resolve(decodeFrame(new Uint8Array(bytes).buffer));
        else reject(new Error(bytes.toString()));
      });
    }).on('error', reject);
  });
}
