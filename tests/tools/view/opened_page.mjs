// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page of the program, and the one with the core as WebAssembly, with a volume in Chromium: what
// holds for one holds for the other.
import { spawn } from 'node:child_process';
import { createReadStream, existsSync } from 'node:fs';
import http from 'node:http';
import { extname, join } from 'node:path';

import { addressOf } from './checks.mjs';
import { Browser } from './chromium.mjs';

const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };

/** The files of a folder. */
function serve(folder) {
  const server = http.createServer((request, response) => {
    const name = request.url.split('?')[0].slice(1) || 'index.html';
    const path = join(folder, name);
    if (name.includes('..') || !existsSync(path)) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { 'content-type': types[extname(path)] ?? 'application/octet-stream' });
    createReadStream(path).pipe(response);
  });
  return new Promise((resolve) => { server.listen(0, '127.0.0.1', () => resolve(server)); });
}

export class OpenedPage {
  /**
   * kind: 'view', whose target is the program, or 'explore', whose target is a folder
   * volumes: files, the first of which 'explore' opens
   */
  static async open(kind, target, browserPath, pictures, volumes) {
    const opened = new OpenedPage();
    opened.volumes = volumes;
    opened.takesFiles = kind === 'explore';
    if (opened.takesFiles) {
      const server = await serve(target);
      opened.stop = () => server.close();
      opened.address = `http://127.0.0.1:${server.address().port}/`;
    } else {
      opened.program = spawn(target, ['view', ...volumes, '--no-browser'], { stdio: ['ignore', 'pipe', 'inherit'] });
      opened.stop = () => opened.program.kill('SIGKILL');
      opened.address = await addressOf(opened.program);
    }
    opened.browser = await Browser.open(browserPath, pictures);
    opened.page = opened.browser.page;
    return opened;
  }

  async close() {
    await this.browser.close();
    this.stop();
  }

  /** Until the picture is what was asked for last. */
  settled() {
    return this.page.waitForFunction(
      () => window.nestgrid?.shown?.motion === 'settled' && window.nestgrid.idle, { timeout: 120000 });
  }

  /** The page without a file, which the page of the program never is. */
  async goEmpty() {
    await this.page.goto('about:blank');
    await this.page.goto(this.address);
    await this.page.waitForSelector('#drop:not([hidden])');
  }

  /** A volume as an address describes it. */
  async go(hash = '') {
    await this.page.goto('about:blank');
    await this.page.goto(this.address + hash);
    if (this.takesFiles) await (await this.page.$('#file')).uploadFile(this.volumes[0]);
    await this.settled();
  }

  theme(scheme) {
    return this.page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: scheme }]);
  }
}
