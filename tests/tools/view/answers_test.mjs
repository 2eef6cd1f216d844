// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page answers: it shows that it works, what it has refused, and that its program hangs or is gone;
// readers cancel, and see what they have chosen. Messages are looked at, not read in the document.
// Arguments: the program, the browser, a folder for pictures, a volume in which a choice takes seconds.
import { spawn } from 'node:child_process';
import { resolve } from 'node:path';

import { addressOf, check, finish } from './checks.mjs';
import { Browser } from './chromium.mjs';

const [program, browserPath, folder, volume] = process.argv.slice(2);
const started = [];
const start = () => {
  const child = spawn(program, ['view', volume, '--no-browser'], { stdio: ['ignore', 'pipe', 'inherit'] });
  started.push(child);
  return child;
};
const pause = (milliseconds) => new Promise((done) => { setTimeout(done, milliseconds); });

const server = start();
const address = await addressOf(server);
const browser = await Browser.open(browserPath, resolve(folder));
const { page, complaints } = browser;
const settled = () => page.waitForFunction(
  () => window.nestgrid?.shown?.motion === 'settled' && window.nestgrid.idle, { timeout: 60000 });
const set = (id, value) => page.$eval(`#${id}`, (e, x) => {
  e.value = x;
  e.dispatchEvent(new Event('change'));
}, value);
const click = (id) => page.$eval(`#${id}`, (e) => e.click());
const busy = () => page.$$eval('[aria-busy=true]', (list) => list.map((e) => e.id).sort().join());
const visited = () => page.evaluate(() => window.nestgrid.shown.frame.visited);
const doing = async () => (await (await fetch(`${address}pulse`)).json()).doing;

try {
  await page.goto(address);
  await settled();

  // Where nothing is to do there is no bar.
  await browser.awaitHidden('work', 3000);
  check((await busy()) === '', 'the page works where nothing is to do');

  // A slow choice shows one after 300 ms; meanwhile the program answers.
  check(/slow at first/.test(await page.$eval('#indicator [value=visual]', (e) => e.textContent)),
    'a slow choice does not say so');
  const before = await visited();
  // Within the page, so that the test is as quick as a hand.
  const told = await page.evaluate(async () => {
    const byId = (id) => document.getElementById(id);
    const frame = () => new Promise((resolve) => { requestAnimationFrame(resolve); });
    const begin = performance.now();
    byId('indicator').value = 'visual';
    byId('indicator').dispatchEvent(new Event('change'));
    const atOnce = !byId('work').hidden;
    while (byId('work').hidden && performance.now() - begin < 20000) await frame();
    const appeared = performance.now() - begin;
    await new Promise((resolve) => { setTimeout(resolve, 100); });
    const { left, top, width, height } = byId('cancel').getBoundingClientRect();
    const found = {
      atOnce,
      appeared,
      busy: [...document.querySelectorAll('[aria-busy=true]')].map((e) => e.id).sort().join(),
      styles: [...byId('numbers').querySelectorAll('dd')].map((e) => getComputedStyle(e).fontStyle),
      top: document.elementFromPoint(left + width / 2, top + height / 2)?.id,
      doing: (await (await fetch('pulse')).json()).doing,
    };
    byId('cancel').click();
    return found;
  });
  check(!told.atOnce && told.appeared >= 290 && told.appeared < 2500, `the bar appears after ${told.appeared} ms`);
  check(told.busy === 'numbers,stage', `busy are ${told.busy}`);
  check(told.styles.every((style) => style === 'italic'), 'the old numbers are not dimmed');
  check(told.top === 'cancel', `on the button that cancels lies ${told.top}`);
  check(told.doing !== '', 'the program does not tell what it does');

  // Cancelled, the program stops, and the page shows and chooses what was there before.
  await browser.awaitHidden('work', 2000);
  check((await page.$eval('#indicator', (e) => e.value)) === 'offset', 'a cancelled choice stays chosen');
  check((await visited()) === before && (await busy()) === '', 'a cancelled choice changes the picture');
  await pause(500);
  check((await doing()) === '', `cancelled, the program goes on: ${await doing()}`);

  // The same choice, left alone, arrives; the next frame replaces one that nobody waits for.
  await page.select('#indicator', 'numerical');
  await pause(50);
  await page.select('#indicator', 'visual');
  await page.waitForSelector('#work:not([hidden])');
  await browser.picture('working');
  await page.waitForFunction(() => window.nestgrid.idle && window.nestgrid.shown.request.includes('visual'),
    { timeout: 120000 });
  await browser.awaitHidden('work');
  await page.select('#indicator', 'offset');
  await settled();

  // Nothing chosen, an empty stage; nothing found, a sentence.
  await click('surface');
  await browser.awaitSeen('empty', /Nothing is chosen/);
  check((await browser.look()).drawn < 1500 && (await page.$$eval('#numbers dd', (all) => all.length)) === 0,
    'nothing is chosen, and there is a picture');
  await browser.picture('empty');
  await click('surface');
  await settled();
  await browser.awaitHidden('empty');
  await set('isovalue-number', '1e30');
  await browser.awaitSeen('empty', /nothing here/);
  await page.evaluate(() => { location.hash = ''; });
  await browser.awaitHidden('empty');
  await settled();

  // A drag turns the picture and moves no lens.
  await page.select('#lens', 'click');
  await settled();
  await browser.drag([480, 400], [540, 430]);
  await pause(200);
  check(!(await page.evaluate(() => location.hash)).includes('centre='), 'a drag is taken for a click');
  await page.mouse.click(480, 400);
  await page.waitForFunction(() => location.hash.includes('centre='));
  await settled();

  // A program that is stopped is told, and goes on.
  for (const [width, height] of [[390, 700], [1280, 800]]) {
    await page.setViewport({ width, height });
    server.kill('SIGSTOP');
    const after = await browser.awaitSeen('connection', /does not answer/, 8000);
    console.log(`stopped, told after ${after} ms`);
    await browser.picture(`stopped_${width}`);
    server.kill('SIGCONT');
    await browser.awaitHidden('connection');
  }
  await set('isovalue', '300');
  await settled();

  // One that is killed while it draws is told at once, and another one goes on with the view.
  await set('isovalue', '310');
  server.kill('SIGKILL');
  const after = await browser.awaitSeen('connection', /has ended/, 5000);
  console.log(`killed, told after ${after} ms`);
  await browser.picture('ended');
  const view = new URL(page.url()).hash;
  await page.type('#new-address', 'nonsense');
  await page.keyboard.press('Enter');
  check((await page.$eval('#new-address', (e) => e.getAttribute('aria-invalid'))) === 'true', 'nonsense is an address');
  await page.$eval('#new-address', (e) => { e.value = ''; });
  const next = await addressOf(start());
  await page.type('#new-address', next);
  await Promise.all([page.waitForNavigation(), page.keyboard.press('Enter')]);
  await settled();
  check(page.url().startsWith(next) && new URL(page.url()).hash === view && view.includes('isovalue='),
    `the view ${view} became ${page.url()}`);
  check((await browser.seen('connection')) === '', 'a program that runs is told as ended');
  const unexpected = complaints.filter((text) => !/net::ERR_|Failed to fetch/.test(text));
  check(unexpected.length === 0, `the console says: ${unexpected.join('; ')}`);
} catch (error) {
  check(false, error.stack);
  await browser.picture('failed').catch(() => {});
} finally {
  await browser.close();
  for (const child of started) child.kill('SIGKILL');
}
finish();
