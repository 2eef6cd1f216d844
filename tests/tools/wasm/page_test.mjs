// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The folder explore in a browser, from a server that knows only files: a reader drops a volume,
// drags every slider through 60 places, and drops damaged files.
// Arguments: the folder explore, that of make_volumes.cpp, a volume of 129^3 samples, the package
// puppeteer-core, the browser, a folder for pictures.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';

const [folder, volumes, large, puppeteerFolder, browserPath, pictures] = process.argv.slice(2);
const { default: puppeteer } = await import(
  pathToFileURL(join(puppeteerFolder, 'lib/esm/puppeteer/puppeteer-core.js'))
);
mkdirSync(pictures, { recursive: true });
const work = mkdtempSync(join(tmpdir(), 'explore-'));

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

  /**
   * Drags a slider over 60 places and lets it go: the hand waits for the frame of each place, which
   * is not drawn. Returns the frames, and how many a second there were.
   */
  drag(id, from, to) {
    return this.page.evaluate(
      async (slider, first, last) => {
        const element = document.getElementById(slider);
        const { stage } = window.nestgrid;
        const { draw } = stage;
        stage.draw = () => {};
        const frames = [];
        const place = async (position, kind) => {
          const before = window.nestgrid.shown;
          element.value = String(Math.round(position));
          element.dispatchEvent(new Event(kind));
          while (window.nestgrid.shown === before || !window.nestgrid.idle) {
            await new Promise((resolve) => {
              const channel = new MessageChannel();
              channel.port1.onmessage = resolve;
              channel.port2.postMessage(0);
            });
          }
          frames.push(window.nestgrid.shown.frame.triangles);
        };
        const start = performance.now();
        for (let i = 0; i < 60; ++i) await place(first + (i / 59) * (last - first), 'input');
        const rate = 60000 / (performance.now() - start);
        await place(last, 'change');
        stage.draw = draw;
        return { frames, rate };
      },
      id,
      from,
      to,
    );
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
  executablePath: browserPath,
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
  assert.ok(await page.$eval('#panel', (panel) => panel.inert));
  assert.match(
    await reader.text('drop-formats'),
    /\.vti, \.mha, \.mhd, \.nrrd, \.nhdr, \.nii, \.nii\.gz, \.raw/,
  );
  await page.screenshot({ path: join(pictures, 'explore_empty.png') });

  // Readers come when a file needs them.
  const loaded = () =>
    [...asked].filter((url) => url.includes('/readers/')).map((url) => url.split('/').at(-1));
  assert.deepEqual(loaded().sort(), ['open_volume.js', 'volume.js']);

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
    const own = { 'v.vti': 'vti.js', 'v.nrrd': 'nrrd.js' }[name] ?? 'nifti.js';
    assert.ok(loaded().includes(own), `${own} is not asked for`);
  }
  assert.ok(
    !loaded().some((name) => ['raw.js', 'meta_image.js'].includes(name)),
    `asked for: ${loaded()}`,
  );
  // Members of gzip, and what is behind them, which browsers do not unpack.
  const whole = readFileSync(join(volumes, 'v.nii'));
  const members = [0, 100, 3000].map((from, i, all) => gzipSync(whole.subarray(from, all[i + 1])));
  for (const behind of [[], [0, 0, 0]]) {
    const name = `members_${behind.length}.nii.gz`;
    await reader.open(write(name, Buffer.concat([...members, Buffer.from(behind)])));
    assert.equal(await reader.text('title'), name);
    assert.match(await reader.text('subtitle'), /values from 10 to 250/);
  }
  const damaged = Buffer.concat(members);
  damaged[members[0].length - 6] ^= 1;
  await reader.refuse(write('sum.nii.gz', damaged), /sum\.nii\.gz is truncated or damaged/);
  await reader.drop(join(volumes, 'v.raw'));
  await page.waitForSelector('#raw-dialog[open]');
  await page.type('#raw-dialog input[name=samples]', '20 24 17');
  assert.match(
    await page.$eval('.raw-check', (e) => e.textContent),
    /These samples take 8160 bytes; the file has 8640/,
  );
  await page.screenshot({ path: join(pictures, 'explore_raw.png') });
  await page.$eval('#raw-dialog input[name=samples]', (e) => {
    e.value = '';
  });
  await page.type('#raw-dialog input[name=samples]', '20 24 18');
  await page.click('#raw-dialog button[value=open]');
  await page.waitForFunction(() => document.getElementById('title').textContent === 'v.raw');

  // Another file begins anew.
  await reader.choose('isovalue', '900');
  await reader.settle();
  assert.match(page.url(), /isovalue=226/);
  // 129^3 samples, 100,000 triangles a frame.
  const budget = 100000;
  await reader.open(large);
  assert.doesNotMatch(page.url(), /isovalue=/);
  await page.evaluate((count) => {
    location.hash = `#triangles=${count}`;
  }, budget);
  await page.waitForFunction(
    (count) => window.nestgrid.idle && window.nestgrid.shown.request.includes(`triangles=${count}`),
    {},
    budget,
  );
  assert.ok((await reader.pixels()) > 50);
  await page.screenshot({ path: join(pictures, 'explore.png') });
  const drag = async (slider, from, to, most) => {
    const { frames, rate } = await reader.drag(slider, from, to);
    console.log(
      `${slider}: ${rate.toFixed(1)} frames/s, ${frames[0]} to ${frames.at(-1)} triangles`,
    );
    assert.equal(frames.length, 61);
    if (!most) return frames;
    const off = frames.map((triangles) => Math.abs(triangles / most - 1));
    assert.ok(Math.max(...off) <= 0.05, `${slider}: triangles are ${Math.max(...off)} off`);
    assert.ok(frames.at(-1) <= most, `${slider}: ${frames.at(-1)} triangles where it was let go`);
    return frames;
  };
  await drag('isovalue', 250, 400, budget);
  await reader.choose('slice', 'z');
  await reader.settle();
  await drag('slice-at', 300, 700, budget);
  await page.screenshot({ path: join(pictures, 'explore_slice.png') });
  await reader.choose('slice', 'none');
  await reader.settle();
  const counts = await drag('triangles', 200, 500);
  // The first frames follow the leap from 100,000 triangles.
  assert.ok(counts.at(-1) > 2 * counts[10]);
  await page.click('#by-threshold');
  await reader.settle();
  const thresholds = await drag('threshold', 900, 300);
  assert.ok(thresholds.at(-1) > 2 * thresholds[0]);

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
