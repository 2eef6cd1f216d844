// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drives the page of a program that pushes surfaces while it runs, docs/examples/live.cpp, in Chromium
// without a screen. Arguments: the program, the browser, a folder for pictures.
import { spawn } from 'node:child_process';
import { resolve } from 'node:path';

import { addressOf, check, finish, pushedFrame } from './checks.mjs';
import { Browser, count } from './chromium.mjs';

const [program, browserPath, folder] = process.argv.slice(2);
const steps = 300;  // ten a second: a slow browser turns the first before the last has come
const start = (last) => spawn(program, [`${last}`], { stdio: ['pipe', 'pipe', 'inherit'] });

const browser = await Browser.open(browserPath, resolve(folder));
const solver = start(steps);
let killed = null;
const { page, complaints } = browser;
const text = (id) => browser.text(id);
const connection = (state) => page.waitForFunction(
  (wanted) => document.body.dataset.connection === wanted, { timeout: 60000 }, state);
const shownStep = (step) => page.waitForFunction(
  (wanted) => window.nestgrid?.shown?.frame.step >= wanted, { timeout: 120000 }, step);
/** Of one surface, what the frame has, and what the page tells. */
const told = () => page.evaluate(() => {
  const { frame } = window.nestgrid.shown;
  const of = (name) => document.getElementById(`number-${name}`).textContent;
  return { triangles: frame.triangles, texts: { triangles: of('triangles'), step: of('step') }, step: frame.step };
});

try {
  const address = await addressOf(solver);
  await page.goto(address);
  await shownStep(0);

  // What the page tells of a surface.
  check((await text('title')) === 'A drop parts', `the title is ${await text('title')}`);
  check((await text('subtitle')) === 'The solver is running', await text('subtitle'));
  check((await text('legend-title')) === 'temperature', `the legend names ${await text('legend-title')}`);
  check((await page.$$eval('#legend-ticks span', (spans) => spans.length)) >= 3, 'no legend');
  const first = await told();
  check(first.triangles > 1000 && count(first.texts.triangles) === first.triangles
    && count(first.texts.step) === first.step, `the numbers are ${JSON.stringify(first)}`);
  const picture = await browser.look();
  check(picture.colours > 100 && picture.drawn > 300, `the canvas is empty: ${JSON.stringify(picture)}`);

  // A surface that is there has no isovalue, threshold, slice or lens to choose.
  const controls = await page.$$eval('input, select, button, canvas#histogram',
    (all) => all.filter((e) => e.checkVisibility() && !e.closest('.tools')).map((e) => e.id).sort().join());
  check(controls === 'gltf,outlines,projection,reset,screenshot', `the controls are ${controls}`);
  await page.$eval('#outlines', (box) => box.click());
  await page.waitForFunction(() => window.nestgrid.shown.frame.parts.some((part) => part.kind === 'outlines'));

  // The camera stays where the reader has put it, while surfaces come.
  const untouched = await browser.camera();
  await browser.drag([480, 400], [520, 360]);
  const camera = await browser.camera();
  const before = (await told()).step;
  check(before < steps, 'all surfaces have come before the reader has turned the first');
  await shownStep(Math.min(before + 1, steps));
  const later = await browser.camera();
  check(later.every((x, i) => Math.abs(x - camera[i]) < 1e-9), `the camera is ${later}, not ${camera}`);
  check(later.some((x, i) => Math.abs(x - untouched[i]) > 1), 'the camera is what it was before the reader has turned it');
  await page.click('#reset');
  await page.mouse.move(1100, 600);
  await shownStep(0.75 * steps);
  await browser.picture('live');

  // The last surface is the one that another reader gets, and stays behind the end of the solver.
  await shownStep(steps);
  const last = await told();
  const frame = await pushedFrame(address);
  check(frame.step === steps && frame.triangles === last.triangles,
    `${frame.triangles} triangles are pushed in step ${frame.step}, ${last.triangles} shown in ${last.step}`);
  const ended = new Promise((done) => { solver.once('exit', done); });
  solver.stdin.end('\n');
  await connection('ended');
  check((await text('subtitle')) === 'The solver has ended', await text('subtitle'));
  check((await ended) === 0, 'the solver has failed');
  check((await browser.look()).drawn > 300, 'the last surface is gone');
  check(complaints.length === 0, `the console says: ${complaints.join('; ')}`);

  // A solver that is killed says nothing.
  killed = start(1000);
  await page.goto(await addressOf(killed));
  await shownStep(0);
  killed.kill('SIGKILL');
  await connection('lost');
  check((await text('subtitle')).includes('cannot be reached'), await text('subtitle'));
} catch (error) {
  check(false, error.stack);
  await browser.picture('failed').catch(() => {});
} finally {
  await browser.close();
  solver.kill('SIGKILL');
  killed?.kill('SIGKILL');
}
finish();
