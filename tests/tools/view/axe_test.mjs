// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// axe finds nothing in any state of a page, in both themes; controls have an edge that is seen; and the
// surface stands out from its ground. Arguments: 'view' or 'explore', the program or the folder, the
// browser, a folder for pictures, a volume.
import { resolve } from 'node:path';
import axe from 'axe-core';

import { check, finish } from './checks.mjs';
import { OpenedPage } from './opened_page.mjs';

const [kind, target, browserPath, folder, volume] = process.argv.slice(2);
const opened = await OpenedPage.open(kind, target, browserPath, resolve(folder), [volume]);
const { page, browser } = opened;

async function look(name) {
  await page.evaluate(axe.source);
  const violations = await page.evaluate(async () => {
    const rules = { 'target-size': { enabled: true } };
    const found = await window.axe.run(document, { resultTypes: ['violations'], rules });
    return found.violations.map(({ id, nodes }) => `${id}: ${nodes.map((n) => n.html.slice(0, 120)).join(' ')}`);
  });
  check(violations.length === 0, `${name}: ${violations.join('; ')}`);
  await browser.picture(`${kind}_${name.replaceAll(' ', '_')}`);
}

/** Controls whose edge has less than 3 : 1 against what they lie on. */
const faintEdges = () => page.evaluate(() => {
  const luminance = (colour) => {
    const [r, g, b] = colour.match(/[\d.]+/g).map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const groundOf = (element) => {
    for (let e = element.parentElement; e; e = e.parentElement) {
      const { backgroundColor } = getComputedStyle(e);
      if (!/, 0\)|transparent/.test(backgroundColor)) return backgroundColor;
    }
    return 'rgb(255, 255, 255)';
  };
  const contrast = (a, b) => {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  };
  return [...document.querySelectorAll('button, select, input')]
    .filter((e) => e.checkVisibility() && !e.disabled && e.type !== 'range')
    .map((e) => [e, getComputedStyle(e, ['checkbox', 'radio'].includes(e.type) ? '::before' : null)])
    .filter(([e, style]) => contrast(style.borderTopColor, groundOf(e)) < 3)
    .map(([e]) => e.outerHTML.slice(0, 80));
});

/** How far points of the surface, apart from its edge, stand out from the ground: the lowest twentieth. */
const standsOut = () => page.evaluate(() => {
  const { stage } = window.nestgrid;
  const source = document.getElementById('canvas');
  stage.drawNow();
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [source.width, source.height];
  const context = copy.getContext('2d');
  context.drawImage(source, 0, 0);
  const { data, width } = context.getImageData(0, 0, copy.width, copy.height);
  const linear = (c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4);
  const luminance = (x, y) => {
    const at = 4 * (Math.round(y) * width + Math.round(x));
    return 0.2126 * linear(data[at]) + 0.7152 * linear(data[at + 1]) + 0.0722 * linear(data[at + 2]);
  };
  const ground = luminance(2, copy.height / 2);
  const { left, top, width: shownWidth, height: shownHeight } = source.getBoundingClientRect();
  const scale = source.width / shownWidth;
  const hits = (x, y) => stage.pick(left + x, top + y)?.kind === 'isosurface';
  const ratios = [];
  for (let y = 0; y < shownHeight; y += shownHeight / 40) {
    for (let x = 0; x < shownWidth; x += shownWidth / 40) {
      if (!hits(x, y) || !hits(x + 3, y) || !hits(x - 3, y) || !hits(x, y + 3) || !hits(x, y - 3)) continue;
      const [low, high] = [ground, luminance(x * scale, y * scale)].sort((a, b) => a - b);
      ratios.push((high + 0.05) / (low + 0.05));
    }
  }
  ratios.sort((a, b) => a - b);
  return { count: ratios.length, ratio: ratios[Math.floor(ratios.length / 20)] };
});

try {
  for (const scheme of ['light', 'dark']) {
    await opened.theme(scheme);
    if (opened.takesFiles) {
      await opened.goEmpty();
      await look(`${scheme} empty`);
      await (await page.$('#file')).uploadFile(process.argv[1]);
      await page.waitForSelector('#message:not([hidden])');
      await look(`${scheme} error`);
    }
    await opened.go();
    await look(`${scheme} surface`);
    const found = await standsOut();
    console.log(`${scheme}: the surface stands out from its ground by ${found.ratio?.toFixed(2)} : 1`);
    check(found.count > 50 && found.ratio >= 3, `${scheme}: ${JSON.stringify(found)}`);
    const faint = await faintEdges();
    check(faint.length === 0, `${scheme}: edges that are hardly seen: ${faint.join(' ')}`);
    await page.click('#hint');
    await page.click('#meanings summary');
    await look(`${scheme} help`);
    await page.click('#screenshot');
    await look(`${scheme} picture`);
    await page.click('#picture-dialog button[value=cancel]');
    await opened.go('#slice=z&lens=cursor&detail=threshold&projection=parallel');
    await look(`${scheme} slice`);
    await opened.go('#detail=error&collapse=on');
    await look(`${scheme} error`);
    await opened.go('#detail=distance');
    await look(`${scheme} distance`);
    await page.setViewport({ width: 390, height: 844 });
    await look(`${scheme} narrow`);
    await page.setViewport({ width: 1280, height: 800 });
    await opened.go('#surface=on');
    await page.$eval('#surface', (box) => box.click());
    await look(`${scheme} nothing chosen`);
    if (!opened.takesFiles) {
      // A program that is stopped while a frame is under way.
      await opened.go('');
      opened.program.kill('SIGSTOP');
      await page.$eval('#isovalue', (slider) => { slider.value = '400'; slider.dispatchEvent(new Event('change')); });
      await new Promise((done) => { setTimeout(done, 3000); });
      await look(`${scheme} at work`);
      opened.program.kill('SIGCONT');
      await opened.settled();
    }
    await opened.go('#isovalue=1e9');
    await page.waitForSelector('#empty:not([hidden])');
    await look(`${scheme} message`);
  }
} catch (error) {
  check(false, error.stack);
  await browser.picture(`${kind}_failed`).catch(() => {});
} finally {
  await opened.close();
}
finish();
