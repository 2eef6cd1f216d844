// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page with the core as WebAssembly and its files: refusals are seen wherever they appear, a file
// takes the place of everything that belonged to the last one, and what takes long can be cancelled.
// Arguments: the folder explore, the browser, a folder for pictures, a folder of small volumes, a volume
// in which a choice takes seconds.
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

import { check, finish } from './checks.mjs';
import { OpenedPage } from './opened_page.mjs';

const [folder, browserPath, pictures, volumes, large] = process.argv.slice(2);
const small = join(volumes, 'v.nrrd');
const work = mkdtempSync(join(tmpdir(), 'files-'));
const opened = await OpenedPage.open('explore', folder, browserPath, resolve(pictures), [small]);
const { browser, page } = opened;
const drop = async (path) => (await page.$('#file')).uploadFile(path);
const write = (name, bytes) => {
  writeFileSync(join(work, name), bytes);
  return join(work, name);
};
const shows = (title) => page.waitForFunction(
  (name) => document.getElementById('title').textContent === name && window.nestgrid.idle && window.nestgrid.shown,
  { timeout: 120000 }, title);
const set = (id, value) => page.$eval(`#${id}`, (e, x) => {
  e.value = x;
  e.dispatchEvent(new Event('change'));
}, value);

try {
  const refused = [
    [write('cut.vti', '<?xml version="1.0"?>\n<VTKFile type="ImageData"'), /cut\.vti is truncated/],
    [write('a.png', 'PNG'), /a\.png is of no known format/],
    [write('nothing.nrrd', ''), /nothing\.nrrd is empty/],
    [write('claim.nrrd', 'NRRD0004\ntype: float\ndimension: 3\nsizes: 2000 2000 2000\nencoding: raw\n\n'), /59\.6 GB/],
  ];
  for (const [width, height] of [[1280, 800], [390, 700]]) {
    await page.setViewport({ width, height });
    await opened.goEmpty();
    // The first file, and one more: the message of the last one stays.
    for (const [path, pattern] of refused) {
      await drop(path);
      await browser.awaitSeen('message', pattern);
    }
    await browser.picture(`refused_first_${width}`);
    await drop(small);
    await shows('v.nrrd');
    check((await browser.text('message')) === '' && (await browser.seen('message')) === '', 'a refusal stays');
    for (const [path, pattern] of refused) {
      await drop(path);
      await browser.awaitSeen('message', pattern);
      check((await browser.text('title')) === 'v.nrrd', 'a refused file takes the name of the one in the picture');
    }
    await browser.picture(`refused_${width}`);
  }
  await page.setViewport({ width: 1280, height: 800 });

  // Everything of one file goes with it.
  await opened.go();
  const camera = await browser.camera();
  const start = await page.$eval('#isovalue-number', (e) => e.value);
  await set('isovalue', '700');
  await opened.settled();
  await set('isovalue-number', 'much');
  await page.select('#lens', 'click');
  await page.select('#slice', 'z');
  await page.$eval('#by-threshold', (e) => e.click());
  await opened.settled();
  await browser.drag([480, 400], [580, 440]);
  check((await browser.camera()).some((x, i) => Math.abs(x - camera[i]) > 1e-3), 'the camera has not moved');
  await page.mouse.move(470, 400);
  await drop(write('damaged.vti', 'nothing'));
  await browser.awaitSeen('message', /damaged\.vti/);
  const before = await page.evaluate(() => location.hash);
  check(before.includes('isovalue=') && before.includes('file=v.nrrd'), `the address is ${before}`);
  await drop(join(volumes, 'v.vti'));
  await shows('v.vti');
  const fields = await page.evaluate(() => ({
    isovalue: document.getElementById('isovalue-number').value,
    invalid: document.getElementById('isovalue-number').getAttribute('aria-invalid'),
    lens: document.getElementById('lens').value,
    slice: document.getElementById('slice').value,
    byTriangles: document.getElementById('by-triangles').checked,
    message: document.getElementById('message').hidden,
    hash: location.hash,
  }));
  const expected = { isovalue: start, invalid: 'false', lens: 'off', slice: 'none', byTriangles: true, message: true };
  for (const [key, value] of Object.entries(expected)) {
    check(fields[key] === value, `of the last file, ${key} is ${fields[key]}, not ${value}`);
  }
  check(!fields.hash.includes('isovalue'), `the address is ${fields.hash}`);
  check((await browser.camera()).every((x, i) => Math.abs(x - camera[i]) < 1e-3), 'the camera is that of the last file');

  // The address of one file says nothing of another.
  await page.goto('about:blank');
  await page.goto(`${opened.address}#isovalue=99&file=another.nrrd`);
  await drop(small);
  await shows('v.nrrd');
  check((await page.$eval('#isovalue-number', (e) => e.value)) === start, 'the address of another file counts');

  // A file of several frames and numbers per sample: the first of each, and what is left out, is told.
  const samples = Buffer.alloc(4 * 8 * 8 * 8 * 3 * 4);
  for (let i = 0; i < 8 * 8 * 8 * 3 * 4; ++i) {
    const [component, frame] = [i % 3, Math.floor(i / (512 * 3))];
    const place = Math.floor(i / 3) % 512;
    const centre = [place % 8, Math.floor(place / 8) % 8, Math.floor(place / 64)].map((x) => x - 3.5);
    samples.writeFloatLE((component + 1) * (10 - Math.hypot(...centre)) + 100 * frame, 4 * i);
  }
  const header = [
    'NRRD0005', 'type: float', 'dimension: 5', 'space: RAS', 'sizes: 3 8 8 8 4',
    'space directions: none (1,0,0) (0,1,0) (0,0,2) none', 'space units: "mm" "mm" "mm"',
    'kinds: 3-vector space space space time', 'endian: little', 'encoding: raw', 'data file: several.bin', ''];
  const several = [write('several.nhdr', header.join('\n')), write('several.bin', samples)];
  const chosen = () => page.evaluate(() => ({
    note: document.getElementById('volume-note').textContent,
    subtitle: document.getElementById('subtitle').textContent,
    hash: location.hash,
    component: document.getElementById('component').value,
    frame: document.getElementById('frame-text').textContent,
    isovalue: document.getElementById('isovalue-number').value,
    message: document.getElementById('message').textContent,
  }));
  const choose = async (id, value) => {
    await page.evaluate(() => { window.lastShown = window.nestgrid.shown; });
    await set(id, value);
    await page.waitForFunction(
      () => window.nestgrid.idle && window.nestgrid.shown && window.nestgrid.shown !== window.lastShown,
      { timeout: 60000 });
    return chosen();
  };
  await drop(several[0]);
  await browser.awaitSeen('message', /several\.nhdr keeps its samples in another file, 'several\.bin'/);
  await (await page.$('#file')).uploadFile(...several);
  await shows('several.nhdr');
  const first = await chosen();
  check(/^Frame 0 of the 4 in several\.nhdr is read; component 0 of the 3 numbers per sample \(3-vector\) is read\.$/
    .test(first.note), `the note is ${first.note}`);
  check(first.subtitle.includes('7 × 7 × 14 mm in RAS'), `the subtitle is ${first.subtitle}`);
  check(!/frame|component/.test(first.hash), `the address of the first is ${first.hash}`);
  await browser.picture('several');
  const doubled = await choose('component', '1');
  check(doubled.note.includes('component 1 of the 3'), `the note is ${doubled.note}`);
  check(doubled.hash.includes('component=1'), `the address is ${doubled.hash}`);
  await set('isovalue-number', '112');
  await opened.settled();
  const later = await choose('frame', '1');
  check(later.note.startsWith('Frame 1 of the 4') && later.frame === 'frame 1', `the note is ${later.note}`);
  check(later.isovalue === '112' && later.component === '1', `behind a frame, the isovalue is ${later.isovalue}`);
  const norm = await choose('component', 'magnitude');
  check(norm.hash.includes('component=magnitude') && norm.hash.includes('frame=1'), `the address is ${norm.hash}`);
  check(norm.isovalue !== '112', 'the isovalue of a component stays with the magnitude');
  // The address chooses again.
  await page.goto('about:blank');
  await page.goto(`${opened.address}${norm.hash}`);
  await (await page.$('#file')).uploadFile(...several);
  await shows('several.nhdr');
  const again = await chosen();
  check(again.note === norm.note && again.component === 'magnitude', `the address chooses ${again.note}`);
  // One that does not fit the file is refused once.
  await page.goto('about:blank');
  await page.goto(`${opened.address}#frame=9&file=several.nhdr`);
  await (await page.$('#file')).uploadFile(...several);
  await browser.awaitSeen('message', /several\.nhdr has no frame 9: it is 0 to 3/);
  await (await page.$('#file')).uploadFile(...several);
  await shows('several.nhdr');
  await drop(small);
  await shows('v.nrrd');
  check(!(await page.$eval('#volume-section', (e) => e.checkVisibility())), 'a file of one volume offers a choice');

  // What takes long has a bar, and can be cancelled; the page goes on.
  await drop(large);
  await shows('first.nrrd');
  const top = await page.evaluate(async () => {
    const byId = (id) => document.getElementById(id);
    byId('indicator').value = 'visual';
    byId('indicator').dispatchEvent(new Event('change'));
    const begin = performance.now();
    while (byId('work').hidden && performance.now() - begin < 20000) {
      await new Promise((next) => { setTimeout(next, 10); });
    }
    const { left, top: from, width, height } = byId('cancel').getBoundingClientRect();
    const found = document.elementFromPoint(left + width / 2, from + height / 2)?.id;
    byId('cancel').click();
    return found;
  });
  check(top === 'cancel', `on the button that cancels lies ${top}`);
  await browser.awaitHidden('work', 2000);
  check((await page.$eval('#indicator', (e) => e.value)) === 'offset', 'a cancelled choice stays chosen');
  await set('isovalue', '420');
  await opened.settled();
  check((await browser.look()).colours > 20, 'behind a cancelled choice nothing is drawn');
  await page.select('#indicator', 'visual');
  await page.waitForFunction(() => window.nestgrid.idle && window.nestgrid.shown.request.includes('visual'),
    { timeout: 120000 });

  // A dialog that asks for the samples of one file goes when another one comes.
  await drop(join(volumes, 'v.raw'));
  await page.waitForSelector('#raw-dialog[open]');
  await drop(small);
  await shows('v.nrrd');
  check((await page.$$('dialog[open]')).length === 0, 'the dialog of the last file is open');
  check(browser.complaints.length === 0, `the console says: ${browser.complaints.join('; ')}`);
} catch (error) {
  check(false, error.stack);
  await browser.picture('failed').catch(() => {});
} finally {
  await opened.close();
  rmSync(work, { recursive: true });
}
finish();
