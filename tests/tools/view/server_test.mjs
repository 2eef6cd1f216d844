// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the server of the page refuses, and that it lives on. Arguments: the program, a volume.
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import net from 'node:net';
import os from 'node:os';
import path from 'node:path';

import { check, finish } from './checks.mjs';

const [program, volume] = process.argv.slice(2);

/** Starts the program. \return the process and its lines of output */
function startOn(file, ...options) {
  const child = spawn(program, ['view', file, '--no-browser', ...options]);
  const output = { text: '', errors: '' };
  child.stdout.on('data', (data) => { output.text += data; });
  child.stderr.on('data', (data) => { output.errors += data; });
  const ended = new Promise((resolve) => child.on('exit', (code) => resolve(code)));
  const line = new Promise((resolve, reject) => {
    child.stdout.on('data', () => output.text.includes('\n') && resolve(output.text.trim()));
    ended.then((code) => reject(new Error(`ended with ${code}: ${output.errors}`)));
  });
  return { child, output, ended, line };
}

const start = (...options) => startOn(volume, ...options);

/** Sends bytes and gives what is answered until the connection is closed. */
function raw(port, text, more = null) {
  return new Promise((resolve) => {
    const socket = net.connect(port, '127.0.0.1');
    let answer = '';
    let sent = 0;
    socket.on('data', (data) => { answer += data.toString('latin1'); });
    socket.on('error', () => {});
    socket.on('close', () => resolve({ answer, sent }));
    socket.on('connect', () => {
      socket.write(text);
      if (!more) return;
      const chunk = Buffer.alloc(1 << 20, 'x');
      const push = () => {
        while (sent < more && !socket.destroyed) {
          sent += chunk.length;
          if (!socket.write(chunk)) return socket.once('drain', push);
        }
      };
      push();
    });
  });
}

function get(port, path, headers = {}, method = 'GET') {
  return new Promise((resolve, reject) => {
    const request = http.request({ host: '127.0.0.1', port, path, headers, method, agent: false },
      (response) => {
        const chunks = [];
        response.on('data', (data) => chunks.push(data));
        response.on('end', () => resolve({
          status: response.statusCode, headers: response.headers, body: Buffer.concat(chunks) }));
      });
    request.on('error', reject);
    request.end();
  });
}

const server = start();
const address = await server.line;
const { port: portText, pathname: root } = new URL(address);
const port = Number(portText);
check(/^http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\/$/.test(address), `the address is ${address}`);

const frame = `${root}frame?isovalue=0.4&threshold=0`;
const alive = async (behind) => {
  const answer = await get(port, frame);
  check(answer.status === 200 && answer.body.length > 1000, `no frame behind ${behind}`);
};
await alive('the start');

// The page, its files, and hosts that a tunnel gives.
for (const name of ['', 'main.js', 'style.css', 'three.module.js', 'info']) {
  check((await get(port, root + name)).status === 200, `${name} is not served`);
}
for (const Host of ['localhost', 'localhost:9999', '127.0.0.1:1', `127.0.0.1:${port}`]) {
  check((await get(port, frame, { Host })).status === 200, `the host ${Host} is refused`);
}

async function refused(what, expected, sentence, answer) {
  const { status, body } = await answer;
  const text = body.toString();
  check(status === expected, `${what}: status ${status}`);
  check(text.includes(sentence) && text.trim().split('\n').length === 1 && text.length < 400,
    `${what}: '${text}'`);
  await alive(what);
}

for (const Host of ['example.com', `example.com:${port}`, '127.0.0.1.example.com', 'localhost:x',
                    'localhost@example.com', '[::1]', '0.0.0.0', 'localhost.']) {
  await refused(`the host '${Host}'`, 403, 'localhost', get(port, frame, { Host }));
}
const nobody = await raw(port, `GET ${frame} HTTP/1.0\r\n\r\n`);
check(nobody.answer.startsWith('HTTP/1.1 403'), 'a request without a host is answered');
const wrong = root.replace(/[0-9a-f]/, (c) => (c === '0' ? '1' : '0'));
for (const path of ['/', '/info', '/frame?isovalue=0.4', wrong, `${wrong}info`, '/favicon.ico',
                    root.slice(0, -2) + '/', root.slice(0, -1) + '0/']) {
  await refused(`the path ${path}`, 403, 'token', get(port, path));
}
for (const name of ['../../etc/passwd', '..%2f..%2fetc%2fpasswd', '/etc/passwd', 'main.js/', 'page/main.js',
                    './main.js', 'package.json', '%00', 'three.LICENSE']) {
  await refused(`the file ${name}`, 404, 'no such file', get(port, root + name));
}
for (const [query, sentence] of [['isovalue=high', 'no finite number'], ['', 'nothing is to be drawn'],
  ['isovalue=nan&triangles=100', 'no finite number'], ['isovalue=1&x=%3Cscript%3E', 'knows only'],
  [`isovalue=${'1'.repeat(3000)}`, 'longer than']]) {
  await refused(`the request ${query.slice(0, 40)}`, 400, sentence, get(port, `${root}frame?${query}`));
}
for (const method of ['HEAD', 'POST', 'PUT', 'DELETE', 'OPTIONS']) {
  const { status } = await get(port, frame, {}, method);
  check(status === 405, `${method}: status ${status}`);
  await alive(method);
}

// A body of 1 GB is not read: the connection is closed long before it is sent.
const host = `Host: 127.0.0.1:${port}\r\n`;
for (const method of ['POST', 'GET']) {
  const begin = `${method} ${frame} HTTP/1.1\r\n${host}Content-Length: 1000000000\r\n\r\n`;
  const { answer, sent } = await raw(port, begin, 1e9);
  check(answer.startsWith('HTTP/1.1 413') && answer.includes('has no body'),
    `a body of 1 GB by ${method}: '${answer.slice(0, 60)}'`);
  check(sent < 1e8, `${sent} bytes of a body were taken`);
  await alive('a body of 1 GB');
}
const chunked = await raw(port, `GET ${frame} HTTP/1.1\r\n${host}Transfer-Encoding: chunked\r\n\r\n`, 1e9);
check(chunked.answer.startsWith('HTTP/1.1 413') && chunked.sent < 1e8, 'a body in chunks is read');
// Nor are heads without an end.
for (const [what, begin] of [['an address', `GET ${root}`], ['a header', `GET ${frame} HTTP/1.1\r\nX: `],
                             ['no line', '']]) {
  const { sent } = await raw(port, begin, 1e9);
  check(sent < 1e8, `${what} of ${sent} bytes was taken`);
  await alive(`${what} without an end`);
}
for (const text of ['\r\n\r\n', 'nonsense\r\n\r\n', '\0\0\0\0\r\n\r\n', `GET ${frame} HTTP/9.9\r\n\r\n`]) {
  const { answer } = await raw(port, text);
  check(!answer.includes(' 200 '), `'${text}' is answered`);
  await alive('nonsense');
}
// Browsers that say nothing hold up nobody for long.
const silent = Array.from({ length: 12 }, () => net.connect(port, '127.0.0.1'));
await alive('twelve silent connections');
silent.forEach((socket) => socket.destroy());

// What no page of another site may do with the answers.
const { headers } = await get(port, root);
check(/default-src 'none'/.test(headers['content-security-policy']), 'no security policy');
check(headers['x-content-type-options'] === 'nosniff', 'types are guessed');
check(!('access-control-allow-origin' in headers), 'other sites may read answers');

// It ends at once, with one line printed. The port is free again, and one that is not is refused.
setTimeout(() => process.exit(2), 60000).unref();
const second = start('--port', portText);
second.line.catch(() => {});
check((await second.ended) === 1, 'two servers at one port');
check(/^nestgrid: .*port.*\n$/.test(second.output.errors), `'${second.output.errors}'`);
const begin = Date.now();
server.child.kill('SIGINT');
check((await server.ended) === 0, 'the interrupt is no clean end');
check(Date.now() - begin < 4000, 'the end takes long');
check(server.output.text === `${address}\n`, `it printed '${server.output.text}'`);
check(server.output.errors === '', `it complained '${server.output.errors}'`);
const third = start('--port', portText);
check((await third.line).includes(`:${portText}/`) && (await third.line) !== address,
  'the token is the same again');
third.child.kill('SIGTERM');
check((await third.ended) === 0, 'the end is not clean');

// A plane is shown as a slab: walls stand on its isolines.
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'plane-'));
const ramp = path.join(folder, 'ramp.pgm');
const samples = Array.from({ length: 9 * 7 }, (_, i) => 10 * (i % 9));
fs.writeFileSync(ramp, Buffer.concat([Buffer.from('P5\n9 7\n255\n'), Buffer.from(samples)]));
const plane = startOn(ramp);
const shown = new URL(await plane.line);
const facts = JSON.parse((await get(shown.port, `${shown.pathname}info`)).body);
check(JSON.stringify(facts.box[1].slice(0, 2)) === '[8,6]' && facts.box[1][2] > 0.1,
  `the slab is ${JSON.stringify(facts.box)}`);
const walls = await get(shown.port, `${shown.pathname}frame?isovalue=35&threshold=0`);
check(walls.status === 200 && walls.body.length > 1000, `no walls: ${walls.body.toString().slice(0, 200)}`);
plane.child.kill('SIGTERM');
check((await plane.ended) === 0 && plane.output.errors.includes('slab of two equal layers'),
  `the plane: '${plane.output.errors}'`);
fs.rmSync(folder, { recursive: true });

finish();
