// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Errors and distances that a reader asks for in the page of the program, and in the one with the core
// as WebAssembly: what is asked for is kept and told.
// Arguments: view or explore, the program or the folder, the browser, a folder for pictures, volumes.
import { check, finish } from './checks.mjs';
import { OpenedPage } from './opened_page.mjs';

const [kind, target, browserPath, pictures, ...volumes] = process.argv.slice(2);
const opened = await OpenedPage.open(kind, target, browserPath, pictures, volumes);
const { page, browser } = opened;

const text = (id) => browser.text(id);
const frame = () => page.evaluate(() => {
  const { parts, ...numbers } = window.nestgrid.shown.frame;
  return { ...numbers, request: window.nestgrid.shown.request };
});
const click = async (id) => {
  await page.$eval(`#${id}`, (control) => control.click());
  await opened.settled();
};
/** Puts a slider at a place, by the hand that lets it go ('change') or still moves it ('input'). */
const slide = async (id, position, event = 'change') => {
  await page.evaluate(({ id: slider, position: value, event: kindOfEvent }) => {
    const control = document.getElementById(slider);
    window.nestgrid.before = window.nestgrid.shown;
    control.value = String(value);
    control.dispatchEvent(new Event(kindOfEvent, { bubbles: true }));
  }, { id, position, event });
  await page.waitForFunction(() => window.nestgrid.shown !== window.nestgrid.before && window.nestgrid.idle);
};
const whyOf = (id) => page.$eval(`#${id}`, (control) => (control.disabled
  ? control.closest('label').querySelector('.why').textContent : ''));
const inTwoDigits = /^([\d.e-]+) %(?: · ([\d.e-]+)(?: \S+)?)?$/;
const range = () => page.$eval('#subtitle', (line) => {
  const [, least, greatest] = /values from (\S+) to (\S+)$/.exec(line.textContent);
  return Number(greatest) - Number(least);
});

try {
  await opened.go();
  const all = await range();
  check(inTwoDigits.test(await text('number-within')), `a number of triangles is within ${await text('number-within')}`);

  // An error is kept, and told with the distance that it is about.
  await click('by-error');
  for (const position of [400, 600, 800]) {
    await slide('error', position);
    const { error_bound: bound, threshold: asked, distance, request } = await frame();
    check(request.includes('error=') && !request.includes('indicator='), `an error asks for ${request}`);
    check(bound > 0 && bound <= asked, `${bound} is told of an error of ${asked}`);
    const told = inTwoDigits.exec(await text('number-within'));
    check(told && Math.abs(Number(told[1]) - (100 * bound) / all) <= 0.06 * Number(told[1]),
      `an error of ${bound} is told as ${await text('number-within')}`);
    check(told?.[2] && Math.abs(Number(told[2]) - distance) <= 0.06 * distance,
      `a distance of ${distance} is told as ${await text('number-within')}`);
    check(/^at most \S+ \(\S+ % of the range\)$/.test(await text('error-text')), await text('error-text'));
    check((await text('numbers')).includes('error asked for'), 'what was asked for is not told');
  }
  check((await whyOf('indicator')) === 'the error decides', `the indicator is dimmed: ${await whyOf('indicator')}`);
  const coarse = await frame();
  await slide('isovalue', 400, 'input');
  const moving = await frame();
  check(moving.error_bound <= coarse.threshold && moving.distance === null, 'a moving frame keeps no error');
  await slide('isovalue', 400);

  // Collapsed triangles keep it, too, and have no outlines.
  await slide('error', 700);
  const before = await frame();
  await click('collapse');
  const collapsed = await frame();
  check(collapsed.triangles < before.triangles / 2, `${collapsed.triangles} of ${before.triangles} triangles are left`);
  check(collapsed.error_bound <= before.threshold, `collapsed within ${collapsed.error_bound} of ${before.threshold}`);
  check(await page.$eval('#outlines', (box) => box.disabled), 'collapsed triangles have outlines');
  const link = page.url();
  check(link.includes('collapse=on') && link.includes('detail=error'), `the address tells nothing: ${link}`);
  await opened.go(new URL(link).hash);
  check((await frame()).triangles === collapsed.triangles, 'the address brings another picture');
  check((await whyOf('cap')) === 'a collapsed surface stays open', 'a collapsed surface has a cap');
  await click('collapse');
  check(await page.$eval('#positions-controls', (controls) => controls.hidden), 'a volume has curved elements');

  // A cap closes the surface, where it meets the boundary.
  await slide('isovalue', 15);
  const open = await frame();
  await click('cap');
  const closed = await frame();
  check(closed.request.includes('cap=on'), `no cap is asked for: ${closed.request}`);
  check(closed.triangles > open.triangles, `${closed.triangles} triangles with a cap, ${open.triangles} without`);
  check(page.url().includes('cap=on'), `the address tells nothing of the cap: ${page.url()}`);
  await click('cap');
  await slide('isovalue', 400);

  // Several isosurfaces, a slice along a sphere and the boundary, with areas and volumes.
  await page.$eval('#more', (field) => {
    field.value = '80 120';
    field.dispatchEvent(new Event('change', { bubbles: true }));
  });
  await opened.settled();
  await page.select('#slice', 'sphere');
  await opened.settled();
  await click('boundary');
  const parts = await page.evaluate(() => window.nestgrid.shown.frame.parts.map(
    ({ kind, isovalue, area, volume }) => ({ kind, isovalue, area, volume })));
  check(parts.map(({ kind }) => kind).join(' ') === 'slice boundary isosurface isosurface isosurface',
    `the parts are ${JSON.stringify(parts)}`);
  const surfaces = parts.slice(2);
  check(surfaces[1].isovalue === 80 && surfaces[2].isovalue === 120, JSON.stringify(surfaces));
  check((await text('number-area')).split(' · ').length === 3, `the areas are ${await text('number-area')}`);
  check(page.url().includes('more=80,120') && page.url().includes('slice=sphere')
    && page.url().includes('boundary=on'), `the address tells nothing of the parts: ${page.url()}`);
  await page.$eval('#more', (field) => {
    field.value = 'many';
    field.dispatchEvent(new Event('change', { bubbles: true }));
  });
  check(await page.$eval('#more', (field) => field.getAttribute('aria-invalid')) === 'true', 'many is an isovalue');
  check((await frame()).request.includes('80,120'), 'what is no number takes isovalues away');
  await opened.go('#detail=error');

  // What else a frame may be asked for: each control puts it into the request and the address, and brings
  // it back; where it means nothing, the reader is told why, and it is not asked for.
  const put = async (id, value) => {
    await page.$eval(`#${id}`, (field, to) => {
      field.value = to;
      field.dispatchEvent(new Event('change', { bubbles: true }));
    }, value);
    await opened.settled();
  };
  await opened.go('#detail=threshold&slice=sphere');
  const shown = await range();
  check((await whyOf('distance_field')) === 'only for a distance', await whyOf('distance_field'));
  await put('band', `${0.3 * shown} ${0.4 * shown}`);
  await put('lines', '4');
  await put('colour_tolerance', `${0.02 * shown}`);
  await put('blend', '2');
  check((await whyOf('box')) === 'not while nodes move', await whyOf('box'));
  await put('blend', '');
  await put('box', '0, 30, 0, 30, 0, 30');
  await put('cuts', 'linear');
  await click('at_nodes');
  await click('measure');
  const { request: more } = await frame();
  for (const key of ['band=', 'lines=', 'colour_tolerance=', 'box=0,30,0,30,0,30', 'cuts=linear', 'at_nodes=on',
    'measure=on']) {
    check(more.includes(key), `${key} is not asked for: ${more}`);
    check(page.url().includes(key), `${key} is not in the address: ${page.url()}`);
  }
  check(!more.includes('blend='), `what was taken back is asked for: ${more}`);
  const kinds = () => page.evaluate(() => window.nestgrid.shown.frame.parts.map(({ kind }) => kind).join(' '));
  check((await kinds()) === 'slice isolines band isosurface', `the parts are ${await kinds()}`);
  check(inTwoDigits.test(await text('number-measured')), `the error is measured as ${await text('number-measured')}`);
  const again = new URL(page.url()).hash;
  await opened.go(again);
  check((await frame()).request === more, 'the address asks for something else');
  await put('lines', 'many');
  check(await page.$eval('#lines', (field) => field.getAttribute('aria-invalid')) === 'true', 'many is a number');
  check((await frame()).request === more, 'what is no number changes the request');
  await opened.go('#detail=distance&distance_field=on&blend=-1&box=1,2&lines=3');
  const kept = (await frame()).request;
  check(kept.includes('distance_field=on'), `the distance is not kept: ${kept}`);
  check(!/blend|box|lines/.test(kept), `what means nothing is asked for: ${kept}`);
  await opened.go('#detail=error&collapse=on&slice=sphere&slice_distance=0.5');
  check((await frame()).request.includes('slice_distance=0.5'), 'slices are not collapsed');
  await opened.go('#detail=error');

  // A distance is about kept; while something moves, the number of triangles is.
  await click('by-distance');
  let last = Infinity;
  for (const position of [300, 500, 700]) {
    await slide('distance', position);
    const { distance, threshold: asked, triangles } = await frame();
    check(distance > 0 && distance <= asked, `${distance} is told of a distance of ${asked}`);
    check(triangles < last, 'a greater distance has no fewer triangles');
    last = triangles;
    check((await text('distance-text')).startsWith('about '), await text('distance-text'));
  }
  await slide('isovalue', 410, 'input');
  check(Math.abs((await frame()).triangles / last - 1) < 0.1, `${(await frame()).triangles} triangles move, not ${last}`);
  await slide('isovalue', 410);
  await page.select('#slice', 'z');
  await click('surface');
  check((await whyOf('by-distance')) === 'only of an isosurface', 'slices have a distance');
  check((await frame()).request.includes('triangles='), 'a slice is drawn at a distance');
  await click('surface');
  check((await frame()).request.includes('distance='), 'the distance is forgotten');

  await opened.go('#detail=error&error=-1');
  check((await frame()).error_bound > 0, 'a broken address leaves no picture');
  check(browser.complaints.length === 0, `the console says: ${browser.complaints.join('; ')}`);
} catch (error) {
  check(false, error.stack);
  await browser.picture(`${kind}_detail_failed`).catch(() => {});
} finally {
  await opened.close();
}
finish();
