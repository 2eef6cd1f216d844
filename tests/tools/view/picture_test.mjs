// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A saved picture has the size, the ground, the scale, the legend and the texts that were asked for, and
// the address in it brings the view back. Arguments: the program, the browser, a folder for pictures, a
// volume.
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { gzipSync } from 'node:zlib';

import { check, finish } from './checks.mjs';
import { OpenedPage } from './opened_page.mjs';

const [program, browserPath, folder, volume] = process.argv.slice(2);
const saved = resolve(folder, 'saved_pictures');
const opened = await OpenedPage.open('view', program, browserPath, resolve(folder), [volume]);
const { page, browser } = opened;

/** The sum that PNG has of a chunk, which gzip has of a file. */
const sumOf = (bytes) => gzipSync(bytes).subarray(-8).readUInt32LE(0);

/** The chunks of a PNG file, as { type, data }; checks their sums. */
function chunksOf(file) {
  const chunks = [];
  for (let at = 8; at < file.length;) {
    const length = file.readUInt32BE(at);
    const content = file.subarray(at + 4, at + 8 + length);
    check(sumOf(content) === file.readUInt32BE(at + 8 + length), 'a chunk has a wrong sum');
    chunks.push({ type: content.toString('latin1', 0, 4), data: content.subarray(4) });
    at += 12 + length;
  }
  return chunks;
}

/** Decodes a PNG file in the browser: [red, green, blue, alpha] of a point, from the left and the top. */
async function decode(file) {
  const name = await page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    window.saved ??= [];
    return window.saved.push(context.getImageData(0, 0, image.width, image.height)) - 1;
  }, file.toString('base64'));
  const [width, height] = await page.evaluate((n) => [window.saved[n].width, window.saved[n].height], name);
  return {
    width,
    height,
    at: (x, y) => page.evaluate((n, i, j) => {
      const { data, width: w, height: h } = window.saved[n];
      const at = 4 * ((j < 0 ? h + j : j) * w + (i < 0 ? w + i : i));
      return [...data.slice(at, at + 4)];
    }, name, x, y),
    /** The longest run of one colour in a row. */
    run: (y, colour) => page.evaluate((picture, row, wanted) => {
      const { data, width: w, height: h } = window.saved[picture];
      const j = row < 0 ? h + row : row;
      let best = 0;
      for (let i = 0, n = 0; i < w; ++i) {
        const at = 4 * (j * w + i);
        n = wanted.every((c, k) => Math.abs(data[at + k] - c) < 8) ? n + 1 : 0;
        best = Math.max(best, n);
      }
      return best;
    }, name, y, colour),
  };
}

/** Saves by the dialog, and decodes the file. */
async function save({ size, ground, off = [], on = [] }) {
  rmSync(saved, { recursive: true, force: true });
  mkdirSync(saved, { recursive: true });
  await page.click('#screenshot');
  await page.waitForSelector('#picture-dialog[open]');
  if (size) {
    for (const [name, value] of [['width', size[0]], ['height', size[1]]]) {
      await page.$eval(`#picture-dialog [name=${name}]`, (field, text) => {
        field.value = text;
        field.dispatchEvent(new Event('input', { bubbles: true }));
      }, String(value));
    }
  }
  await page.select('#picture-dialog [name=ground]', ground);
  for (const name of ['caption', 'legend', 'scale', 'box', 'address']) {
    const wanted = on.includes(name) || (!off.includes(name) && name !== 'address');
    await page.$eval(`#picture-dialog [name=${name}]`, (box, checked) => { if (box.checked !== checked) box.click(); }, wanted);
  }
  await page.click('#picture-dialog button[value=save]');
  const path = join(saved, 'nestgrid.png');
  for (let i = 0; i < 300 && !existsSync(path); ++i) await new Promise((done) => { setTimeout(done, 100); });
  const file = readFileSync(path);
  const texts = new Map(chunksOf(file).filter(({ type }) => type === 'tEXt')
    .map(({ data }) => data.toString('latin1').split('\0')));
  return { texts, ...await decode(file) };
}

try {
  const session = await browser.browser.target().createCDPSession();
  await session.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: saved });
  await opened.go('#slice=z&projection=parallel');
  const camera = await browser.camera();

  // Sizes that no window has, also beyond what is drawn at once.
  const white = await save({ size: [2500, 1300], ground: 'white' });
  check(white.width === 2500 && white.height === 1300, `${white.width} x ${white.height}`);
  check((await white.at(0, 0)).join() === '255,255,255,255', `white ground is ${await white.at(0, 0)}`);
  check((await browser.camera()).every((x, i) => Math.abs(x - camera[i]) < 1e-9), 'saving moves the camera');
  // The legend: its bar, from the least value at the bottom to the greatest at the top.
  const em = 1300 / 45;
  const bar = async (part) => white.at(Math.round(1.7 * em), Math.round(1300 - em - part * 14 * em));
  const [low, high] = [await bar(0.02), await bar(0.98)];
  check(Math.abs(low[0] - 68) < 12 && Math.abs(low[2] - 84) < 12, `the bar begins with ${low}`);
  check(high[0] > 230 && high[1] > 215 && high[2] < 70, `the bar ends with ${high}`);
  // The scale bar: as long as the label says, at the depth of the target.
  const { length, perPoint } = await page.evaluate(() => {
    const { stage } = window.nestgrid;
    const each = stage.view.heightAtTarget / 1300;
    const wanted = 0.1 * 2500 * each;
    const unit = 10 ** Math.floor(Math.log10(wanted));
    return { perPoint: each, length: unit * [1, 2, 5, 10].find((step) => step * unit >= wanted) };
  });
  const text = [0x1c, 0x21, 0x28];
  const drawn = await white.run(Math.round(1300 - 1.2 * em), text);
  check(Math.abs(drawn - length / perPoint) < 0.5 * em, `the scale bar is ${drawn} points long, not ${length / perPoint}`);

  // For the documentation, as large as it is shown there.
  await save({ size: [1250, 650], ground: 'white' });
  copyFileSync(join(saved, 'nestgrid.png'), resolve(folder, 'saved.png'));

  // Texts.
  for (const [keyword, wanted] of [['Software', 'nestgrid'], ['Title', volume.split('/').at(-1)]]) {
    check(white.texts.get(keyword) === wanted, `${keyword} is ${white.texts.get(keyword)}`);
  }
  check(/^[\d,]+ triangles, error at most/.test(white.texts.get('Description')), white.texts.get('Description'));

  // No ground, and nothing but the surface.
  const bare = await save({ size: [800, 600], ground: 'none-light', off: ['caption', 'legend', 'scale', 'box'] });
  for (const [x, y] of [[0, 0], [-1, 0], [0, -1], [-1, -1], [20, -30], [-30, -20]]) {
    check((await bare.at(x, y))[3] === 0, `without ground (${x}, ${y}) is ${await bare.at(x, y)}`);
  }
  check((await bare.at(400, 300))[3] === 255, 'the middle is not drawn');

  // The address underneath, on more lines than one.
  const plain = await save({ size: [800, 600], ground: 'black', off: ['caption', 'legend', 'scale', 'box'] });
  check((await plain.at(0, 0)).join() === '0,0,0,255', `black ground is ${await plain.at(0, 0)}`);
  const written = async (picture) => {
    let rows = 0;
    for (let y = -30; y < -2; ++y) rows += (await picture.run(y, [0, 0, 0])) < 800 - 40 ? 1 : 0;
    return rows;
  };
  const noted = await save({ size: [800, 600], ground: 'black', off: ['caption', 'legend', 'scale', 'box'], on: ['address'] });
  const [rows, without] = [await written(noted), await written(plain)];
  check(without === 0 && rows > 10, `the address is on ${rows} rows, without it there are ${without}`);

  // The address of the view brings it back, whatever a page begins with.
  const view = noted.texts.get('View');
  const seen = (await plain.at(400, 300)).join();
  check(/isovalue=.*slice=z.*projection=parallel.*camera=/.test(view), `the view is ${view}`);
  await opened.go(view);
  const again = await browser.camera();
  check(again.every((x, i) => Math.abs(x - camera[i]) < 1e-6 * (1 + Math.abs(x))), 'the camera is lost');
  const repeated = await save({ size: [800, 600], ground: 'black', off: ['caption', 'legend', 'scale', 'box'] });
  check((await repeated.at(400, 300)).join() === seen, 'the picture is another one');

  // A size that cannot be is refused where it is typed.
  await page.click('#screenshot');
  await page.$eval('#picture-dialog [name=width]', (field) => {
    field.value = '9e9';
    field.dispatchEvent(new Event('input', { bubbles: true }));
  });
  check((await browser.text('picture-check')).includes('whole numbers from'), await browser.text('picture-check'));
  await page.click('#picture-dialog button[value=save]');
  check(await page.$eval('#picture-dialog', (dialog) => dialog.open), 'a wrong size is saved');
  await page.click('#picture-dialog button[value=cancel]');

  // Nothing coloured, no legend to choose; the reason stands beside it.
  await opened.go('');
  await page.click('#screenshot');
  check(await page.$eval('#picture-dialog [name=legend]', (box) => box.disabled
    && box.closest('label').textContent.includes('nothing is coloured')), 'a legend without colours');
  check(browser.complaints.length === 0, `the console says: ${browser.complaints.join('; ')}`);
} catch (error) {
  check(false, error.stack);
  await browser.picture('failed').catch(() => {});
} finally {
  await opened.close();
}
finish();
