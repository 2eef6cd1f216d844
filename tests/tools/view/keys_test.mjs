// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A reader who has a keyboard alone reaches everything of a page, sees where the focus is, and is told
// what changes. Arguments: 'view' or 'explore', the program or the folder, the browser, a folder for
// pictures, volumes (frames of one layout).
import { resolve } from 'node:path';

import { check, finish } from './checks.mjs';
import { OpenedPage } from './opened_page.mjs';

const [kind, target, browserPath, folder, ...volumes] = process.argv.slice(2);
const opened = await OpenedPage.open(kind, target, browserPath, resolve(folder), volumes);
const { page, browser } = opened;
const { keyboard } = page;

const pause = (ms) => new Promise((done) => { setTimeout(done, ms); });
const focused = () => page.evaluate(() => document.activeElement.id);
const text = (id) => browser.text(id);
const request = () => page.evaluate(() => window.nestgrid.shown.request);
const asked = (part) => page.waitForFunction(
  (wanted) => window.nestgrid.shown?.request.includes(wanted) && window.nestgrid.idle, { timeout: 60000 }, part);
const valueText = (id) => page.$eval(`#${id}`, (e) => e.getAttribute('aria-valuetext'));

async function press(key, ...held) {
  for (const modifier of held) await keyboard.down(modifier);
  await keyboard.press(key);
  for (const modifier of held) await keyboard.up(modifier);
}

/** Goes on by Tab to an element. */
async function tabTo(id) {
  for (let i = 0; i < 100; ++i) {
    if ((await focused()) === id) return;
    await press('Tab');
  }
  throw new Error(`Tab does not reach ${id}`);
}

/** Until a screen reader is told something of a pattern. */
const told = (pattern) => page.waitForFunction(
  (source) => new RegExp(source).test(document.getElementById('status').textContent), { timeout: 30000 }, pattern)
  .catch(async () => check(false, `told is '${await text('status')}', not ${pattern}`));

/** A file that the reader chooses by a button, reached and pressed by keys. */
async function chooseFile(button, volume) {
  await tabTo(button);
  const chooser = page.waitForFileChooser({ timeout: 30000 });
  await pause(200);  // until the browser asks the test, not a window
  await press('Enter');
  await (await chooser).accept([volume]);
  await opened.settled();
}

/** Every control that is seen: whether Tab stops there, how large it is, and whether its focus is seen. */
async function tabThrough() {
  await page.evaluate(() => { window.stops = new Map(); });
  // Around the whole page, which ends in the browser.
  for (let known = 0; known < 4;) {
    await press('Tab');
    known = await page.evaluate((before) => {
      const at = document.activeElement;
      if (at === document.body || window.stops.has(at)) return before + 1;
      const { outlineStyle, outlineWidth } = getComputedStyle(at);
      window.stops.set(at, outlineStyle !== 'none' && parseFloat(outlineWidth) >= 2);
      return 0;
    }, known);
  }
  return page.evaluate(() => [...document.querySelectorAll('button, input, select, summary, [tabindex], a')]
    .filter((e) => e.checkVisibility() && !e.disabled)
    // Tab stops at the chosen radio button; arrow keys go to the others.
    .filter((e) => e.type !== 'radio' || e.checked)
    .map((e) => {
      const { width, height } = e.getBoundingClientRect();
      return {
        name: e.outerHTML.slice(0, 60), reached: window.stops.has(e), ring: window.stops.get(e) === true, width, height };
    }));
}

try {
  if (opened.takesFiles) {
    await opened.goEmpty();
    await chooseFile('choose-first', volumes[0]);
  } else {
    await opened.go();
  }
  await told('[\\d,]+ triangles, error at most: ');
  const stops = await tabThrough();
  check(stops.length > 20, `${stops.length} controls`);
  for (const { name, reached, ring, width, height } of stops) {
    check(reached, `Tab does not reach ${name}`);
    check(!reached || ring, `the focus is not seen at ${name}`);
    check(width >= 24 && height >= 24, `${name} is ${width} x ${height} points large`);
  }

  // The camera.
  await page.evaluate(() => document.activeElement.blur());
  await tabTo('canvas');
  const moves = async (what, ...keys) => {
    const before = await browser.camera();
    await press(...keys);
    const after = await browser.camera();
    check(after.some((x, i) => Math.abs(x - before[i]) > 1e-3), `${keys.join(' ')} does not ${what}`);
    return [before, after];
  };
  const distance = (c) => Math.hypot(c[0] - c[3], c[1] - c[4], c[2] - c[5]);
  const first = await browser.camera();
  for (const key of ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown']) {
    const [a, b] = await moves('turn', key);
    check(Math.abs(distance(a) / distance(b) - 1) < 1e-6, `${key} changes the distance`);
    const [c, d] = await moves('move', key, 'Shift');
    check(d.slice(3, 6).some((x, i) => Math.abs(x - c[3 + i]) > 1e-3), `Shift and ${key} leave the target`);
  }
  const [far, near] = await moves('zoom', '+');
  check(distance(near) < distance(far), '+ goes away');
  await moves('zoom', '-');
  for (const [key, side] of [['x', [1, 0, 0]], ['y', [0, 1, 0]], ['z', [0, 0, 1]]]) {
    for (const sign of [1, -1]) {
      await press(key, ...(sign < 0 ? ['Shift'] : []));
      const towards = await page.evaluate(() => window.nestgrid.stage.towardsReader);
      check(towards.every((x, i) => Math.abs(x - sign * side[i]) < 1e-3), `${key}: from ${towards}`);
    }
  }
  await told('from the side of minus z');
  await press('Home');
  check((await browser.camera()).every((x, i) => Math.abs(x - first[i]) < 1e-3), 'Home does not show all');
  await press('ArrowLeft');
  await page.waitForFunction(() => window.location.hash.includes('camera='));

  // The aim tells what lies there.
  await press('Enter');
  check(await page.$eval('#aim', (e) => !e.hasAttribute('hidden')), 'the aim is not seen');
  const place = () => page.$eval('#aim', (e) => `${e.style.left} ${e.style.top}`);
  const before = await place();
  for (let i = 0; i < 4; ++i) await press('ArrowRight', 'Control');
  check((await place()) !== before, 'the aim does not move');

  // The lens: chosen, placed, moved, and made larger.
  const centre = async () => /lens=([^&]*)/.exec(await request())?.[1].split(',').map(Number);
  await tabTo('lens');
  await press('ArrowDown');
  await press('ArrowDown');
  await page.waitForFunction(() => document.getElementById('lens').value === 'click');
  // From the middle to where the surface is hit.
  const aimed = async () => {
    for (let i = 0; i < 80; ++i) {
      if ((await text('cursor')).includes('=')) return;
      await press(i < 40 ? 'ArrowDown' : 'ArrowLeft', 'Control');
    }
    throw new Error('the aim does not find the surface');
  };
  await page.evaluate(() => document.activeElement.blur());
  await tabTo('canvas');
  await press('ArrowDown', 'Control');
  await aimed();
  await told('x .*y .*z .*=');
  await press('Enter');
  await asked('lens=');
  const placed = await centre();
  for (let i = 0; i < 3; ++i) await press('ArrowDown', 'Control');
  await aimed();
  await press('Enter');
  await page.waitForFunction((old) => !window.nestgrid.shown.request.includes(old) && window.nestgrid.idle,
    { timeout: 60000 }, placed.join(','));
  const moved = await centre();
  check(moved.slice(0, 3).some((x, i) => x !== placed[i]), 'the lens does not move');
  await press(']');
  await page.waitForFunction((old) => Number(/lens=([^&]*)/.exec(window.nestgrid.shown.request)[1].split(',')[3]) > old,
    { timeout: 60000 }, moved[3]);
  await browser.picture(`${kind}_keys`);

  // Sliders, which say what they are at.
  const slide = async (id, pattern) => {
    await tabTo(id);
    const was = await valueText(id);
    const position = () => page.$eval(`#${id}`, (e) => Number(e.value));
    const from = await position();
    for (let i = 0; i < 5; ++i) await press('ArrowRight');
    // Each key counts, also where it moves a slider by less than its value is rounded to.
    check((await position()) === from + 5, `five keys move ${id} by ${(await position()) - from}`);
    await page.waitForFunction((name, old) => document.getElementById(name).getAttribute('aria-valuetext') !== old,
      { timeout: 5000 }, id, was).catch(() => check(false, `arrow keys do not move ${id}`));
    check(pattern.test(await valueText(id)), `${id} is read as ${await valueText(id)}`);
    await opened.settled();
  };
  await slide('lens-radius', /^radius [\d.]+/);
  await page.evaluate(() => document.activeElement.blur());
  await slide('isovalue', /^[\d.e-]+/);
  await told('[\\d,]+ triangles, error at most: ');
  await tabTo('slice');
  await press('ArrowDown');
  await asked('axis=x');
  await slide('slice-at', /^x [\d.-]+/);
  await slide('triangles', /^about [\d,]+ triangles$/);
  await press('Tab', 'Shift');
  await press('ArrowDown');
  const checked = (id) => page.waitForFunction((radio) => document.getElementById(radio).checked, {}, id);
  await checked('by-error');
  await slide('error', /^at most .*% of the range/);
  await press('Tab', 'Shift');
  await press('ArrowDown');
  await checked('by-distance');
  await slide('distance', /^about [\d.e-]+/);
  await press('Tab', 'Shift');
  await press('ArrowDown');
  await checked('by-threshold');
  await slide('threshold', /% of the range/);
  if (volumes.length > 1 && !opened.takesFiles) {
    await page.evaluate(() => document.activeElement.blur());
    await slide('time', /^time [\d.]+/);
    // Without motion where the reader wants none: from frame to frame.
    await page.emulateMediaFeatures([{ name: 'prefers-reduced-motion', value: 'reduce' }]);
    await tabTo('play');
    await press('Enter');
    const times = new Set();
    for (let i = 0; i < 60; ++i) {
      times.add(Number(/time=([\d.]+)/.exec(page.url())?.[1] ?? 0));
      await pause(50);
    }
    await press('Enter');
    check(times.size > 1 && times.size <= 5, `${times.size} times were shown in three seconds`);
  }

  // What is saved; Escape goes back.
  await tabTo('screenshot');
  await press('Enter');
  check(await page.$eval('#picture-dialog', (d) => d.open && d.contains(document.activeElement)), 'no dialog');
  await press('Escape');
  check((await focused()) === 'screenshot', `behind the dialog the focus is at ${await focused()}`);

  // Another file.
  if (opened.takesFiles) {
    await page.evaluate(() => document.activeElement.blur());
    await page.evaluate(() => { window.before = window.nestgrid.shown; });
    await chooseFile('choose', volumes[1]);
    await page.waitForFunction(() => window.nestgrid.shown !== window.before && window.nestgrid.idle, { timeout: 60000 });
    check(volumes[1].endsWith(await text('title')), `the title is ${await text('title')}`);
  }
  check(browser.complaints.length === 0, `the console says: ${browser.complaints.join('; ')}`);
} catch (error) {
  check(false, error.stack);
  await browser.picture(`${kind}_failed`).catch(() => {});
} finally {
  await opened.close();
}
finish();
