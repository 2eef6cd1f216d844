// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page in Chromium without a screen, and what a reader sees there.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import puppeteer from 'puppeteer-core';

/** The number in a text with separators of thousands. */
export const count = (text) => Number(text.replace(/\D/g, ''));

export class Browser {
  /** What the console of the page says of errors. */
  complaints = [];

  /** pictures: a folder, which is made */
  static async open(browserPath, pictures) {
    mkdirSync(pictures, { recursive: true });
    const opened = new Browser();
    opened.pictures = pictures;
    opened.browser = await puppeteer.launch({
      executablePath: browserPath,
      args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
    });
    opened.page = await opened.browser.newPage();
    opened.page.setDefaultTimeout(120000);  // other work may have all processors
    await opened.page.setViewport({ width: 1280, height: 800 });
    opened.page.on('pageerror', (error) => opened.complaints.push(error.message));
    opened.page.on('console', (message) => {
      if (message.type() === 'error') opened.complaints.push(message.text());
    });
    return opened;
  }

  close() {
    return this.browser.close();
  }

  /** What an element says. */
  text(id) {
    return this.page.$eval(`#${id}`, (e) => e.textContent.trim());
  }

  /** What a reader sees of an element: its text, or '' where it is hidden, empty or under something. */
  seen(id) {
    return this.page.evaluate((name) => {
      const element = document.getElementById(name);
      const { left, top, width, height } = element.getBoundingClientRect();
      const text = element.textContent.trim();
      if (width === 0 || height === 0 || text === '') return '';
      const corners = [[0.5, 0.5], [0.02, 0.5], [0.98, 0.5], [0.5, 0.1], [0.5, 0.9]];
      const lies = corners.every(([x, y]) => {
        const found = document.elementFromPoint(left + x * width, top + y * height);
        return element.contains(found);
      });
      return lies ? text : '';
    }, id);
  }

  /** Waits until a reader sees an element that says something. \return how many milliseconds that took */
  async awaitSeen(id, pattern, milliseconds = 10000) {
    const begin = Date.now();
    for (;;) {
      if (pattern.test(await this.seen(id))) return Date.now() - begin;
      if (Date.now() - begin > milliseconds) {
        throw new Error(`#${id} is seen as '${await this.seen(id)}', its text is '${await this.text(id)}'`);
      }
      await new Promise((resolve) => { setTimeout(resolve, 20); });
    }
  }

  async awaitHidden(id, milliseconds = 10000) {
    await this.page.waitForSelector(`#${id}[hidden]`, { timeout: milliseconds });
  }

  picture(name) {
    return this.page.screenshot({ path: join(this.pictures, `${name}.png`) });
  }

  async drag(from, to) {
    await this.page.mouse.move(...from);
    await this.page.mouse.down();
    await this.page.mouse.move(...to, { steps: 4 });
    await this.page.mouse.up();
  }

  camera() {
    return this.page.evaluate(() => window.nestgrid.stage.camera);
  }

  /** How many colours the picture has, and how much of it is not ground. */
  look() {
    return this.page.evaluate(() => {
      const source = document.getElementById('canvas');
      window.nestgrid.stage.drawNow();
      const copy = document.createElement('canvas');
      copy.width = copy.height = 100;
      const context = copy.getContext('2d');
      context.drawImage(source, 0, 0, 100, 100);
      const { data } = context.getImageData(0, 0, 100, 100);
      const seen = new Map();
      for (let i = 0; i < data.length; i += 4) {
        const colour = data.slice(i, i + 3).join();
        seen.set(colour, (seen.get(colour) ?? 0) + 1);
      }
      return { colours: seen.size, drawn: 10000 - Math.max(...seen.values()) };
    });
  }
}
