// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The folder explore in a browser, from a server that knows only files: a reader drops a volume,
// drags every slider through 60 places, and drops damaged files.
// Arguments: the folder explore, that of make_volumes.cpp, the package puppeteer-core, a folder for
// screenshots.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [folder, volumes, puppeteerFolder, screenshots] = process.argv.slice(2);
const { default: puppeteer } = await import(
  pathToFileURL(join(puppeteerFolder, 'lib/esm/puppeteer/puppeteer-core.js'))
);
mkdirSync(screenshots, { recursive: true });
const work = mkdtempSync(join(tmpdir(), 'explore-'));

/** Bytes of a volume of n^3 floats, a gyroid. */
function gyroid(n) {
  const samples = new Float32Array(n ** 3);
  const at = (i) => (4 * Math.PI * i) / (n - 1);
  for (let z = 0, i = 0; z < n; ++z) {
    for (let y = 0; y < n; ++y) {
      for (let x = 0; x < n; ++x, ++i) {
        samples[i] =
          Math.sin(at(x)) * Math.cos(at(y)) +
          Math.sin(at(y)) * Math.cos(at(z)) +
          Math.sin(at(z)) * Math.cos(at(x));
      }
    }
  }
  return Buffer.from(samples.buffer);
}

/** The command of docs/explore.md, at a port of its own choice. */
function serve() {
  const server = spawn('/usr/bin/python3', [
    '-u',
    '-m',
    'http.server',
    '-b',
    '127.0.0.1',
    '-d',
    folder,
    '0',
  ]);
  return new Promise((resolve, reject) => {
    server.on('error', reject);
    server.stdout.on('data', (text) => {
      const port = /port (\d+)/.exec(text)?.[1];
      if (port) resolve({ server, address: `http://127.0.0.1:${port}/` });
    });
  });
}

class Reader {
  constructor(page) {
    this.page = page;
  }
  /** Until the picture shows what was asked for last, or a message. */
  async settle() {
    await this.page.waitForFunction(
      () =>
        window.nestgrid.idle &&
        (window.nestgrid.shown || !document.getElementById('message').hidden),
      { timeout: 120000 },
    );
  }
  async drop(path) {
    const input = await this.page.$('#file');
    await this.page.evaluate(() => {
      document.getElementById('message').hidden = true;
      window.nestgrid.shownBefore = window.nestgrid.shown;
    });
    await input.uploadFile(path);
  }
  async open(path) {
    await this.drop(path);
    await this.page.waitForFunction(
      () => window.nestgrid.shown !== window.nestgrid.shownBefore && window.nestgrid.idle,
      { timeout: 120000 },
    );
  }
  message() {
    return this.page.$eval('#message', (element) => (element.hidden ? '' : element.textContent));
  }
  text(id) {
    return this.page.$eval(`#${id}`, (element) => element.textContent);
  }
  async refuse(path, pattern) {
    await this.drop(path);
    await this.page.waitForFunction(() => !document.getElementById('message').hidden, {
      timeout: 60000,
    });
    const message = await this.message();
    assert.match(message, pattern);
    console.log(`refused: ${message}`);
  }
  choose(id, value) {
    return this.page.$eval(
      `#${id}`,
      (element, chosen) => {
        element.value = chosen;
        element.dispatchEvent(new Event('input'));
        element.dispatchEvent(new Event('change'));
      },
      value,
    );
  }

  /** Drags a slider through 60 places; as many frames, each extracted and sent to the page. */
  drag(id) {
    return this.page.evaluate(async (slider) => {
      const element = document.getElementById(slider);
      const frames = [];
      for (let i = 0; i <= 60; ++i) {
        const before = window.nestgrid.shown;
        element.value = String(200 + 10 * i);
        element.dispatchEvent(new Event(i < 60 ? 'input' : 'change'));
        const end = performance.now() + 60000;
        while (
          (window.nestgrid.shown === before || !window.nestgrid.idle) &&
          performance.now() < end
        ) {
          await new Promise((resolve) => {
            setTimeout(resolve, 0);
          });
        }
        const { frame, milliseconds, motion } = window.nestgrid.shown;
        frames.push({ triangles: frame.triangles, milliseconds, motion });
      }
      return frames;
    }, id);
  }
  async pixels() {
    return this.page.evaluate(() => {
      window.nestgrid.stage.drawNow();
      const source = document.getElementById('canvas');
      const canvas = new OffscreenCanvas(64, 64);
      const context = canvas.getContext('2d');
      context.drawImage(source, 0, 0, 64, 64);
      return new Set(new Uint32Array(context.getImageData(0, 0, 64, 64).data.buffer)).size;
    });
  }
}

const { server, address } = await serve();
const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: [
    '--no-sandbox',
    '--use-gl=angle',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
  ],
  protocolTimeout: 300000,
});
try {
  const page = await browser.newPage();
  await page.setViewport({ width: 1100, height: 720 });
  const faults = [];
  const asked = new Set();
  page.on('pageerror', (error) => faults.push(error.stack ?? error.message));
  page.on('request', (request) => {
    if (!request.url().startsWith('data:') && !request.url().startsWith('blob:'))
      asked.add(request.url());
  });
  await page.goto(address);
  const reader = new Reader(page);
  await page.waitForSelector('#drop:not([hidden])');
  assert.match(await reader.text('drop-formats'), /\.vti, \.nrrd, \.nii, \.nii\.gz, \.raw/);
  await page.screenshot({ path: join(screenshots, 'explore_empty.png') });

  // Damaged files before there is a picture, and formats that are none.
  const write = (name, bytes) => {
    writeFileSync(join(work, name), bytes);
    return join(work, name);
  };
  await reader.refuse(
    write('cut.vti', '<?xml version="1.0"?>\n<VTKFile type="ImageData"'),
    /cut\.vti is truncated or no VTK file/,
  );
  await reader.refuse(write('a.png', 'PNG'), /a\.png is of no known format/);

  // Every format.
  for (const name of ['v.vti', 'v.nrrd', 'v.nii', 'v.nii.gz']) {
    await reader.open(join(volumes, name));
    assert.equal(await reader.text('title'), name);
    assert.match(await reader.text('subtitle'), /values from 10 to 250/);
    assert.equal(await reader.message(), '');
  }
  await reader.drop(join(volumes, 'v.raw'));
  await page.waitForSelector('#raw-dialog[open]');
  await page.type('#raw-dialog input[name=samples]', '20 24 17');
  assert.match(
    await page.$eval('.raw-check', (e) => e.textContent),
    /These samples take 8160 bytes; the file has 8640/,
  );
  await page.screenshot({ path: join(screenshots, 'explore_raw.png') });
  await page.$eval('#raw-dialog input[name=samples]', (e) => {
    e.value = '';
  });
  await page.type('#raw-dialog input[name=samples]', '20 24 18');
  await page.click('#raw-dialog button[value=open]');
  await page.waitForFunction(() => document.getElementById('title').textContent === 'v.raw');

  // 129^3 samples, 100,000 triangles a frame.
  const budget = 100000;
  await reader.open(write('gyroid_129x129x129_float32.raw', gyroid(129)));
  await page.evaluate((count) => {
    location.hash = `#triangles=${count}`;
  }, budget);
  await reader.settle();
  await page.waitForFunction(
    (count) => window.nestgrid.idle && window.nestgrid.shown.request.includes(`triangles=${count}`),
    {},
    budget,
  );
  assert.ok((await reader.pixels()) > 50);
  await page.screenshot({ path: join(screenshots, 'explore.png') });
  const percent = (x) => `${(100 * x).toFixed(1)} %`;
  const assertHeld = (frames, slider, most) => {
    const moving = frames.filter((frame) => frame.motion === 'moving');
    const off = frames.map((frame) => frame.triangles / most - 1);
    const seconds = moving.reduce((sum, frame) => sum + frame.milliseconds, 0) / 1000;
    console.log(
      `${slider}: ${(moving.length / seconds).toFixed(1)} frames/s, triangles within ` +
        `${[Math.min(...off), Math.max(...off)].map(percent).join('/')} of ${most}`,
    );
    assert.equal(frames.length, 61);
    assert.ok(
      off.every((x) => Math.abs(x) <= 0.05),
      `${slider}: ${off}`,
    );
    assert.ok(frames.at(-1).motion === 'settled' && frames.at(-1).triangles <= most);
  };
  assertHeld(await reader.drag('isovalue'), 'isovalue', budget);
  await reader.choose('slice', 'z');
  await reader.settle();
  assertHeld(await reader.drag('slice-at'), 'slice', budget);
  await page.screenshot({ path: join(screenshots, 'explore_slice.png') });
  await reader.choose('slice', 'none');
  await reader.settle();
  const counts = await reader.drag('triangles');
  assert.equal(counts.length, 61);
  assert.ok(counts.at(-1).triangles > counts[0].triangles);
  await page.click('#by-threshold');
  await reader.settle();
  const thresholds = await reader.drag('threshold');
  assert.ok(thresholds.at(-1).triangles < thresholds[0].triangles);

  // Damaged files leave the picture, and the engine, as they are.
  const before = await reader.text('number-triangles');
  const nrrd = 'NRRD0004\ntype: float\ndimension: 3\nsizes: 2000 2000 2000\nencoding: raw\n\n';
  await reader.refuse(
    write('claim.nrrd', nrrd),
    /claim\.nrrd has 2000 x 2000 x 2000 samples of float32, which need 59\.6 GB/,
  );
  await reader.refuse(
    write('short_20x24x19_uint8.raw', 'abc'),
    /has 3 bytes, but 20 x 24 x 19 samples/,
  );
  await reader.refuse(join(volumes, 'nan.vti'), /not|nan|finite/i);
  assert.equal(await reader.text('number-triangles'), before);
  await page.click('#by-triangles');
  await reader.settle();
  assert.ok((await page.evaluate(() => window.nestgrid.shown.frame.triangles)) > 1000);

  assert.deepEqual(faults, []);
  for (const url of asked) assert.ok(url.startsWith(address), `the page asked for ${url}`);
  console.log(`${asked.size} files asked for, all from ${address}`);
} finally {
  await browser.close();
  server.kill();
  rmSync(work, { recursive: true });
}
