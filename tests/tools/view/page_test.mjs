// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drives the page in Chromium without a screen, as a reader would. Frames per second are printed, never
// judged. Arguments: the program, the browser, a folder for pictures, volumes (frames of one layout).
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { addressOf, check, finish } from './checks.mjs';
import { Browser, count } from './chromium.mjs';

const [program, browserPath, folder, ...volumes] = process.argv.slice(2);
const pictures = resolve(folder);
const server = spawn(program, ['view', ...volumes, '--no-browser'], { stdio: ['ignore', 'pipe', 'inherit'] });
const address = await addressOf(server);
const browser = await Browser.open(browserPath, pictures);
const { page, complaints } = browser;

const text = (id) => browser.text(id);
const look = () => browser.look();
const picture = (name) => browser.picture(name);
// window.nestgrid appears some time after the page is loaded. A function that throws is not asked again.
const settled = () => page.waitForFunction(
  () => window.nestgrid?.shown?.motion === 'settled' && window.nestgrid.idle, { timeout: 60000 });
const select = async (id, value) => {
  await page.select(`#${id}`, value);
  await settled();
};

/**
 * Drags a slider over so many positions: the hand waits for the frame of each.
 * \return numbers of triangles, and frames per second
 */
const drag = (id, from, to, positions, drawn) => page.evaluate(async (sliderId, first, last, steps, drawing) => {
  const slider = document.getElementById(sliderId);
  const { stage } = window.nestgrid;
  const { draw } = stage;
  if (!drawing) stage.draw = () => {};
  const triangles = [];
  const begin = performance.now();
  for (let i = 0; i < steps; ++i) {
    const before = window.nestgrid.shown;
    slider.value = String(Math.round(first + (i / (steps - 1)) * (last - first)));
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    while (window.nestgrid.shown === before || !window.nestgrid.idle) {
      await new Promise((resolve) => { const c = new MessageChannel(); c.port1.onmessage = resolve; c.port2.postMessage(0); });
    }
    if (drawing) stage.drawNow();
    triangles.push(window.nestgrid.shown.frame.triangles);
  }
  const seconds = (performance.now() - begin) / 1000;
  stage.draw = draw;
  slider.dispatchEvent(new Event('change', { bubbles: true }));
  return { triangles, rate: steps / seconds, bytes: window.nestgrid.shown.frame.bytes };
}, id, from, to, positions, drawn);

try {
  await page.goto(address);
  await settled();
  check((await text('title')).length > 0 && (await page.title()).includes('nestgrid'), 'no title');
  check((await text('subtitle')).includes('values from'), 'the range is not told');
  check(count(await text('number-triangles')) > 1000, 'no triangles');
  check((await text('number-ms')).endsWith('ms'), 'no time');
  check(await page.$eval('#legend', (legend) => legend.hidden), 'a legend of colours that nothing has');
  const first = await look();
  check(first.colours > 50 && first.drawn > 1000, `the canvas is empty: ${JSON.stringify(first)}`);
  await page.mouse.move(480, 400);
  await page.waitForFunction(() => document.getElementById('cursor').textContent.includes('='));
  check(/x .*y .*z .*\n?.* = .* ± /s.test(await text('cursor')), `cursor: ${await text('cursor')}`);
  await picture('view');

  // Every slider over 60 positions: within 5 % of the number of triangles.
  const rates = async (name, id, from, to, goal) => {
    const page_ = await drag(id, from, to, 60, false);
    await settled();
    const drawn = await drag(id, from, to, 8, true);
    await settled();
    console.log(`${name}: ${page_.rate.toFixed(1)} frames/s without drawing, `
      + `${drawn.rate.toFixed(1)} drawn by the processor, ${(page_.bytes / 1e6).toFixed(2)} MB a frame`);
    if (goal) {
      const worst = Math.max(...[...page_.triangles, ...drawn.triangles].map((t) => Math.abs(t / goal - 1)));
      check(worst <= 0.05, `${name}: ${(100 * worst).toFixed(1)} % off the number of triangles`);
    }
  };
  const goTo = async (hash) => {
    await page.goto('about:blank');
    await page.goto(address + hash);
    await settled();
  };
  for (const goal of [20000, 50000, 100000]) {
    await goTo(`#triangles=${goal}`);
    await rates(`isovalue at ${goal} triangles`, 'isovalue', 250, 400, goal);
  }
  await goTo('#detail=threshold');
  await rates('threshold', 'threshold', 900, 300);
  await goTo('');
  await rates('triangles', 'triangles', 200, 500);
  await goTo('');
  await select('slice', 'z');
  await rates('slice with the surface', 'slice-at', 300, 700, 50000);
  await picture('slice');
  check((await look()).colours > 50, 'no slice');
  check(!(await page.$eval('#legend', (legend) => legend.hidden)), 'no legend');
  check((await page.$$eval('#legend-ticks span', (spans) => spans.length)) >= 4, 'no values at the legend');
  check((await text('legend-title')).length > 0, 'the legend has no name');
  await select('slice', 'view');
  check((await text('slice-text')).includes('distance'), 'the slice that faces the reader has no distance');
  await select('slice', 'none');
  await select('lens', 'cursor');
  await page.mouse.move(470, 420);
  await page.mouse.move(480, 400);
  await page.waitForFunction(() => window.nestgrid.shown.request.includes('lens='));
  await settled();
  await rates('radius of the lens', 'lens-radius', 100, 300);
  await page.$eval('#outlines', (box) => box.click());
  await page.waitForFunction(() => window.nestgrid.shown.frame.parts.some((part) => part.kind === 'outlines'));
  await settled();
  await picture('lens');
  await page.$eval('#outlines', (box) => box.click());
  await select('lens', 'off');
  if (volumes.length > 1) {
    await rates('time', 'time', 0, 1000, 50000);
    await picture('time');
  }
  for (const indicator of ['visual', 'numerical', 'wavelet', 'offset']) await select('indicator', indicator);

  // The settled frame keeps within the number, and the address brings it back.
  await page.$eval('#isovalue', (s) => { s.value = '330'; s.dispatchEvent(new Event('change')); });
  await settled();
  const numbers = await text('numbers');
  check(count(await text('number-triangles')) <= 50000, 'a settled frame has too many triangles');
  await browser.drag([480, 400], [560, 440]);
  const camera = await browser.camera();
  const link = page.url();
  check(link.includes('isovalue=') && link.includes('camera='), `the address tells nothing: ${link}`);
  await page.goto('about:blank');
  await page.goto(link);
  await settled();
  const again = await browser.camera();
  check(again.every((x, i) => Math.abs(x - camera[i]) < 1e-6 * (1 + Math.abs(x))), 'the camera is lost');
  const steady = (t) => t.replace(/extraction.*$/s, '');
  check(steady(await text('numbers')) === steady(numbers), `${await text('numbers')}, not ${numbers}`);

  // What is saved.
  const session = await browser.browser.target().createCDPSession();
  const saved = join(pictures, 'saved');
  rmSync(saved, { recursive: true, force: true });
  mkdirSync(saved);
  await session.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: saved });
  for (const [id, name] of [['screenshot', 'nestgrid.png'], ['gltf', 'nestgrid.glb']]) {
    await page.click(`#${id}`);
    if (id === 'screenshot') await page.click('#picture-dialog button[value=save]');
    for (let i = 0; i < 100 && !existsSync(join(saved, name)); ++i) await new Promise((r) => setTimeout(r, 100));
    check(readdirSync(saved).includes(name), `${name} was not saved`);
  }

  // An error is a sentence in the page, which goes on.
  await page.evaluate(() => { document.getElementById('isovalue-number').value = 'much'; });
  await page.$eval('#isovalue-number', (e) => e.dispatchEvent(new Event('change')));
  check((await page.$eval('#isovalue-number', (e) => e.getAttribute('aria-invalid'))) === 'true', 'no number is taken');
  await page.$eval('#isovalue-number', (e) => { e.value = '1e30'; e.dispatchEvent(new Event('change')); });
  await browser.awaitSeen('empty', /nothing here/);
  await goTo('#isovalue=x&triangles=-5&camera=1,2&slice=no');
  check((await look()).drawn > 1000, 'a broken address leaves no picture');

  await page.setViewport({ width: 420, height: 800 });
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: 'dark' }]);
  await goTo('');
  await picture('narrow');
  await page.setViewport({ width: 1280, height: 800 });
  await picture('dark');

  check(complaints.length === 0, `the console says: ${complaints.join('; ')}`);
  server.kill('SIGINT');
  await new Promise((resolve) => server.once('exit', resolve));
  await page.$eval('#isovalue', (s) => { s.value = '300'; s.dispatchEvent(new Event('change')); });
  await browser.awaitSeen('connection', /has ended/);
} catch (error) {
  check(false, error.stack);
  await picture('failed').catch(() => {});
} finally {
  await browser.close();
  server.kill('SIGKILL');
}
finish();
