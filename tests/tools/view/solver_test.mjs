// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A reader takes the surfaces that a solver pushes with --view, until the solver ends.
// Arguments: the solver, its arguments.
import { spawn } from 'node:child_process';

import { addressOf, check, finish, pushedFrame } from './checks.mjs';

const [program, ...options] = process.argv.slice(2);
const solver = spawn(program, [...options, '--view'], { stdio: ['pipe', 'pipe', 'inherit'] });
const ended = new Promise((resolve) => { solver.once('exit', resolve); });
process.once('exit', () => solver.kill('SIGKILL'));

/** Checks that the triangles and values of a frame are those of its vertices. */
function checkSurface(frame) {
  const [{ kind, triangles, positions, indices, values }] = frame.parts;
  const vertices = positions.length / 3;
  const name = `step ${frame.step}`;
  check(kind === 'surface' && triangles > 0 && triangles === frame.triangles, `${name}: ${triangles} triangles`);
  check(indices.length === 3 * triangles && indices.every((i) => i < vertices), `${name}: other vertices`);
  const [low, high] = frame.box;
  check(positions.every((x, i) => x >= low[i % 3] && x <= high[i % 3]), `${name}: outside the domain`);
  check(values.length === vertices && values.every(Number.isFinite), `${name}: ${values.length} values`);
  check(frame.field === 'exact solution', `${name}: the field is ${frame.field}`);
}

const address = await addressOf(solver);
let output = '';
solver.stdout.on('data', (data) => {
  output += data;
  // Enter comes when the reader has the last surface and waits for another one.
  if (output.includes('until Enter')) setTimeout(() => solver.stdin.end('\n'), 500);
});
let step = -1;
for (let number = 0, running = true; running;) {
  const frame = await pushedFrame(address, number);
  running = !frame.ended;
  if (frame.parts.length === 0) continue;
  checkSurface(frame);
  check(frame.number > number && frame.step > step, `step ${frame.step} comes behind ${step}`);
  ({ number, step } = frame);
}
check(step >= 0, 'no surface has come');
check((await ended) === 0, `the solver has failed:\n${output}`);
finish();
